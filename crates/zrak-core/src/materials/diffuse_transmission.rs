//! Diffuse reflection and transmission: paper, leaves, cloth.

use bytemuck::{Pod, Zeroable};

use crate::bxdfs::DiffuseTransmissionBsdf;
use crate::math::{Color, max};
use crate::scene::SceneView;
use crate::textures::{ColorInput, TextureContext};

/// Reflects and transmits evenly. See [`DiffuseTransmissionBsdf`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct DiffuseTransmission {
    /// Share that is reflected.
    pub reflectance: ColorInput,
    /// Share that goes through.
    pub transmittance: ColorInput,
}

const _: () = assert!(size_of::<DiffuseTransmission>() == 32);

impl DiffuseTransmission {
    /// The BSDF at a point; both shares together are at most all of the light.
    #[inline(always)]
    #[must_use]
    pub fn bsdf(&self, scene: &SceneView, at: &TextureContext) -> DiffuseTransmissionBsdf {
        let reflectance = self.reflectance.evaluate_share(scene, at);
        let transmittance = self.transmittance.evaluate_share(scene, at);
        let sum = reflectance + transmittance;
        let scale = |x: f32| 1.0 / max(1.0, x);
        let fit = Color::new(scale(sum.r), scale(sum.g), scale(sum.b));
        DiffuseTransmissionBsdf {
            reflectance: reflectance * fit,
            transmittance: transmittance * fit,
        }
    }
}
