//! Against what the reference encoder (meshoptimizer's `encodeGltfBuffer`) makes of known numbers.

use super::decode;
use crate::json::MeshoptCompression;

const ATTRIBUTES: &str = "a02a0eeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeee0000000010002000001f004ade8d069ad13d56ea\
     8112a6c53162f6751eb2b9256efd692abead197af15dffff000036caa10d86e551421a00022244446668\
     88a8acacceeeefffff1010101210ffff000014121414141416162a055555555555555555555555555555\
     555555555500000000011000000015303c0f0306f5f61a19d5c0f03c0fd63a39b5b65a5903c000009596\
     15003c0f0326254e4d74c0f03c0f739c9bc2c1eae903c00000eff0000000000000000000000000000000\
     0000000000000000000000000000000000";
const TRIANGLES: &str = "e1fe1e100e100e100e100efe1e190e180e170e160eff1e160e160e160e160eff1e160e160e160e160eff\
     fe0f0c9f025f090c5f090cff0039d00fffc90fcc0f007687566778a9866589689801690000";
const SEQUENCE: &str = "d1000404a11f04050405f0d20e931f01011300000000";
const OCTAHEDRAL_8: &str = "a0013f0000006cea57013fc000009117aafe00013fc000000403fdfe0000000000000000000000000000\
     000000000000000000000000000000007f7f";
const OCTAHEDRAL_16: &str = "a0013f000000da7ca8013f00000006111a013f400000dc7aaa0137c00000090c0e0000013e4000000403\
     0127c00000fdfe00000000000000000000000000000000000000000000000000000000ff07ff7f";
const QUATERNION: &str = "a0013f000000bf33f4013f0000002c2307013fc00000bf1a5a4c013fc000002c127538013f000000bf4b\
     f3013f0000002c350a013980000005000000000000000000000000000000000000000000000000000000\
     00000000ff1f";
const EXPONENTIAL: &str = "a0013c00000004030000013c0000002619010c00000098010c00000091013c000000070e013c00000026\
     19013c000000403f013c000000bd21013c000000160f013c000000261900000000000000000000000000\
     00000000000000000000ee000004ee0000fcee";

fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<u8> = hex.chars().filter_map(|c| c.to_digit(16)).map(|d| d as u8).collect();
    digits.chunks_exact(2).map(|d| d[0] << 4 | d[1]).collect()
}

fn desc(mode: &str, filter: &str, count: u64, stride: u64) -> MeshoptCompression {
    MeshoptCompression {
        buffer: 0,
        byte_offset: 0,
        byte_length: 0,
        byte_stride: stride,
        count,
        mode: mode.to_owned(),
        filter: Some(filter.to_owned()),
    }
}

fn words(bytes: &[u8]) -> Vec<u16> {
    bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
}

#[test]
fn attributes_come_back() {
    let decoded = decode(&desc("ATTRIBUTES", "NONE", 40, 8), &bytes(ATTRIBUTES)).unwrap();
    let expected: Vec<u16> = (0..40_u16)
        .flat_map(|i| {
            let last = if i.is_multiple_of(5) { i * 1000 } else { 3 };
            [i * 7, (u32::from(i) * u32::from(i) * 37) as u16, (i * 3).wrapping_neg(), last]
        })
        .collect();
    assert_eq!(words(&decoded), expected);
}

#[test]
fn triangles_come_back() {
    let decoded = decode(&desc("TRIANGLES", "NONE", 126, 4), &bytes(TRIANGLES)).unwrap();
    let decoded: Vec<u32> = words(&decoded).chunks(2).map(|w| w[0].into()).collect();
    let cell = |i: u32| [i, i + 1, i + 6, i + 6, i + 1, i + 7];
    let mut expected: Vec<u32> =
        (0..4).flat_map(|y| (0..5).flat_map(move |x| cell(y * 6 + x))).collect();
    expected.extend([29, 0, 1000, 1001, 7, 3]);
    // The encoder may turn a triangle's corners round.
    let turned = |triangle: &[u32]| {
        let first = (0..3).min_by_key(|&i| triangle[i]).unwrap();
        [0, 1, 2].map(|i| triangle[(first + i) % 3])
    };
    let of = |indices: &[u32]| indices.chunks(3).map(turned).collect::<Vec<_>>();
    assert_eq!(of(&decoded), of(&expected));
}

#[test]
fn sequences_come_back() {
    let decoded = decode(&desc("INDICES", "NONE", 13, 2), &bytes(SEQUENCE)).unwrap();
    assert_eq!(words(&decoded), [0, 1, 2, 1000, 3, 1001, 4, 1002, 60000, 5, 5, 5, 0]);
}

