//! Clear dielectrics that are rough, and panes that are thin.

use bytemuck::{Pod, Zeroable};

use super::Roughness;
use crate::bxdfs::DielectricBsdf;
use crate::scene::SceneView;
use crate::textures::TextureContext;

/// Clear dielectric with a rough surface. See [`DielectricBsdf`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct RoughDielectric {
    /// How rough it is.
    pub roughness: Roughness,
    /// Index of refraction inside, relative to outside.
    pub ior: f32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<RoughDielectric>() == 32);

/// Thin pane of a clear dielectric. See [`crate::bxdfs::thin_dielectric`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ThinDielectric {
    /// Index of refraction inside, relative to outside.
    pub ior: f32,
}

impl RoughDielectric {
    /// The BSDF at a point.
    #[inline(always)]
    #[must_use]
    pub fn bsdf(&self, scene: &SceneView, at: &TextureContext) -> DielectricBsdf {
        DielectricBsdf { roughness: self.roughness.evaluate(scene, at), eta: self.ior }
    }
}
