//! An opaque base under a dielectric coat with a medium in between: light walks at random between the
//! two until it leaves.
//!
//! Guo, Hasan, Zhao, *Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs*, 2018, in the form
//! of Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., section 14.3. There is no closed
//! form: `sample` follows one path and its weight is an unbiased estimate; `eval` averages some paths
//! that are joined to the light's direction, with multiple importance sampling where the coat is rough.

use core::f32::consts::FRAC_1_PI;

use super::{BsdfSample, ConductorBsdf, DielectricBsdf, Lobes, cosine_hemisphere};
use crate::math::{Color, Vec3, abs, dot, exp, ln, max, min};
use crate::media::{henyey_greenstein, sample_henyey_greenstein, tangents};
use crate::sampler::Stream;

/// The coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Its outside; the inside is that of the coat.
    pub interface: DielectricBsdf,
    /// Thickness of the medium, in its mean free paths.
    pub thickness: f32,
    /// Single-scattering albedo of the medium; black if there is none.
    pub albedo: Color,
    /// Mean cosine of its phase function.
    pub g: f32,
    /// Most segments of a path.
    pub max_depth: u32,
    /// Paths that `eval` averages.
    pub n_samples: u32,
}

/// What is below the coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoatedBase {
    /// Ideal diffuse reflection with this albedo.
    Diffuse(Color),
    /// Metal.
    Conductor(ConductorBsdf),
}

/// A coated base. The same on both sides: seen from below, everything is turned over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayeredBsdf {
    /// The coat.
    pub coat: Coat,
    /// The base.
    pub base: CoatedBase,
}

/// Share of light that passes a thickness of medium along `w`.
#[inline(always)]
fn passed(thickness: f32, w: Vec3) -> f32 {
    exp(-abs(thickness) / max(abs(w.z), 1e-12))
}

/// Weight of a sample whose density is `a`, beside another way with density `b`: the power heuristic.
#[inline(always)]
fn power(a: f32, b: f32) -> f32 {
    let (a2, b2) = (a * a, b * b);
    if a2 == f32::INFINITY {
        1.0
    } else if a2 + b2 > 0.0 {
        a2 / (a2 + b2)
    } else {
        0.0
    }
}

/// Direction after scattering of light that travels along `d`.
#[inline(always)]
fn scattered(g: f32, d: Vec3, u: f32, v: f32) -> (Vec3, f32) {
    let cos = sample_henyey_greenstein(g, u);
    let sin = crate::math::sqrt(max(0.0, 1.0 - cos * cos));
    let (s, c) = crate::math::sin_cos_turns(v);
    let (t, b) = tangents(d);
    ((t * (sin * c) + b * (sin * s) + d * cos).normalized(), henyey_greenstein(g, cos))
}

impl CoatedBase {
    /// Draws a direction above the base for `wo` above it.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn sample(&self, wo: Vec3, u: f32, v: f32) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(albedo) => {
                let wi = cosine_hemisphere(u, v);
                Some(BsdfSample { wi, weight: *albedo, pdf: wi.z * FRAC_1_PI })
            }
            Self::Conductor(metal) => metal.sample(wo, u, v),
        }
    }

    /// f |cos wi| and the density of `wi`.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Color, f32) {
        match self {
            Self::Diffuse(albedo) => {
                let cos = max(0.0, wi.z) * FRAC_1_PI;
                (*albedo * cos, cos)
            }
            Self::Conductor(metal) => {
                let value = metal.eval(wo, wi);
                (value.f_cos, value.pdf)
            }
        }
    }

    #[inline(always)]
    fn is_delta(&self) -> bool {
        match self {
            Self::Diffuse(_) => false,
            Self::Conductor(metal) => metal.roughness.is_smooth(),
        }
    }
}

