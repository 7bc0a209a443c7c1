//! Round trips through files, and files that mean harm.

use std::path::PathBuf;

use proptest::prelude::*;
use tempfile::TempDir;

use super::*;
use crate::{Metadata, Transfer, compare, encode, linear_to_srgb8, write};

const FORMATS: [Format; 5] = [Format::Png, Format::Jpeg, Format::Hdr, Format::Exr, Format::Pfm];
const SMALL: Limits = Limits { max_width: 64, max_height: 64, max_bytes: 64 * 64 * 12 };

/// A smooth picture with values in [0, 1], of 37 x 41 pixels.
fn picture() -> Picture {
    let pixels = (0..41 * 37)
        .map(|i| {
            let (x, y) = ((i % 37) as f32 / 36.0, (i / 37) as f32 / 40.0);
            [x, y, 0.5 * (x + y)]
        })
        .collect();
    Picture { width: 37, height: 41, pixels }
}

fn bytes_of(format: Format, picture: &Picture) -> Vec<u8> {
    encode(format, picture, None, Transfer::Srgb).unwrap()
}

/// A file of the given content; the folder lives as long as it is held.
fn file_of(name: &str, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn round_trip(name: &str, picture: &Picture) -> Picture {
    let (_folder, path) = file_of(name, b"what was there before");
    write(&path, picture, None, Transfer::Srgb).unwrap();
    read_picture(&path).unwrap()
}

#[test]
fn exr_and_pfm_keep_every_bit() {
    let mut picture = picture();
    let odd = [f32::NAN, f32::INFINITY, -0.0, -7.5, f32::MIN_POSITIVE / 8.0, f32::MAX];
    for (pixel, value) in picture.pixels.iter_mut().zip(odd) {
        pixel[1] = value;
    }
    for name in ["a.exr", "a.pfm"] {
        let comparison = compare(&picture, &round_trip(name, &picture)).unwrap();
        assert_eq!(comparison.n_differing_pixels, 0, "{name}: {comparison:?}");
    }
}

#[test]
fn hdr_keeps_eight_bits_of_the_largest_channel() {
    for width in [1, 7, 8, 300] {
        let pixels: Vec<_> =
            (0..width * 5).map(|i| [0.01 * i as f32, 3.0, (i / 9) as f32 * 100.0]).collect();
        let picture = Picture { width, height: 5, pixels };
        let back = round_trip("a.hdr", &picture);
        assert_eq!((back.width, back.height), (width, 5));
        for (a, b) in picture.pixels.iter().zip(&back.pixels) {
            let tolerance = a.iter().fold(0.0f32, |m, &v| m.max(v)) / 256.0;
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() <= tolerance, "{a} became {b}");
            }
        }
        // What the format can hold is held exactly.
        assert_eq!(round_trip("a.hdr", &back), back);
    }
}

#[test]
fn png_keeps_the_nearest_srgb_codes() {
    let picture = picture();
    let table = srgb::srgb8_to_linear_table();
    let expected = picture.pixels.iter().map(|p| p.map(|v| table[linear_to_srgb8(v) as usize]));
    assert_eq!(round_trip("a.png", &picture).pixels, expected.collect::<Vec<_>>());
}

#[test]
fn jpeg_is_near() {
    let comparison = compare(&picture(), &round_trip("a.jpg", &picture())).unwrap();
    assert!(comparison.psnr_db > 40.0, "{comparison:?}");
}

