//! Objects.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TransformStep, Triple};

/// One object and where it stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ObjectDesc {
    /// Sphere, still or moving on a line, or a part of one.
    Sphere {
        /// Centre, at time 0 if it moves.
        center: Triple,
        /// Centre at time 1, if it moves.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        center_end: Option<Triple>,
        /// Radius.
        radius: f64,
        /// For a part of a sphere, its lower end relative to the centre.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        z_min: Option<f64>,
        /// For a part of a sphere, its upper end relative to the centre.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        z_max: Option<f64>,
        /// For a part of a sphere, the angle that it covers about the z axis through its centre, from
        /// the x axis towards y.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        phi_max_deg: Option<f64>,
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
    /// Triangle mesh.
    Mesh {
        /// Name of its mesh.
        mesh: String,
        /// Name of its material.
        material: String,
        /// Names of the materials of its face groups, by group; those beyond the last have `material`.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        group_materials: Vec<String>,
        /// Whether the side that normals point to is the other one.
        #[serde(default, skip_serializing_if = "super::is_false")]
        flip: bool,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Disk or ring about the z axis, facing +z.
    Disk {
        /// Where on the z axis.
        #[serde(default)]
        height: f64,
        /// Outer radius.
        radius: f64,
        /// Inner radius; a hole if it is more than 0.
        #[serde(default)]
        inner_radius: f64,
        /// Angle that it covers, from the x axis towards y.
        #[serde(default = "full_turn")]
        phi_max_deg: f64,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Open cylinder about the z axis, facing away from it.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Lower end.
        z_min: f64,
        /// Upper end.
        z_max: f64,
        /// Angle that it covers, from the x axis towards y.
        #[serde(default = "full_turn")]
        phi_max_deg: f64,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// Curve of cubic Bézier segments with a width: a hair, a blade of grass, a thread.
    Curve {
        /// Control points: 4 for the first segment, whose last is the first of the next, and 3 more for
        /// each.
        points: Vec<Triple>,
        /// Width at the start and at the end; in between it changes evenly from segment to segment.
        widths: [f64; 2],
        /// What it looks like across.
        #[serde(default)]
        form: CurveForm,
        /// For a ribbon, the normal at the start of each segment and at the end of the last.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        normals: Vec<Triple>,
        /// Name of its material.
        material: String,
        /// Steps applied in order, the first first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
    },
    /// All objects of a prototype, which are stored once however often they are placed.
    Instance {
        /// Name of the prototype.
        prototype: String,
        /// Steps applied in order, the first first; where it is at time 0, if it moves.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        transform: Vec<TransformStep>,
        /// Where it is at time 1, if it moves: on the way there, matrices are blended linearly.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        transform_end: Option<Vec<TransformStep>>,
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

/// What a curve looks like across.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CurveForm {
    /// Flat, and turned to whoever looks.
    #[default]
    Flat,
    /// Round, as far as its normals go.
    Cylinder,
    /// Flat, with normals of its own.
    Ribbon,
}

fn full_turn() -> f64 {
    360.0
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
