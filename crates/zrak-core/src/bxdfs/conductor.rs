//! Metal, rough or smooth: reflection by microfacets that obey Fresnel's equations.

use super::{BsdfSample, BsdfValue, TrowbridgeReitz, fresnel_conductor, reflect_about};
use crate::math::{Color, Vec3, abs, dot, max, vec3};

/// Metal with a complex index of refraction eta + i k, by channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorBsdf {
    /// Its roughness.
    pub roughness: TrowbridgeReitz,
    /// Real part of the index.
    pub eta: Color,
    /// Imaginary part.
    pub k: Color,
}

impl ConductorBsdf {
    /// Draws a direction.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn sample(&self, wo: Vec3, u: f32, v: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.roughness.is_smooth() {
            let wi = vec3(-wo.x, -wo.y, wo.z);
            let weight = fresnel_conductor(abs(wo.z), self.eta, self.k);
            return Some(BsdfSample { wi, weight, pdf: 0.0 });
        }
        let wm = self.roughness.sample_visible(wo, u, v);
        let wi = reflect_about(wo, wm);
        if wo.z * wi.z <= 0.0 {
            return None;
        }
        let cos = abs(dot(wo, wm));
        let pdf = self.roughness.pdf_visible(wo, wm) / (4.0 * max(cos, 1e-12));
        // D and the Jacobian cancel.
        let share = self.roughness.g(wo, wi) / self.roughness.g1(wo);
        Some(BsdfSample { wi, weight: fresnel_conductor(cos, self.eta, self.k) * share, pdf })
    }

    /// Value and density for a pair of directions.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        let sum = wo + wi;
        let length = sum.length();
        if wo.z * wi.z <= 0.0 || self.roughness.is_smooth() || length == 0.0 {
            return BsdfValue::ZERO;
        }
        let wm = sum / length;
        let cos = abs(dot(wo, wm));
        let d = self.roughness.d(wm);
        let f = fresnel_conductor(cos, self.eta, self.k);
        let f_cos = f * (d * self.roughness.g(wo, wi) / (4.0 * abs(wo.z)));
        let pdf = self.roughness.pdf_visible(wo, wm) / (4.0 * max(cos, 1e-12));
        BsdfValue { f_cos, pdf }
    }
}