/// The promise of the same texels everywhere: these hashes hold on any machine, whether it has
/// AVX2, NEON or neither. The odd size makes partial blocks; chroma is
/// whole, halved across, and halved both ways in a progressive file.
#[test]
fn jpeg_bytes_and_texels_are_the_same_on_every_machine() {
    use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

    let fnv = |bytes: &[u8]| {
        bytes.iter().fold(0xcbf2_9ce4_8422_2325u64, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        })
    };
    // Noise, so that every coefficient is in use.
    let noise: Vec<u8> = (0u32..61 * 43 * 3)
        .map(|i| {
            (i.wrapping_mul(2_654_435_761).rotate_left(9).wrapping_mul(0x9e37_79b9) >> 24) as u8
        })
        .collect();
    let mut hashes = Vec::new();
    for (sampling, progressive) in [
        (SamplingFactor::F_1_1, false),
        (SamplingFactor::F_2_1, false),
        (SamplingFactor::F_2_2, true),
    ] {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 85);
        encoder.set_sampling_factor(sampling);
        encoder.set_progressive(progressive);
        encoder.encode(&noise, 61, 43, ColorType::Rgb).unwrap();
        let Texels::Srgb8(texels) = decode(&bytes, &SMALL).unwrap().texels else {
            panic!("a JPEG has 8-bit texels")
        };
        hashes.push((fnv(&bytes), fnv(texels.as_flattened())));
    }
    let expected = [
        (0x90cb_7ede_aa72_1b74, 0x9441_92c9_2479_6528),
        (0x568f_57df_d907_25df, 0x22ce_572b_de72_88da),
        (0x5394_1692_1ed6_89d1, 0x706f_40bc_e50e_6dfd),
    ];
    assert_eq!(hashes, expected, "{hashes:#x?}");
}

#[test]
fn png_of_every_colour_type_becomes_a_texture() {
    use ::png::{BitDepth, ColorType};

    // (colour type, depth, bytes of one row of two texels, expected)
    let cases: [(ColorType, BitDepth, &[u8], Texels); 7] = [
        (
            ColorType::Rgb,
            BitDepth::Eight,
            &[1, 2, 3, 4, 5, 6],
            Texels::Srgb8(vec![[1, 2, 3, 255], [4, 5, 6, 255]]),
        ),
        (
            ColorType::Rgba,
            BitDepth::Eight,
            &[1, 2, 3, 4, 5, 6, 7, 8],
            Texels::Srgb8(vec![[1, 2, 3, 4], [5, 6, 7, 8]]),
        ),
        (
            ColorType::Grayscale,
            BitDepth::Eight,
            &[9, 200],
            Texels::Srgb8(vec![[9, 9, 9, 255], [200, 200, 200, 255]]),
        ),
        (
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            &[9, 10, 200, 0],
            Texels::Srgb8(vec![[9, 9, 9, 10], [200, 200, 200, 0]]),
        ),
        (
            ColorType::Grayscale,
            BitDepth::One,
            &[0b1000_0000],
            Texels::Srgb8(vec![[255; 4], [0, 0, 0, 255]]),
        ),
        (
            ColorType::Grayscale,
            BitDepth::Sixteen,
            &[0xff, 0xff, 0, 0],
            Texels::Srgb16(vec![[0xffff; 4], [0, 0, 0, 0xffff]]),
        ),
        (
            ColorType::Rgba,
            BitDepth::Sixteen,
            &[0xff, 0xff, 0, 0, 0x80, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1],
            Texels::Srgb16(vec![[0xffff, 0, 0x8080, 0], [0, 0, 0, 0x0101]]),
        ),
    ];
    for (color, depth, row, expected) in cases {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(row).unwrap();
        writer.finish().unwrap();
        assert_eq!(decode(&bytes, &SMALL).unwrap().texels, expected, "{color:?} {depth:?}");
    }

    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(ColorType::Indexed);
    encoder.set_palette(vec![1, 2, 3, 4, 5, 6]);
    encoder.set_trns(vec![7]);
    encoder.write_header().unwrap().write_image_data(&[1, 0]).unwrap();
    let expected = Texels::Srgb8(vec![[4, 5, 6, 255], [1, 2, 3, 7]]);
    assert_eq!(decode(&bytes, &SMALL).unwrap().texels, expected);
}

#[test]
fn grey_jpeg_is_expanded() {
    let mut bytes = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut bytes, 100);
    encoder.encode(&[100; 64], 8, 8, jpeg_encoder::ColorType::Luma).unwrap();
    assert_eq!(
        decode(&bytes, &SMALL).unwrap().texels,
        Texels::Srgb8(vec![[100, 100, 100, 255]; 64])
    );
}

