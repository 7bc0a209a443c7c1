//! Curves: that they have points, a width, and the normals that their form asks for.

use super::checker::Checker;
use super::limits::LENGTH_MIN;
use super::{length, sub};
use crate::desc::{CurveForm, Triple};

/// Checks a curve; gives points that enclose it if it is good.
pub(super) fn check(
    checker: &mut Checker<'_>,
    points: &[Triple],
    widths: [f64; 2],
    form: CurveForm,
    normals: &[Triple],
) -> Option<Vec<Triple>> {
    let mut good = triples(checker, "points", points);
    let n = points.len();
    if n < 4 || n % 3 != 1 {
        let message = format!("a curve has 4, 7, 10, ... control points; here are {n}");
        let help = "each segment has four, the last of which is the first of the next";
        checker.note("points", message, Some(help));
        good = false;
    } else if good && points.iter().all(|&p| length(sub(p, points[0])) < LENGTH_MIN) {
        checker.note("points", "the curve has no length", None);
        good = false;
    }
    good &= checker.enter("widths", |checker| {
        let mut good = checker.numbers(&widths);
        if good && !(widths[0] >= 0.0 && widths[1] >= 0.0 && widths[0] + widths[1] >= LENGTH_MIN) {
            let message = "widths must not be negative, and not both 0";
            checker.note("", message, None);
            good = false;
        }
        good
    });
    good &= normals_of(checker, form, normals, n / 3);
    let reach = 0.5 * widths[0].max(widths[1]);
    good.then(|| {
        let corners = |p: &Triple| [p.map(|x| x - reach), p.map(|x| x + reach)];
        points.iter().flat_map(corners).collect()
    })
}

fn normals_of(
    checker: &mut Checker<'_>,
    form: CurveForm,
    normals: &[Triple],
    n_segments: usize,
) -> bool {
    if form != CurveForm::Ribbon {
        if !normals.is_empty() {
            let help = "take the normals away, or make its `form` a ribbon";
            checker.note("normals", "only ribbons have normals", Some(help));
        }
        return normals.is_empty();
    }
    let n = normals.len();
    if n != n_segments + 1 {
        let message = format!(
            "a ribbon of {n_segments} segments has {} normals; here are {n}",
            n_segments + 1
        );
        let help = "one at the start of each segment, and one at the end of the last";
        checker.note("normals", message, Some(help));
        return false;
    }
    if !triples(checker, "normals", normals) {
        return false;
    }
    let Some(i) = normals.iter().position(|&n| length(n) < LENGTH_MIN) else { return true };
    checker.enter("normals", |checker| {
        checker.note_at(checker.path().join(i), "the normal has no direction", None);
    });
    false
}

fn triples(checker: &mut Checker<'_>, key: &str, values: &[Triple]) -> bool {
    checker.enter(key, |checker| {
        let mut good = true;
        for (i, value) in values.iter().enumerate() {
            good &= checker.enter(i, |checker| checker.numbers(value));
        }
        good
    })
}
