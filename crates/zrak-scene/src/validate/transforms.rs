//! Transforms: each step by itself, and what the steps of an object and its groups come to.

use super::checker::Checker;
use super::limits::{LENGTH_MIN, NUMBER_MAX};
use super::{cross, dot, length};
use crate::desc::{ScaleDesc, TransformStep, Triple};

/// Rows of the 3x4 matrix of an affine map.
pub(super) type Affine = [[f64; 4]; 3];

pub(super) const IDENTITY: Affine =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Smallest volume of a unit cube's image, relative to the product of its edges.
const RELATIVE_VOLUME_MIN: f64 = 1e-9;

/// Checks `steps`, and gives the map of all of them followed by `outer`, unless it is degenerate.
/// `outer` is none where that was found to be degenerate already.
pub(super) fn check(
    checker: &mut Checker<'_>,
    steps: &[TransformStep],
    outer: Option<Affine>,
) -> Option<Affine> {
    let all_good = checker.enter("transform", |checker| {
        let mut good = true;
        for (i, step) in steps.iter().enumerate() {
            good &= checker.enter(i, |checker| check_step(checker, step));
        }
        good
    });
    if !all_good {
        return None;
    }
    let own = steps.iter().fold(IDENTITY, |map, step| compose(&matrix(step), &map));
    let whole = compose(&outer?, &own);
    if is_degenerate(&whole) {
        let message = "the steps together, with those of the groups around, scale lengths to \
                       outside of [1e-12, 1e12] or flatten space";
        checker.note("transform", message, None);
        return None;
    }
    Some(whole)
}

/// Where a map takes a point.
pub(super) fn apply(m: &Affine, p: Triple) -> Triple {
    m.map(|[x, y, z, w]| dot([x, y, z], p) + w)
}

fn check_step(checker: &mut Checker<'_>, step: &TransformStep) -> bool {
    match step {
        TransformStep::Translate(by) => checker.triple("translate", *by),
        TransformStep::Rotate { axis, angle_deg } => checker.enter("rotate", |checker| {
            let good = checker.triple("axis", *axis);
            if good && length(*axis) < LENGTH_MIN {
                checker.note("axis", "the axis has no length", None);
                return false;
            }
            checker.number("angle_deg", *angle_deg) && good
        }),
        TransformStep::RotateXDeg(angle) => checker.number("rotate_x_deg", *angle),
        TransformStep::RotateYDeg(angle) => checker.number("rotate_y_deg", *angle),
        TransformStep::RotateZDeg(angle) => checker.number("rotate_z_deg", *angle),
        TransformStep::Scale(scale) => {
            let (factors, good) = match scale {
                ScaleDesc::Uniform(factor) => ([*factor; 3], checker.number("scale", *factor)),
                ScaleDesc::PerAxis(factors) => (*factors, checker.triple("scale", *factors)),
            };
            if good && factors.iter().any(|x| x.abs() < LENGTH_MIN) {
                let help = "everything would be flat; use a small factor, or a quad";
                checker.note("scale", "a factor of `scale` is 0", Some(help));
                return false;
            }
            good
        }
        TransformStep::Matrix(rows) => checker.enter("matrix", |checker| {
            let mut good = true;
            for (i, row) in rows.iter().enumerate() {
                good &= checker.enter(i, |checker| checker.numbers(row));
            }
            if good && is_degenerate(rows) {
                let message = "the matrix flattens space: its left 3x3 part has no inverse";
                checker.note("", message, None);
                return false;
            }
            good
        }),
    }
}

fn is_degenerate(m: &Affine) -> bool {
    let column = |j: usize| [m[0][j], m[1][j], m[2][j]];
    let [x, y, z] = [column(0), column(1), column(2)];
    let lengths = [length(x), length(y), length(z)];
    let has_range = |l: f64| (LENGTH_MIN..=NUMBER_MAX).contains(&l);
    let volume = dot(cross(x, y), z).abs();
    !lengths.into_iter().all(has_range)
        || length(column(3)) > NUMBER_MAX
        || volume < RELATIVE_VOLUME_MIN * lengths[0] * lengths[1] * lengths[2]
}

/// First `inner`, then `outer`.
fn compose(outer: &Affine, inner: &Affine) -> Affine {
    let column = |j: usize| [inner[0][j], inner[1][j], inner[2][j]];
    outer.map(|[x, y, z, w]| {
        let row = |j| dot([x, y, z], column(j));
        [row(0), row(1), row(2), row(3) + w]
    })
}

fn matrix(step: &TransformStep) -> Affine {
    match *step {
        TransformStep::Translate([x, y, z]) => {
            [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]]
        }
        TransformStep::Rotate { axis, angle_deg } => rotation(axis, angle_deg),
        TransformStep::RotateXDeg(angle_deg) => rotation([1.0, 0.0, 0.0], angle_deg),
        TransformStep::RotateYDeg(angle_deg) => rotation([0.0, 1.0, 0.0], angle_deg),
        TransformStep::RotateZDeg(angle_deg) => rotation([0.0, 0.0, 1.0], angle_deg),
        TransformStep::Scale(scale) => {
            let [x, y, z] = match scale {
                ScaleDesc::Uniform(factor) => [factor; 3],
                ScaleDesc::PerAxis(factors) => factors,
            };
            [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]]
        }
        TransformStep::Matrix(rows) => rows,
    }
}

/// Rodrigues' rotation formula.
fn rotation(axis: Triple, angle_deg: f64) -> Affine {
    let [x, y, z] = axis.map(|a| a / length(axis));
    let (s, c) = libm::sincos(angle_deg * (std::f64::consts::PI / 180.0));
    let k = 1.0 - c;
    [
        [k * x * x + c, k * x * y - s * z, k * x * z + s * y, 0.0],
        [k * y * x + s * z, k * y * y + c, k * y * z - s * x, 0.0],
        [k * z * x - s * y, k * z * y + s * x, k * z * z + c, 0.0],
    ]
}

#[cfg(test)]
mod tests {
    use super::{IDENTITY, apply, compose, matrix};
    use crate::desc::{ScaleDesc, TransformStep};

    #[test]
    fn steps_apply_in_order() {
        let steps = [
            TransformStep::Scale(ScaleDesc::Uniform(2.0)),
            TransformStep::RotateYDeg(90.0),
            TransformStep::Translate([0.0, 0.0, 1.0]),
        ];
        let map = steps.iter().fold(IDENTITY, |map, step| compose(&matrix(step), &map));
        // x turns to -z about y.
        let p = apply(&map, [1.0, 3.0, 0.0]);
        for (p, expected) in p.into_iter().zip([0.0, 6.0, -1.0]) {
            assert!((p - expected).abs() < 1e-12, "{p} is not {expected}");
        }
    }
}
