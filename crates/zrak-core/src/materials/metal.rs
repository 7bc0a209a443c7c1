//! Mirror whose reflection is perturbed: a metal without Fresnel's equations.

use core::f32::consts::PI;

use bytemuck::{Pod, Zeroable};

use super::Response;
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, dot, max, sqrt, square_to_uniform_sphere};
use crate::sampler::{BounceDim, Sampler};
use crate::scene::SceneView;
use crate::textures::ColorInput;

/// Reflects into reflect(d) + fuzz * (uniform point on the unit sphere); what would go below the
/// surface is absorbed. Shirley et al., *Ray Tracing in One Weekend*, section 10.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Metal {
    /// Reflectance.
    pub reflectance: ColorInput,
    /// Radius of the perturbation, 0 to 1.
    pub fuzz: f32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Metal>() == 32);

/// Mirror image of the direction `d` on a surface with normal `n`, on either side.
#[inline(always)]
#[must_use]
pub fn reflect(d: Vec3, n: Vec3) -> Vec3 {
    d - n * (2.0 * dot(d, n))
}

impl Metal {
    #[inline(always)]
    pub(super) fn respond(
        &self,
        scene: &SceneView,
        surface: &SurfaceInteraction,
        d: Vec3,
        sampler: &Sampler,
    ) -> Response {
        let n = surface.ns_toward(d);
        let mut wi = reflect(d, n);
        if self.fuzz > 0.0 {
            let point = square_to_uniform_sphere(
                sampler.at_bounce(BounceDim::DirectionU),
                sampler.at_bounce(BounceDim::DirectionV),
            );
            wi += point * self.fuzz;
        }
        let length_squared = wi.length_squared();
        if dot(wi, n) <= 0.0 || length_squared < 1e-12 {
            return Response::ABSORBED;
        }
        let tint = self.reflectance.evaluate_share(scene, &surface.texture_context());
        Response::scattered(wi.normalized(), tint)
    }

    /// f |cos| of light from `wi`: the tint times the density of the perturbed reflection. With the
    /// mirror direction r and c = wi.r, the line along `wi` cuts the sphere of radius `fuzz` around r
    /// at s = c -+ q with q^2 = c^2 - 1 + fuzz^2, and each cut has density s^2 / (4 pi fuzz q).
    #[inline(always)]
    pub(super) fn evaluate(
        &self,
        scene: &SceneView,
        surface: &SurfaceInteraction,
        d: Vec3,
        wi: Vec3,
    ) -> Color {
        let n = surface.ns_toward(d);
        let c = dot(reflect(d, n), wi);
        let q2 = c * c - 1.0 + self.fuzz * self.fuzz;
        if self.fuzz <= 0.0 || dot(wi, n) <= 0.0 || q2 <= 0.0 {
            return Color::BLACK;
        }
        let q = sqrt(q2);
        let (near, far) = (max(0.0, c - q), max(0.0, c + q));
        let density = (near * near + far * far) / (4.0 * PI * self.fuzz * q);
        self.reflectance.evaluate_share(scene, &surface.texture_context()) * density
    }
}
