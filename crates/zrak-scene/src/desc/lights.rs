//! What shines without being an object: the background and lights.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TransformStep, Triple, one};

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
    /// A picture of the whole sphere of directions.
    Image {
        /// PNG, JPEG, Radiance HDR, OpenEXR or PFM file, relative to the scene file.
        path: String,
        /// How directions fall on the picture.
        #[serde(default)]
        mapping: EnvironmentMapping,
        /// Factor of the radiance.
        #[serde(default = "one")]
        strength: f64,
        /// Colour that the radiance is multiplied with.
        #[serde(default = "white")]
        tint: Triple,
        /// Steps that turn the picture; only their turns and mirrorings count.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// The clear sky of the earth with its sun.
    Sky {
        /// Direction towards the sun, of any length.
        sun_direction: Triple,
        /// Direction that is up, of any length.
        #[serde(default = "default_up")]
        up: Triple,
        /// How hazy the air is: 1.7 very clear, 3 clear, 10 hazy.
        #[serde(default = "default_turbidity")]
        turbidity: f64,
        /// Albedo of the ground.
        #[serde(default = "default_ground")]
        ground_albedo: Triple,
        /// Whether the sun's disk itself shines.
        #[serde(default = "yes")]
        sun: bool,
        /// Factor of the radiance.
        #[serde(default = "one")]
        strength: f64,
    },
}

fn white() -> Triple {
    [1.0; 3]
}

fn default_up() -> Triple {
    [0.0, 1.0, 0.0]
}

fn default_turbidity() -> f64 {
    3.0
}

fn default_ground() -> Triple {
    [0.3; 3]
}

fn yes() -> bool {
    true
}

/// How directions fall on the picture of an environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EnvironmentMapping {
    /// Longitude along the width, latitude along the height, +y up in the first row, the middle of
    /// the picture towards -z, +x a quarter to its right.
    #[default]
    Equirect,
    /// Clarberg's equal-area map of the sphere to the square, as pbrt uses it: +z in the middle.
    EqualArea,
}

/// A light without a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum LightDesc {
    /// Shines evenly from a point.
    Point {
        /// Where it is.
        position: Triple,
        /// Radiant intensity (power per steradian).
        intensity: Triple,
    },
    /// Shines from a point into a cone.
    Spot {
        /// Where it is.
        position: Triple,
        /// Axis of the cone, of any length.
        direction: Triple,
        /// Radiant intensity in the middle.
        intensity: Triple,
        /// Angle between the axis and the rim, beyond which it is dark, in degrees, in (0, 180).
        cone_angle_deg: f64,
        /// Angle between the axis and where it begins to get darker.
        falloff_start_deg: f64,
        /// Curve of the falloff.
        #[serde(default)]
        falloff: SpotFalloff,
    },
    /// Shines from infinitely far away.
    Distant {
        /// Direction in which the light travels, of any length.
        direction: Triple,
        /// Irradiance on a surface that faces it.
        irradiance: Triple,
    },
}

/// How a spot's intensity falls from 1 to 0 between its two angles, by x = (cos - cos_rim) /
/// (cos_start - cos_rim).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpotFalloff {
    /// x^2 (3 - 2 x), as in pbrt.
    #[default]
    Smoothstep,
    /// x^2, as in glTF.
    Square,
}

impl Default for BackgroundDesc {
    fn default() -> Self {
        Self::Constant { color: [0.0; 3] }
    }
}
