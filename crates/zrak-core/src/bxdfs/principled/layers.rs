//! How the principled surface shares light out among its layers, as seen from one direction.

use super::{PrincipledBsdf, PrincipledParams};
use crate::bxdfs::{Fuzz, TrowbridgeReitz, dielectric_albedo, mean_cosine, mirror_albedo};
use crate::materials::fresnel_dielectric;
use crate::math::{Color, Vec3, abs, lerp, max, min, sqrt};

/// Roughnesses along and across, as the specification makes them of a roughness and an anisotropy.
#[inline(always)]
fn distribution(roughness: f32, anisotropy: f32) -> TrowbridgeReitz {
    let across = 1.0 - anisotropy;
    let x = roughness * roughness * sqrt(2.0 / (1.0 + across * across));
    TrowbridgeReitz::new(x, across * x)
}

/// The roughness in all directions whose albedo a distribution is taken to have. The smallest: nothing is
/// made up for that may not be lost.
#[inline(always)]
fn isotropic(distribution: &TrowbridgeReitz) -> f32 {
    min(distribution.alpha_x, distribution.alpha_y)
}

/// The index whose reflection at right angles is `weight` times that of `eta`.
#[inline(always)]
fn modulated(eta: f32, weight: f32) -> f32 {
    if weight == 1.0 {
        return eta;
    }
    let f = (eta - 1.0) / (eta + 1.0);
    let e = min(0.999, sqrt(max(0.0, weight)) * abs(f));
    let above = (1.0 + e) / (1.0 - e);
    if eta < 1.0 { 1.0 / above } else { above }
}

impl PrincipledBsdf {
    /// The surface seen from `wo`; none from its very edge.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn new(params: &PrincipledParams, wo: Vec3) -> Option<Self> {
        if wo.z == 0.0 {
            return None;
        }
        let p = *params;
        let is_turned = wo.z < 0.0;
        let wo = if is_turned { -wo } else { wo };
        let is_inside = is_turned && p.transmission_weight > 0.0 && !p.geometry_thin_walled;
        let mu = min(1.0, wo.z);

        let (metal, glass) =
            if is_inside { (0.0, 1.0) } else { (p.base_metalness, p.transmission_weight) };
        let (fuzz_weight, coat_weight) =
            if is_inside { (0.0, 0.0) } else { (p.fuzz_weight, p.coat_weight) };

        // Fuzz, and what passes it.
        let fuzz = Fuzz::new(wo, p.fuzz_roughness);
        let below_fuzz = 1.0 - fuzz_weight * fuzz.albedo;

        // The coat, and what passes it.
        let coat = distribution(p.coat_roughness, p.coat_roughness_anisotropy);
        let coat_albedo = if coat_weight > 0.0 {
            dielectric_albedo(mu, isotropic(&coat), p.coat_ior)
        } else {
            0.0
        };
        let below_coat = below_fuzz * (1.0 - coat_weight * coat_albedo);

        // A rough coat makes what is below look rougher.
        let r = p.specular_roughness;
        let coated = {
            let (r2, c2) = (r * r, p.coat_roughness * p.coat_roughness);
            sqrt(sqrt(min(1.0, r2 * r2 + 2.0 * c2 * c2)))
        };
        let roughness = if coat_weight > 0.0 { lerp(coat_weight, r, coated) } else { r };
        let specular = distribution(roughness, p.specular_roughness_anisotropy);
        let alpha = isotropic(&specular);

        // The base is next to the coat where there is one; an index below the coat's is turned over,
        // because no light comes from the coat at angles that would be reflected totally.
        let against_coat = p.specular_ior / p.coat_ior;
        let against_coat = max(against_coat, 1.0 / against_coat);
        let eta = if coat_weight > 0.0 {
            lerp(coat_weight, p.specular_ior, against_coat)
        } else {
            p.specular_ior
        };
        let eta = if is_inside { 1.0 / p.specular_ior } else { eta };
        let eta_glass = modulated(eta, p.specular_weight);
        let eta_opaque = max(eta_glass, 1.0 / eta_glass);

