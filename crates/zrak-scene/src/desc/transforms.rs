//! Transforms.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Triple;

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