#[test]
fn half_float_and_grey_exr_are_read() {
    use ::exr::prelude::{
        Encoding, Image, Layer, LayerAttributes, SpecificChannels, WritableImage, f16,
    };

    let mut bytes = std::io::Cursor::new(Vec::new());
    let channels = SpecificChannels::rgba(|p: ::exr::math::Vec2<usize>| {
        (f16::from_f32(0.5), f16::from_f32(p.0 as f32), f16::from_f32(p.1 as f32), f16::ONE)
    });
    let layer =
        Layer::new((3, 2), LayerAttributes::named("main"), Encoding::SMALL_LOSSLESS, channels);
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
    let image = decode(bytes.get_ref(), &SMALL).unwrap();
    assert_eq!((image.width, image.height), (3, 2));
    let Texels::Linear(texels) = image.texels else { panic!("EXR is linear") };
    assert_eq!((texels[2], texels[3]), ([0.5, 2.0, 0.0], [0.5, 0.0, 1.0]));

    let mut bytes = std::io::Cursor::new(Vec::new());
    let channels = SpecificChannels::build()
        .with_channel("Y")
        .with_pixel_fn(|p: ::exr::math::Vec2<usize>| (p.0 as f32,));
    Image::from_channels((2, 1), channels).write().non_parallel().to_buffered(&mut bytes).unwrap();
    let image = decode(bytes.get_ref(), &SMALL).unwrap();
    assert_eq!(image.texels, Texels::Linear(vec![[0.0; 3], [1.0; 3]]));

    let mut bytes = std::io::Cursor::new(Vec::new());
    let channels = SpecificChannels::build()
        .with_channel("depth.Z")
        .with_pixel_fn(|_: ::exr::math::Vec2<usize>| (1f32,));
    Image::from_channels((2, 1), channels).write().non_parallel().to_buffered(&mut bytes).unwrap();
    let fault = decode(bytes.get_ref(), &SMALL).unwrap_err();
    assert_eq!(fault.kind, ErrorKind::Unsupported);
    assert!(fault.cause.contains("depth.Z"), "{}", fault.cause);
}

#[test]
fn old_hdr_runs_exposure_and_orders_are_understood() {
    let decode = |text: &str, data: &[u8]| decode(&[text.as_bytes(), data].concat(), &SMALL);
    // A pixel of (1, 1/2, 1/4), then a run of three more.
    let data = [128, 64, 32, 129, 1, 1, 1, 3];
    let header = "#?RGBE\n# comment\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
    let fault = decode(header, &data).unwrap_err();
    assert!(fault.cause.contains("a run beyond the scanline in row 0"), "{}", fault.cause);
    let header = "#?RADIANCE\r\nEXPOSURE=2.0\r\nEXPOSURE= 0.25\r\n\r\n-Y 1 +X 4\r\n";
    let image = decode(header, &data).unwrap();
    assert_eq!(image.texels, Texels::Linear(vec![[2.0, 1.0, 0.5]; 4]));

    for (header, kind) in [
        ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 4\n", ErrorKind::Unsupported),
        ("#?RADIANCE\n\n+X 4 -Y 1\n", ErrorKind::Unsupported),
        ("#?RADIANCE\n\n-Y 1 +X -4\n", ErrorKind::Damaged),
        ("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 4\n", ErrorKind::Damaged),
        ("#?RADIANCE\n\n-Y 9999999 +X 4\n", ErrorKind::TooLarge),
        ("#?RADIANCE\n\n", ErrorKind::Damaged),
        ("#?RADIANCE\n", ErrorKind::Damaged),
    ] {
        assert_eq!(decode(header, &data).unwrap_err().kind, kind, "{header}");
    }
    // A run with no pixel before it, and counts that would overflow any integer.
    let markers = [1, 1, 1, 0].repeat(100);
    let header = "#?RADIANCE\n\n-Y 1 +X 4\n";
    assert_eq!(decode(header, &markers).unwrap_err().kind, ErrorKind::Damaged);
    let markers = [&[128, 64, 32, 129], &markers[..], &[1, 1, 1, 255]].concat();
    assert_eq!(decode(header, &markers).unwrap_err().kind, ErrorKind::Damaged);
}

