//! The OpenPBR surface.

use bytemuck::{Pod, Zeroable};

use crate::bxdfs::PrincipledParams;
use crate::math::{Color, max, min};
use crate::scene::{SceneView, TextureRef};
use crate::textures::{ColorInput, ScalarInput, TextureContext};

/// Flag of a surface whose two sides are those of a thin wall, without an inside.
pub const PRINCIPLED_THIN_WALLED: u32 = 1;

/// The parameters of *OpenPBR Surface* 1.1. See [`crate::bxdfs::PrincipledBsdf`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
#[allow(missing_docs)] // The specification says what each of them is.
pub struct Principled {
    pub base_color: ColorInput,
    pub specular_color: ColorInput,
    pub transmission_color: ColorInput,
    pub subsurface_color: ColorInput,
    pub coat_color: ColorInput,
    pub fuzz_color: ColorInput,
    pub base_weight: ScalarInput,
    pub base_metalness: ScalarInput,
    pub base_diffuse_roughness: ScalarInput,
    pub specular_weight: ScalarInput,
    pub specular_roughness: ScalarInput,
    pub specular_roughness_anisotropy: ScalarInput,
    pub transmission_weight: ScalarInput,
    pub subsurface_weight: ScalarInput,
    pub coat_weight: ScalarInput,
    pub coat_roughness: ScalarInput,
    pub coat_roughness_anisotropy: ScalarInput,
    pub coat_darkening: ScalarInput,
    pub fuzz_weight: ScalarInput,
    pub fuzz_roughness: ScalarInput,
    pub thin_film_weight: ScalarInput,
    /// In micrometres.
    pub thin_film_thickness: ScalarInput,
    pub specular_ior: f32,
    pub coat_ior: f32,
    pub thin_film_ior: f32,
    /// [`PRINCIPLED_THIN_WALLED`] or nothing.
    pub flags: u32,
}

const _: () = assert!(size_of::<Principled>() == 240);

impl Principled {
    /// The textures of all inputs.
    #[must_use]
    pub fn textures(&self) -> [TextureRef; 22] {
        [
            self.base_color.texture,
            self.specular_color.texture,
            self.transmission_color.texture,
            self.subsurface_color.texture,
            self.coat_color.texture,
            self.fuzz_color.texture,
            self.base_weight.texture,
            self.base_metalness.texture,
            self.base_diffuse_roughness.texture,
            self.specular_weight.texture,
            self.specular_roughness.texture,
            self.specular_roughness_anisotropy.texture,
            self.transmission_weight.texture,
            self.subsurface_weight.texture,
            self.coat_weight.texture,
            self.coat_roughness.texture,
            self.coat_roughness_anisotropy.texture,
            self.coat_darkening.texture,
            self.fuzz_weight.texture,
            self.fuzz_roughness.texture,
            self.thin_film_weight.texture,
            self.thin_film_thickness.texture,
        ]
    }

    /// Whether nothing goes through, wherever it is looked at.
    #[inline(always)]
    pub(super) fn is_opaque(&self) -> bool {
        let is_clear = self.transmission_weight.value > 0.0
            || self.transmission_weight.texture != TextureRef::default();
        !is_clear && self.flags & PRINCIPLED_THIN_WALLED == 0
    }

    /// The parameters at a point, brought into their ranges: textures may leave them. What belongs to a
    /// layer that is not there is not looked up.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn evaluate(&self, scene: &SceneView, at: &TextureContext) -> PrincipledParams {
        let mut p = PrincipledParams {
            base_weight: share(&self.base_weight, scene, at),
            base_color: self.base_color.evaluate_share(scene, at),
            base_metalness: share(&self.base_metalness, scene, at),
            base_diffuse_roughness: share(&self.base_diffuse_roughness, scene, at),
            specular_weight: share(&self.specular_weight, scene, at),
            specular_color: self.specular_color.evaluate_share(scene, at),
            specular_roughness: share(&self.specular_roughness, scene, at),
            specular_roughness_anisotropy: share(&self.specular_roughness_anisotropy, scene, at),
            specular_ior: self.specular_ior,
            transmission_weight: share(&self.transmission_weight, scene, at),
            transmission_color: Color::WHITE,
            subsurface_weight: share(&self.subsurface_weight, scene, at),
            subsurface_color: Color::WHITE,
            coat_weight: share(&self.coat_weight, scene, at),
            coat_color: Color::WHITE,
            coat_roughness: 0.0,
            coat_roughness_anisotropy: 0.0,
            coat_ior: self.coat_ior,
            coat_darkening: 0.0,
            fuzz_weight: share(&self.fuzz_weight, scene, at),
            fuzz_color: Color::WHITE,
            fuzz_roughness: 0.5,
            thin_film_weight: share(&self.thin_film_weight, scene, at),
            thin_film_thickness: 0.0,
            thin_film_ior: self.thin_film_ior,
            geometry_thin_walled: self.flags & PRINCIPLED_THIN_WALLED != 0,
        };
        if p.transmission_weight > 0.0 {
            p.transmission_color = self.transmission_color.evaluate_share(scene, at);
        }
        if p.subsurface_weight > 0.0 {
            p.subsurface_color = self.subsurface_color.evaluate_share(scene, at);
        }
        if p.coat_weight > 0.0 {
            p.coat_color = self.coat_color.evaluate_share(scene, at);
            p.coat_roughness = share(&self.coat_roughness, scene, at);
            p.coat_roughness_anisotropy = share(&self.coat_roughness_anisotropy, scene, at);
            p.coat_darkening = share(&self.coat_darkening, scene, at);
        }
        if p.fuzz_weight > 0.0 {
            p.fuzz_color = self.fuzz_color.evaluate_share(scene, at);
            p.fuzz_roughness = share(&self.fuzz_roughness, scene, at);
        }
        if p.thin_film_weight > 0.0 {
            p.thin_film_thickness = max(0.0, self.thin_film_thickness.evaluate(scene, at));
        }
        p
    }
}

/// A number from 0 to 1.
#[inline(always)]
fn share(input: &ScalarInput, scene: &SceneView, at: &TextureContext) -> f32 {
    max(0.0, min(1.0, input.evaluate(scene, at)))
}
