//! The OpenPBR surface: metal, glossy diffuse and glass under a coat under fuzz. *OpenPBR Surface*,
//! specification 1.1, Academy Software Foundation, 2024, whose names the parameters have.
//!
//! The specification describes slabs and leaves it open how light is followed through them. Here each layer
//! takes its directional albedo, as seen by the viewer, from what the layers below get, which needs no
//! random walk, never makes light, and is not reciprocal. Metals get back the light that several
//! reflections among their facets would add (Turquin, *Practical multiple scattering compensation for
//! microfacet models*, 2019).
//!
//! What differs from the specification: subsurface scattering is diffuse reflection, and in thin walls half
//! of it transmission; `transmission_color` colours the light at the surface, as for a
//! `transmission_depth` of 0; light inside a body of glass meets only its wall, whatever is mixed
//! with the glass outside.

mod base;
mod layers;

use core::f32::consts::FRAC_1_PI;

use base::{facets, refracting_facets};

use super::{
    BsdfSample, BsdfValue, Fuzz, TrowbridgeReitz, cosine_hemisphere, oren_nayar, reflect_about,
};
use crate::materials::fresnel_dielectric;
use crate::math::{Color, Vec3, dot, max, min, vec3};

/// The parameters, evaluated at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // The specification says what each of them is.
pub struct PrincipledParams {
    pub base_weight: f32,
    pub base_color: Color,
    pub base_metalness: f32,
    pub base_diffuse_roughness: f32,
    pub specular_weight: f32,
    pub specular_color: Color,
    pub specular_roughness: f32,
    pub specular_roughness_anisotropy: f32,
    pub specular_ior: f32,
    pub transmission_weight: f32,
    pub transmission_color: Color,
    pub subsurface_weight: f32,
    pub subsurface_color: Color,
    pub coat_weight: f32,
    pub coat_color: Color,
    pub coat_roughness: f32,
    pub coat_roughness_anisotropy: f32,
    pub coat_ior: f32,
    pub coat_darkening: f32,
    pub fuzz_weight: f32,
    pub fuzz_color: Color,
    pub fuzz_roughness: f32,
    pub thin_film_weight: f32,
    /// In micrometres.
    pub thin_film_thickness: f32,
    pub thin_film_ior: f32,
    pub geometry_thin_walled: bool,
}

/// The surface as it is seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledBsdf {
    params: PrincipledParams,
    /// Towards the viewer, above the surface: from below, everything is turned over.
    wo: Vec3,
    is_turned: bool,
    /// Whether the viewer is inside of a body of glass.
    is_inside: bool,
    fuzz: Fuzz,
    coat: TrowbridgeReitz,
    specular: TrowbridgeReitz,
    /// Index of refraction behind the surface over that before it: as Fresnel's equations of the
    /// opaque part see it, of the glass, and as it refracts.
    eta_opaque: f32,
    eta_glass: f32,
    eta_refract: f32,
    /// How much of the surface is metal and, of the rest, glass.
    metal: f32,
    glass: f32,
    /// What the coat, and all below the coat, get of the light, but for the coat's colour.
    below_fuzz: f32,
    below_coat: Color,
    /// Factors of reflection by metal and by dielectric for what is reflected several times.
    metal_gain: Color,
    dielectric_gain: f32,
    /// The light that mirroring facets lose, over what they do not lose.
    lost: f32,
    /// What the diffuse part gets of the light that reaches the base.
    below_specular: f32,
    /// Chances of the lobes.
    p_fuzz: f32,
    p_coat: f32,
    p_specular: f32,
    p_refract: f32,
    p_reflect_diffuse: f32,
    p_transmit_diffuse: f32,
}

