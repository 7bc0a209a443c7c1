//! Metal by Fresnel's equations.

use bytemuck::{Pod, Zeroable};

use super::Roughness;
use crate::bxdfs::{ConductorBsdf, reflectance_to_k};
use crate::math::Color;
use crate::scene::SceneView;
use crate::textures::{ColorInput, TextureContext};

/// The metal is given by its index of refraction.
pub const METAL_INDEX: u32 = 0;
/// The metal is given by its reflectance at right angles.
pub const METAL_REFLECTANCE: u32 = 1;

/// Metal. See [`ConductorBsdf`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Conductor {
    /// Reflectance, if it is given by that.
    pub reflectance: ColorInput,
    /// Real part of the index of refraction.
    pub eta: Color,
    /// [`METAL_INDEX`] or [`METAL_REFLECTANCE`].
    pub kind: u32,
    /// Imaginary part of the index.
    pub k: Color,
    /// Nothing.
    pub _pad0: u32,
    /// How rough it is.
    pub roughness: Roughness,
    /// Nothing.
    pub _pad1: [u32; 2],
}

const _: () = assert!(size_of::<Conductor>() == 80);

impl Conductor {
    /// The BSDF at a point.
    #[inline(always)]
    #[must_use]
    pub fn bsdf(&self, scene: &SceneView, at: &TextureContext) -> ConductorBsdf {
        let roughness = self.roughness.evaluate(scene, at);
        if self.kind == METAL_REFLECTANCE {
            let k = reflectance_to_k(self.reflectance.evaluate_share(scene, at));
            return ConductorBsdf { roughness, eta: Color::WHITE, k };
        }
        ConductorBsdf { roughness, eta: self.eta, k: self.k }
    }
}
