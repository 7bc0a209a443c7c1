//! Curves: any basis and degree, as cubic Bézier segments.

use zrak_scene::desc::{CurveForm, ObjectDesc};

use crate::error::{Fault, Result, Span};
use crate::params::Params;

type Triple = [f64; 3];

/// A curve that has been read.
pub(crate) struct Curve {
    points: Vec<Triple>,
    widths: [f64; 2],
    form: CurveForm,
    normals: Vec<Triple>,
    pub(crate) has_normals_in_vain: bool,
}

impl Curve {
    pub(crate) fn object(self, material: String) -> ObjectDesc {
        ObjectDesc::Curve {
            points: self.points,
            widths: self.widths,
            form: self.form,
            normals: self.normals,
            material,
            transform: Vec::new(),
        }
    }
}

/// Reads the parameters of a curve; gives none if there is nothing to see.
pub(crate) fn curve(at: &Span, params: &Params) -> Result<Option<Curve>> {
    let fault = |message: String| Fault::new(at, message);
    let width = params.float("width")?.unwrap_or(1.0);
    let widths =
        [params.float("width0")?.unwrap_or(width), params.float("width1")?.unwrap_or(width)];
    if widths.iter().any(|w| *w < 0.0) {
        return Err(fault("widths of curves must not be negative".to_owned()));
    }
    let degree = params.integer("degree")?.unwrap_or(3);
    if degree != 2 && degree != 3 {
        return Err(fault(format!("curves have degree 2 or 3, not {degree}")));
    }
    let form = match params.string("type")?.unwrap_or("flat") {
        "flat" => CurveForm::Flat,
        "cylinder" => CurveForm::Cylinder,
        "ribbon" => CurveForm::Ribbon,
        other => {
            let fault = fault(format!("unknown type \"{other}\" of curve"));
            return Err(fault.help("there are flat, cylinder and ribbon"));
        }
    };
    let Some(points) = params.triples("P")? else {
        return Err(fault("the curve needs control points: \"point3 P\"".to_owned()));
    };
    let degree = degree as usize;
    let n = points.len();
    let points = match params.string("basis")?.unwrap_or("bezier") {
        "bezier" => {
            if n <= degree || (n - 1) % degree != 0 {
                return Err(fault(format!(
                    "a Bezier curve of degree {degree} has 1 + {degree} n control points; here \
                     are {n}"
                )));
            }
            if degree == 3 { points } else { elevated(&points) }
        }
        "bspline" => {
            if n <= degree {
                return Err(fault(format!(
                    "a B-spline of degree {degree} has at least {} control points; here are {n}",
                    degree + 1
                )));
            }
            if degree == 3 { of_cubic_bspline(&points) } else { of_quadratic_bspline(&points) }
        }
        other => {
            let fault = fault(format!("unknown basis \"{other}\""));
            return Err(fault.help("there are bezier and bspline"));
        }
    };
    let given = params.triples("N")?.unwrap_or_default();
    let n_segments = points.len() / 3;
    let is_ribbon = form == CurveForm::Ribbon;
    if is_ribbon && given.len() != n_segments + 1 {
        return Err(fault(format!(
            "a ribbon of {n_segments} segments has {} normals `N`; here are {}",
            n_segments + 1,
            given.len()
        )));
    }
    let has_normals_in_vain = !is_ribbon && !given.is_empty();
    let normals = if is_ribbon { given } else { Vec::new() };
    if normals.contains(&[0.0; 3]) {
        return Err(fault("a normal of the ribbon is zero".to_owned()));
    }
    let is_point = points.iter().all(|p| (0..3).all(|i| (p[i] - points[0][i]).abs() < 1e-12));
    let is_seen = !is_point && widths[0] + widths[1] >= 1e-12;
    Ok(is_seen.then_some(Curve { points, widths, form, normals, has_normals_in_vain }))
}

/// Weighted sum of points.
fn sum<const N: usize>(points: [Triple; N], weights: [f64; N]) -> Triple {
    std::array::from_fn(|axis| points.iter().zip(weights).map(|(p, w)| p[axis] * w).sum())
}

/// Segments of degree 2 as ones of degree 3.
fn elevated(points: &[Triple]) -> Vec<Triple> {
    let mut all = vec![points[0]];
    for i in (0..points.len() - 2).step_by(2) {
        let [a, b, c] = [points[i], points[i + 1], points[i + 2]];
        let third = 1.0 / 3.0;
        all.extend([sum([a, b], [third, 2.0 * third]), sum([b, c], [2.0 * third, third]), c]);
    }
    all
}

/// Quadratic B-splines: segments meet half way between control points.
fn of_quadratic_bspline(points: &[Triple]) -> Vec<Triple> {
    let middle = |i: usize| sum([points[i], points[i + 1]], [0.5, 0.5]);
    let mut quadratic = vec![middle(0)];
    for (i, point) in points.iter().enumerate().take(points.len() - 1).skip(1) {
        quadratic.extend([*point, middle(i)]);
    }
    elevated(&quadratic)
}

/// Cubic B-splines with evenly spaced knots.
fn of_cubic_bspline(points: &[Triple]) -> Vec<Triple> {
    let (third, sixth) = (1.0 / 3.0, 1.0 / 6.0);
    let knot =
        |i: usize| sum([points[i - 1], points[i], points[i + 1]], [sixth, 4.0 * sixth, sixth]);
    let mut all = vec![knot(1)];
    for i in 1..points.len() - 2 {
        let [a, b] = [points[i], points[i + 1]];
        all.extend([
            sum([a, b], [2.0 * third, third]),
            sum([a, b], [third, 2.0 * third]),
            knot(i + 1),
        ]);
    }
    all
}
