//! Scalar operations.

use crate::math::{
    EPSILON, floor, gamma, lerp, max, min, next_down, next_up, reciprocal_or_huge, sqrt,
};
use crate::testing::Rng;

#[test]
fn floor_is_the_floor() {
    let mut rng = Rng::new(1);
    for _ in 0..4_000_000 {
        let x = f32::from_bits(rng.bits() as u32);
        // The conversion saturates, and takes NaN to 0.
        assert_eq!(floor(x), f64::from(x).floor() as i32, "{x}");
    }
    for (x, expected) in [
        (0.0, 0),
        (-0.0, 0),
        (-1e-30, -1),
        (-1.0, -1),
        (-1.5, -2),
        (1.999_999_9, 1),
        (2_147_483_520.0, 2_147_483_520),
        (-2_147_483_648.0, i32::MIN),
        (3e9, i32::MAX),
        (-3e9, i32::MIN),
        (f32::INFINITY, i32::MAX),
        (f32::NEG_INFINITY, i32::MIN),
    ] {
        assert_eq!(floor(x), expected, "{x}");
    }
}

#[test]
fn next_numbers_are_neighbours() {
    let mut rng = Rng::new(2);
    for _ in 0..2_000_000 {
        let x = f32::from_bits(rng.bits() as u32);
        if !x.is_nan() {
            assert_eq!(next_up(x), x.next_up(), "{x}");
            assert_eq!(next_down(x), x.next_down(), "{x}");
        }
    }
    let tiny = f32::from_bits(1);
    for (x, up) in [
        (0.0, tiny),
        (-0.0, tiny),
        (-tiny, 0.0),
        (f32::MAX, f32::INFINITY),
        (f32::INFINITY, f32::INFINITY),
        (f32::NEG_INFINITY, f32::MIN),
    ] {
        assert_eq!(next_up(x), up, "{x}");
        assert_eq!(next_down(-x), -up, "{x}");
    }
}

#[test]
fn gamma_bounds_the_error_of_a_row_of_operations() {
    assert_eq!(EPSILON, 2.0_f32.powi(-24));
    let mut rng = Rng::new(3);
    for n in 1..20 {
        for _ in 0..2000 {
            let (mut product, mut exact) = (1.0_f32, 1.0_f64);
            for _ in 0..n {
                let x = rng.range(0.5, 2.0) as f32;
                product *= x;
                exact *= f64::from(x);
            }
            let error = (f64::from(product) - exact).abs();
            assert!(error <= exact * f64::from(gamma(n)), "{n} operations: {error:e}");
        }
    }
    // And it is not much larger than needed.
    assert!(gamma(5) < 5.001 * EPSILON);
}

#[test]
fn reciprocals_are_finite_and_keep_their_sign() {
    let mut rng = Rng::new(4);
    let tiny = 2.0_f32.powi(-80);
    for _ in 0..1_000_000 {
        let x = f32::from_bits(rng.bits() as u32);
        if x.is_finite() {
            let r = reciprocal_or_huge(x);
            let expected = if x.abs() < tiny { (1.0 / tiny).copysign(x) } else { 1.0 / x };
            assert_eq!(r, expected, "{x:e}");
            assert_eq!(r * 0.0, 0.0);
        }
    }
    assert_eq!(reciprocal_or_huge(0.0), 2.0_f32.powi(80));
    assert_eq!(reciprocal_or_huge(-0.0), -2.0_f32.powi(80));
}

#[test]
fn small_things() {
    assert_eq!((min(1.0, 2.0), min(2.0, 1.0), max(1.0, 2.0), max(2.0, 1.0)), (1.0, 1.0, 2.0, 2.0));
    assert_eq!((lerp(0.0, 3.0, 7.0), lerp(1.0, 3.0, 7.0), lerp(0.25, 0.0, 8.0)), (3.0, 7.0, 2.0));
    assert_eq!(sqrt(2.0), std::f32::consts::SQRT_2);
}
