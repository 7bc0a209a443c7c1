//! What the shapes of a material need: its name, light, media and holes.

use std::fmt::Write;

use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageEncoding, LightSides, MappingDesc, MaterialDesc, TextureDesc,
};
use zrak_scene::error::SceneError;

use super::Writer;
use super::text::{param, quoted, word};

type Result<T> = std::result::Result<T, SceneError>;

/// What stands before a shape, and among its parameters.
#[derive(Clone, Debug, Default)]
pub(super) struct Shading {
    /// Directives for the material, its light and media.
    pub(super) before: String,
    /// Parameters of the shape.
    pub(super) params: String,
    pub(super) shines: bool,
}

impl Writer<'_, '_> {
    pub(super) fn shading(&mut self, name: &str) -> Result<Shading> {
        if let Some(known) = self.shadings.get(name) {
            return Ok(known.clone());
        }
        let desc = self.desc;
        let mut shading = Shading::default();
        let mut light = None;
        let mut media = None;
        let material = match desc.materials.get(name) {
            Some(MaterialDesc::DiffuseLight { color, sides }) => {
                light = Some((color, 1.0, *sides));
                self.material(name)?
            }
            Some(MaterialDesc::Surface {
                base,
                emission,
                emission_strength,
                emission_sides,
                alpha,
                alpha_cutoff,
                normal_map,
                normal_scale,
                bump,
                medium,
                one_sided,
            }) => {
                light = emission.as_ref().map(|color| (color, *emission_strength, *emission_sides));
                if *one_sided {
                    self.warn("surfaces are seen from both sides in pbrt");
                }
                if let Some(alpha) = alpha {
                    shading.params = self.scalar("alpha", alpha)?;
                    if alpha_cutoff.is_some() {
                        self.warn("alpha is a chance in pbrt: it is not cut off");
                    }
                }
                if let Some(medium) = medium {
                    let mut of = |name: &Option<String>| match name {
                        Some(name) => self.medium(name),
                        None => String::new(),
                    };
                    media = Some((of(&medium.inside), of(&medium.outside)));
                }
                let bumps = self.bumps(bump.as_ref(), normal_map.as_deref(), *normal_scale)?;
                if let Some(MaterialDesc::DiffuseLight { color, sides }) = desc.materials.get(base)
                {
                    light = light.or(Some((color, 1.0, *sides)));
                }
                if bumps.is_empty() {
                    self.material(base)?
                } else {
                    self.material_with(base, name, &bumps)?
                }
            }
            _ => self.material(name)?,
        };
        let _ = writeln!(shading.before, "NamedMaterial {}", quoted(&material));
        if let Some((inside, outside)) = media {
            let _ = writeln!(
                shading.before,
                "MediumInterface {} {}",
                quoted(&inside),
                quoted(&outside)
            );
        }
        if let Some((color, strength, sides)) = light {
            let light = self.area_light(color, strength, sides)?;
            shading.shines = true;
            let _ = writeln!(shading.before, "AreaLightSource \"diffuse\"{light}");
        }
        self.shadings.insert(name.to_owned(), shading.clone());
        Ok(shading)
    }

    fn area_light(
        &mut self,
        color: &ColorDesc,
        strength: f64,
        sides: LightSides,
    ) -> Result<String> {
        let desc = self.desc;
        let two_sided = if sides == LightSides::Both { " \"bool twosided\" true" } else { "" };
        let texture = match color {
            ColorDesc::Solid(color) => {
                let scale = if strength == 1.0 {
                    String::new()
                } else {
                    param("float", "scale", [strength])
                };
                return Ok(param("rgb", "L", *color) + &scale + two_sided);
            }
            ColorDesc::Texture(name) => desc.textures.get(name),
        };
        let (light, factor) = match texture {
            Some(TextureDesc::Image {
                path, encoding, channel, scale, invert, mapping, ..
            }) => {
                let is_plain = *mapping == MappingDesc::Uv
                    && !invert
                    && *channel == ImageChannel::Color
                    && *encoding != ImageEncoding::Linear;
                if !is_plain {
                    self.warn("pictures of area lights are looked up as they are");
                }
                (word("string", "filename", &self.copied(path)?), *scale)
            }
            Some(TextureDesc::Solid { color }) => (param("rgb", "L", *color), 1.0),
            _ => {
                self.warn("lights with a texture that is no picture are even and white");
                (String::new(), 1.0)
            }
        };
        Ok(light + &param("float", "scale", [strength * factor]) + two_sided)
    }

    pub(super) fn all_media(&mut self) {
        let desc = self.desc;
        for name in desc.media.keys() {
            self.medium(name);
        }
    }

    /// Name of a medium.
    pub(super) fn medium(&mut self, name: &str) -> String {
        if let Some(known) = self.media.get(name) {
            return known.clone();
        }
        let written = self.unique_name("medium", name);
        if let Some(medium) = self.desc.media.get(name) {
            self.define_medium(&written, medium.sigma_a, medium.sigma_s, medium.g);
        }
        self.media.insert(name.to_owned(), written.clone());
        written
    }

    pub(super) fn define_medium(
        &mut self,
        name: &str,
        sigma_a: [f64; 3],
        sigma_s: [f64; 3],
        g: f64,
    ) {
        let params = word("string", "type", "homogeneous")
            + &param("rgb", "sigma_a", sigma_a)
            + &param("rgb", "sigma_s", sigma_s)
            + &param("float", "g", [g]);
        let _ = writeln!(self.out, "MakeNamedMedium {}{params}", quoted(name));
    }
}
