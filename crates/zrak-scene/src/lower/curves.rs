//! Curves: cut into parts whose boxes are tight, and brought into the space that they are placed in.

use zrak_core::math::{Bounds, Vec3};
use zrak_core::scene::{MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{CURVE_CYLINDER, CURVE_FLAT, CURVE_RIBBON, Curve, MAX_HALVINGS, Ribbon};

use super::transform::Transform;
use crate::arena::SceneArrays;
use crate::desc::{CurveForm, Triple};

/// A segment is cut into at most this power of two of parts.
const CUTS_MAX: u32 = 3;
/// Cutting must save this share of the boxes' area.
const SAVING: f32 = 0.2;
/// How far a part that counts as straight may be off its chord, as a share of its width.
const FLATNESS: f64 = 0.05;
/// Greatest turn of a ribbon's normal along a part that counts as straight, in radians.
const TURN_MAX: f64 = 0.2;

/// A curve as it is described.
pub(super) struct CurveParts<'a> {
    pub(super) points: &'a [Triple],
    pub(super) widths: [f64; 2],
    pub(super) form: CurveForm,
    pub(super) normals: &'a [Triple],
    pub(super) material: MaterialRef,
}

/// The factor of all widths under a map, if it has one to within what can be seen.
pub(super) fn scale(map: &Transform) -> Option<f64> {
    map.uniform_scale_within(1e-6)
}

/// Adds the parts of a curve to the arrays, under a map with its scale; none if they are too many.
pub(super) fn add(
    curve: &CurveParts<'_>,
    map: Option<(&Transform, f64)>,
    arrays: &mut SceneArrays,
) -> Option<impl Iterator<Item = PrimRef> + use<>> {
    let place = |p: Triple| map.map_or(p, |(map, _)| map.point(p));
    let scale = map.map_or(1.0, |(_, scale)| scale);
    let n_segments = curve.points.len() / 3;
    let first = arrays.curves.len();
    for segment in 0..n_segments {
        let at = 3 * segment;
        let points = [at, at + 1, at + 2, at + 3].map(|i| place(curve.points[i]));
        let share = |u: f64| (segment as f64 + u) / n_segments as f64;
        let width = |u: f64| {
            let [w0, w1] = curve.widths;
            scale * (w0 + (w1 - w0) * share(u))
        };
        let (form, mut ribbon, mut turn) = match curve.form {
            CurveForm::Flat => (CURVE_FLAT, 0, 0.0),
            CurveForm::Cylinder => (CURVE_CYLINDER, 0, 0.0),
            CurveForm::Ribbon => (CURVE_RIBBON, arrays.ribbons.len() as u32, 0.0),
        };
        if form == CURVE_RIBBON {
            let ends = [curve.normals[segment], curve.normals[segment + 1]];
            let normals = ribbon_of(ends, map.map(|(map, _)| map));
            turn = f64::from(normals.angle);
            // Segments of hair are many, and most have the normals of the one before.
            match arrays.ribbons.last() {
                Some(last) if *last == normals => ribbon -= 1,
                _ => arrays.ribbons.push(normals),
            }
        }
        let parts = 1_u32 << n_cuts(&points, width(0.0).max(width(1.0)));
        for k in 0..parts {
            let u = [f64::from(k), f64::from(k + 1)].map(|k| k / f64::from(parts));
            let part = part_of(&points, u);
            let widths = u.map(width);
            let widest = widths[0].max(widths[1]);
            if arrays.curves.len() >= 1 << 28 {
                return None;
            }
            arrays.curves.push(Curve {
                points: part.map(single),
                widths: widths.map(|w| w as f32),
                u: u.map(|u| u as f32),
                material: curve.material,
                form,
                ribbon,
                n_halvings: n_halvings(&part, widest, turn / f64::from(parts)),
            });
        }
    }
    let range = first as u32..arrays.curves.len() as u32;
    Some(range.map(|i| PrimRef::new(PrimKind::Curve, i)))
}

fn single(p: Triple) -> Vec3 {
    Vec3::from_array(p.map(|x| x as f32))
}

fn combine(a: Triple, b: Triple, f: impl Fn(f64, f64) -> f64) -> Triple {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])]
}

/// Control points of a part of a segment. Parts that follow one another share a point to the last bit:
/// it is the same polar value.
fn part_of(points: &[Triple; 4], [a, b]: [f64; 2]) -> [Triple; 4] {
    let mix = |p: Triple, q: Triple, u: f64| combine(p, q, |p, q| p * (1.0 - u) + q * u);
    let polar = |u: [f64; 3]| {
        let [p, q, r, s] = *points;
        let (pq, qr, rs) = (mix(p, q, u[0]), mix(q, r, u[0]), mix(r, s, u[0]));
        mix(mix(pq, qr, u[1]), mix(qr, rs, u[1]), u[2])
    };
    [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(polar)
}

/// How often it pays to halve a segment for the sake of its boxes.
fn n_cuts(points: &[Triple; 4], width: f64) -> u32 {
    let area = |n_cuts: u32| -> f32 {
        let parts = 1_u32 << n_cuts;
        let share = |k: u32| f64::from(k) / f64::from(parts);
        (0..parts)
            .map(|k| {
                let part = part_of(points, [share(k), share(k + 1)]);
                let [a, b, c, d] = part.map(single);
                let hull = Bounds::of_points(a, b).union(Bounds::of_points(c, d));
                hull.padded(0.5 * width as f32).half_area()
            })
            .sum()
    };
    let mut n = 0;
    let mut before = area(0);
    while n < CUTS_MAX {
        let after = area(n + 1);
        // False for areas beyond the range of single precision.
        if after.is_nan() || after >= (1.0 - SAVING) * before {
            break;
        }
        before = after;
        n += 1;
    }
    n
}

/// How often a part must be halved until it counts as straight. A curve is off its chord by at most
/// sqrt(2) 6 / 8 times its greatest second difference, which each halving quarters.
fn n_halvings(points: &[Triple; 4], width: f64, turn: f64) -> u32 {
    let bend = |i: usize| {
        let [a, b, c] = [points[i], points[i + 1], points[i + 2]];
        let second = [0, 1, 2].map(|k| a[k] - 2.0 * b[k] + c[k]);
        second.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let mut off = std::f64::consts::SQRT_2 * 6.0 / 8.0 * bend(0).max(bend(1));
    let mut turn = turn;
    let mut n = 0;
    while n < MAX_HALVINGS && (off > FLATNESS * width || turn > TURN_MAX) {
        off *= 0.25;
        turn *= 0.5;
        n += 1;
    }
    n
}

fn ribbon_of(ends: [Triple; 2], map: Option<&Transform>) -> Ribbon {
    let back = map.map(|map| map.inverse().unwrap_or(Transform::IDENTITY));
    let dot = |a: Triple, b: Triple| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let unit = |n: Triple| {
        let n = back.map_or(n, |back| back.transposed_vector(n));
        let largest = n.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let n = n.map(|x| x / largest);
        let length = dot(n, n).sqrt();
        n.map(|x| x / length)
    };
    let [start, end] = ends.map(unit);
    let angle = libm::acos(dot(start, end).clamp(-1.0, 1.0));
    let sin = libm::sin(angle);
    Ribbon {
        start: single(start),
        angle: angle as f32,
        end: single(end),
        // Of opposite normals, none in between is better than another.
        inv_sin: if sin > 1e-3 { (1.0 / sin) as f32 } else { 0.0 },
    }
}
