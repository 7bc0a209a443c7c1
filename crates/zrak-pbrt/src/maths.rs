//! Maps that may move, and vectors.

use zrak_scene::desc::TransformStep;
use zrak_scene::lower::Transform;

use crate::error::{Fault, Result, Span};

/// A map at the shutter's opening and closing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Maps {
    pub(crate) start: Transform,
    pub(crate) end: Transform,
}

impl Maps {
    pub(crate) const IDENTITY: Self = Self { start: Transform::IDENTITY, end: Transform::IDENTITY };

    pub(crate) fn is_moving(&self) -> bool {
        self.start != self.end
    }
}

/// A map as the steps of a description.
pub(crate) fn steps(map: &Transform) -> Vec<TransformStep> {
    if *map == Transform::IDENTITY { Vec::new() } else { vec![matrix_step(map)] }
}

pub(crate) fn matrix_step(map: &Transform) -> TransformStep {
    TransformStep::Matrix(map.rows)
}

pub(crate) fn inverse_of(maps: &Maps, span: &Span) -> Result<Maps> {
    let one = |map: &Transform| {
        map.inverse().ok_or_else(|| Fault::new(span, "the map at this point flattens space"))
    };
    Ok(Maps { start: one(&maps.start)?, end: one(&maps.end)? })
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 1e-12).then(|| a.map(|x| x / length))
}

/// From the world to a camera at `eye`, whose z axis points at `look`: left-handed, as pbrt has it.
pub(crate) fn look_at(eye: [f64; 3], look: [f64; 3], up: [f64; 3]) -> Option<Transform> {
    let forward = unit(sub(look, eye))?;
    let right = unit(cross(unit(up)?, forward))?;
    let up = cross(forward, right);
    let row = |axis: [f64; 3]| [axis[0], axis[1], axis[2], -dot(axis, eye)];
    Some(Transform { rows: [row(right), row(up), row(forward)] })
}
