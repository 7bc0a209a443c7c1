//! The parts of glTF's JSON that are read, as plain data.
//!
//! Own types rather than a crate's: the extensions of materials are most of what there is to read,
//! and every number that leads to a piece of memory is to be checked here and nowhere else. Names
//! and defaults are those of the glTF 2.0 specification; what is not named is skipped.

mod geometry;
mod material;

use serde::Deserialize;
use serde::de::IgnoredAny;

pub(crate) use geometry::{
    Accessor, Buffer, BufferView, Mesh, MeshoptCompression, Primitive, Skin,
};
pub(crate) use material::{Material, SpecularGlossiness, TextureInfo};

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Root {
    pub(crate) asset: Option<Asset>,
    pub(crate) extensions_used: Vec<String>,
    pub(crate) extensions_required: Vec<String>,
    pub(crate) scene: Option<usize>,
    pub(crate) scenes: Vec<Scene>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) accessors: Vec<Accessor>,
    pub(crate) buffer_views: Vec<BufferView>,
    pub(crate) buffers: Vec<Buffer>,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) images: Vec<Image>,
    pub(crate) samplers: Vec<Sampler>,
    pub(crate) cameras: Vec<Camera>,
    pub(crate) skins: Vec<Skin>,
    pub(crate) animations: Vec<IgnoredAny>,
    pub(crate) extensions: RootExtensions,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Asset {
    pub(crate) version: String,
    pub(crate) min_version: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct RootExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(crate) lights: Option<Lights>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Lights {
    pub(crate) lights: Vec<Light>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Light {
    #[serde(rename = "type")]
    pub(crate) kind: String,
    #[serde(default = "white")]
    pub(crate) color: [f64; 3],
    #[serde(default = "one")]
    pub(crate) intensity: f64,
    #[serde(default)]
    pub(crate) spot: Option<Spot>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Spot {
    pub(crate) inner_cone_angle: f64,
    pub(crate) outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f64::consts::FRAC_PI_4 }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Scene {
    pub(crate) name: Option<String>,
    pub(crate) nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Node {
    pub(crate) name: Option<String>,
    pub(crate) children: Vec<usize>,
    pub(crate) matrix: Option<Box<[f64; 16]>>,
    pub(crate) translation: Option<[f64; 3]>,
    pub(crate) rotation: Option<[f64; 4]>,
    pub(crate) scale: Option<[f64; 3]>,
    pub(crate) mesh: Option<usize>,
    pub(crate) skin: Option<usize>,
    pub(crate) camera: Option<usize>,
    pub(crate) weights: Vec<f64>,
    pub(crate) extensions: Option<Box<NodeExtensions>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(crate) light: Option<NodeLight>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(crate) instancing: Option<Instancing>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct NodeLight {
    pub(crate) light: usize,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Instancing {
    pub(crate) attributes: InstancingAttributes,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE", default)]
pub(crate) struct InstancingAttributes {
    pub(crate) translation: Option<usize>,
    pub(crate) rotation: Option<usize>,
    pub(crate) scale: Option<usize>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Camera {
    #[serde(default)]
    pub(crate) name: Option<String>,
    #[serde(rename = "type")]
    pub(crate) kind: String,
    pub(crate) perspective: Option<Perspective>,
    pub(crate) orthographic: Option<Orthographic>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Perspective {
    pub(crate) aspect_ratio: Option<f64>,
    pub(crate) yfov: f64,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Orthographic {
    pub(crate) xmag: f64,
    pub(crate) ymag: f64,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Texture {
    pub(crate) source: Option<usize>,
    pub(crate) sampler: Option<usize>,
    pub(crate) extensions: TextureExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureExtensions {
    #[serde(rename = "KHR_texture_basisu")]
    pub(crate) basisu: Option<IgnoredAny>,
    #[serde(rename = "EXT_texture_webp")]
    pub(crate) webp: Option<IgnoredAny>,
    #[serde(rename = "EXT_texture_avif")]
    pub(crate) avif: Option<IgnoredAny>,
    #[serde(rename = "MSFT_texture_dds")]
    pub(crate) dds: Option<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Image {
    pub(crate) name: Option<String>,
    pub(crate) uri: Option<String>,
    pub(crate) mime_type: Option<String>,
    pub(crate) buffer_view: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Sampler {
    pub(crate) mag_filter: Option<u32>,
    pub(crate) min_filter: Option<u32>,
    pub(crate) wrap_s: Option<u32>,
    pub(crate) wrap_t: Option<u32>,
}

fn one() -> f64 {
    1.0
}

fn white() -> [f64; 3] {
    [1.0; 3]
}
