//! Materials of MTL files as OpenPBR surfaces.
//!
//! MTL is Phong's model with additions of many hands, and says little about what its numbers mean. What is
//! chosen here:
//!
//! - the exponent `Ns` is Blinn's n of the distribution of normals, whose GGX counterpart has
//!   alpha^2 = 2 / (n + 2) (Walter, Marschner, Li, Torrance, *Microfacet Models for Refraction through
//!   Rough Surfaces*, 2007, equation 36 and after); OpenPBR's roughness is the root of alpha;
//! - `Ks` is the weight and tint of a dielectric's reflection with the index `Ni`, or 1.5; over a black
//!   `Kd`, the colour of a metal. `illum` 0 and 1 have no reflection;
//! - with `illum` 4, 6, 7 or 9, 1 - `d` is the share of light that is refracted (all of it with 6 and 7 if
//!   `d` is 1); else `d` is how much of the surface is there;
//! - the numbers of the PBR extension (`Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`) are OpenPBR's own.

use std::collections::BTreeMap;

use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageEncoding, LightSides, MaterialDesc, PrincipledDesc, ScalarDesc,
    TextureDesc, Triple,
};

use crate::mtl::Mtl;
use crate::textures::Textures;

/// Height of a bump map's white over its black, as a part of the size of the scene: the format does not
/// say.
const BUMP_HEIGHT: f64 = 1e-3;
/// Greatest radiance that is taken over.
const RADIANCE_MAX: f64 = 1e9;

/// The materials of a scene.
pub(crate) struct Materials<'a> {
    pub(crate) textures: Textures<'a>,
    pub(crate) materials: BTreeMap<String, MaterialDesc>,
    /// Whether one shines enough to light a scene.
    pub(crate) has_light: bool,
    /// Whether the mesh has colours.
    pub(crate) has_colors: bool,
    /// Diagonal of a box around the scene.
    pub(crate) size: f64,
}

