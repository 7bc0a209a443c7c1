//! The scene description: what a scene file says, as plain data.
//!
//! Everything is `f64` and unvalidated here; [`crate::validate`] says what is wrong with a
//! description, and lowering turns a valid one into the arena. All lengths are world units, all
//! angles degrees, all times seconds, all colours linear sRGB.

mod camera;
mod lights;
mod materials;
mod meshes;
mod objects;
mod textures;
mod transforms;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use camera::{CameraDesc, ProjectionDesc};
pub use lights::{BackgroundDesc, EnvironmentMapping, LightDesc, SpotFalloff};
pub use materials::{
    CoatDesc, ConductorDesc, FresnelDesc, LightSides, MaterialDesc, MediumInterfaceDesc,
    PrincipledDesc, RoughnessDesc, RoughnessMap,
};
pub use meshes::MeshDesc;
pub use objects::{BoundaryDesc, CurveForm, ObjectDesc};
pub use textures::{
    ColorDesc, FractalPattern, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, NoisePattern,
    ScalarDesc, TextureDesc, WrapMode,
};
pub use transforms::{ScaleDesc, TransformStep};

/// A point, a vector, or a linear sRGB colour, by context.
pub type Triple = [f64; 3];

/// A whole scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneDesc {
    /// Version of the format; this version of zrak reads 1.
    pub format: u32,
    /// Name of the scene, kept in the metadata of pictures.
    pub name: String,
    /// One line about the scene.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// How the picture is taken.
    pub camera: CameraDesc,
    /// How it is sampled, unless the command line says otherwise.
    #[serde(default)]
    pub render: RenderDesc,
    /// What a ray that leaves the scene sees.
    #[serde(default)]
    pub background: BackgroundDesc,
    /// Textures by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub textures: BTreeMap<String, TextureDesc>,
    /// Materials by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub materials: BTreeMap<String, MaterialDesc>,
    /// Participating media that surfaces can bound, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub media: BTreeMap<String, MediumDesc>,
    /// Triangle meshes by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub meshes: BTreeMap<String, MeshDesc>,
    /// Groups of objects by name, to be placed any number of times by `instance` objects.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub prototypes: BTreeMap<String, Vec<ObjectDesc>>,
    /// Lights without a surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<LightDesc>,
    /// What is in the scene.
    #[serde(default)]
    pub objects: Vec<ObjectDesc>,
}

impl Default for SceneDesc {
    /// An empty scene without light.
    fn default() -> Self {
        Self {
            format: 1,
            name: String::new(),
            description: String::new(),
            camera: CameraDesc::default(),
            render: RenderDesc::default(),
            background: BackgroundDesc::default(),
            textures: BTreeMap::new(),
            materials: BTreeMap::new(),
            media: BTreeMap::new(),
            meshes: BTreeMap::new(),
            prototypes: BTreeMap::new(),
            lights: Vec::new(),
            objects: Vec::new(),
        }
    }
}

/// How many samples, how deep, and which.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RenderDesc {
    /// Samples per pixel.
    pub samples_per_pixel: u32,
    /// Greatest number of ray segments of a path, the camera ray being the first.
    pub max_depth: u32,
    /// Number of ray segments after which paths that carry little may be ended by chance (Russian
    /// roulette), which saves time and keeps the mean. No less than `max_depth` for never.
    #[serde(default = "default_rr_depth", skip_serializing_if = "is_default_rr_depth")]
    pub rr_depth: u32,
    /// Seed of every random number of the picture.
    pub seed: u64,
}

impl Default for RenderDesc {
    fn default() -> Self {
        Self { samples_per_pixel: 100, max_depth: 50, rr_depth: default_rr_depth(), seed: 0 }
    }
}

/// A participating medium that surfaces can bound: homogeneous, with the Henyey-Greenstein phase
/// function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MediumDesc {
    /// Absorption coefficient per world unit.
    pub sigma_a: Triple,
    /// Scattering coefficient per world unit.
    pub sigma_s: Triple,
    /// Mean cosine of the scattering angle, in (-1, 1): negative scatters back, 0 evenly.
    #[serde(default)]
    pub g: f64,
}

fn default_rr_depth() -> u32 {
    2
}

fn is_default_rr_depth(n: &u32) -> bool {
    *n == default_rr_depth()
}

fn one() -> f64 {
    1.0
}

fn is_false(x: &bool) -> bool {
    !x
}
