//! Textures and inputs that may have one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TransformStep, Triple, is_false, one};

/// A colour given directly, or the name of a texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ColorDesc {
    /// The same colour everywhere.
    Solid(Triple),
    /// The texture of this name.
    Texture(String),
}

/// A number given directly, or the name of a texture whose red channel it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ScalarDesc {
    /// The same number everywhere.
    Value(f64),
    /// The texture of this name.
    Texture(String),
}

impl From<f64> for ScalarDesc {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

impl From<Triple> for ColorDesc {
    fn from(color: Triple) -> Self {
        Self::Solid(color)
    }
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
    /// Sums of octaves of Perlin noise in world space, as a blend from `low` to `high`.
    Fractal {
        /// Noise cells per world unit.
        scale: f64,
        /// How the octaves are added up.
        #[serde(default)]
        pattern: FractalPattern,
        /// Octaves, 1 to 16.
        #[serde(default = "default_octaves")]
        octaves: u32,
        /// How much each octave weighs against the one before, 0 to 1.
        #[serde(default = "half")]
        roughness: f64,
        /// Chooses the lattice of gradients.
        #[serde(default)]
        seed: u32,
        /// Colour at the pattern's value 0; it may go beyond both ends.
        #[serde(default)]
        low: Triple,
        /// Colour at the pattern's value 1.
        #[serde(default = "default_high")]
        high: Triple,
    },
    /// A texture in world space, moved.
    Placed {
        /// The texture.
        texture: ColorDesc,
        /// Steps that move the texture, the first first.
        transform: Vec<TransformStep>,
    },
    /// A picture, looked up at (u, v).
    Image {
        /// PNG, JPEG, Radiance HDR, OpenEXR or PFM file, relative to the scene file; `builtin:NAME` is a
        /// picture inside zrak (`builtin:earth.png`).
        path: String,
        /// How texels are combined.
        #[serde(default)]
        filter: ImageFilter,
        /// What is beyond the left and right sides.
        #[serde(default = "repeat", skip_serializing_if = "is_repeat")]
        wrap_u: WrapMode,
        /// What is beyond the upper and lower sides.
        #[serde(default = "clamp", skip_serializing_if = "is_clamp")]
        wrap_v: WrapMode,
        /// What the numbers in the file mean.
        #[serde(default, skip_serializing_if = "ImageEncoding::is_auto")]
        encoding: ImageEncoding,
        /// Which channels are looked at.
        #[serde(default, skip_serializing_if = "ImageChannel::is_color")]
        channel: ImageChannel,
        /// Factor of the values.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        scale: f64,
        /// Whether to take 1 minus the value (before `scale`).
        #[serde(default, skip_serializing_if = "is_false")]
        invert: bool,
        /// Where on the picture a point of the surface falls.
        #[serde(default, skip_serializing_if = "MappingDesc::is_uv")]
        mapping: MappingDesc,
    },
    /// Alternating squares in (u, v), each of side 1.
    UvChecker {
        /// Colour where the sum of the square's indices is even.
        even: ColorDesc,
        /// Colour where it is odd.
        odd: ColorDesc,
        /// Where in (u, v) a point of the surface falls.
        #[serde(default, skip_serializing_if = "MappingDesc::is_uv")]
        mapping: MappingDesc,
    },
    /// Randomly placed dots in (u, v), at most one in each square of side 1.
    Dots {
        /// Colour of the dots.
        inside: ColorDesc,
        /// Colour around them.
        outside: ColorDesc,
        /// Where in (u, v) a point of the surface falls.
        #[serde(default, skip_serializing_if = "MappingDesc::is_uv")]
        mapping: MappingDesc,
    },
    /// Bilinear blend of four colours by (u, v).
    Bilerp {
        /// Colours at (0, 0), (0, 1), (1, 0), (1, 1).
        corners: [Triple; 4],
        /// Where in (u, v) a point of the surface falls.
        #[serde(default, skip_serializing_if = "MappingDesc::is_uv")]
        mapping: MappingDesc,
    },
    /// (1 - amount) a + amount b.
    Mix {
        /// Colour at amount 0.
        a: ColorDesc,
        /// Colour at amount 1.
        b: ColorDesc,
        /// How much of `b`.
        amount: ScalarDesc,
    },
    /// Product of two colours.
    Multiply {
        /// One factor.
        a: ColorDesc,
        /// The other.
        b: ColorDesc,
    },
    /// The colours of the mesh's vertices, white where it has none; `channel` picks one of them.
    VertexColor {
        /// Which channels are looked at.
        #[serde(default, skip_serializing_if = "ImageChannel::is_color")]
        channel: ImageChannel,
    },
}

impl TextureDesc {
    /// The picture at `path` with everything else by default.
    #[must_use]
    pub fn image(path: impl Into<String>, filter: ImageFilter) -> Self {
        Self::Image {
            path: path.into(),
            filter,
            wrap_u: repeat(),
            wrap_v: clamp(),
            encoding: ImageEncoding::default(),
            channel: ImageChannel::default(),
            scale: 1.0,
            invert: false,
            mapping: MappingDesc::default(),
        }
    }
}

/// Where in (u, v) a point of a surface falls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MappingDesc {
    /// The surface's own coordinates under an affine map, the identity by default.
    #[default]
    Uv,
    /// The surface's own coordinates under an affine map: u' = m00 u + m01 v + m02, v' likewise.
    UvAffine {
        /// Rows of the 2x3 matrix.
        matrix: [[f64; 3]; 2],
    },
    /// Affine in world space: u and v are the products of the rows with (p, 1).
    Planar {
        /// Rows of the 2x4 matrix.
        matrix: [[f64; 4]; 2],
    },
    /// u = angle about z over a turn, v = angle from +z over half a turn, in texture space.
    Spherical {
        /// From the world to texture space.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// u = angle about z over a turn, v = z, in texture space.
    Cylindrical {
        /// From the world to texture space.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
}

impl MappingDesc {
    fn is_uv(&self) -> bool {
        *self == Self::Uv
    }
}

/// What is beyond the rim of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WrapMode {
    /// The picture again.
    Repeat,
    /// Its outermost texels.
    Clamp,
    /// The picture mirrored.
    Mirror,
    /// Black.
    Black,
}

/// What the numbers in a picture's file mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImageEncoding {
    /// By use and format: 8 and 16-bit files are sRGB-coded where a colour is asked for, and linear
    /// where a number or a normal is; files of floating-point numbers are linear.
    #[default]
    Auto,
    /// sRGB codes.
    Srgb,
    /// Linear.
    Linear,
}

