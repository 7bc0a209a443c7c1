//! Hashes against known values, and their evenness.

use std::collections::HashSet;

use crate::math::{lowbias32, pcg3d, pcg4d, unit_f32};
use crate::testing::{ChiSquared, Rng};

/// pcg3d as printed in the paper, in its own words: vector operations step by step, in `u64`.
fn reference_pcg3d(v: [u64; 3]) -> [u64; 3] {
    const M: u64 = 1 << 32;
    let mut v = v.map(|x| (x * 1_664_525 + 1_013_904_223) % M);
    for round in 0..2 {
        v[0] = (v[0] + v[1] * v[2] % M) % M;
        v[1] = (v[1] + v[2] * v[0] % M) % M;
        v[2] = (v[2] + v[0] * v[1] % M) % M;
        if round == 0 {
            v = v.map(|x| x ^ (x >> 16));
        }
    }
    v
}

fn reference_pcg4d(v: [u64; 4]) -> [u64; 4] {
    const M: u64 = 1 << 32;
    let mut v = v.map(|x| (x * 1_664_525 + 1_013_904_223) % M);
    for round in 0..2 {
        v[0] = (v[0] + v[1] * v[3] % M) % M;
        v[1] = (v[1] + v[2] * v[0] % M) % M;
        v[2] = (v[2] + v[0] * v[1] % M) % M;
        v[3] = (v[3] + v[1] * v[2] % M) % M;
        if round == 0 {
            v = v.map(|x| x ^ (x >> 16));
        }
    }
    v
}

#[test]
fn pcg_hashes_are_those_of_the_paper() {
    let mut rng = Rng::new(1);
    for i in 0..100_000_u32 {
        let v: [u32; 4] = if i < 4 { [i; 4] } else { std::array::from_fn(|_| rng.bits() as u32) };
        let [x, y, z, _] = v;
        assert_eq!(pcg3d([x, y, z]).map(u64::from), reference_pcg3d([x, y, z].map(u64::from)));
        assert_eq!(pcg4d(v).map(u64::from), reference_pcg4d(v.map(u64::from)));
    }
}

/// What is computed here must never change: every picture hangs on it.
#[test]
fn hashes_have_known_values() {
    assert_eq!(lowbias32(0), 0);
    assert_eq!([1, 2, u32::MAX].map(lowbias32), KNOWN_LOWBIAS);
    assert_eq!(pcg3d([0, 0, 0]), KNOWN_PCG3D);
    assert_eq!(pcg4d([1, 2, 3, 4]), KNOWN_PCG4D);
}

const KNOWN_LOWBIAS: [u32; 3] = [114_555_507, 229_111_015, 3_652_544_131];
const KNOWN_PCG3D: [u32; 3] = [2_611_992_518, 2_833_812_075, 1_058_359_340];
const KNOWN_PCG4D: [u32; 4] = [908_250_390, 4_044_648_920, 3_775_961_919, 45_698_095];

/// Undoes an exclusive or with the word shifted right.
fn unshift(x: u32, by: u32) -> u32 {
    (0..32 / by + 1).fold(x, |y, _| x ^ (y >> by))
}

/// Inverse of an odd number modulo 2^32, by Newton's iteration.
fn inverse(a: u32) -> u32 {
    (0..5).fold(a, |x, _| x.wrapping_mul(2_u32.wrapping_sub(a.wrapping_mul(x))))
}

#[test]
fn lowbias_has_an_inverse() {
    let back = |x: u32| {
        let x = unshift(x, 15).wrapping_mul(inverse(0xd35a_2d97));
        let x = unshift(x, 15).wrapping_mul(inverse(0x21f0_aaad));
        unshift(x, 16)
    };
    let mut rng = Rng::new(2);
    for i in 0..1_000_000_u32 {
        let x = if i < 1000 { i } else { rng.bits() as u32 };
        assert_eq!(back(lowbias32(x)), x);
    }
}

#[test]
fn pcg_hashes_of_different_words_differ() {
    let mut seen3 = HashSet::new();
    let mut seen4 = HashSet::new();
    for x in 0..40_u32 {
        for y in 0..40_u32 {
            for z in 0..40_u32 {
                assert!(seen3.insert(pcg3d([x, y << 16, z])));
                assert!(seen4.insert(pcg4d([x, y, z << 20, x ^ 0x8000_0000])));
            }
        }
    }
}

#[test]
fn a_flipped_bit_flips_half_of_the_bits() {
    let mut rng = Rng::new(3);
    let n = 2000;
    for bit in 0..128 {
        let mut flips = [0_u32; 4];
        for _ in 0..n {
            let mut v: [u32; 4] = std::array::from_fn(|_| rng.bits() as u32);
            let before = pcg4d(v);
            v[bit / 32] ^= 1 << (bit % 32);
            let after = pcg4d(v);
            for i in 0..4 {
                flips[i] += (before[i] ^ after[i]).count_ones();
            }
        }
        // The upper bits of the input only reach some of the lower bits; the sampler mixes on.
        for (i, flips) in flips.into_iter().enumerate() {
            let share = f64::from(flips) / f64::from(32 * n);
            assert!((0.15..0.52).contains(&share), "bit {bit} to word {i}: {share}");
        }
    }
}

#[test]
fn unit_numbers_are_below_one() {
    assert_eq!(unit_f32(0), 0.0);
    assert_eq!(unit_f32(255), 0.0);
    assert_eq!(unit_f32(256), 2.0_f32.powi(-24));
    assert_eq!(unit_f32(u32::MAX), 1.0 - 2.0_f32.powi(-24));
    assert_eq!(unit_f32(1 << 31), 0.5);
}

#[test]
fn hashes_of_counters_are_uniform() {
    let test = ChiSquared { n_tests: 8 };
    let mut counts = [[0_u64; 256]; 8];
    for i in 0..1_000_000_u32 {
        let words = [
            lowbias32(i),
            pcg3d([i, 0, 0])[0],
            pcg3d([i & 0x3ff, i >> 10, 7])[2],
            pcg4d([i, 0, 0, 0])[0],
            pcg4d([0, i, 0, 0])[1],
            pcg4d([0, 0, i, 0])[2],
            pcg4d([0, 0, 0, i])[3],
            pcg4d([i & 0x3ff, i >> 10, 1, 0])[0],
        ];
        for (counts, word) in counts.iter_mut().zip(words) {
            counts[(word >> 24) as usize] += 1;
        }
    }
    for (i, counts) in counts.iter().enumerate() {
        // More even than chance is as good: these are bijections of a counter.
        test.check_uniform(&format!("hash {i}"), counts);
    }
}
