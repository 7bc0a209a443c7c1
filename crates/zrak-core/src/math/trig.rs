//! Transcendental functions as polynomials in `f32`: the same bits everywhere.
//!
//! Polynomials are those of Moshier's Cephes library (single precision); the errors stated are
//! measured against `f64` by the tests.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI, TAU};

use super::scalar::floor;

/// Sine of `x` in [-pi/4, pi/4].
#[inline(always)]
fn sin_kernel(x: f32) -> f32 {
    let z = x * x;
    ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * x + x
}

/// Cosine of `x` in [-pi/4, pi/4].
#[inline(always)]
fn cos_kernel(x: f32) -> f32 {
    let z = x * x;
    ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * z * z - 0.5 * z + 1.0
}

/// Sine and cosine of `turns` full turns, for |turns| < 2^21. Absolute error below 1.2e-7.
#[inline(always)]
#[must_use]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // Quarter turns to the nearest; the rest is exact.
    let quarters = floor(turns * 4.0 + 0.5);
    let x = (turns - quarters as f32 * 0.25) * TAU;
    let (s, c) = (sin_kernel(x), cos_kernel(x));
    let (s, c) = if quarters & 1 == 0 { (s, c) } else { (c, -s) };
    if quarters & 2 == 0 { (s, c) } else { (-s, -c) }
}

/// Sine of `x` radians. Absolute error below 2e-7 + 1.2e-7 |x| for |x| < 2^22; of larger numbers,
/// whose neighbours are too far apart for a sine to make sense, it is 0 at last.
#[inline(always)]
#[must_use]
pub fn sin(x: f32) -> f32 {
    let turns = x * (1.0 / TAU);
    // False for NaN and the infinities.
    let turns = if turns.abs() < 2_097_152.0 { turns } else { 0.0 };
    sin_cos_turns(turns).0
}

/// Arc tangent of `x` in [0, 1]. Absolute error below 1.2e-7.
#[inline(always)]
fn atan_kernel(x: f32) -> f32 {
    // tan(pi/8): beyond, atan(x) = pi/4 + atan((x - 1) / (x + 1)).
    let (base, x) = if x > 0.414_213_56 { (FRAC_PI_4, (x - 1.0) / (x + 1.0)) } else { (0.0, x) };
    let z = x * x;
    let p = (((8.053_744_5e-2 * z - 1.387_768_6e-1) * z + 1.997_771_1e-1) * z - 3.333_294_9e-1) * z;
    base + (p * x + x)
}

/// Angle of the vector (`x`, `y`) in [-pi, pi]; 0 for the zero vector. Absolute error below 5e-7.
#[inline(always)]
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    if ax == 0.0 && ay == 0.0 {
        return 0.0;
    }
    let a = if ay <= ax { atan_kernel(ay / ax) } else { FRAC_PI_2 - atan_kernel(ax / ay) };
    let a = if x < 0.0 { PI - a } else { a };
    if y < 0.0 { -a } else { a }
}

/// Natural logarithm of a normal positive number. Relative error below 2e-7, absolute below 1e-7
/// near 1.
#[inline(always)]
#[must_use]
pub fn ln(x: f32) -> f32 {
    // x = m 2^e with m in [sqrt(1/2), sqrt(2)).
    let bits = x.to_bits();
    let mut e = (bits >> 23) as i32 - 126;
    let mut m = f32::from_bits((bits & 0x007f_ffff) | 0x3f00_0000);
    if m < core::f32::consts::FRAC_1_SQRT_2 {
        e -= 1;
        m += m;
    }
    let m = m - 1.0;
    let z = m * m;
    let mut p = 7.037_683_6e-2;
    p = p * m - 1.151_461e-1;
    p = p * m + 1.167_699_9e-1;
    p = p * m - 1.242_014_1e-1;
    p = p * m + 1.424_932_3e-1;
    p = p * m - 1.666_805_8e-1;
    p = p * m + 2.000_071_5e-1;
    p = p * m - 2.499_999_4e-1;
    p = p * m + 3.333_333_1e-1;
    let e = e as f32;
    // ln 2 in two parts, the first exact in few bits, so that e times it is exact.
    const LN_2_HI: f32 = 0.693_359_4;
    const LN_2_LO: f32 = -2.121_944_4e-4;
    debug_assert!((LN_2_HI + LN_2_LO - LN_2).abs() < 1e-7);
    let tail = p * m * z + e * LN_2_LO - 0.5 * z;
    (tail + m) + e * LN_2_HI
}
