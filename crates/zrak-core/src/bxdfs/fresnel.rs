//! Fresnel's equations for conductors, and approximations of them that artists have a hold on.

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

/// Schlick's approximation of what is reflected at the cosine `cos`, for a share `f0` at right angles.
#[inline(always)]
#[must_use]
pub fn schlick_from(f0: f32, cos: f32) -> f32 {
    let m = max(0.0, 1.0 - cos);
    let m2 = m * m;
    f0 + (1.0 - f0) * (m2 * m2 * m)
}

/// The same at the surface between two dielectrics with the indices `n1` and `n2`.
#[inline(always)]
#[must_use]
pub fn schlick_between(n1: f32, n2: f32, cos: f32) -> f32 {
    let r = (n1 - n2) / (n1 + n2);
    schlick_from(r * r, cos)
}

/// Metal of the colour `f0` at right angles, whose reflection near 82 degrees (a cosine of 1/7) is `f82`
/// times Schlick's. Kutz, Hasan, Edmondson, *Novel aspects of the Adobe Standard Material*, 2021, as the
/// OpenPBR specification has it.
#[inline(always)]
#[must_use]
pub fn fresnel_f82(cos: f32, f0: Color, f82: Color) -> Color {
    let one = |f0: f32, f82: f32| {
        // cos (1 - cos)^6 at 1/7.
        const AT_82: f32 = 46_656.0 / 823_543.0;
        let m = max(0.0, 1.0 - cos);
        let m2 = m * m;
        let dip = schlick_from(f0, 1.0 / 7.0) * (1.0 - f82) / AT_82;
        max(0.0, min(1.0, schlick_from(f0, cos) - cos * (m2 * m2 * m2) * dip))
    };
    Color::new(one(f0.r, f82.r), one(f0.g, f82.g), one(f0.b, f82.b))
}
