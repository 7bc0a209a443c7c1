//! The scene description: what a scene file says, as plain data.
//!
//! Everything is `f64` and unvalidated here; [`crate::validate`] says what is wrong with a
//! description, and lowering turns a valid one into the arena. All lengths are world units, all
//! angles degrees, all times seconds, all colours linear sRGB.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// What is in the scene.
    #[serde(default)]
    pub objects: Vec<ObjectDesc>,
}

/// A thin-lens camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraDesc {
    /// Centre of the lens.
    pub look_from: Triple,
    /// Point that falls on the centre of the picture.
    pub look_at: Triple,
    /// Direction that is up in the picture; need not be perpendicular to the view.
    #[serde(default = "default_vup")]
    pub vup: Triple,
    /// Vertical field of view of the whole picture, in degrees, in (0, 180).
    pub vfov_deg: f64,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Apex angle of the cone from a point in focus to the edge of the lens, in degrees; 0 is a pinhole.
    #[serde(default)]
    pub defocus_angle_deg: f64,
    /// Distance from the lens to the plane in perfect focus.
    #[serde(default = "default_focus_distance")]
    pub focus_distance: f64,
    /// When the shutter opens.
    #[serde(default)]
    pub shutter_open_s: f64,
    /// When the shutter closes; moving shapes move over [0, 1].
    #[serde(default = "default_shutter_close")]
    pub shutter_close_s: f64,
}

fn default_vup() -> Triple {
    [0.0, 1.0, 0.0]
}

fn default_focus_distance() -> f64 {
    10.0
}

fn default_shutter_close() -> f64 {
    1.0
}

/// How many samples, how deep, and which.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RenderDesc {
    /// Samples per pixel.
    pub samples_per_pixel: u32,
    /// Greatest number of ray segments of a path, the camera ray being the first.
    pub max_depth: u32,
    /// Seed of every random number of the picture.
    pub seed: u64,
}

impl Default for RenderDesc {
    fn default() -> Self {
        Self { samples_per_pixel: 100, max_depth: 50, seed: 0 }
    }
}

/// What a ray that leaves the scene sees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum BackgroundDesc {
    /// The same radiance in every direction.
    Constant {
        /// Radiance.
        color: Triple,
    },
    /// Linear blend by the y of the unit direction: `bottom` at -1, `top` at +1.
    Gradient {
        /// Radiance straight down.
        bottom: Triple,
        /// Radiance straight up.
        top: Triple,
    },
}

impl Default for BackgroundDesc {
    fn default() -> Self {
        Self::Constant { color: [0.0; 3] }
    }
}

/// A colour given directly, or the name of a texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ColorDesc {
    /// The same colour everywhere.
    Solid(Triple),
    /// The texture of this name.
    Texture(String),
}

/// A texture: a colour for every point of a surface or of space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TextureDesc {
    /// The same colour everywhere.
    Solid {
        /// The colour.
        color: Triple,
    },
    /// Alternating cubes in world space.
    Checker {
        /// Edge length of a cube.
        scale: f64,
        /// Colour where the sum of the cube's indices is even.
        even: ColorDesc,
        /// Colour where it is odd.
        odd: ColorDesc,
    },
    /// Perlin's gradient noise in world space, as a blend from `low` to `high`.
    Noise {
        /// Noise cells per world unit.
        scale: f64,
        /// `noise`: one octave; `turbulence`: absolute value of a sum of octaves; `marble`: sine veins along z bent by turbulence.
        #[serde(default)]
        pattern: NoisePattern,
        /// Octaves of turbulence, 1 to 16.
        #[serde(default = "default_octaves")]
        octaves: u32,
        /// Chooses the lattice of gradients.
        #[serde(default)]
        seed: u32,
        /// Colour at the pattern's value 0.
        #[serde(default)]
        low: Triple,
        /// Colour at the pattern's value 1.
        #[serde(default = "default_high")]
        high: Triple,
    },
    /// A picture, looked up at (u, v).
    Image {
        /// PNG, JPEG, Radiance HDR, OpenEXR or PFM file, relative to the scene file; `builtin:NAME` is a
        /// picture inside zrak (`builtin:earth.png`).
        path: String,
        /// How texels are combined.
        #[serde(default)]
        filter: ImageFilter,
    },
}

fn default_octaves() -> u32 {
    7
}

fn default_high() -> Triple {
    [1.0; 3]
}

/// Patterns made of Perlin noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NoisePattern {
    /// (1 + noise(p)) / 2.
    #[default]
    Noise,
    /// |sum over octaves of noise(2^i p) / 2^i|.
    Turbulence,
    /// (1 + sin(p.z + 10 turbulence(p / scale))) / 2, with p scaled.
    Marble,
}

