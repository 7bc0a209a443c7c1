//! The transcendental functions against those of `f64`.

use std::f64::consts::TAU;

use crate::math::{atan2, ln, sin, sin_cos_turns};
use crate::testing::Rng;

/// Largest of the errors, and where it is.
fn worst(errors: impl Iterator<Item = (f32, f64)>) -> (f32, f64) {
    errors.fold((0.0, 0.0), |worst, e| {
        assert!(!e.1.is_nan(), "not a number at {}", e.0);
        if e.1 > worst.1 { e } else { worst }
    })
}

fn turns_error(turns: f32) -> f64 {
    let (s, c) = sin_cos_turns(turns);
    let exact = f64::from(turns);
    let angle = TAU * (exact - exact.round());
    (f64::from(s) - angle.sin()).abs().max((f64::from(c) - angle.cos()).abs())
}

#[test]
fn sine_and_cosine_of_turns_are_as_exact_as_stated() {
    // Every number that the sampler can draw.
    let drawn = (0..1_u32 << 24).map(|i| i as f32 / 16_777_216.0).map(|t| (t, turns_error(t)));
    let (at, error) = worst(drawn);
    assert!(error < 1.2e-7, "{error:e} at {at}");
    // And many turns, of either sign.
    let mut rng = Rng::new(1);
    let far = (0..2_000_000).map(|_| {
        let t = rng.log_range(1e-30, f64::from(1 << 21)) as f32;
        let t = if rng.chance(0.5) { t } else { -t };
        (t, turns_error(t))
    });
    let (at, error) = worst(far);
    assert!(error < 1.2e-7, "{error:e} at {at}");
}

#[test]
fn quarter_turns_are_exact() {
    for (turns, expected) in [
        (0.0, (0.0, 1.0)),
        (0.25, (1.0, 0.0)),
        (0.5, (0.0, -1.0)),
        (0.75, (-1.0, 0.0)),
        (1.0, (0.0, 1.0)),
        (-0.25, (-1.0, 0.0)),
        (1001.5, (0.0, -1.0)),
    ] {
        assert_eq!(sin_cos_turns(turns), expected, "{turns}");
    }
}

#[test]
fn sine_is_as_exact_as_stated() {
    let mut rng = Rng::new(2);
    for i in 0..4_000_000 {
        let x = match i % 3 {
            0 => rng.range(-10.0, 10.0),
            1 => rng.range(-1e4, 1e4),
            _ => rng.log_range(1e-30, f64::from(1 << 22)),
        } as f32;
        let error = (f64::from(sin(x)) - f64::from(x).sin()).abs();
        let bound = 2e-7 + 1.2e-7 * f64::from(x.abs());
        assert!(error < bound, "{error:e} at {x}, stated {bound:e}");
    }
}

#[test]
fn sine_of_anything_is_a_sine() {
    let mut rng = Rng::new(3);
    for _ in 0..1_000_000 {
        let x = f32::from_bits(rng.bits() as u32);
        if x.is_finite() {
            assert!(sin(x).abs() <= 1.000_000_2, "{} at {x:e}", sin(x));
        }
    }
}

#[test]
fn arc_tangent_is_as_exact_as_stated() {
    let mut rng = Rng::new(4);
    for i in 0..4_000_000 {
        let angle = rng.range(-0.5, 0.5) * TAU;
        let r = rng.log_range(1e-15, 1e15);
        let (mut y, mut x) = ((r * angle.sin()) as f32, (r * angle.cos()) as f32);
        if i % 8 == 0 {
            // Near an axis.
            let tiny = rng.log_range(1e-12, 1.0) as f32;
            if rng.chance(0.5) {
                y *= tiny;
            } else {
                x *= tiny;
            }
        }
        let error = (f64::from(atan2(y, x)) - f64::from(y).atan2(f64::from(x))).abs();
        assert!(error < 5e-7, "{error:e} at ({y}, {x})");
    }
}

#[test]
fn arc_tangent_along_the_axes() {
    use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    for (y, x, expected) in [
        (0.0, 0.0, 0.0),
        (0.0, -0.0, 0.0),
        (0.0, 2.0, 0.0),
        (0.0, -2.0, PI),
        (3.0, 0.0, FRAC_PI_2),
        (-3.0, 0.0, -FRAC_PI_2),
        (1.0, 1.0, FRAC_PI_4),
        (-1.0, 1.0, -FRAC_PI_4),
    ] {
        assert_eq!(atan2(y, x), expected, "atan2({y}, {x})");
    }
}

fn ln_errors(x: f32) -> (f64, f64) {
    let exact = f64::from(x).ln();
    let error = (f64::from(ln(x)) - exact).abs();
    (error, error / exact.abs())
}

#[test]
fn logarithm_is_as_exact_as_stated() {
    // Every argument that a free flight can have: 1 - u.
    for i in 1..=1_u32 << 24 {
        let x = i as f32 / 16_777_216.0;
        let (absolute, relative) = ln_errors(x);
        assert!(absolute < 1e-7 || relative < 2e-7, "{absolute:e}, {relative:e} at {x}");
    }
    let mut rng = Rng::new(5);
    for _ in 0..4_000_000 {
        let x = rng.log_range(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32;
        let (absolute, relative) = ln_errors(x);
        assert!(absolute < 1e-7 || relative < 2e-7, "{absolute:e}, {relative:e} at {x}");
    }
    assert_eq!(ln(1.0), 0.0);
    // A free flight never has a negative length: the logarithm of what is not above 1 is not above 0.
    for i in 1..=1_u32 << 24 {
        let x = i as f32 / 16_777_216.0;
        assert!(ln(x) <= 0.0, "ln({x}) = {}", ln(x));
    }
}