#[test]
fn big_endian_and_grey_pfm_are_read() {
    let floats: Vec<u8> = [0.5f32, 1.0].map(f32::to_be_bytes).concat();
    let image = decode(&[b"Pf 1  2\r\n1\n", &floats[..]].concat(), &SMALL);
    // The blank after the scale is one byte, so that a float may begin with what looks like one.
    assert_eq!(image.unwrap().texels, Texels::Linear(vec![[1.0; 3], [0.5; 3]]));
    for (header, kind) in [
        ("PF 2 2 -1\n", ErrorKind::Damaged),
        ("PF 0 2 -1\n", ErrorKind::Damaged),
        ("PF -1 2 -1\n", ErrorKind::Damaged),
        ("PF 1 1 0\n", ErrorKind::Damaged),
        ("PF 1 1 nan\n", ErrorKind::Damaged),
        ("PFx 1 1 1\n", ErrorKind::Damaged),
        ("PF 1", ErrorKind::Damaged),
        ("PF 4000000000 4000000000 -1\n", ErrorKind::TooLarge),
    ] {
        let fault = decode(&[header.as_bytes(), &floats].concat(), &SMALL).unwrap_err();
        assert_eq!(fault.kind, kind, "{header}: {}", fault.cause);
    }
}

#[test]
fn the_content_decides_the_format() {
    for format in FORMATS {
        let (_folder, path) = file_of("misleading.png", &bytes_of(format, &picture()));
        assert_eq!(read_texture(&path, &SMALL).unwrap().width, 37, "{format:?}");
    }
}

#[test]
fn limits_are_those_of_the_header() {
    for format in FORMATS {
        let (_folder, path) = file_of("a", &bytes_of(format, &picture()));
        for (limits, words) in [
            (Limits { max_width: 36, ..SMALL }, "37x41 texels and the limit is 36x64"),
            (Limits { max_height: 40, ..SMALL }, "37x41 texels and the limit is 64x40"),
            (Limits { max_bytes: 1000, ..SMALL }, "bytes and the limit is 1000"),
        ] {
            let error = read_texture(&path, &limits).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::TooLarge, "{format:?}: {error}");
            assert!(error.to_string().contains(words), "{format:?}: {error}");
        }
    }
}

#[test]
fn the_header_says_what_texels_will_take() {
    for format in FORMATS {
        let bytes = bytes_of(format, &picture());
        let per_texel = if matches!(format, Format::Png | Format::Jpeg) { 4 } else { 12 };
        let n_bytes = texel_bytes(&bytes, "a".as_ref(), &SMALL).unwrap();
        assert_eq!(n_bytes, 37 * 41 * per_texel, "{format:?}");
        assert!(texel_bytes(&bytes[..8], "a".as_ref(), &SMALL).is_err(), "{format:?}");
    }
}

#[test]
fn a_header_alone_cannot_take_memory() {
    // Headers that claim the largest size, with next to no data behind.
    let mut png = bytes_of(Format::Png, &picture());
    png[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let checksum = {
        let mut crc = flate2::Crc::new();
        crc.update(&png[12..29]);
        crc.sum()
    };
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    assert_eq!(decode(&png, &Limits::default()).unwrap_err().kind, ErrorKind::TooLarge);

    let mut jpeg = bytes_of(Format::Jpeg, &picture());
    let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0xff; 4]);
    assert_eq!(decode(&jpeg, &Limits::default()).unwrap_err().kind, ErrorKind::TooLarge);

    let mut exr = bytes_of(Format::Exr, &picture());
    let window = exr.windows(10).position(|name| name == b"dataWindow").unwrap() + 21;
    exr[window..window + 16]
        .copy_from_slice(&[0, 0, 999_999, 999_999].map(i32::to_le_bytes).concat());
    assert_eq!(decode(&exr, &Limits::default()).unwrap_err().kind, ErrorKind::TooLarge);
}

#[test]
fn every_truncation_is_an_error() {
    for format in FORMATS {
        let bytes = bytes_of(format, &picture());
        for n_bytes in (0..bytes.len()).step_by(bytes.len() / 200 + 1).chain([bytes.len() - 1]) {
            let fault = match decode(&bytes[..n_bytes], &SMALL) {
                Err(fault) => fault,
                Ok(_) => panic!("{format:?} is read without its end: {n_bytes} of {}", bytes.len()),
            };
            let is_nothing = Format::sniff(&bytes[..n_bytes]).is_none() && n_bytes > 0;
            let kind = if is_nothing { ErrorKind::UnknownFormat } else { ErrorKind::Damaged };
            assert_eq!(fault.kind, kind, "{format:?} {n_bytes}: {}", fault.cause);
        }
    }
}

