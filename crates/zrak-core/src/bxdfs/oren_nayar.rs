//! Rough diffuse reflection that loses no light: EON, the energy-preserving Oren-Nayar model of Portsmouth,
//! Kutz and Hill, *EON: A Practical Energy-Preserving Rough Diffuse BRDF*, JCGT 14(1), 2025. Single
//! scattering is Fujii's variant of Oren and Nayar's model; what it loses comes back as a second, almost
//! even lobe.

use core::f32::consts::{FRAC_1_PI, PI};

use crate::math::{Color, Vec3, max};

/// 1/2 - 2 / (3 pi).
const C1: f32 = 0.5 - 2.0 / (3.0 * PI);
/// 2/3 - 28 / (15 pi).
const C2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// Albedo of single scattering on a white surface, for light at this cosine: the paper's polynomial,
/// equation 31, with an error of about 1e-3.
#[inline(always)]
fn single_albedo(cos: f32, roughness: f32) -> f32 {
    let x = 1.0 - cos;
    let g = x * (0.057_108_53 + x * (0.491_881_87 + x * (-0.332_181_44 + x * 0.071_442_995)));
    (1.0 + roughness * g) / (1.0 + C1 * roughness)
}

/// f(wo, wi) for directions above the surface, whose roughness is from 0 (Lambert) to 1.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn oren_nayar(color: Color, roughness: f32, wo: Vec3, wi: Vec3) -> Color {
    if roughness <= 0.0 {
        return color * FRAC_1_PI;
    }
    let s = wo.x * wi.x + wo.y * wi.y;
    let s_over_t = if s > 0.0 { s / max(max(wo.z, wi.z), 1e-6) } else { s };
    let scale = 1.0 / (1.0 + C1 * roughness);
    let single = scale * (1.0 + roughness * s_over_t);
    let mean = scale * (1.0 + C2 * roughness);
    let lost = (1.0 - single_albedo(wo.z, roughness)) * (1.0 - single_albedo(wi.z, roughness));
    // Light that is scattered twice or more is coloured as often.
    let several = |c: f32| c * c * mean / (1.0 - c * (1.0 - mean)) * max(0.0, lost) / (1.0 - mean);
    (color * single + color.map(several)) * FRAC_1_PI
}
