//! Directional albedo of rough surfaces: the share of light from one direction that single reflection
//! by Trowbridge-Reitz microfacets sends anywhere. Layered models need it, to know what is left for the
//! layers below and what several reflections among the facets would add.
//!
//! Polynomials are fitted to the integral with Smith's height-correlated masking, from one side: the
//! albedo is not too small by more than 2.5e-3 (6e-3 at grazing angles), so that what is left is not too
//! much. It is too large by 0.4% in the mean over directions and roughness.

use crate::materials::fresnel_dielectric;
use crate::math::{max, min};

/// sum of c_ij t^i alpha^j for i, j = 0..3.
#[inline(always)]
fn bicubic(c: &[[f32; 4]; 4], t: f32, alpha: f32) -> f32 {
    let row = |c: &[f32; 4]| c[0] + alpha * (c[1] + alpha * (c[2] + alpha * c[3]));
    row(&c[0]) + t * (row(&c[1]) + t * (row(&c[2]) + t * row(&c[3])))
}

/// Albedo of facets that are perfect mirrors, for light at this cosine, 0 to 1, to a surface with the
/// roughness `alpha`, at most 1. At most 0.017 too large.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn mirror_albedo(cos: f32, alpha: f32) -> f32 {
    const LOSS: [[f32; 4]; 4] = [
        [0.116, 0.111, 3.183, -1.038],
        [-0.828, 3.476, -7.835, 2.966],
        [4.951, -11.004, 14.524, -5.276],
        [-4.399, 6.341, 7.076, -5.657],
    ];
    // What is lost depends on how the direction's slope compares with that of the facets.
    let t = cos / max(cos + 0.7 * alpha, 1e-6);
    let loss = t * (1.0 - t) * bicubic(&LOSS, t, alpha);
    1.0 - max(0.0, loss - 5e-4)
}

/// The cosine at which a smooth surface with the index `eta` > 1 reflects as much as the facets of a
/// rough one do in the mean, at least.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn mean_cosine(cos: f32, alpha: f32, eta: f32) -> f32 {
    const SHIFT: [[f32; 4]; 4] = [
        [0.029, 1.126, -1.159, 0.476],
        [-0.195, 0.406, -1.813, 0.872],
        [0.423, 4.05, -28.278, 15.526],
        [-0.267, -13.676, 38.237, -20.868],
    ];
    let t = cos / max(cos + 3.0 * alpha, 1e-6);
    let shift = (1.0 - t) * bicubic(&SHIFT, t, alpha);
    // The lower the index, the steeper is Fresnel's curve, and the more do grazing facets count.
    let steepness = 1.032 * (eta - 1.0) / (eta - 1.0 + 0.016);
    max(0.0, min(1.0, cos + if shift > 0.0 { shift * steepness } else { shift }))
}

/// Albedo of the reflection by the facets of a dielectric with the index `eta` > 1, seen from outside.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn dielectric_albedo(cos: f32, alpha: f32, eta: f32) -> f32 {
    fresnel_dielectric(mean_cosine(cos, alpha, eta), 1.0 / eta) * mirror_albedo(cos, alpha)
}
