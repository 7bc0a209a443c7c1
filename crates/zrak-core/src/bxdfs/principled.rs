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

use core::f32::consts::FRAC_1_PI;

use super::dielectric::refract_about;
use super::{
    BsdfSample, BsdfValue, Fuzz, ThinFilm, TrowbridgeReitz, cosine_hemisphere, dielectric_albedo,
    fresnel_f82, mean_cosine, mirror_albedo, oren_nayar, reflect_about,
};
use crate::materials::fresnel_dielectric;
use crate::math::{Color, Vec3, abs, dot, exp, lerp, ln, max, min, sqrt, vec3};

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

/// c^x for c from 0 to 1.
#[inline(always)]
fn power(c: Color, x: f32) -> Color {
    c.map(|c| if c >= 1.0 { 1.0 } else { exp(ln(max(c, 1e-6)) * x) })
}

#[inline(always)]
fn squared_root_of_root(x: f32) -> f32 {
    sqrt(sqrt(x))
}

impl PrincipledBsdf {
    /// The surface seen from `wo`; none from its very edge.
    #[inline(always)]
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
            squared_root_of_root(min(1.0, r2 * r2 + 2.0 * c2 * c2))
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

    fn f0_metal(&self) -> Color {
        self.params.base_color * self.params.base_weight
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
        let color = Color::lerp(p.subsurface_weight, p.base_color * p.base_weight, p.subsurface_color);
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

    /// Shares of the subsurface's light that are reflected and go through.
    #[inline(always)]
    fn subsurface(&self) -> (f32, f32) {
        let weight = self.params.subsurface_weight;
        if self.params.geometry_thin_walled { (0.5 * weight, 0.5 * weight) } else { (weight, 0.0) }
    }

    /// Share of light that a facet of the opaque dielectric reflects.
    #[inline(always)]
    fn fresnel_opaque(&self, cos: f32) -> Color {
        self.filmed(cos, fresnel_dielectric(cos, 1.0 / self.eta_opaque), self.eta_opaque)
    }

    /// Share of light that a facet of the glass reflects.
    #[inline(always)]
    fn fresnel_glass(&self, cos: f32) -> Color {
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
    #[inline(always)]
    fn reflected(&self, cos: f32) -> Color {
        let p = &self.params;
        let mut dielectric = Color::BLACK;
        if self.glass < 1.0 {
            dielectric = self.fresnel_opaque(cos) * self.dielectric_gain * (1.0 - self.glass);
        }
        if self.glass > 0.0 {
            dielectric += self.fresnel_glass(cos) * self.glass;
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
    fn coat_color(&self, wi_cos: f32, ways: u32) -> Color {
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

    /// Draws a direction; `u_lobe` chooses the lobe.
    #[inline(always)]
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
            let wm = if is_delta {
                vec3(0.0, 0.0, 1.0)
            } else {
                self.specular.sample_visible(wo, u, v)
            };
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
        let value = self.eval_above(wi);
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

    /// Where light from the facet `wm` comes from through the surface: refracted, or in a thin wall
    /// straight on but for the facet's turn.
    #[inline(always)]
    fn transmitted(&self, wo: Vec3, wm: Vec3) -> Option<Vec3> {
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
    fn refracts_to_delta(&self) -> bool {
        let is_same = abs(self.eta_refract - 1.0) < 1e-3 && !self.params.geometry_thin_walled;
        self.specular.is_smooth() || is_same
    }

    /// Share of light that comes through a facet at this cosine.
    #[inline(always)]
    fn refracted(&self, cos: f32) -> Color {
        let share = (1.0 - self.metal) * self.glass;
        let light = self.below_coat * self.coat_color(1.0, 1) * self.params.transmission_color;
        (Color::WHITE - self.fresnel_glass(cos)) * light * share
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

    #[inline(always)]
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

    #[inline(always)]
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

/// f |cos wi| of facets that are perfect mirrors, and the density of `wi` by facets that are seen from `wo`.
#[inline(always)]
fn facets(distribution: &TrowbridgeReitz, wo: Vec3, wi: Vec3, wm: Vec3) -> (f32, f32) {
    let f_cos = distribution.d(wm) * distribution.g(wo, wi) / (4.0 * wo.z);
    let pdf = distribution.pdf_visible(wo, wm) / (4.0 * max(abs(dot(wo, wm)), 1e-12));
    (f_cos, pdf)
}

/// The same for facets that refract all of the light, and the cosine at which they are met.
#[inline(always)]
fn refracting_facets(
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
