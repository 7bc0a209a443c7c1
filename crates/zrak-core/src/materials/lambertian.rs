//! Ideal diffuse reflection, on both sides of the surface.

use core::f32::consts::FRAC_1_PI;

use bytemuck::{Pod, Zeroable};

use super::Response;
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, dot, max, square_to_uniform_sphere};
use crate::sampler::{BounceDim, Sampler};
use crate::scene::SceneView;
use crate::textures::ColorInput;

/// f = albedo / pi.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Lambertian {
    /// Albedo.
    pub albedo: ColorInput,
}

impl Lambertian {
    #[inline(always)]
    pub(super) fn respond(
        &self,
        scene: &SceneView,
        surface: &SurfaceInteraction,
        d: Vec3,
        sampler: &Sampler,
    ) -> Response {
        let n = surface.ns_toward(d);
        let wi = sample_cosine(
            n,
            sampler.at_bounce(BounceDim::DirectionU),
            sampler.at_bounce(BounceDim::DirectionV),
        );
        // The density cos / pi cancels the cosine and the 1 / pi of f.
        Response::scattered(wi, self.albedo.evaluate_share(scene, &surface.texture_context()))
    }

    /// f |cos| of light from `wi`.
    #[inline(always)]
    pub(super) fn evaluate(
        &self,
        scene: &SceneView,
        surface: &SurfaceInteraction,
        d: Vec3,
        wi: Vec3,
    ) -> Color {
        let cos = max(0.0, dot(surface.ns_toward(d), wi));
        self.albedo.evaluate_share(scene, &surface.texture_context()) * (cos * FRAC_1_PI)
    }
}

/// Direction around the unit vector `n` with density cos / pi per steradian: the sum of `n` and a
/// uniform point on the unit sphere, scaled to unit length.
#[inline(always)]
pub(super) fn sample_cosine(n: Vec3, u: f32, v: f32) -> Vec3 {
    let sum = n + square_to_uniform_sphere(u, v);
    let length_squared = sum.length_squared();
    // The point opposite of n: any direction of the hemisphere will do.
    if length_squared < 1e-12 {
        return n;
    }
    let wi = sum.normalized();
    if dot(wi, n) > 0.0 { wi } else { n }
}