impl Materials<'_> {
    /// Name of the material of faces without one.
    pub(crate) fn default_material(&mut self) -> String {
        let name = self.free("default");
        let surface = PrincipledDesc {
            base_color: self.vertex_colors().unwrap_or(ColorDesc::Solid([0.8; 3])),
            ..PrincipledDesc::default()
        };
        self.insert(name.clone(), surface);
        name
    }

    fn insert(&mut self, name: String, surface: PrincipledDesc) {
        self.materials.insert(name, MaterialDesc::Principled { surface: Box::new(surface) });
    }

    /// A name that no material has yet.
    fn free(&self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        while self.materials.contains_key(&name) {
            name.push('\'');
        }
        name
    }

    fn vertex_colors(&mut self) -> Option<ColorDesc> {
        self.has_colors.then(|| {
            let desc = TextureDesc::VertexColor { channel: ImageChannel::Color };
            ColorDesc::Texture(self.textures.add(desc, "vertex colors"))
        })
    }

    /// Adds a material of an MTL file in `folder`; gives its name.
    pub(crate) fn translate(
        &mut self,
        mtl: &Mtl,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> String {
        let wanted = if mtl.name.is_empty() { "material" } else { &mtl.name };
        let name = self.free(wanted);
        let (surface, is_refractive) = self.principled(mtl, folder, warn);
        let mut wrapped = MaterialDesc::surface("");
        if let MaterialDesc::Surface {
            emission,
            emission_sides,
            alpha,
            normal_map,
            normal_scale,
            bump,
            ..
        } = &mut wrapped
        {
            *emission = self.emission(mtl, folder, warn);
            *emission_sides = LightSides::Both;
            if !is_refractive {
                *alpha = self.alpha(mtl, folder, warn);
            }
            if let Some(map) = mtl.maps.get("norm") {
                let (encoding, channel) = (ImageEncoding::Linear, ImageChannel::Color);
                let image = self.textures.image(map, folder, encoding, channel, 1.0, warn);
                *normal_map = Some(image);
                *normal_scale = map.bump.clamp(-1e6, 1e6);
            } else if let Some(map) = mtl.maps.get("bump") {
                let height = (map.bump * BUMP_HEIGHT * self.size).clamp(0.0, 1e6);
                *bump = Some(self.textures.scalar(height, Some(map), folder, warn));
            }
        }
        if wrapped == MaterialDesc::surface("") {
            self.insert(name.clone(), surface);
            return name;
        }
        let inner = self.free(&format!("{name} (base)"));
        if let MaterialDesc::Surface { base, .. } = &mut wrapped {
            base.clone_from(&inner);
        }
        self.insert(inner, surface);
        self.materials.insert(name.clone(), wrapped);
        name
    }

    fn emission(
        &mut self,
        mtl: &Mtl,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> Option<ColorDesc> {
        let map = mtl.maps.get("Ke");
        let factor = match mtl.colors.get("Ke") {
            Some(color) => color.map(|x| x.clamp(0.0, RADIANCE_MAX)),
            None if map.is_some() => [1.0; 3],
            None => return None,
        };
        // Black beside a map is what exporters write that know nothing of the factor.
        let factor = if factor == [0.0; 3] && map.is_some() { [1.0; 3] } else { factor };
        if factor == [0.0; 3] {
            return None;
        }
        // Pictures of small lamps and screens light no scene.
        self.has_light |= map.is_none() || factor.iter().any(|&x| x > 1.0);
        Some(self.textures.color(factor, map, folder, warn))
    }

    fn alpha(
        &mut self,
        mtl: &Mtl,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> Option<ScalarDesc> {
        let opacity = mtl.numbers.get("d").map_or(1.0, |d| d.clamp(0.0, 1.0));
        let Some(map) = mtl.maps.get("d") else {
            return (opacity < 1.0).then_some(ScalarDesc::Value(opacity));
        };
        // The picture of the colour again: then its alpha is meant.
        let is_color = mtl.maps.get("Kd").is_some_and(|color| color.path == map.path);
        let channel = if is_color { ImageChannel::A } else { ImageChannel::Color };
        let encoding = ImageEncoding::Linear;
        let opacity = if opacity == 0.0 { 1.0 } else { opacity };
        let name = self.textures.image(map, folder, encoding, channel, opacity, warn);
        Some(ScalarDesc::Texture(name))
    }

    /// How a material scatters, and whether light goes through it by refraction.
    fn principled(
        &mut self,
        mtl: &Mtl,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> (PrincipledDesc, bool) {
        let mut surface = PrincipledDesc::default();
        let number = |key: &str| mtl.numbers.get(key).map(|x| x.clamp(0.0, 1.0));
        let colors = |key: &str| mtl.colors.get(key).map(|c| c.map(|x| x.clamp(0.0, 1.0)));
        let kd_map = mtl.maps.get("Kd");
        let kd = colors("Kd");
        surface.base_color = match (kd, kd_map) {
            (Some([0.0, 0.0, 0.0]) | None, Some(_)) => {
                self.textures.color([1.0; 3], kd_map, folder, warn)
            }
            (kd, Some(_)) => self.textures.color(kd.unwrap_or([1.0; 3]), kd_map, folder, warn),
            (kd, None) => match self.vertex_colors() {
                Some(colors) => self.textures.times(colors, kd.unwrap_or([1.0; 3])),
                None => ColorDesc::Solid(kd.unwrap_or([0.8; 3])),
            },
        };
        let is_black = kd == Some([0.0; 3]) && kd_map.is_none();
        let physical = ["Pr", "Pm", "Ps", "Pc", "Pcr", "aniso"];
        let is_physical =
            physical.iter().any(|key| mtl.numbers.contains_key(key) || mtl.maps.contains_key(key));
        let index = mtl.numbers.get("Ni").copied().filter(|&n| n >= 1.0).map(|n| n.min(10.0));
        let opacity = number("d").unwrap_or(1.0);
        let through = match mtl.illum {
            Some(6 | 7) if opacity == 1.0 => 1.0,
            Some(4 | 6 | 7 | 9) => 1.0 - opacity,
            _ => 0.0,
        };
        if let Some(index) = index.filter(|&n| n > 1.0 || through > 0.0) {
            surface.specular_ior = index;
        }
        // Roughness.
        let exponent = mtl.numbers.get("Ns").map_or(10.0, |n| n.max(0.0));
        let phong = (2.0 / (exponent + 2.0)).sqrt().sqrt();
        let mapped = |key: &str| mtl.maps.get(key);
        // Numbers beside a map are its factor, but for 0, which would make it useless.
        let factor = |key: &str| number(key).filter(|&x| x > 0.0).unwrap_or(1.0);
        let mut share = |key: &str| -> Option<ScalarDesc> {
            match mapped(key) {
                Some(map) => Some(self.textures.scalar(factor(key), Some(map), folder, warn)),
                None => number(key).map(ScalarDesc::Value),
            }
        };
        surface.specular_roughness = match share("Pr") {
            Some(roughness) => roughness,
            None if is_physical && !mtl.numbers.contains_key("Ns") => {
                surface.specular_roughness.clone()
            }
            None => phong.into(),
        };
        if let Some(metalness) = share("Pm") {
            surface.base_metalness = metalness;
        }
        if let Some(fuzz) = share("Ps") {
            surface.fuzz_weight = fuzz;
        }
        if let Some(coat) = share("Pc") {
            surface.coat_weight = coat;
            surface.coat_ior = 1.5;
        }
        if let Some(roughness) = share("Pcr") {
            surface.coat_roughness = roughness;
        }
        if let Some(anisotropy) = share("aniso") {
            surface.specular_roughness_anisotropy = anisotropy;
        }
        // Reflection.
        let ks = colors("Ks");
        let ks_map = mtl.maps.get("Ks");
        if is_physical {
            // Exporters write any `Ks` beside these.
        } else if matches!(mtl.illum, Some(0 | 1)) || (ks.is_none() && ks_map.is_none()) {
            surface.specular_weight = if through > 0.0 { 1.0 } else { 0.0 }.into();
        } else if ks_map.is_some() {
            let factor = ks.filter(|c| *c != [0.0; 3]).unwrap_or([1.0; 3]);
            surface.specular_color = self.textures.color(factor, ks_map, folder, warn);
        } else {
            let ks = ks.unwrap_or([0.0; 3]);
            let largest = ks.iter().fold(0.0_f64, |m, &x| m.max(x));
            if is_black && largest > 0.0 && through == 0.0 && opacity == 1.0 {
                surface.base_metalness = 1.0.into();
                surface.base_color = ColorDesc::Solid(ks);
            } else if through == 0.0 {
                surface.specular_weight = largest.into();
                if largest > 0.0 {
                    surface.specular_color = ColorDesc::Solid(ks.map(|x| x / largest));
                }
            }
        }
        if through > 0.0 {
            surface.transmission_weight = through.into();
            let filter: Option<Triple> = colors("Tf").filter(|c| *c != [0.0; 3]);
            surface.transmission_color = ColorDesc::Solid(filter.unwrap_or([1.0; 3]));
            if !mtl.numbers.contains_key("Ns") && !is_physical {
                surface.specular_roughness = 0.0.into();
            } else if exponent >= 1000.0 && !is_physical {
                // The largest exponent that programs have stands for none.
                surface.specular_roughness = 0.0.into();
            }
        } else if is_black && exponent >= 1000.0 && !is_physical {
            surface.specular_roughness = 0.0.into();
        }
        (surface, through > 0.0)
    }
}
