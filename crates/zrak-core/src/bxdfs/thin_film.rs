//! Interference in a thin film on a surface. Belcour and Barla, *A Practical Extension to Microfacet Theory
//! for the Modeling of Varying Iridescence*, 2017: Airy's sum over reflections in the film, integrated
//! against the eye's sensitivities in Fourier space, where each order is a damped cosine. Reflection at the
//! base is Schlick's, as in Khronos' `KHR_materials_iridescence`, so that metals need no phase tables.

use core::f32::consts::PI;

use super::schlick_between;
use crate::materials::fresnel_dielectric;
use crate::math::{Color, exp, max, min, sin_cos_turns, sqrt};

/// A film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Thickness in micrometres.
    pub thickness_um: f32,
    /// Index of refraction.
    pub ior: f32,
}

/// The sensitivity to an order of interference: linear sRGB of light whose spectrum is the cosine of its
/// phase, for a path difference in metres and a constant phase shift in turns. The eye's curves are
/// Gaussians in frequency (Belcour and Barla, supplemental code).
#[inline(always)]
fn sensitivity(difference_m: f32, shift_turns: f32) -> Color {
    // 2 pi times the difference is the phase per unit of wave number.
    let phase = 2.0 * PI * difference_m;
    let one = |value: f32, position: f32, variance: f32| {
        let (_, cos) = sin_cos_turns(position * difference_m + shift_turns);
        value * sqrt(2.0 * PI * variance) * cos * exp(-variance * phase * phase)
    };
    let x = one(5.4856e-13, 1.6810e6, 4.3278e9) + one(9.7470e-14, 2.2399e6, 4.5282e9);
    let y = one(4.4201e-13, 1.7953e6, 9.3046e9);
    let z = one(5.2481e-13, 2.2084e6, 6.6121e9);
    let scale = 1.0 / 1.0685e-7;
    let (x, y, z) = (x * scale, y * scale, z * scale);
    // To linear sRGB, each channel scaled so that light of even spectrum is white.
    Color::new(
        (3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z) / 1.204_784_3,
        (-0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z) / 0.948_300_8,
        (0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z) / 0.908_842_7,
    )
}

impl ThinFilm {
    /// Share of light that is reflected at the cosine `cos`, for a base of the index `base` by channel,
    /// of which only how much it reflects at right angles counts.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn reflectance(&self, cos: f32, base: Color) -> Color {
        let sin2 = (1.0 - cos * cos) / (self.ior * self.ior);
        if sin2 >= 1.0 {
            return Color::WHITE;
        }
        let cos_film = sqrt(1.0 - sin2);
        let r12 = fresnel_dielectric(cos, 1.0 / self.ior);
        let t121 = 1.0 - r12;
        // At an optically denser wall light is turned by half a wave.
        let shift_21 = if self.ior < 1.0 { 0.0 } else { 0.5 };
        let difference_m = 2e-6 * self.ior * self.thickness_um * cos_film;
        // One channel of the base at a time, because each has its own phase.
        let order = |n: f32, channel: fn(Color) -> f32| {
            let r23 = schlick_between(self.ior, n, cos_film);
            let shift = shift_21 + if n < self.ior { 0.5 } else { 0.0 };
            let r123 = min(0.9999, r12 * r23);
            let r = sqrt(r123);
            let rs = t121 * t121 * r23 / (1.0 - r123);
            let c1 = (rs - t121) * r;
            let c2 = c1 * r;
            let sum = r12
                + rs
                + 2.0 * c1 * channel(sensitivity(difference_m, shift))
                + 2.0 * c2 * channel(sensitivity(2.0 * difference_m, 2.0 * shift));
            max(0.0, min(1.0, sum))
        };
        Color::new(order(base.r, |c| c.r), order(base.g, |c| c.g), order(base.b, |c| c.b))
    }
}
