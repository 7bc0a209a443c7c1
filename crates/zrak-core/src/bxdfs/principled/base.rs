//! The principled surface's base: what its facets reflect and let through.

use super::PrincipledBsdf;
use crate::bxdfs::dielectric::refract_about;
use crate::bxdfs::{ThinFilm, TrowbridgeReitz, fresnel_f82, reflect_about};
use crate::materials::fresnel_dielectric;
use crate::math::{Color, Vec3, abs, dot, exp, ln, max, min, sqrt, vec3};

/// c^x for c from 0 to 1.
#[inline(always)]
fn power(c: Color, x: f32) -> Color {
    c.map(|c| if c >= 1.0 { 1.0 } else { exp(ln(max(c, 1e-6)) * x) })
}

impl PrincipledBsdf {
    /// Colour of the metal at right angles.
    #[inline(always)]
    pub(super) fn f0_metal(&self) -> Color {
        self.params.base_color * self.params.base_weight
    }

    /// Shares of the subsurface's light that are reflected and go through.
    #[inline(always)]
    pub(super) fn subsurface(&self) -> (f32, f32) {
        let weight = self.params.subsurface_weight;
        if self.params.geometry_thin_walled { (0.5 * weight, 0.5 * weight) } else { (weight, 0.0) }
    }

    /// Share of light that a facet of the opaque dielectric reflects.
    #[inline(always)]
    pub(super) fn fresnel_opaque(&self, cos: f32) -> Color {
        self.filmed(cos, fresnel_dielectric(cos, 1.0 / self.eta_opaque), self.eta_opaque)
    }

    /// Share of light that a facet of the glass reflects.
    #[inline(always)]
    pub(super) fn fresnel_glass(&self, cos: f32) -> Color {
        // What cannot be refracted is reflected, whatever the weight of the reflection.
        let sin2 = (1.0 - cos * cos) / (self.eta_refract * self.eta_refract);
        let is_thin = self.params.geometry_thin_walled;
        if sin2 >= 1.0 && !is_thin {
            return Color::WHITE;
        }
        let f = fresnel_dielectric(cos, 1.0 / self.eta_glass);
        let f = self.filmed(cos, f, self.eta_glass);
        // Both walls, and all reflections between them: R + T^2 R / (1 - R^2) = 2 R / (1 + R).
        if is_thin { f.map(|r| 2.0 * r / (1.0 + r)) } else { f }
    }

    /// What is reflected where a share `f` would be without the thin film.
    #[inline(always)]
    fn filmed(&self, cos: f32, f: f32, eta: f32) -> Color {
        let p = &self.params;
        if p.thin_film_weight <= 0.0 || self.is_inside {
            return Color::grey(f);
        }
        let film = ThinFilm { thickness_um: p.thin_film_thickness, ior: p.thin_film_ior };
        let reflectance = film.reflectance(cos, Color::grey(eta));
        Color::lerp(p.thin_film_weight, Color::grey(f), reflectance)
    }

