//! Transforms: each step by itself, and what the steps of an object and its groups come to.

use super::checker::Checker;
use super::limits::{LENGTH_MIN, NUMBER_MAX};
use super::{cross, dot, length};
use crate::desc::{ScaleDesc, TransformStep};
use crate::lower::Transform;

/// Smallest volume of a unit cube's image, relative to the product of its edges.
const RELATIVE_VOLUME_MIN: f64 = 1e-9;

/// Checks `steps`, and gives the map of all of them followed by `outer`, unless it is degenerate.
/// `outer` is none where that was found to be degenerate already.
pub(super) fn check(
    checker: &mut Checker<'_>,
    steps: &[TransformStep],
    outer: Option<Transform>,
) -> Option<Transform> {
    check_at(checker, "transform", steps, outer)
}

/// The same for steps that stand in the field `key`.
pub(super) fn check_at(
    checker: &mut Checker<'_>,
    key: &str,
    steps: &[TransformStep],
    outer: Option<Transform>,
) -> Option<Transform> {
    let all_good = checker.enter(key, |checker| {
        let mut good = true;
        for (i, step) in steps.iter().enumerate() {
            good &= checker.enter(i, |checker| check_step(checker, step));
        }
        good
    });
    if !all_good {
        return None;
    }
    let whole = Transform::of_steps(steps).then(&outer?);
    if is_degenerate(&whole.rows) {
        let message = "the steps together, with those of the groups around, scale lengths to \
                       outside of [1e-12, 1e12] or flatten space";
        checker.note(key, message, None);
        return None;
    }
    Some(whole)
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

fn is_degenerate(m: &[[f64; 4]; 3]) -> bool {
    let column = |j: usize| [m[0][j], m[1][j], m[2][j]];
    let [x, y, z] = [column(0), column(1), column(2)];
    let lengths = [length(x), length(y), length(z)];
    let has_range = |l: f64| (LENGTH_MIN..=NUMBER_MAX).contains(&l);
    let volume = dot(cross(x, y), z).abs();
    !lengths.into_iter().all(has_range)
        || length(column(3)) > NUMBER_MAX
        || volume < RELATIVE_VOLUME_MIN * lengths[0] * lengths[1] * lengths[2]
}
