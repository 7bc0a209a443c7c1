//! Diffuse reflection and transmission.

use core::f32::consts::FRAC_1_PI;

use super::{BsdfSample, BsdfValue};
use crate::math::{Color, Vec3, abs, max, sqrt, square_to_uniform_disk, vec3};

/// Direction around +z with density cos / pi per steradian: Malley's method.
#[inline(always)]
#[must_use]
pub fn cosine_hemisphere(u: f32, v: f32) -> Vec3 {
    let (x, y) = square_to_uniform_disk(u, v);
    vec3(x, y, sqrt(max(1e-12, 1.0 - x * x - y * y)))
}

/// Reflects and transmits evenly, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmissionBsdf {
    /// Share that is reflected.
    pub reflectance: Color,
    /// Share that goes through.
    pub transmittance: Color,
}

impl DiffuseTransmissionBsdf {
    /// Chance of reflection; none if there is no light.
    #[inline(always)]
    fn chance(&self) -> Option<f32> {
        let largest = |c: Color| max(c.r, max(c.g, c.b));
        let (r, t) = (largest(self.reflectance), largest(self.transmittance));
        if r + t > 0.0 { Some(r / (r + t)) } else { None }
    }

    /// Draws a direction; `u_lobe` chooses the side.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: f32, v: f32) -> Option<BsdfSample> {
        let p = self.chance()?;
        let up = cosine_hemisphere(u, v);
        let reflects = u_lobe < p;
        let wi = if (wo.z > 0.0) == reflects { up } else { -up };
        let (share, chance) =
            if reflects { (self.reflectance, p) } else { (self.transmittance, 1.0 - p) };
        Some(BsdfSample { wi, weight: share * (1.0 / chance), pdf: chance * up.z * FRAC_1_PI })
    }

    /// Value and density for a pair of directions.
    #[inline(always)]
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        let Some(p) = self.chance() else { return BsdfValue::ZERO };
        let (share, chance) =
            if wo.z * wi.z > 0.0 { (self.reflectance, p) } else { (self.transmittance, 1.0 - p) };
        let cos = abs(wi.z) * FRAC_1_PI;
        BsdfValue { f_cos: share * cos, pdf: chance * cos }
    }
}
