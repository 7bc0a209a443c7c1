//! A diffuse or metallic base under a dielectric coat.

use bytemuck::{Pod, Zeroable};

use super::{Conductor, Roughness};
use crate::bxdfs::{Coat, CoatedBase, DielectricBsdf, LayeredBsdf};
use crate::math::{Color, max};
use crate::scene::SceneView;
use crate::textures::{ColorInput, TextureContext};

/// The base is diffuse.
pub const BASE_DIFFUSE: u32 = 0;
/// The base is metal.
pub const BASE_METAL: u32 = 1;

/// Coated base. See [`LayeredBsdf`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Layered {
    /// The base, if it is metal.
    pub metal: Conductor,
    /// Albedo of the base, if it is diffuse.
    pub color: ColorInput,
    /// How rough the coat is.
    pub roughness: Roughness,
    /// Index of refraction of the coat.
    pub ior: f32,
    /// Thickness of the medium in the coat, in its mean free paths.
    pub thickness: f32,
    /// Single-scattering albedo of that medium.
    pub albedo: Color,
    /// Mean cosine of its phase function.
    pub g: f32,
    /// Most segments of a path in the coat.
    pub max_depth: u32,
    /// Paths that are averaged for a light.
    pub n_samples: u32,
    /// [`BASE_DIFFUSE`] or [`BASE_METAL`].
    pub base: u32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Layered>() == 160);

impl Layered {
    /// The BSDF at a point.
    #[inline(always)]
    #[must_use]
    pub fn bsdf(&self, scene: &SceneView, at: &TextureContext) -> LayeredBsdf {
        let base = if self.base == BASE_METAL {
            // Seen from inside the coat, whose index is the metal's surroundings.
            let mut metal = self.metal.bsdf(scene, at);
            metal.eta = metal.eta * (1.0 / self.ior);
            metal.k = metal.k * (1.0 / self.ior);
            CoatedBase::Conductor(metal)
        } else {
            CoatedBase::Diffuse(self.color.evaluate_share(scene, at))
        };
        let roughness = self.roughness.evaluate(scene, at);
        let coat = Coat {
            interface: DielectricBsdf { roughness, eta: self.ior },
            thickness: max(self.thickness, 1e-6),
            albedo: self.albedo,
            g: self.g,
            max_depth: self.max_depth,
            n_samples: max(1.0, self.n_samples as f32) as u32,
        };
        LayeredBsdf { coat, base }
    }
}