impl PrincipledBsdf {
    /// Draws a direction; `u_lobe` chooses the lobe.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn sample(&self, u_lobe: f32, u: f32, v: f32) -> Option<BsdfSample> {
        let wo = self.wo;
        let (a, b) = (self.p_fuzz, self.p_fuzz + self.p_coat);
        let c = b + self.p_specular;
        let d = c + self.p_refract;
        let mirrored = vec3(-wo.x, -wo.y, wo.z);
        // The weight of a delta, or none.
        let mut delta = Color::BLACK;
        let mut is_delta = false;
        let wi = if u_lobe < a {
            self.fuzz.sample(u, v)
        } else if u_lobe < b {
            if self.coat.is_smooth() {
                is_delta = true;
                let f = fresnel_dielectric(min(1.0, wo.z), 1.0 / self.params.coat_ior);
                delta = Color::grey(self.below_fuzz * self.params.coat_weight * f / self.p_coat);
                mirrored
            } else {
                reflect_about(wo, self.coat.sample_visible(wo, u, v))
            }
        } else if u_lobe < c {
            if self.specular.is_smooth() {
                is_delta = true;
                let light = self.below_coat * self.coat_color(wo.z, 2) * (1.0 / self.p_specular);
                delta = self.reflected(wo.z) * light;
                mirrored
            } else {
                reflect_about(wo, self.specular.sample_visible(wo, u, v))
            }
        } else if u_lobe < d {
            is_delta = self.refracts_to_delta();
            let wm =
                if is_delta { vec3(0.0, 0.0, 1.0) } else { self.specular.sample_visible(wo, u, v) };
            let wi = self.transmitted(wo, wm)?;
            if is_delta {
                delta = self.refracted(wo.z) * (1.0 / self.p_refract);
            }
            wi
        } else {
            let up = cosine_hemisphere(u, v);
            if u_lobe < d + self.p_reflect_diffuse || self.p_transmit_diffuse <= 0.0 {
                up
            } else {
                vec3(up.x, up.y, -up.z)
            }
        };
        if is_delta {
            return Some(BsdfSample { wi: self.outward(wi), weight: delta, pdf: 0.0 });
        }
        // Facets that reflect into the surface lose the light to other facets.
        let is_below = wi.z <= 0.0 && u_lobe < c;
        let value = if is_below { BsdfValue::ZERO } else { self.eval_above(wi) };
        if value.pdf <= 0.0 {
            return None;
        }
        let weight = value.f_cos * (1.0 / value.pdf);
        Some(BsdfSample { wi: self.outward(wi), weight, pdf: value.pdf })
    }

    /// Value for a direction, and the density with which `sample` gives it.
    #[inline(always)]
    #[must_use]
    pub fn eval(&self, wi: Vec3) -> BsdfValue {
        self.eval_above(self.outward(wi))
    }

    /// Turned over, as the viewer was.
    #[inline(always)]
    fn outward(&self, w: Vec3) -> Vec3 {
        if self.is_turned { -w } else { w }
    }

    #[inline(always)]
    fn eval_above(&self, wi: Vec3) -> BsdfValue {
        if wi.z > 0.0 {
            self.eval_reflection(wi)
        } else if wi.z < 0.0 {
            self.eval_transmission(wi)
        } else {
            BsdfValue::ZERO
        }
    }

    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn eval_reflection(&self, wi: Vec3) -> BsdfValue {
        let (p, wo) = (&self.params, self.wo);
        let mut f_cos = Color::BLACK;
        let mut pdf = 0.0;
        if self.p_fuzz > 0.0 {
            let lobe = self.fuzz.pdf(wi);
            f_cos += p.fuzz_color * (p.fuzz_weight * self.fuzz.albedo * lobe);
            pdf += self.p_fuzz * lobe;
        }
        let wm = (wo + wi).normalized();
        let cos = max(0.0, min(1.0, dot(wo, wm)));
        if self.p_coat > 0.0 && !self.coat.is_smooth() {
            let f = fresnel_dielectric(cos, 1.0 / p.coat_ior);
            let lobe = facets(&self.coat, wo, wi, wm);
            f_cos += Color::grey(self.below_fuzz * p.coat_weight * f * lobe.0);
            pdf += self.p_coat * lobe.1;
        }
        let base = self.below_coat * self.coat_color(wi.z, 2);
        if self.p_specular > 0.0 && !self.specular.is_smooth() {
            let lobe = facets(&self.specular, wo, wi, wm);
            f_cos += self.reflected(cos) * base * lobe.0;
            pdf += self.p_specular * lobe.1;
        }
        if self.p_reflect_diffuse > 0.0 {
            let share = (1.0 - self.metal) * (1.0 - self.glass) * self.below_specular * wi.z;
            let own = oren_nayar(p.base_color * p.base_weight, p.base_diffuse_roughness, wo, wi);
            let below = p.subsurface_color * (self.subsurface().0 * FRAC_1_PI);
            f_cos += (own * (1.0 - p.subsurface_weight) + below) * base * share;
            pdf += self.p_reflect_diffuse * wi.z * FRAC_1_PI;
        }
        BsdfValue { f_cos, pdf }
    }

    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn eval_transmission(&self, wi: Vec3) -> BsdfValue {
        let (p, wo) = (&self.params, self.wo);
        let mut f_cos = Color::BLACK;
        let mut pdf = 0.0;
        if self.p_transmit_diffuse > 0.0 {
            let share = (1.0 - self.metal) * (1.0 - self.glass) * self.below_specular;
            let light = self.below_coat * self.coat_color(1.0, 1) * p.subsurface_color;
            let lobe = -wi.z * FRAC_1_PI;
            f_cos += light * (share * self.subsurface().1 * lobe);
            pdf += self.p_transmit_diffuse * lobe;
        }
        if self.p_refract > 0.0 && !self.refracts_to_delta() {
            let lobe = if p.geometry_thin_walled {
                let up = vec3(wi.x, wi.y, -wi.z);
                let wm = (wo + up).normalized();
                let lobe = facets(&self.specular, wo, up, wm);
                Some((lobe, dot(wo, wm)))
            } else {
                refracting_facets(&self.specular, wo, wi, self.eta_refract)
            };
            if let Some((lobe, cos)) = lobe {
                f_cos += self.refracted(max(0.0, min(1.0, cos))) * lobe.0;
                pdf += self.p_refract * lobe.1;
            }
        }
        BsdfValue { f_cos, pdf }
    }
}

/// Draws a direction from the surface as it is seen from `wo`. A function of its own, as is the next: there
/// is so much of it that copies of it cost a kernel more than calls.
#[inline(never)]
#[must_use]
pub fn sample_principled(
    params: &PrincipledParams,
    wo: Vec3,
    u_lobe: f32,
    u: f32,
    v: f32,
) -> Option<BsdfSample> {
    PrincipledBsdf::new(params, wo)?.sample(u_lobe, u, v)
}

/// Value for a pair of directions, and the density of `wi`.
#[inline(never)]
#[must_use]
pub fn evaluate_principled(params: &PrincipledParams, wo: Vec3, wi: Vec3) -> BsdfValue {
    match PrincipledBsdf::new(params, wo) {
        Some(bsdf) => bsdf.eval(wi),
        None => BsdfValue::ZERO,
    }
}