#[test]
fn filters_give_the_numbers_within_their_bits() {
    let close = |a: &[f64], b: &[f64], tolerance: f64| {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= tolerance, "{a} is not {b}");
        }
    };
    let vectors = [
        [0.0, 0.0, 1.0, 1.0],
        [0.6, -0.8, 0.0, -1.0],
        [-0.577, -0.577, -0.577, 1.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, -1.0, 1.0],
    ];
    let decoded = decode(&desc("ATTRIBUTES", "OCTAHEDRAL", 5, 4), &bytes(OCTAHEDRAL_8)).unwrap();
    let decoded: Vec<f64> = decoded.iter().map(|&b| f64::from(b as i8) / 127.0).collect();
    close(&decoded, vectors.as_flattened(), 0.015);

    let decoded = decode(&desc("ATTRIBUTES", "OCTAHEDRAL", 5, 8), &bytes(OCTAHEDRAL_16)).unwrap();
    let decoded: Vec<f64> =
        words(&decoded).iter().map(|&w| f64::from(w as i16) / 32767.0).collect();
    for (decoded, vector) in decoded.chunks(4).zip(&vectors) {
        close(&decoded[..3], &vector[..3], 0.001);
    }

    // The largest component comes back positive: a quaternion and its opposite turn alike.
    let turns = [
        [0.0, 0.0, 0.0, 1.0],
        [0.5, 0.5, 0.5, 0.5],
        [-0.1, 0.7, 0.1, 0.7],
        [0.8, 0.0, -0.6, 0.0],
        [0.0, 1.0, 0.0, 0.0],
    ];
    let decoded = decode(&desc("ATTRIBUTES", "QUATERNION", 5, 8), &bytes(QUATERNION)).unwrap();
    let decoded: Vec<f64> =
        words(&decoded).iter().map(|&w| f64::from(w as i16) / 32767.0).collect();
    close(&decoded, turns.as_flattened(), 0.001);

    let numbers = [0.0_f64, 1.0, -1.0, 3.25, -0.001, 1e6, 1e-9, 123.456, -7.0];
    let decoded = decode(&desc("ATTRIBUTES", "EXPONENTIAL", 3, 12), &bytes(EXPONENTIAL)).unwrap();
    let floats = decoded.chunks(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    for (i, (x, expected)) in floats.zip(numbers).enumerate() {
        // 20 bits, with one exponent for the three numbers of an element.
        let vector = &numbers[i / 3 * 3..][..3];
        let largest = vector.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let x = f64::from(x);
        assert!((x - expected).abs() <= largest / 2.0_f64.powi(18), "{x} is not {expected}");
    }
}

#[test]
fn cut_off_and_damaged_data_is_an_error() {
    let all = [
        (desc("ATTRIBUTES", "NONE", 40, 8), ATTRIBUTES),
        (desc("TRIANGLES", "NONE", 126, 4), TRIANGLES),
        (desc("INDICES", "NONE", 13, 2), SEQUENCE),
    ];
    for (desc, hex) in all {
        let whole = bytes(hex);
        for n in 0..whole.len() {
            assert!(decode(&desc, &whole[..n]).is_err(), "{} cut to {n} bytes", desc.mode);
            // Anything may come out of damaged bytes, but nothing may go wrong.
            for flip in [1, 0x80, 0xff] {
                let mut damaged = whole.clone();
                damaged[n] ^= flip;
                let _ = decode(&desc, &damaged);
            }
        }
        let many = MeshoptCompression { count: 3 << 40, ..desc };
        assert!(decode(&many, &whole).is_err());
    }
}

#[test]
fn wrong_layouts_are_errors() {
    for (mode, filter, count, stride, part) in [
        ("ATTRIBUTES", "NONE", 4, 6, "byteStride"),
        ("ATTRIBUTES", "NONE", 4, 260, "byteStride"),
        ("ATTRIBUTES", "NONE", 4, 0, "byteStride"),
        ("ATTRIBUTES", "OCTAHEDRAL", 40, 12, "byteStride"),
        ("ATTRIBUTES", "SQUARE", 40, 8, "SQUARE"),
        ("ATTRIBUTES", "QUATERNION", 40, 4, "byteStride"),
        ("TRIANGLES", "NONE", 4, 4, "triangles"),
        ("INDICES", "OCTAHEDRAL", 4, 4, "filter"),
        ("POINTS", "NONE", 4, 4, "POINTS"),
    ] {
        let result = decode(&desc(mode, filter, count, stride), &bytes(ATTRIBUTES));
        let message = result.unwrap_err();
        assert!(message.contains(part), "{mode} {filter} {stride}: {message}");
    }
}
