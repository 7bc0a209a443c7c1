//! Fresnel's equations for conductors.

use crate::math::{Color, max, min, sqrt};

/// Share of unpolarised light that a metal with the complex index eta + i k reflects, by channel; `cos`
/// is that of the angle of incidence, at least 0.
#[inline(always)]
#[must_use]
pub fn fresnel_conductor(cos: f32, eta: Color, k: Color) -> Color {
    let one = |eta, k| fresnel_complex(cos, eta, k);
    Color::new(one(eta.r, k.r), one(eta.g, k.g), one(eta.b, k.b))
}

/// The equations with real arithmetic. With t = eta^2 - k^2 - sin^2: a^2 + b^2 = sqrt(t^2 + 4 eta^2 k^2)
/// and 2 a^2 = a^2 + b^2 + t, where a + i b = sqrt((eta + i k)^2 - sin^2).
#[inline(always)]
fn fresnel_complex(cos: f32, eta: f32, k: f32) -> f32 {
    let cos = min(1.0, max(0.0, cos));
    let cos2 = cos * cos;
    let sin2 = 1.0 - cos2;
    let (eta2, k2) = (eta * eta, k * k);
    let t = eta2 - k2 - sin2;
    let a2b2 = sqrt(t * t + 4.0 * eta2 * k2);
    let a = sqrt(max(0.0, 0.5 * (a2b2 + t)));
    let (s0, s1) = (a2b2 + cos2, 2.0 * a * cos);
    let rs = (s0 - s1) / (s0 + s1);
    let (p0, p1) = (cos2 * a2b2 + sin2 * sin2, s1 * sin2);
    let rp = rs * (p0 - p1) / (p0 + p1);
    0.5 * (rs + rp)
}

/// Imaginary part of the index of a metal with eta = 1 that reflects this share at right angles, as pbrt
/// has it: k = 2 sqrt(r / (1 - r)).
#[inline(always)]
#[must_use]
pub fn reflectance_to_k(r: Color) -> Color {
    let one = |r: f32| {
        let r = min(0.9999, max(0.0, r));
        2.0 * sqrt(r / (1.0 - r))
    };
    Color::new(one(r.r), one(r.g), one(r.b))
}
