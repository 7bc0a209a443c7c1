//! The OpenPBR surface: each parameter is an input.

use zrak_core::materials::{PRINCIPLED_THIN_WALLED, Principled};
use zrak_core::textures::{ColorInput, ScalarInput};

use super::Lowering;
use crate::desc::{ColorDesc, PrincipledDesc, ScalarDesc};

impl<'a> Lowering<'a, '_> {
    /// The record, and whether it looks at texture coordinates.
    pub(super) fn principled(&mut self, desc: &'a PrincipledDesc) -> (Principled, bool) {
        let mut needs_uv = false;
        let mut color = |lowering: &mut Self, desc: &'a ColorDesc| -> ColorInput {
            let lowered = lowering.color_input(desc);
            needs_uv |= lowered.needs_uv;
            lowered.input
        };
        let base_color = color(self, &desc.base_color);
        let specular_color = color(self, &desc.specular_color);
        let transmission_color = color(self, &desc.transmission_color);
        let subsurface_color = color(self, &desc.subsurface_color);
        let coat_color = color(self, &desc.coat_color);
        let fuzz_color = color(self, &desc.fuzz_color);
        let mut scalar = |desc: &'a ScalarDesc| -> ScalarInput {
            let (input, uv) = self.scalar_input(desc);
            needs_uv |= uv;
            input
        };
        let record = Principled {
            base_color,
            specular_color,
            transmission_color,
            subsurface_color,
            coat_color,
            fuzz_color,
            base_weight: scalar(&desc.base_weight),
            base_metalness: scalar(&desc.base_metalness),
            base_diffuse_roughness: scalar(&desc.base_diffuse_roughness),
            specular_weight: scalar(&desc.specular_weight),
            specular_roughness: scalar(&desc.specular_roughness),
            specular_roughness_anisotropy: scalar(&desc.specular_roughness_anisotropy),
            transmission_weight: scalar(&desc.transmission_weight),
            subsurface_weight: scalar(&desc.subsurface_weight),
            coat_weight: scalar(&desc.coat_weight),
            coat_roughness: scalar(&desc.coat_roughness),
            coat_roughness_anisotropy: scalar(&desc.coat_roughness_anisotropy),
            coat_darkening: scalar(&desc.coat_darkening),
            fuzz_weight: scalar(&desc.fuzz_weight),
            fuzz_roughness: scalar(&desc.fuzz_roughness),
            thin_film_weight: scalar(&desc.thin_film_weight),
            thin_film_thickness: scalar(&desc.thin_film_thickness),
            specular_ior: desc.specular_ior as f32,
            coat_ior: desc.coat_ior as f32,
            thin_film_ior: desc.thin_film_ior as f32,
            flags: if desc.geometry_thin_walled { PRINCIPLED_THIN_WALLED } else { 0 },
        };
        // Brushes run along u.
        let none = ScalarDesc::Value(0.0);
        needs_uv |= desc.specular_roughness_anisotropy != none
            || (desc.coat_roughness_anisotropy != none && desc.coat_weight != none);
        (record, needs_uv)
    }
}
