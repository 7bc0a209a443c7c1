//! The exponential function.

/// e^x with a relative error below 2 units in the last place; 0 below -87.3, where the result would be
/// subnormal, and infinite above 88.7.
///
/// x = k ln 2 + r with |r| <= ln 2 / 2, and e^r by its Taylor polynomial of degree 7.
#[inline(always)]
#[must_use]
pub fn exp(x: f32) -> f32 {
    const LOG2_E: f32 = core::f32::consts::LOG2_E;
    // ln 2 in two parts: products of the first with small integers are exact.
    const LN2_HI: f32 = 0.693_359_4;
    const LN2_LO: f32 = -2.121_944_4e-4;
    if x < -87.3 {
        return 0.0;
    }
    if x > 88.7 {
        return f32::INFINITY;
    }
    let scaled = x * LOG2_E;
    let k = (scaled + if scaled < 0.0 { -0.5 } else { 0.5 }) as i32;
    let kf = k as f32;
    let r = (x - kf * LN2_HI) - kf * LN2_LO;
    let tail = 0.5
        + r * (1.0 / 6.0
            + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0)))));
    let e_r = 1.0 + (r + r * r * tail);
    // Two factors, because 2^128 itself is not a number.
    let half = k / 2;
    let power = |k: i32| f32::from_bits(((k + 127) as u32) << 23);
    e_r * power(half) * power(k - half)
}
