//! Isotropic phase function.

use bytemuck::{Pod, Zeroable};

use super::Scatter;
use crate::math::{Color, Vec3, square_to_uniform_sphere};
use crate::sampler::{BounceDim, Sampler};
use crate::scene::SceneView;
use crate::textures::{ColorInput, TextureContext};

/// Scatters into every direction alike: 1 / (4 pi) per steradian.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Isotropic {
    /// Single-scattering albedo.
    pub albedo: ColorInput,
}

impl Isotropic {
    /// Single-scattering albedo at the world-space point `p`.
    #[inline(always)]
    #[must_use]
    pub fn albedo_at(&self, scene: &SceneView, p: Vec3) -> Color {
        self.albedo.evaluate_share(scene, &TextureContext::in_space(p))
    }

    /// Direction after a collision at the world-space point `p`.
    #[inline(always)]
    #[must_use]
    pub fn scatter(&self, scene: &SceneView, p: Vec3, sampler: &Sampler) -> Scatter {
        let wi = square_to_uniform_sphere(
            sampler.at_bounce(BounceDim::DirectionU),
            sampler.at_bounce(BounceDim::DirectionV),
        );
        // Off by rounding; directions are of unit length.
        Scatter { wi: wi.normalized(), attenuation: self.albedo_at(scene, p) }
    }
}
