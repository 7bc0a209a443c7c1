//! Materials and their extensions.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::{one, white};

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Material {
    pub(crate) name: Option<String>,
    pub(crate) pbr_metallic_roughness: MetallicRoughness,
    pub(crate) normal_texture: Option<TextureInfo>,
    pub(crate) emissive_texture: Option<TextureInfo>,
    pub(crate) emissive_factor: [f64; 3],
    pub(crate) alpha_mode: Option<String>,
    pub(crate) alpha_cutoff: Option<f64>,
    pub(crate) double_sided: bool,
    pub(crate) extensions: Box<MaterialExtensions>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct MetallicRoughness {
    pub(crate) base_color_factor: [f64; 4],
    pub(crate) base_color_texture: Option<TextureInfo>,
    pub(crate) metallic_factor: f64,
    pub(crate) roughness_factor: f64,
    pub(crate) metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

/// Where a texture is looked up; `scale` is that of a normal texture.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextureInfo {
    pub(crate) index: usize,
    #[serde(default)]
    pub(crate) tex_coord: usize,
    #[serde(default = "one")]
    pub(crate) scale: f64,
    #[serde(default)]
    pub(crate) extensions: TextureInfoExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(crate) transform: Option<Box<TextureTransform>>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct TextureTransform {
    pub(crate) offset: [f64; 2],
    pub(crate) rotation: f64,
    pub(crate) scale: [f64; 2],
    pub(crate) tex_coord: Option<usize>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(crate) emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_ior")]
    pub(crate) ior: Option<Ior>,
    #[serde(rename = "KHR_materials_transmission")]
    pub(crate) transmission: Option<Box<Transmission>>,
    #[serde(rename = "KHR_materials_volume")]
    pub(crate) volume: Option<Box<Volume>>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub(crate) clearcoat: Option<Box<Clearcoat>>,
    #[serde(rename = "KHR_materials_sheen")]
    pub(crate) sheen: Option<Box<Sheen>>,
    #[serde(rename = "KHR_materials_specular")]
    pub(crate) specular: Option<Box<Specular>>,
    #[serde(rename = "KHR_materials_anisotropy")]
    pub(crate) anisotropy: Option<Box<Anisotropy>>,
    #[serde(rename = "KHR_materials_iridescence")]
    pub(crate) iridescence: Option<Box<Iridescence>>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(crate) specular_glossiness: Option<Box<SpecularGlossiness>>,
    #[serde(rename = "KHR_materials_dispersion")]
    pub(crate) dispersion: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_unlit")]
    pub(crate) unlit: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct EmissiveStrength {
    #[serde(default = "one")]
    pub(crate) emissive_strength: f64,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Ior {
    #[serde(default = "default_ior")]
    pub(crate) ior: f64,
}

fn default_ior() -> f64 {
    1.5
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Transmission {
    #[serde(default)]
    pub(crate) transmission_factor: f64,
    pub(crate) transmission_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Volume {
    #[serde(default)]
    pub(crate) thickness_factor: f64,
    pub(crate) attenuation_distance: Option<f64>,
    #[serde(default = "white")]
    pub(crate) attenuation_color: [f64; 3],
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Clearcoat {
    #[serde(default)]
    pub(crate) clearcoat_factor: f64,
    pub(crate) clearcoat_texture: Option<TextureInfo>,
    #[serde(default)]
    pub(crate) clearcoat_roughness_factor: f64,
    pub(crate) clearcoat_roughness_texture: Option<TextureInfo>,
    pub(crate) clearcoat_normal_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Sheen {
    #[serde(default)]
    pub(crate) sheen_color_factor: [f64; 3],
    pub(crate) sheen_color_texture: Option<TextureInfo>,
    #[serde(default)]
    pub(crate) sheen_roughness_factor: f64,
    pub(crate) sheen_roughness_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Specular {
    #[serde(default = "one")]
    pub(crate) specular_factor: f64,
    pub(crate) specular_texture: Option<TextureInfo>,
    #[serde(default = "white")]
    pub(crate) specular_color_factor: [f64; 3],
    pub(crate) specular_color_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Anisotropy {
    #[serde(default)]
    pub(crate) anisotropy_strength: f64,
    #[serde(default)]
    pub(crate) anisotropy_rotation: f64,
    pub(crate) anisotropy_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Iridescence {
    pub(crate) iridescence_factor: f64,
    pub(crate) iridescence_texture: Option<TextureInfo>,
    pub(crate) iridescence_ior: f64,
    pub(crate) iridescence_thickness_minimum: f64,
    pub(crate) iridescence_thickness_maximum: f64,
    pub(crate) iridescence_thickness_texture: Option<TextureInfo>,
}

impl Default for Iridescence {
    fn default() -> Self {
        Self {
            iridescence_factor: 0.0,
            iridescence_texture: None,
            iridescence_ior: 1.3,
            iridescence_thickness_minimum: 100.0,
            iridescence_thickness_maximum: 400.0,
            iridescence_thickness_texture: None,
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct SpecularGlossiness {
    pub(crate) diffuse_factor: [f64; 4],
    pub(crate) diffuse_texture: Option<TextureInfo>,
    pub(crate) specular_factor: [f64; 3],
    pub(crate) glossiness_factor: f64,
    pub(crate) specular_glossiness_texture: Option<TextureInfo>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self {
            diffuse_factor: [1.0; 4],
            diffuse_texture: None,
            specular_factor: [1.0; 3],
            glossiness_factor: 1.0,
            specular_glossiness_texture: None,
        }
    }
}