        let mut bsdf = Self {
            params: p,
            wo,
            is_turned,
            is_inside,
            fuzz,
            coat,
            specular,
            eta_opaque,
            eta_glass,
            eta_refract: if is_inside { 1.0 / p.specular_ior } else { p.specular_ior },
            metal,
            glass,
            below_fuzz,
            below_coat: Color::grey(below_coat),
            metal_gain: Color::WHITE,
            dielectric_gain: 1.0,
            lost: 0.0,
            below_specular: 1.0,
            p_fuzz: fuzz_weight * fuzz.albedo * p.fuzz_color.max_channel(),
            p_coat: below_fuzz * coat_weight * coat_albedo,
            p_specular: 0.0,
            p_refract: 0.0,
            p_reflect_diffuse: 0.0,
            p_transmit_diffuse: 0.0,
        };
        if coat_weight > 0.0 {
            bsdf.darken(mu, coat_weight);
        }
        bsdf.share_base(mu, alpha);
        let sum = bsdf.p_fuzz
            + bsdf.p_coat
            + bsdf.p_specular
            + bsdf.p_refract
            + bsdf.p_reflect_diffuse
            + bsdf.p_transmit_diffuse;
        if sum <= 0.0 {
            return None;
        }
        let scale = 1.0 / sum;
        bsdf.p_fuzz *= scale;
        bsdf.p_coat *= scale;
        bsdf.p_specular *= scale;
        bsdf.p_refract *= scale;
        bsdf.p_reflect_diffuse *= scale;
        bsdf.p_transmit_diffuse *= scale;
        Some(bsdf)
    }

    /// Light that the coat's inside sends back to the base, again and again: of what reaches the base,
    /// the share (1 - K) / (1 - E K) comes out, with the albedo E of the base and the share K that the
    /// coat's inside reflects.
    #[inline(always)]
    fn darken(&mut self, mu: f32, coat_weight: f32) {
        let p = &self.params;
        let eta = p.coat_ior;
        let specular = fresnel_dielectric(mu, 1.0 / eta);
        // Fresnel's mean over directions, by Kulla and Conty's fit; and that of the inside.
        let mean = max(0.0, (eta - 1.0) / (4.085_67 + 1.000_71 * eta));
        let diffuse = max(0.0, 1.0 - (1.0 - mean) / (eta * eta));
        let k = lerp(lerp(p.base_metalness, 1.0, p.specular_roughness), specular, diffuse);
        let k = min(0.999, k);
        let color =
            Color::lerp(p.subsurface_weight, p.base_color * p.base_weight, p.subsurface_color);
        let dielectric = color * (1.0 - p.transmission_weight);
        let albedo = Color::lerp(p.base_metalness, dielectric, p.base_color * p.base_weight);
        let share = coat_weight * p.coat_darkening;
        let darkening = albedo.map(|e| lerp(share, 1.0, (1.0 - k) / (1.0 - e * k)));
        self.below_coat *= darkening;
    }

    /// Shares the light that reaches the base out among its lobes.
    #[inline(always)]
    fn share_base(&mut self, mu: f32, alpha: f32) {
        let p = self.params;
        let mirror = mirror_albedo(mu, alpha);
        let lost = (1.0 - mirror) / mirror;
        self.lost = lost;
        let f0 = self.f0_metal();
        self.metal_gain = f0.map(|f0| 1.0 + f0 * lost);
        let r = (self.eta_opaque - 1.0) / (self.eta_opaque + 1.0);
        self.dielectric_gain = 1.0 + r * r * lost;

        let cos = mean_cosine(mu, alpha, self.eta_opaque);
        let gained = mirror * self.dielectric_gain;
        let reflected = min(1.0, self.fresnel_opaque(cos).max_channel() * gained);
        self.below_specular = 1.0 - reflected;

        let light = self.below_coat.max_channel();
        let dielectric = light * (1.0 - self.metal);
        let opaque = dielectric * (1.0 - self.glass);
        self.p_specular = light * self.metal * p.specular_weight * max(f0.max_channel(), 0.05)
            + opaque * reflected * p.specular_color.max_channel();
        if self.glass > 0.0 {
            let glass = dielectric * self.glass;
            let mut reflect = self.fresnel_glass(mu).max_channel();
            if !self.specular.is_smooth() {
                // An estimate; and what is possible needs a chance.
                reflect = max(0.05, min(0.95, reflect));
            }
            self.p_specular += glass * reflect * p.specular_color.max_channel();
            self.p_refract = glass * (1.0 - reflect) * p.transmission_color.max_channel();
        }
        let opaque = opaque * self.below_specular;
        let (subsurface, through) = self.subsurface();
        let color = (p.base_color * p.base_weight).max_channel() * (1.0 - p.subsurface_weight);
        let below = p.subsurface_color.max_channel();
        self.p_reflect_diffuse = opaque * (color + below * subsurface);
        self.p_transmit_diffuse = opaque * below * through;
    }
}
