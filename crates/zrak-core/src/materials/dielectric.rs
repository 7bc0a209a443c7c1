//! Smooth clear dielectric: glass, water, and bubbles in them.

use bytemuck::{Pod, Zeroable};

use super::Response;
use super::metal::reflect;
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, abs, dot, max, min, sqrt};
use crate::sampler::{BounceDim, Sampler};

/// Fresnel's equations for unpolarised light.
pub const FRESNEL_EXACT: u32 = 0;
/// Schlick's approximation.
pub const FRESNEL_SCHLICK: u32 = 1;

/// Reflects or refracts, with the chance of either its share of the light.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Dielectric {
    /// Index of refraction inside, relative to outside.
    pub ior: f32,
    /// [`FRESNEL_EXACT`] or [`FRESNEL_SCHLICK`].
    pub fresnel: u32,
    /// Nothing.
    pub _pad: [u32; 2],
}

const _: () = assert!(size_of::<Dielectric>() == 16);

/// Direction into which `d` is refracted, by Snell's law; none if it is totally reflected. `n` points
/// against `d`, `cos_i` = -d.n, and `eta` is the index of refraction before the surface over that behind it.
#[inline(always)]
#[must_use]
pub fn refract(d: Vec3, n: Vec3, cos_i: f32, eta: f32) -> Option<Vec3> {
    let sin2_t = eta * eta * max(0.0, 1.0 - cos_i * cos_i);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = sqrt(1.0 - sin2_t);
    Some((d * eta + n * (eta * cos_i - cos_t)).normalized())
}

/// Share of unpolarised light that is reflected, by Fresnel's equations. `eta` as for [`refract`].
#[inline(always)]
#[must_use]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let sin2_t = eta * eta * max(0.0, 1.0 - cos_i * cos_i);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = sqrt(1.0 - sin2_t);
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Share of light that is reflected, by Schlick's approximation (*An Inexpensive BRDF Model for
/// Physically-based Rendering*, 1994), as the book uses it: with the cosine on the side of `d`.
#[inline(always)]
#[must_use]
pub fn schlick(cos_i: f32, eta: f32) -> f32 {
    let r0 = (1.0 - eta) / (1.0 + eta);
    let r0 = r0 * r0;
    let m = 1.0 - cos_i;
    let m2 = m * m;
    r0 + (1.0 - r0) * (m2 * m2 * m)
}

impl Dielectric {
    #[inline(always)]
    pub(super) fn respond(
        &self,
        surface: &SurfaceInteraction,
        d: Vec3,
        sampler: &Sampler,
    ) -> Response {
        let front = surface.is_front(d);
        let eta = if front { 1.0 / self.ior } else { self.ior };
        let n = surface.ns_toward(d);
        let cos_i = min(1.0, abs(dot(d, n)));
        let reflected = if self.fresnel == FRESNEL_SCHLICK {
            schlick(cos_i, eta)
        } else {
            fresnel_dielectric(cos_i, eta)
        };
        let wi = match refract(d, n, cos_i, eta) {
            Some(wi) if sampler.at_bounce(BounceDim::Lobe) >= reflected => wi,
            _ => reflect(d, n).normalized(),
        };
        Response::scattered(wi, Color::WHITE)
    }
}
