//! How the picture is taken.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Triple, is_false};

/// A camera, by default one with a thin lens.
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
    /// How directions fall on the picture.
    #[serde(default, skip_serializing_if = "ProjectionDesc::is_perspective")]
    pub projection: ProjectionDesc,
    /// Mirrors the picture left to right.
    #[serde(default, skip_serializing_if = "is_false")]
    pub flip_x: bool,
    /// The part of the whole view that the picture shows: left, right, top, bottom, where the whole
    /// view is 0, 1, 0, 1. The field of view is that of the whole view.
    #[serde(default = "default_window", skip_serializing_if = "is_default_window")]
    pub window: [f64; 4],
    /// Name of the medium that the camera is in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub medium: Option<String>,
}

/// How directions fall on the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ProjectionDesc {
    /// Straight lines through the lens.
    #[default]
    Perspective,
    /// Parallel lines; `vfov_deg` is not looked at.
    Orthographic {
        /// Height of the whole view in world units.
        height: f64,
    },
    /// All directions, as longitude (the view direction in the middle) and latitude.
    Equirectangular,
    /// All directions, on Clarberg's equal-area map of the sphere to the square; the view direction
    /// and up span the map's frame as in pbrt's spherical camera.
    EqualArea,
}

impl ProjectionDesc {
    fn is_perspective(&self) -> bool {
        *self == Self::Perspective
    }
}

fn default_window() -> [f64; 4] {
    [0.0, 1.0, 0.0, 1.0]
}

fn is_default_window(window: &[f64; 4]) -> bool {
    *window == default_window()
}

impl Default for CameraDesc {
    /// A pinhole camera at the origin that looks along -z.
    fn default() -> Self {
        Self {
            look_from: [0.0; 3],
            look_at: [0.0, 0.0, -1.0],
            vup: default_vup(),
            vfov_deg: 40.0,
            width: 1280,
            height: 720,
            defocus_angle_deg: 0.0,
            focus_distance: default_focus_distance(),
            shutter_open_s: 0.0,
            shutter_close_s: default_shutter_close(),
            projection: ProjectionDesc::Perspective,
            flip_x: false,
            window: default_window(),
            medium: None,
        }
    }
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