impl ImageEncoding {
    fn is_auto(&self) -> bool {
        *self == Self::Auto
    }
}

/// Which channels of a picture are looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImageChannel {
    /// Red, green and blue; where one number is asked for, their luminance if the file has colours.
    #[default]
    Color,
    /// Red, for all three.
    R,
    /// Green, for all three.
    G,
    /// Blue, for all three.
    B,
    /// Alpha, for all three; 1 if the file has none.
    A,
}

impl ImageChannel {
    fn is_color(&self) -> bool {
        *self == Self::Color
    }
}

fn repeat() -> WrapMode {
    WrapMode::Repeat
}

fn is_repeat(mode: &WrapMode) -> bool {
    *mode == WrapMode::Repeat
}

fn clamp() -> WrapMode {
    WrapMode::Clamp
}

fn is_clamp(mode: &WrapMode) -> bool {
    *mode == WrapMode::Clamp
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

fn half() -> f64 {
    0.5
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

/// How a fractal texture adds up octaves of noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FractalPattern {
    /// Fractional Brownian motion: sum over octaves of roughness^i noise(1.99^i p).
    #[default]
    Fbm,
    /// The same with the noise's absolute value.
    Wrinkled,
    /// Waves under a wind: |fbm(p / 10)| fbm(p).
    Windy,
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
    /// Blend of two bilinear look-ups in smaller copies of the picture, chosen by how much of it a
    /// ray covers.
    Trilinear,
}