impl LayeredBsdf {
    /// Follows one path from `wo`. Its density is not known: two samples cannot be compared by it.
    #[inline(never)]
    #[must_use]
    pub fn sample(&self, wo: Vec3, stream: &mut Stream) -> Option<BsdfSample> {
        let coat = &self.coat;
        let turned = wo.z < 0.0;
        let wo = if turned { -wo } else { wo };
        let out = |wi: Vec3, weight: Color| {
            Some(BsdfSample { wi: if turned { -wi } else { wi }, weight, pdf: 0.0 })
        };
        let (u_lobe, u, v) = (stream.next(), stream.next(), stream.next());
        let first = coat.interface.sample(wo, Lobes::BOTH, u_lobe, u, v)?;
        if first.wi.z > 0.0 {
            return out(first.wi, first.weight);
        }
        let has_medium = coat.albedo != Color::BLACK;
        let (mut w, mut weight) = (first.wi, first.weight);
        // Depth below the outside.
        let mut z = 0.0;
        let mut depth = 0;
        let mut result = None;
        let mut going = true;
        while going {
            let mut at_wall = true;
            going = survives(&mut weight, depth, stream) && w.z != 0.0;
            if going && has_medium {
                let step = -ln(1.0 - stream.next()) * abs(w.z);
                let there = if w.z > 0.0 { z - step } else { z + step };
                if there > 0.0 && there < coat.thickness {
                    at_wall = false;
                    z = there;
                    let (wi, _) = scattered(coat.g, w, stream.next(), stream.next());
                    w = wi;
                    weight *= coat.albedo;
                } else {
                    z = if there <= 0.0 { 0.0 } else { coat.thickness };
                }
            } else if going {
                z = if w.z > 0.0 { 0.0 } else { coat.thickness };
                weight = weight * passed(coat.thickness, w);
            }
            if going && at_wall {
                let (u_lobe, u, v) = (stream.next(), stream.next(), stream.next());
                let next = if w.z > 0.0 {
                    coat.interface.sample(-w, Lobes::BOTH, u_lobe, u, v)
                } else {
                    self.base.sample(-w, u, v)
                };
                match next {
                    Some(next) => {
                        weight *= next.weight;
                        let leaves = w.z > 0.0 && next.wi.z > 0.0;
                        w = next.wi;
                        if leaves {
                            result = out(w, weight);
                            going = false;
                        }
                    }
                    None => going = false,
                }
            }
            depth += 1;
            going = going && depth < coat.max_depth;
        }
        result
    }

    /// Estimate of f(wo, wi) |cos wi|.
    #[inline(never)]
    #[must_use]
    pub fn eval(&self, wo: Vec3, wi: Vec3, stream: &mut Stream) -> Color {
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        if wi.z <= 0.0 || wo.z == 0.0 {
            return Color::BLACK;
        }
        let coat = &self.coat;
        let mut sum = Color::BLACK;
        let mut n = 0;
        while n < coat.n_samples {
            sum += self.eval_once(wo, wi, stream);
            n += 1;
        }
        coat.interface.eval(wo, wi, Lobes::BOTH).f_cos + sum * (1.0 / coat.n_samples as f32)
    }

