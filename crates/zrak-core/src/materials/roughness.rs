//! How rough a surface is, as materials give it.

use bytemuck::{Pod, Zeroable};

use crate::bxdfs::TrowbridgeReitz;
use crate::math::{max, min, sqrt};
use crate::scene::SceneView;
use crate::textures::{ScalarInput, TextureContext};

/// The number is the distribution's alpha.
pub const ROUGHNESS_ALPHA: u32 = 0;
/// Alpha is its square root, as in pbrt.
pub const ROUGHNESS_SQRT: u32 = 1;
/// Alpha is its square, as in glTF and OpenPBR.
pub const ROUGHNESS_SQUARE: u32 = 2;

/// Roughness along u and v.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Roughness {
    /// Along u.
    pub u: ScalarInput,
    /// Along v.
    pub v: ScalarInput,
    /// [`ROUGHNESS_ALPHA`] or another of them.
    pub map: u32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Roughness>() == 24);

impl Roughness {
    /// The distribution of microfacets at a point.
    #[inline(always)]
    #[must_use]
    pub fn evaluate(&self, scene: &SceneView, at: &TextureContext) -> TrowbridgeReitz {
        // No closure: one that is not inlined would take the scene by its address, and a scene that has
        // an address is no longer known to lack what its kernel lacks.
        let (u, v) = (self.u.evaluate(scene, at), self.v.evaluate(scene, at));
        TrowbridgeReitz::new(self.alpha(u), self.alpha(v))
    }

    #[inline(always)]
    fn alpha(&self, roughness: f32) -> f32 {
        let r = max(0.0, min(1.0, roughness));
        match self.map {
            ROUGHNESS_SQRT => sqrt(r),
            ROUGHNESS_SQUARE => r * r,
            _ => r,
        }
    }
}
