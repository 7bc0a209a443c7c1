//! Fuzz: a layer of fibres that scatters light forward and backward at grazing angles. Zeltner, Burley and
//! Chiang, *Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines*, 2022: the lobe is a
//! cosine lobe under a linear map, whose coefficients are the rational fits that MaterialX and OpenPBR
//! publish with it.

use core::f32::consts::FRAC_1_PI;

use super::cosine_hemisphere;
use crate::math::{Vec3, exp, max, min, sqrt, vec3};

/// The fuzz as it is seen from one direction above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fuzz {
    /// Share of light that it scatters; the rest reaches what is below.
    pub albedo: f32,
    /// Coefficients of the map that makes the lobe a cosine lobe again: x' = a x + b z, y' = a y.
    a: f32,
    b: f32,
    /// Unit vector along which the viewer is, in the surface's plane.
    along: [f32; 2],
}

impl Fuzz {
    /// Fuzz of this roughness, seen from `wo`, above it.
    #[inline(always)]
    #[must_use]
    pub fn new(wo: Vec3, roughness: f32) -> Self {
        // The range of the fit.
        let y = max(0.01, min(1.0, roughness));
        let x = max(0.0, min(1.0, wo.z));
        let a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
        let b = sqrt(1.0 - x) * (y - 1.0) * y * y * y
            / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
        let s = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
        let m = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
        let o =
            y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
        let z = (x - m) / s;
        // 1 / sqrt(2 pi).
        let albedo = exp(-0.5 * z * z) * 0.398_942_3 / s + o;
        let length = sqrt(wo.x * wo.x + wo.y * wo.y);
        let along = if length > 1e-6 { [wo.x / length, wo.y / length] } else { [1.0, 0.0] };
        Self { albedo: max(0.0, min(1.0, albedo)), a, b, along }
    }

    /// Direction with the density of the lobe.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, u: f32, v: f32) -> Vec3 {
        let w = cosine_hemisphere(u, v);
        let (x, y) = ((w.x - w.z * self.b) / self.a, w.y / self.a);
        let [c, s] = self.along;
        vec3(x * c - y * s, x * s + y * c, w.z).normalized()
    }

    /// Density of the lobe at `wi`, per steradian: a cosine lobe's times the Jacobian of the map. The
    /// fuzz scatters `albedo` times as much.
    #[inline(always)]
    #[must_use]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let [c, s] = self.along;
        let x = self.a * (wi.x * c + wi.y * s) + self.b * wi.z;
        let y = self.a * (wi.y * c - wi.x * s);
        let length2 = x * x + y * y + wi.z * wi.z;
        // cos / pi, with the cosine after the map, and a^2 / length^3.
        wi.z * self.a * self.a / (length2 * length2) * FRAC_1_PI
    }
}