    /// One path's share of light that has been below the outside.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn eval_once(&self, wo: Vec3, wi: Vec3, stream: &mut Stream) -> Color {
        let coat = &self.coat;
        let exit_is_delta = coat.interface.roughness.is_smooth() || coat.interface.eta == 1.0;
        let base_is_delta = self.base.is_delta();
        let has_medium = coat.albedo != Color::BLACK;
        // Into the coat from the viewer, and from the light.
        let (u, v) = (stream.next(), stream.next());
        let entering = coat.interface.sample(wo, Lobes::TRANSMISSION, 0.0, u, v);
        let (u, v) = (stream.next(), stream.next());
        let lit = coat.interface.sample(wi, Lobes::TRANSMISSION, 0.0, u, v);
        let (Some(entering), Some(lit)) = (entering, lit) else { return Color::BLACK };
        // From the inside to the outside, per projected angle: by the square of the index less than the
        // other way. The light's cosine outside belongs to what is asked for.
        let lit_weight = lit.weight * (abs(wi.z) / (coat.interface.eta * coat.interface.eta));
        // Towards the light, seen from inside.
        let to_light = -lit.wi;
        let lit_cos = max(abs(lit.wi.z), 1e-6);
        let (mut w, mut beta) = (entering.wi, entering.weight);
        let mut z = 0.0;
        let mut depth = 0;
        let mut f = Color::BLACK;
        let mut going = true;
        while going {
            going = survives(&mut beta, depth, stream) && w.z != 0.0;
            let mut at_wall = true;
            if going && has_medium {
                let step = -ln(1.0 - stream.next()) * abs(w.z);
                let there = if w.z > 0.0 { z - step } else { z + step };
                if there > 0.0 && there < coat.thickness {
                    at_wall = false;
                    z = there;
                    beta *= coat.albedo;
                    // Joined to the light's way in.
                    let phase = henyey_greenstein(coat.g, dot(w, to_light));
                    let wt = if exit_is_delta { 1.0 } else { power(lit.pdf, phase) };
                    f += beta * lit_weight * (phase * wt * passed(z, to_light) / lit_cos);
                    let (next, pdf) = scattered(coat.g, w, stream.next(), stream.next());
                    w = next;
                    if w.z > 0.0 && !exit_is_delta {
                        // Or met by chance.
                        let exit = coat.interface.eval(-w, wi, Lobes::TRANSMISSION);
                        let back = coat.interface.eval(wi, -w, Lobes::TRANSMISSION).pdf;
                        f += beta * exit.f_cos * (passed(z, w) * power(pdf, back));
                    }
                } else {
                    z = if there <= 0.0 { 0.0 } else { coat.thickness };
                }
            } else if going {
                z = if w.z > 0.0 { 0.0 } else { coat.thickness };
                beta = beta * passed(coat.thickness, w);
            }
            if going && at_wall && w.z > 0.0 {
                // Back down from the outside.
                let (u, v) = (stream.next(), stream.next());
                match coat.interface.sample(-w, Lobes::REFLECTION, 0.0, u, v) {
                    Some(next) => {
                        beta *= next.weight;
                        w = next.wi;
                    }
                    None => going = false,
                }
            } else if going && at_wall {
                if !base_is_delta {
                    let (value, pdf) = self.base.eval(-w, to_light);
                    let wt = if exit_is_delta { 1.0 } else { power(lit.pdf, pdf) };
                    let through = passed(coat.thickness, to_light);
                    f += beta * value * lit_weight * (wt * through / lit_cos);
                }
                let (u, v) = (stream.next(), stream.next());
                match self.base.sample(-w, u, v) {
                    Some(next) => {
                        beta *= next.weight;
                        w = next.wi;
                        if !exit_is_delta {
                            let exit = coat.interface.eval(-w, wi, Lobes::TRANSMISSION);
                            let back = coat.interface.eval(wi, -w, Lobes::TRANSMISSION).pdf;
                            let wt = if base_is_delta { 1.0 } else { power(next.pdf, back) };
                            f += beta * exit.f_cos * (passed(coat.thickness, w) * wt);
                        }
                    }
                    None => going = false,
                }
            }
            depth += 1;
            going = going && depth < coat.max_depth;
        }
        f
    }
}

/// Ends paths that carry little light, some of them, and makes the others up for it.
#[inline(always)]
fn survives(weight: &mut Color, depth: u32, stream: &mut Stream) -> bool {
    let largest = max(weight.r, max(weight.g, weight.b));
    if depth <= 3 || largest >= 0.25 {
        return true;
    }
    let chance = max(largest, 1e-6);
    let stays = stream.next() < min(1.0, chance);
    if stays {
        *weight = *weight * (1.0 / chance);
    }
    stays
}
