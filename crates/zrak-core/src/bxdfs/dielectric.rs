//! Clear dielectric, rough or smooth: reflection and refraction by microfacets. Walter et al.,
//! *Microfacet Models for Refraction through Rough Surfaces*, 2007.

use super::{BsdfSample, BsdfValue, TrowbridgeReitz, reflect_about};
use crate::materials::fresnel_dielectric;
use crate::math::{Color, Vec3, abs, dot, max, min, sqrt, vec3};

/// Which of the two ways light may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lobes {
    /// Back to the side that it came from.
    pub reflection: bool,
    /// To the other side.
    pub transmission: bool,
}

impl Lobes {
    /// Both.
    pub const BOTH: Self = Self { reflection: true, transmission: true };
    /// Reflection alone.
    pub const REFLECTION: Self = Self { reflection: true, transmission: false };
    /// Transmission alone.
    pub const TRANSMISSION: Self = Self { reflection: false, transmission: true };

    /// Chance of reflection where `r` of the light is reflected; none if no light takes a way.
    #[inline(always)]
    fn chance(self, r: f32) -> Option<f32> {
        let pr = if self.reflection { r } else { 0.0 };
        let pt = if self.transmission { 1.0 - r } else { 0.0 };
        let sum = pr + pt;
        if sum > 0.0 { Some(pr / sum) } else { None }
    }
}

/// Surface between two clear dielectrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricBsdf {
    /// Its roughness.
    pub roughness: TrowbridgeReitz,
    /// Index of refraction inside (where z is negative), over that outside.
    pub eta: f32,
}

/// Direction into which `w` is refracted at the normal `n`, which may be on either side; with the index
/// of refraction on the other side over that on the side of `w`. None where it is totally reflected.
#[inline(always)]
pub(super) fn refract_about(w: Vec3, n: Vec3, eta: f32) -> Option<(Vec3, f32)> {
    let cos = dot(w, n);
    let (cos_i, n, etap) = if cos < 0.0 { (-cos, -n, 1.0 / eta) } else { (cos, n, eta) };
    let sin2_t = max(0.0, 1.0 - cos_i * cos_i) / (etap * etap);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = sqrt(1.0 - sin2_t);
    Some(((n * (cos_i / etap - cos_t) - w * (1.0 / etap)).normalized(), etap))
}

impl DielectricBsdf {
    /// Share of light that a facet with normal `wm` reflects, seen from `w` on either side.
    #[inline(always)]
    fn fresnel(&self, w: Vec3, wm: Vec3) -> f32 {
        let cos = dot(w, wm);
        // `fresnel_dielectric` wants the index before the surface over that behind it.
        let ratio = if cos < 0.0 { self.eta } else { 1.0 / self.eta };
        fresnel_dielectric(min(1.0, abs(cos)), ratio)
    }

    /// Draws a direction among `lobes`; `u_lobe` chooses the way.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn sample(
        &self,
        wo: Vec3,
        lobes: Lobes,
        u_lobe: f32,
        u: f32,
        v: f32,
    ) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let is_delta = self.roughness.is_smooth() || self.eta == 1.0;
        let wm =
            if is_delta { vec3(0.0, 0.0, 1.0) } else { self.roughness.sample_visible(wo, u, v) };
        let r = self.fresnel(wo, wm);
        let p_reflect = lobes.chance(r)?;
        let cos_o = dot(wo, wm);
        if u_lobe < p_reflect {
            let wi = reflect_about(wo, wm);
            if wo.z * wi.z <= 0.0 {
                return None;
            }
            if is_delta {
                return Some(BsdfSample { wi, weight: Color::grey(r / p_reflect), pdf: 0.0 });
            }
            let pdf =
                self.roughness.pdf_visible(wo, wm) * p_reflect / (4.0 * max(abs(cos_o), 1e-12));
            let share = self.roughness.g(wo, wi) / self.roughness.g1(wo);
            return Some(BsdfSample { wi, weight: Color::grey(share * r / p_reflect), pdf });
        }
        let p_transmit = 1.0 - p_reflect;
        let (wi, etap) = refract_about(wo, wm, self.eta)?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        if is_delta {
            return Some(BsdfSample { wi, weight: Color::grey((1.0 - r) / p_transmit), pdf: 0.0 });
        }
        let cos_i = dot(wi, wm);
        let sum = cos_i + cos_o / etap;
        let jacobian = abs(cos_i) / max(sum * sum, 1e-20);
        let pdf = self.roughness.pdf_visible(wo, wm) * jacobian * p_transmit;
        let share = self.roughness.g(wo, wi) / self.roughness.g1(wo);
        Some(BsdfSample { wi, weight: Color::grey(share * (1.0 - r) / p_transmit), pdf })
    }

    /// Value for a pair of directions, and the density with which `sample` gives `wi` among `lobes`.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3, lobes: Lobes) -> BsdfValue {
        if self.roughness.is_smooth() || self.eta == 1.0 || wo.z == 0.0 || wi.z == 0.0 {
            return BsdfValue::ZERO;
        }
        let reflects = wo.z * wi.z > 0.0;
        // The facet's normal: halfway between the directions, that to the other side counting by its
        // index.
        let etap = if reflects {
            1.0
        } else if wo.z > 0.0 {
            self.eta
        } else {
            1.0 / self.eta
        };
        let sum = wi * etap + wo;
        let length = sum.length();
        if length == 0.0 {
            return BsdfValue::ZERO;
        }
        let wm = sum / if sum.z < 0.0 { -length } else { length };
        let (cos_i, cos_o) = (dot(wi, wm), dot(wo, wm));
        // Facets that are seen from behind do not count.
        if cos_i * wi.z < 0.0 || cos_o * wo.z < 0.0 {
            return BsdfValue::ZERO;
        }
        let r = self.fresnel(wo, wm);
        let Some(p_reflect) = lobes.chance(r) else { return BsdfValue::ZERO };
        let (d, g) = (self.roughness.d(wm), self.roughness.g(wo, wi));
        let visible = self.roughness.pdf_visible(wo, wm);
        if reflects {
            let f_cos = Color::grey(r * d * g / (4.0 * abs(wo.z)));
            let pdf = visible * p_reflect / (4.0 * max(abs(cos_o), 1e-12));
            return BsdfValue { f_cos, pdf };
        }
        let sum = cos_i + cos_o / etap;
        let jacobian = abs(cos_i) / max(sum * sum, 1e-20);
        let f_cos = (1.0 - r) * d * g * jacobian * abs(cos_o) / abs(wo.z);
        BsdfValue { f_cos: Color::grey(f_cos), pdf: visible * jacobian * (1.0 - p_reflect) }
    }
}

/// Draws a direction from a thin pane: all reflections between its sides are summed, R' = R + T^2 R /
/// (1 - R^2), and what goes through goes straight on.
#[inline(always)]
#[must_use]
pub fn thin_dielectric(wo: Vec3, eta: f32, u_lobe: f32) -> BsdfSample {
    let r = fresnel_dielectric(min(1.0, abs(wo.z)), 1.0 / eta);
    let all = if r < 1.0 { r + (1.0 - r) * (1.0 - r) * r / (1.0 - r * r) } else { r };
    let wi = if u_lobe < all { vec3(-wo.x, -wo.y, wo.z) } else { -wo };
    BsdfSample { wi, weight: Color::WHITE, pdf: 0.0 }
}
