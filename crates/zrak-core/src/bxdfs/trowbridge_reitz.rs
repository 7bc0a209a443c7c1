//! The Trowbridge-Reitz (GGX) distribution of microfacet normals, anisotropic.
//!
//! Trowbridge and Reitz 1975; Walter et al., *Microfacet Models for Refraction through Rough Surfaces*,
//! 2007; Heitz, *Understanding the Masking-Shadowing Function*, JCGT 3(2), 2014, and *Sampling the GGX
//! Distribution of Visible Normals*, JCGT 7(4), 2018.

use core::f32::consts::PI;

use crate::math::{Vec3, abs, cross, dot, lerp, max, sqrt, square_to_uniform_disk, vec3};

/// Rougher than this in neither direction, a surface counts as smooth.
const SMOOTH: f32 = 1e-3;
/// Least roughness of a surface that is rough in one direction.
const FLOOR: f32 = 1e-4;

/// The distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    /// Roughness along x.
    pub alpha_x: f32,
    /// Roughness along y.
    pub alpha_y: f32,
}

impl TrowbridgeReitz {
    /// The distribution with these roughnesses.
    #[inline(always)]
    #[must_use]
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        let is_smooth = max(alpha_x, alpha_y) < SMOOTH;
        let clamp = |a: f32| if is_smooth { a } else { max(a, FLOOR) };
        Self { alpha_x: clamp(alpha_x), alpha_y: clamp(alpha_y) }
    }

    /// Whether the surface counts as smooth, and its reflection as a delta.
    #[inline(always)]
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        max(self.alpha_x, self.alpha_y) < SMOOTH
    }

    /// Differential area of microfacets with normal `wm`.
    #[inline(always)]
    #[must_use]
    pub fn d(&self, wm: Vec3) -> f32 {
        let (x, y) = (wm.x / self.alpha_x, wm.y / self.alpha_y);
        let s = x * x + y * y + wm.z * wm.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * s * s)
    }

    /// Smith's auxiliary function of masking.
    #[inline(always)]
    fn lambda(&self, w: Vec3) -> f32 {
        let z2 = w.z * w.z;
        if z2 == 0.0 {
            return f32::INFINITY;
        }
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        0.5 * (sqrt(1.0 + (x * x + y * y) / z2) - 1.0)
    }

    /// Share of microfacets that are seen from `w`.
    #[inline(always)]
    #[must_use]
    pub fn g1(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Share of microfacets that are seen from both directions.
    #[inline(always)]
    #[must_use]
    pub fn g(&self, wo: Vec3, wi: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// Density of the normals that are seen from `w`, per steradian.
    #[inline(always)]
    #[must_use]
    pub fn pdf_visible(&self, w: Vec3, wm: Vec3) -> f32 {
        self.g1(w) / max(abs(w.z), 1e-12) * self.d(wm) * abs(dot(w, wm))
    }

    /// Normal that is seen from `w`, on the side of z.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn sample_visible(&self, w: Vec3, u: f32, v: f32) -> Vec3 {
        // Stretch, so that the distribution is that of a hemisphere.
        let stretched = vec3(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalized();
        let wh = if stretched.z < 0.0 { -stretched } else { stretched };
        let t1 = if wh.z < 0.99999 {
            cross(vec3(0.0, 0.0, 1.0), wh).normalized()
        } else {
            vec3(1.0, 0.0, 0.0)
        };
        let t2 = cross(wh, t1);
        // The hemisphere seen from there is a disk of which a part is cut off.
        let (x, y) = square_to_uniform_disk(u, v);
        let h = sqrt(max(0.0, 1.0 - x * x));
        let y = lerp(0.5 * (1.0 + wh.z), h, y);
        let z = sqrt(max(0.0, 1.0 - x * x - y * y));
        let nh = t1 * x + t2 * y + wh * z;
        vec3(self.alpha_x * nh.x, self.alpha_y * nh.y, max(1e-6, nh.z)).normalized()
    }
}