/// How an image texture combines texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImageFilter {
    /// Weighted mean of the four nearest texels.
    #[default]
    Bilinear,
    /// The texel that the point falls into.
    Nearest,
}

/// How a surface or a medium scatters or emits light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MaterialDesc {
    /// Ideal diffuse reflection, on both sides.
    Lambertian {
        /// Albedo.
        color: ColorDesc,
    },
    /// Mirror reflection, perturbed: reflect + fuzz * (uniform point on the unit sphere).
    Metal {
        /// Reflectance.
        color: ColorDesc,
        /// Radius of the perturbation, 0 (mirror) to 1.
        #[serde(default)]
        fuzz: f64,
    },
    /// Smooth clear dielectric.
    Dielectric {
        /// Index of refraction inside relative to outside; below 1 for a bubble.
        ior: f64,
        /// How the reflected share is computed.
        #[serde(default)]
        fresnel: FresnelDesc,
    },
    /// Isotropic phase function, for media.
    Isotropic {
        /// Single-scattering albedo.
        color: ColorDesc,
    },
    /// Emits and does not scatter.
    DiffuseLight {
        /// Emitted radiance.
        color: ColorDesc,
        /// Which sides of the surface emit.
        #[serde(default)]
        sides: LightSides,
    },
}

/// How the share of light that a dielectric reflects is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FresnelDesc {
    /// Fresnel's equations for unpolarised light.
    #[default]
    Exact,
    /// Schlick's approximation.
    Schlick,
}

/// Which sides of a light emit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightSides {
    /// Both.
    #[default]
    Both,
    /// Only the side that the surface normal points to; the other is black.
    Front,
}

/// One object and where it stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ObjectDesc {
    /// Sphere, still or moving on a line.
    Sphere {
        /// Centre, at time 0 if it moves.
        center: Triple,
        /// Centre at time 1, if it moves.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        center_end: Option<Triple>,
        /// Radius.
        radius: f64,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Parallelogram; its normal is the direction of `u` x `v`.
    Quad {
        /// Corner.
        corner: Triple,
        /// Edge from the corner, along which texture u grows.
        u: Triple,
        /// Edge from the corner, along which texture v grows.
        v: Triple,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Triangle; its normal is the direction of (b - a) x (c - a).
    Triangle {
        /// The three corners.
        vertices: [Triple; 3],
        /// Texture coordinates at the corners.
        #[serde(default = "default_triangle_uv")]
        uv: [[f64; 2]; 3],
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Box with sides along the axes (before the transform).
    Box {
        /// Corner with the smallest coordinates.
        min: Triple,
        /// Corner with the largest coordinates.
        max: Triple,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Medium of constant density inside a closed convex boundary.
    Medium {
        /// Sphere or box, without a material.
        boundary: BoundaryDesc,
        /// Extinction coefficient: mean number of collisions per world unit.
        density: f64,
        /// Name of its phase function's material (`isotropic`).
        material: String,
        /// Steps applied to the boundary in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Objects that move together.
    Group {
        /// What is in it.
        objects: Vec<ObjectDesc>,
        /// Steps applied in order, the first first, after those of the members.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
}

fn default_triangle_uv() -> [[f64; 2]; 3] {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
}

/// The closed convex surface that holds a medium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum BoundaryDesc {
    /// Sphere, still or moving on a line.
    Sphere {
        /// Centre, at time 0 if it moves.
        center: Triple,
        /// Centre at time 1, if it moves.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        center_end: Option<Triple>,
        /// Radius.
        radius: f64,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Box with sides along the axes (before the transform).
    Box {
        /// Corner with the smallest coordinates.
        min: Triple,
        /// Corner with the largest coordinates.
        max: Triple,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
}

/// One step of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TransformStep {
    /// Move.
    Translate(Triple),
    /// Turn about an axis through the origin, counter-clockwise seen from its tip.
    Rotate {
        /// Axis, of any length but zero.
        axis: Triple,
        /// Angle.
        angle_deg: f64,
    },
    /// Turn about the x axis, in degrees.
    RotateXDeg(f64),
    /// Turn about the y axis, in degrees.
    RotateYDeg(f64),
    /// Turn about the z axis, in degrees.
    RotateZDeg(f64),
    /// Scale about the origin, by one factor or one for each axis.
    Scale(ScaleDesc),
    /// Rows of the 3x4 matrix of an affine map: p' = M (p, 1).
    Matrix([[f64; 4]; 3]),
}

/// One factor, or one for each axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ScaleDesc {
    /// The same for all axes.
    Uniform(f64),
    /// One for each axis.
    PerAxis(Triple),
}