#[test]
fn errors_name_the_path_the_cause_and_the_way_out() {
    let (folder, empty) = file_of("empty.png", b"");
    let text = folder.path().join("notes.png");
    std::fs::write(&text, b"not an image").unwrap();
    let nothing = folder.path().join("nothing.png");
    for (path, kind, words) in [
        (empty.as_path(), ErrorKind::Damaged, "it is empty; the file is damaged"),
        (&text, ErrorKind::UnknownFormat, "convert it to PNG"),
        (&nothing, ErrorKind::Io, "check the path"),
        (folder.path(), ErrorKind::NotAFile, "it is a folder"),
    ] {
        for error in [read_texture(path, &SMALL).unwrap_err(), read_picture(path).unwrap_err()] {
            let text = error.to_string();
            assert_eq!(error.kind(), kind, "{text}");
            assert!(text.contains(words) && text.contains(path.to_str().unwrap()), "{text}");
        }
    }
}

#[test]
fn bad_texels_are_named_in_textures_and_kept_in_pictures() {
    for value in [f32::NAN, f32::INFINITY, -0.5] {
        let mut picture = picture();
        picture.pixels[37 * 3 + 5][2] = value;
        for format in [Format::Exr, Format::Pfm] {
            let (_folder, path) = file_of("a", &bytes_of(format, &picture));
            let error = read_texture(&path, &SMALL).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::BadTexel);
            let text = error.to_string();
            assert!(
                text.contains(&format!("column 5, row 3 is (0.1388889, 0.075, {value})")),
                "{text}"
            );
            let back = read_picture(&path).unwrap();
            assert_eq!(back.pixels[37 * 3 + 5][2].to_bits(), value.to_bits());
        }
    }
}

#[test]
fn metadata_does_not_disturb_reading() {
    let metadata = Metadata {
        scene: "a\n\nb\u{0}c \u{6838}".into(),
        seed: 1,
        samples_per_pixel: u32::MAX,
        backend: String::new(),
        device: "d".repeat(10_000),
        version: "v".into(),
        render_time_s: f64::NAN,
    };
    for format in FORMATS {
        let bytes = encode(format, &picture(), Some(&metadata), Transfer::Srgb).unwrap();
        let plain = decode(&bytes_of(format, &picture()), &SMALL).unwrap();
        let limits = Limits { max_bytes: 1 << 20, ..SMALL };
        assert_eq!(decode(&bytes, &limits).unwrap(), plain, "{format:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn float_formats_keep_any_picture(width in 1u32..40, height in 1u32..40, seed: u32) {
        let pixels = (0..width * height).map(|i| {
            [1u32, 2, 3].map(|c| f32::from_bits((i + seed).wrapping_mul(c.wrapping_mul(0x9e37_79b9))))
        }).collect();
        let picture = Picture { width, height, pixels };
        for format in [Format::Exr, Format::Pfm] {
            let image = decode(&bytes_of(format, &picture), &SMALL).unwrap();
            let Texels::Linear(pixels) = image.texels else { panic!("float formats are linear") };
            let back = Picture { width: image.width, height: image.height, pixels };
            prop_assert_eq!(compare(&picture, &back).unwrap().n_differing_pixels, 0);
        }
    }

    #[test]
    fn damaged_files_never_panic(
        format_idx in 0usize..5,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = bytes_of(FORMATS[format_idx], &picture());
        for (at, value) in damage {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        // Damage may go unnoticed; what is read is then within the limits.
        if let Ok(image) = decode(&bytes, &SMALL) {
            prop_assert!(image.width <= 64 && image.height <= 64);
        }
    }

    #[test]
    fn arbitrary_bytes_never_panic(
        format_idx in 0usize..5,
        tail in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        let mut bytes = bytes_of(FORMATS[format_idx], &picture());
        bytes.truncate(10);
        bytes.extend(tail);
        let _ = decode(&bytes, &SMALL);
    }
}