    /// Share of light that a facet reflects, metal and dielectric together.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    pub(super) fn reflected(&self, cos: f32) -> Color {
        let p = &self.params;
        let mut dielectric = Color::BLACK;
        if self.glass < 1.0 {
            dielectric = self.fresnel_opaque(cos) * self.dielectric_gain * (1.0 - self.glass);
        }
        if self.glass > 0.0 {
            let f = self.fresnel_glass(cos);
            dielectric += f * (Color::WHITE + f * self.lost) * self.glass;
        }
        dielectric *= p.specular_color;
        if self.metal <= 0.0 {
            return dielectric;
        }
        let f0 = self.f0_metal();
        let mut metal = fresnel_f82(cos, f0, p.specular_color);
        if p.thin_film_weight > 0.0 {
            let film = ThinFilm { thickness_um: p.thin_film_thickness, ior: p.thin_film_ior };
            let index = f0.map(|f0| {
                let r = sqrt(max(0.0, min(0.9999, f0)));
                (1.0 + r) / (1.0 - r)
            });
            metal = Color::lerp(p.thin_film_weight, metal, film.reflectance(cos, index));
        }
        Color::lerp(self.metal, dielectric, metal * self.metal_gain * p.specular_weight)
    }

    /// The coat's colour on the way in and out again, whose cosines outside are given; 1 for a way that
    /// does not lead through the coat counts as none if `ways` is 1.
    #[inline(always)]
    pub(super) fn coat_color(&self, wi_cos: f32, ways: u32) -> Color {
        let p = &self.params;
        if self.is_inside || p.coat_weight <= 0.0 || p.coat_color == Color::WHITE {
            return Color::WHITE;
        }
        // The way through the coat is longer the more slanting it is there.
        let n2 = p.coat_ior * p.coat_ior;
        let length = |cos: f32| 1.0 / sqrt(max(1e-4, 1.0 - max(0.0, 1.0 - cos * cos) / n2));
        let way_in = if ways == 2 { length(wi_cos) } else { 0.0 };
        let color = power(p.coat_color, 0.5 * (length(self.wo.z) + way_in));
        Color::lerp(p.coat_weight, Color::WHITE, color)
    }

    /// Where light from the facet `wm` comes from through the surface: refracted, or in a thin wall
    /// straight on but for the facet's turn.
    #[inline(always)]
    pub(super) fn transmitted(&self, wo: Vec3, wm: Vec3) -> Option<Vec3> {
        let wi = if self.params.geometry_thin_walled {
            let wi = reflect_about(wo, wm);
            vec3(wi.x, wi.y, -wi.z)
        } else {
            refract_about(wo, wm, self.eta_refract)?.0
        };
        if wi.z < 0.0 { Some(wi) } else { None }
    }

    /// Whether what comes through comes from one direction: of a smooth surface, or one between things of
    /// the same index.
    #[inline(always)]
    pub(super) fn refracts_to_delta(&self) -> bool {
        let is_same = abs(self.eta_refract - 1.0) < 1e-3 && !self.params.geometry_thin_walled;
        self.specular.is_smooth() || is_same
    }

    /// Share of light that comes through a facet at this cosine.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    pub(super) fn refracted(&self, cos: f32) -> Color {
        let share = (1.0 - self.metal) * self.glass;
        let light = self.below_coat * self.coat_color(1.0, 1) * self.params.transmission_color;
        (Color::WHITE - self.fresnel_glass(cos)) * light * share
    }
}

/// f |cos wi| of facets that are perfect mirrors, and the density of `wi` by facets that are seen from `wo`.
#[inline(always)]
pub(super) fn facets(distribution: &TrowbridgeReitz, wo: Vec3, wi: Vec3, wm: Vec3) -> (f32, f32) {
    let f_cos = distribution.d(wm) * distribution.g(wo, wi) / (4.0 * wo.z);
    let pdf = distribution.pdf_visible(wo, wm) / (4.0 * max(abs(dot(wo, wm)), 1e-12));
    (f_cos, pdf)
}

/// The same for facets that refract all of the light, and the cosine at which they are met.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
pub(super) fn refracting_facets(
    distribution: &TrowbridgeReitz,
    wo: Vec3,
    wi: Vec3,
    eta: f32,
) -> Option<((f32, f32), f32)> {
    let sum = wi * eta + wo;
    let length = sum.length();
    if length < 1e-6 {
        return None;
    }
    let wm = sum * (if sum.z < 0.0 { -1.0 } else { 1.0 } / length);
    let (cos_i, cos_o) = (dot(wi, wm), dot(wo, wm));
    if cos_i >= 0.0 || cos_o <= 0.0 {
        return None;
    }
    let sum = cos_i + cos_o / eta;
    let jacobian = abs(cos_i) / max(sum * sum, 1e-20);
    let f_cos = distribution.d(wm) * distribution.g(wo, wi) * jacobian * cos_o / wo.z;
    Some(((f_cos, distribution.pdf_visible(wo, wm) * jacobian), cos_o))
}
