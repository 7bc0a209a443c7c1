//! The film's sums against exact arithmetic.

use proptest::prelude::*;

use super::{FixedSum, MAX_SAMPLE, PixelSum};
use crate::math::Color;

/// Value of a sample in units of 2^-64, by exact arithmetic on the parts of the `f32`.
fn exact(value: f32) -> u128 {
    if value.is_nan() || value <= 0.0 {
        return 0;
    }
    if value >= MAX_SAMPLE {
        return 1 << (38 + 64);
    }
    let (mantissa, exponent) = {
        let bits = value.to_bits();
        let (e, m) = (bits >> 23, u128::from(bits & 0x7f_ffff));
        // value = mantissa 2^exponent
        if e == 0 { (m, -149) } else { (m | 0x80_0000, e as i32 - 150) }
    };
    let shift = exponent + 64;
    if shift >= 0 {
        mantissa << shift
    } else if shift > -128 {
        mantissa >> -shift
    } else {
        0
    }
}

fn units(sum: FixedSum) -> u128 {
    u128::from(sum.fraction) | u128::from(sum.whole) << 64
}

fn any_f32() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => any::<u32>().prop_map(f32::from_bits),
        4 => 0.0_f32..1000.0,
        1 => (0.0_f32..1.0).prop_map(|x| x * 2.0_f32.powi(-40)),
        1 => prop::sample::select(vec![
            0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, MAX_SAMPLE,
            MAX_SAMPLE.next_down(), MAX_SAMPLE.next_up(), f32::MIN_POSITIVE, f32::from_bits(1),
            2.0_f32.powi(-64), 2.0_f32.powi(-65), 2.0_f32.powi(-41), 1.0,
        ]),
    ]
}

fn pixel(samples: &[([f32; 3], u32)]) -> PixelSum {
    let mut sum = PixelSum::ZERO;
    for &(radiance, n_rays) in samples {
        sum.add_sample(Color::from_array(radiance), n_rays);
    }
    sum
}

#[test]
fn every_exponent_is_taken_exactly() {
    for exponent in 0..=255_u32 {
        for mantissa in [0, 1, 2, 0x40_0000, 0x12_3456, 0x7f_fffe, 0x7f_ffff] {
            for sign in [0, 1 << 31] {
                let x = f32::from_bits(sign | exponent << 23 | mantissa);
                assert_eq!(units(FixedSum::from_f32(x)), exact(x), "{x:e}");
            }
        }
    }
    // Nothing is lost from 2^-41 up: all 24 bits are there.
    for exponent in -41..38 {
        let x = 2.0_f32.powi(exponent) * 1.999_999_9;
        assert_eq!(FixedSum::from_f32(x).to_f64(), f64::from(x));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn sums_are_exact(values in prop::collection::vec(any_f32(), 0..50)) {
        let sum = values.iter().fold(FixedSum::ZERO, |s, &x| s.plus(FixedSum::from_f32(x)));
        prop_assert_eq!(units(sum), values.iter().map(|&x| exact(x)).sum::<u128>());
    }

    #[test]
    fn to_f64_rounds_to_nearest(whole in any::<u64>(), fraction in any::<u64>(), shift in 0..64_u32) {
        let sum = FixedSum { whole: whole >> shift, fraction };
        let bits = units(sum);
        let value = sum.to_f64();
        // Back to units of 2^-64: exact, for f64 has the range.
        let back = (value * 2.0_f64.powi(64)) as u128;
        let error = back.abs_diff(bits);
        let ulp = if bits == 0 { 1 } else { 1_u128 << bits.ilog2().saturating_sub(52) };
        prop_assert!(error <= ulp / 2, "{bits} became {back}");
    }

    /// Any grouping and any order give the same bytes.
    #[test]
    fn pixels_do_not_depend_on_order_or_grouping(
        samples in prop::collection::vec(([any_f32(), any_f32(), any_f32()], 0..100_u32), 1..60),
        cuts in prop::collection::vec(0..60_usize, 0..6),
        shuffle in any::<u64>(),
    ) {
        let whole = pixel(&samples);
        let mut shuffled = samples.clone();
        let mut rng = crate::testing::Rng::new(shuffle);
        for i in (1..shuffled.len()).rev() {
            shuffled.swap(i, rng.below(i as u32 + 1) as usize);
        }
        prop_assert_eq!(pixel(&shuffled), whole);
        // Pieces, merged from the right and from the left.
        let mut cuts: Vec<usize> = cuts.into_iter().map(|c| c.min(samples.len())).collect();
        cuts.extend([0, samples.len()]);
        cuts.sort_unstable();
        let pieces: Vec<PixelSum> =
            cuts.windows(2).map(|pair| pixel(&shuffled[pair[0]..pair[1]])).collect();
        let mut from_left = PixelSum::ZERO;
        pieces.iter().for_each(|piece| from_left.merge(piece));
        let mut from_right = PixelSum::ZERO;
        for piece in pieces.iter().rev() {
            let mut piece = *piece;
            piece.merge(&from_right);
            from_right = piece;
        }
        prop_assert_eq!(from_left, whole);
        prop_assert_eq!(from_right, whole);
        prop_assert_eq!(whole.n_samples, samples.len() as u64);
        prop_assert_eq!(whole.n_rays, samples.iter().map(|s| u64::from(s.1)).sum::<u64>());
    }
}

#[test]
fn the_mean_of_equal_samples_is_the_sample() {
    assert_eq!(PixelSum::ZERO.mean(), Color::BLACK);
    for n in [1, 2, 3, 7, 100, 1000] {
        let mut sum = PixelSum::ZERO;
        (0..n).for_each(|_| sum.add_sample(Color::new(1.0, 0.1, 12_345.678), 1));
        assert_eq!(sum.mean(), Color::new(1.0, 0.1, 12_345.678));
    }
}

#[test]
fn as_many_of_the_largest_samples_as_a_scene_may_have_do_not_overflow() {
    // 2^24 samples of 2^38.
    let largest = FixedSum::from_f32(f32::INFINITY);
    let sum = (0..24).fold(largest, |sum, _| sum.plus(sum));
    assert_eq!(sum, FixedSum { whole: 1 << 62, fraction: 0 });
}
