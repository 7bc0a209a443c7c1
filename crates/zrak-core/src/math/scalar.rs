//! Scalar operations, and the bounds of their rounding errors.

/// Unit roundoff of `f32`: the largest relative error of one operation, 2^-24.
pub const EPSILON: f32 = f32::EPSILON * 0.5;

/// Bound of the relative error of `n` operations in a row: n e / (1 - n e).
///
/// Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, lemma 3.1.
#[inline(always)]
#[must_use]
pub const fn gamma(n: u32) -> f32 {
    (n as f32 * EPSILON) / (1.0 - n as f32 * EPSILON)
}

/// Square root, correctly rounded.
#[cfg(not(target_arch = "nvptx64"))]
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    x.sqrt()
}

/// Square root, correctly rounded (`sqrt.rn.f32`).
#[cfg(target_arch = "nvptx64")]
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    core::intrinsics::sqrtf32(x)
}

/// Smaller of two numbers that are not NaN. Which zero of two zeros it returns is not defined, so
/// its result may be compared and added, but its sign bit must not be looked at.
#[inline(always)]
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    // One instruction each: `min.f32` on the GPU, `minss` on x86.
    #[cfg(target_arch = "nvptx64")]
    return a.min(b);
    #[cfg(not(target_arch = "nvptx64"))]
    if a < b { a } else { b }
}

/// Larger of two numbers that are not NaN; see [`min`] about zeros.
#[inline(always)]
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    #[cfg(target_arch = "nvptx64")]
    return a.max(b);
    #[cfg(not(target_arch = "nvptx64"))]
    if a > b { a } else { b }
}

/// Absolute value.
#[inline(always)]
#[must_use]
pub fn abs(x: f32) -> f32 {
    x.abs()
}

/// Linear blend: `a` at `t` = 0, `b` at `t` = 1.
#[inline(always)]
#[must_use]
pub fn lerp(t: f32, a: f32, b: f32) -> f32 {
    a * (1.0 - t) + b * t
}

/// Largest integer not above `x`, for |x| < 2^31; beyond, the nearest of the bounds of `i32`.
#[inline(always)]
#[must_use]
pub fn floor(x: f32) -> i32 {
    let truncated = x as i32;
    if (truncated as f32) > x { truncated.saturating_sub(1) } else { truncated }
}

/// Next larger `f32`; infinity stays.
#[inline(always)]
#[must_use]
pub fn next_up(x: f32) -> f32 {
    if x == f32::INFINITY {
        return x;
    }
    if x == 0.0 {
        return f32::from_bits(1);
    }
    let bits = x.to_bits();
    f32::from_bits(if x > 0.0 { bits + 1 } else { bits - 1 })
}

/// Next smaller `f32`; minus infinity stays.
#[inline(always)]
#[must_use]
pub fn next_down(x: f32) -> f32 {
    -next_up(-x)
}

/// 1 / x, with |x| taken as at least 2^-80, so that it is finite and products with zero are zero.
#[inline(always)]
#[must_use]
pub fn reciprocal_or_huge(x: f32) -> f32 {
    const TINY: f32 = 8.271_806e-25; // 2^-80
    1.0 / if abs(x) < TINY { TINY.copysign(x) } else { x }
}
