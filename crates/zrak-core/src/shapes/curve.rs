//! Curves: cubic Bézier segments with a width, for hair, grass and threads.
//!
//! A curve is a ruled surface: at the point c(u) of the axis a straight line b(u) as long as the width
//! crosses it, where b is the direction of c'(u) x n and n is
//! - for a *flat* curve, the direction to where the ray comes from, so the curve turns to whoever looks;
//! - for a *cylinder*, the same, but the surface there has the normal of a round thread;
//! - for a *ribbon*, a normal that turns from one given at the segment's start to one at its end.
//!
//! In axes in which the ray runs along z from the origin, it meets the line at u where
//! c_x b_y = c_y b_x. For flat curves that says that c(u) is at its nearest to the ray. The segment is
//! halved until it is almost straight, by walking over the numbers of its pieces, without a stack;
//! pieces whose box the ray misses are left out; and in the others a root is found by false position.
//! (Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., section 6.7, halves in the same way,
//! takes straight lines for the last pieces, and the depth of the axis for that of a ribbon.)
//!
//! Flat curves and cylinders are as thick as they are wide to rays that come from elsewhere. So rays
//! leave them from outside of that: the bound of the error of a point on them is half of the width, along
//! the normal. Light that goes through one is thereby beyond it at once: there is one interaction to a
//! crossing, which is that of the fibre as a whole.

use bytemuck::{Pod, Zeroable};

use super::sphere::facing;
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, abs, cross, dot, gamma, lerp, max, min, sin, sqrt, vec3};
use crate::ray::Ray;
use crate::scene::{MaterialRef, SceneView};

/// Form of a curve that faces every ray.
pub const CURVE_FLAT: u32 = 0;
/// Form of a curve that faces every ray and is lit like a round thread.
pub const CURVE_CYLINDER: u32 = 1;
/// Form of a curve with normals of its own.
pub const CURVE_RIBBON: u32 = 2;

/// Most times that a segment may be halved while a ray is tested.
pub const MAX_HALVINGS: u32 = 10;

/// How much farther out than half of the width rays leave a curve.
const SLACK: f32 = 1.0 + 1.0 / 256.0;

/// A part of a segment of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Curve {
    /// Control points.
    pub points: [Vec3; 4],
    /// Width at the start and at the end; not negative, not both 0.
    pub widths: [f32; 2],
    /// What part of the segment this is: its u at the start and at the end.
    pub u: [f32; 2],
    /// Material of the surface.
    pub material: MaterialRef,
    /// [`CURVE_FLAT`], [`CURVE_CYLINDER`] or [`CURVE_RIBBON`].
    pub form: u32,
    /// Index of the ribbon's normals, if it is one.
    pub ribbon: u32,
    /// How often it is halved until its pieces count as straight; at most [`MAX_HALVINGS`].
    pub n_halvings: u32,
}

const _: () = assert!(size_of::<Curve>() == 80);

/// The normals of a segment of a ribbon; between its ends they turn evenly.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Ribbon {
    /// Unit normal at the start of the segment.
    pub start: Vec3,
    /// Angle between the two, in radians.
    pub angle: f32,
    /// Unit normal at the end.
    pub end: Vec3,
    /// One over the sine of the angle; 0 if that is so small that a straight blend will do.
    pub inv_sin: f32,
}

const _: () = assert!(size_of::<Ribbon>() == 32);

impl Ribbon {
    /// The normal at `u` of the segment, not quite of unit length.
    #[inline(always)]
    fn normal(&self, u: f32) -> Vec3 {
        if self.inv_sin == 0.0 {
            return self.start * (1.0 - u) + self.end * u;
        }
        let weight = |share: f32| sin(share * self.angle) * self.inv_sin;
        self.start * weight(1.0 - u) + self.end * weight(u)
    }
}

/// What a curve's surface is like at a point of its axis.
#[derive(Clone, Copy)]
struct Rung {
    /// Point of the axis.
    c: Vec3,
    /// Its change with the part's u.
    dc: Vec3,
    /// Direction across, times any length.
    b: Vec3,
}

/// Where a ray meets a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurveHit {
    pub(super) t: f32,
    /// Along the part.
    u: f32,
    /// Across, from -1 to 1.
    side: f32,
}

/// A curve in the axes of a ray.
#[derive(Clone, Copy)]
struct Seen {
    points: [Vec3; 4],
    widths: [f32; 2],
    /// u of the segment, for the normals.
    u: [f32; 2],
    /// Normals of a ribbon in these axes; of others, both are those against the ray.
    normals: Ribbon,
    is_ribbon: bool,
    /// Bound of the error of a coordinate.
    error: f32,
    /// Whether all of it is ahead of the ray's origin for certain.
    is_ahead: bool,
}

/// A point of the cubic with these control points, and its derivative.
#[inline(always)]
fn evaluate([a, b, c, d]: [Vec3; 4], u: f32) -> (Vec3, Vec3) {
    let mix = |a: Vec3, b: Vec3| a * (1.0 - u) + b * u;
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    (mix(abc, bcd), (bcd - abc) * 3.0)
}

/// Two places around u, for differences.
#[inline(always)]
fn around(u: f32) -> (f32, f32) {
    (max(u - 1.0 / 256.0, 0.0), min(u + 1.0 / 256.0, 1.0))
}

/// The polar form of the cubic: its control points between u0 and u1 are those at (u0, u0, u0),
/// (u0, u0, u1), (u0, u1, u1) and (u1, u1, u1).
#[inline(always)]
fn blossom([a, b, c, d]: [Vec3; 4], u0: f32, u1: f32, u2: f32) -> Vec3 {
    let mix = |u: f32, a: Vec3, b: Vec3| a * (1.0 - u) + b * u;
    let (ab, bc, cd) = (mix(u0, a, b), mix(u0, b, c), mix(u0, c, d));
    mix(u2, mix(u1, ab, bc), mix(u1, bc, cd))
}

impl Seen {
    #[inline(always)]
    fn rung(&self, u: f32) -> Rung {
        let (c, dc) = evaluate(self.points, u);
        let n = if self.is_ribbon {
            self.normals.normal(lerp(u, self.u[0], self.u[1]))
        } else {
            self.normals.start
        };
        Rung { c, dc, b: cross(dc, n) }
    }

    /// Half of the width.
    #[inline(always)]
    fn radius(&self, u: f32) -> f32 {
        0.5 * lerp(u, self.widths[0], self.widths[1])
    }

    /// Change with u of the point at the distance `across` from the axis, where that of the axis is `dc`:
    /// the lines across turn.
    #[inline(always)]
    fn along(&self, u: f32, dc: Vec3, across: f32) -> Vec3 {
        let (before, after) = around(u);
        let at = |u: f32| unit_or(self.rung(u).b, Vec3::ZERO);
        dc + (at(after) - at(before)) * (across / (after - before))
    }

    /// Whether the ray may meet the part from `u0` to `u1` before `z_best`.
    #[inline(always)]
    fn may_meet(&self, u0: f32, u1: f32, z_best: f32) -> bool {
        let p = self.points;
        let corners = [
            blossom(p, u0, u0, u0),
            blossom(p, u0, u0, u1),
            blossom(p, u0, u1, u1),
            blossom(p, u1, u1, u1),
        ];
        let [a, b, c, d] = corners;
        let lo = a.zip(b, min).zip(c.zip(d, min), min);
        let hi = a.zip(b, max).zip(c.zip(d, max), max);
        let r = max(self.radius(u0), self.radius(u1)) + self.error;
        lo.x <= r && hi.x >= -r && lo.y <= r && hi.y >= -r && hi.z >= -r && lo.z - r <= z_best
    }

    /// The hit in the part from `u0` to `u1`, which is almost straight.
    #[inline(always)]
    fn hit_between(&self, u0: f32, u1: f32) -> Option<CurveHit> {
        // Beside the line across, on one side at u0 and on the other at u1?
        let beside = |rung: &Rung| rung.c.x * rung.b.y - rung.c.y * rung.b.x;
        let (start, end) = (self.rung(u0), self.rung(u1));
        let (mut lo, mut hi) = (u0, u1);
        let (mut at_lo, mut at_hi) = (beside(&start), beside(&end));
        // Parts that follow one another are computed each in its own axes.
        let size = |rung: &Rung| abs(rung.b.x) + abs(rung.b.y);
        let rounding = 4.0 * self.error * max(size(&start), size(&end));
        if !(at_lo * at_hi <= 0.0 || abs(at_lo) <= rounding || abs(at_hi) <= rounding) {
            return None;
        }
        // False position, with the weight of an end that stays halved (the Illinois method).
        let mut u = u0;
        for _ in 0..4 {
            let between = at_lo - at_hi;
            let share = if between != 0.0 { at_lo / between } else { 0.5 };
            u = lo + (hi - lo) * max(0.0, min(share, 1.0));
            let at_u = beside(&self.rung(u));
            if at_u * at_hi <= 0.0 {
                (lo, at_lo) = (hi, at_hi);
            } else {
                at_lo *= 0.5;
            }
            (hi, at_hi) = (u, at_u);
        }
        let Rung { c, dc, b } = self.rung(u);
        let bb = b.x * b.x + b.y * b.y;
        if bb.is_nan() || bb <= 0.0 {
            return None;
        }
        // The point of the line across that is nearest to the ray, and what is left between them.
        let s = -(c.x * b.x + c.y * b.y) / bb;
        let p = c + b * s;
        let residual = abs(p.x) + abs(p.y);
        let radius = self.radius(u);
        let across = s * b.length();
        let z_error = if self.is_ribbon && !self.is_ahead {
            // An error of the place shows in z by the slope of the surface, and that is known to within
            // the errors of what spans it.
            let n = cross(self.along(u, dc, across), b);
            let size = |v: Vec3| abs(v.x) + abs(v.y) + abs(v.z);
            let steep = abs(n.z) - 16.0 * self.error * (size(dc) + size(b));
            let slope = (abs(n.x) + abs(n.y)) / max(steep, 0.0);
            (self.error + residual) * (1.0 + slope)
        } else {
            self.error
        };
        // False for NaN.
        if radius > 0.0
            && abs(across) <= radius
            && residual <= radius * (1.0 / 256.0) + 8.0 * self.error
            && (p.z > z_error || self.is_ahead)
        {
            Some(CurveHit { t: p.z, u, side: across / radius })
        } else {
            None
        }
    }
}

impl Curve {
    /// Box that holds the curve, with a margin for rounding.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let [a, b, c, d] = self.points;
        let hull = Bounds::of_points(a, b).union(Bounds::of_points(c, d));
        let radius = 0.5 * max(self.widths[0], self.widths[1]);
        let size = (hull.hi - hull.lo).max_component();
        hull.padded(radius + (size + radius) * 1e-6)
    }

    #[inline(always)]
    fn normals(&self, scene: &SceneView) -> Ribbon {
        if self.form == CURVE_RIBBON { scene.ribbons.get(self.ribbon) } else { Ribbon::zeroed() }
    }

    /// Parameter of the first intersection ahead of the ray's origin.
    #[inline(always)]
    #[must_use]
    pub fn intersect(&self, scene: &SceneView, ray: &Ray) -> Option<f32> {
        let hit = hit_curve(self, &self.normals(scene), ray)?;
        Some(hit.t)
    }

    /// What is where the ray hits the curve.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn interaction(&self, scene: &SceneView, ray: &Ray) -> SurfaceInteraction {
        let normals = self.normals(scene);
        let hit = match hit_curve(self, &normals, ray) {
            Some(hit) => hit,
            None => CurveHit { t: 0.0, u: 0.5, side: 0.0 },
        };
        let CurveHit { u, side, .. } = hit;
        let radius = 0.5 * lerp(u, self.widths[0], self.widths[1]);
        let against = -ray.d.normalized();
        let is_ribbon = self.form == CURVE_RIBBON;
        let across = |u: f32, dc: Vec3| {
            let n = if is_ribbon { normals.normal(lerp(u, self.u[0], self.u[1])) } else { against };
            unit_or(cross(dc, n), against)
        };
        let (c, dc) = evaluate(self.points, u);
        let b = across(u, dc);
        let arm = b * (radius * side);
        let mut along = dc;
        if is_ribbon {
            // The lines across turn: that tilts the surface away from the axis.
            let (before, after) = around(u);
            let at = |u: f32| across(u, evaluate(self.points, u).1);
            along = dc + (at(after) - at(before)) * (radius * side / (after - before));
        }
        let n = unit_or(cross(b, along), against);
        let toward = |n: Vec3| facing(ray, n, true);
        let abs_points = self.points.map(Vec3::abs);
        let rounding = (evaluate(abs_points, u).0 + arm.abs()) * gamma(16);
        let (p, n, p_error) = match self.form {
            CURVE_RIBBON => {
                // Its front is where the given normals point to.
                let given = normals.normal(lerp(u, self.u[0], self.u[1]));
                (c + arm, if dot(n, given) < 0.0 { -n } else { n }, rounding)
            }
            CURVE_CYLINDER => {
                // From the axis, rays leave to the surface.
                let round = n * sqrt(max(1.0 - side * side, 0.0)) + b * side;
                let n = toward(unit_or(round, n));
                (c, n, rounding + n.abs() * (radius * SLACK))
            }
            _ => {
                let n = toward(n);
                (c + arm, n, rounding + n.abs() * (radius * SLACK))
            }
        };
        // From the part's u to the segment's.
        let length = self.u[1] - self.u[0];
        SurfaceInteraction {
            uv: [lerp(u, self.u[0], self.u[1]), 0.5 + 0.5 * side],
            dpdu: along * (if length > 0.0 { 1.0 / length } else { 0.0 }),
            dpdv: b * (2.0 * radius),
            ..SurfaceInteraction::plain(p, p_error, n, self.material)
        }
    }
}

/// The direction of a vector of any length; of the zero vector, `other`.
#[inline(always)]
fn unit_or(v: Vec3, other: Vec3) -> Vec3 {
    let size = v.abs().max_component();
    if size > 0.0 { (v * (1.0 / size)).normalized() } else { other }
}

/// The first intersection ahead of the ray's origin. A function of its own on every machine: it is long,
/// and few scenes have curves.
#[inline(never)]
fn hit_curve(curve: &Curve, normals: &Ribbon, ray: &Ray) -> Option<CurveHit> {
    let length = ray.d.length();
    let z = ray.d * (1.0 / length);
    // With the curve's chord along y, boxes around its parts are slim.
    let chord = curve.points[3] - curve.points[0];
    let least = vec3(
        if abs(z.x) <= abs(z.y) && abs(z.x) <= abs(z.z) { 1.0 } else { 0.0 },
        if abs(z.y) < abs(z.x) && abs(z.y) <= abs(z.z) { 1.0 } else { 0.0 },
        if abs(z.z) < abs(z.x) && abs(z.z) < abs(z.y) { 1.0 } else { 0.0 },
    );
    let across = cross(z, chord);
    let is_aside = across.length_squared() > 1e-6 * chord.length_squared();
    let x = unit_or(if is_aside { across } else { cross(z, least) }, least);
    let y = cross(z, x);
    let turned = |v: Vec3| vec3(dot(v, x), dot(v, y), dot(v, z));
    let points = curve.points.map(|p| turned(p - ray.o));
    let reach = |p: Vec3| max(abs(p.x), max(abs(p.y), abs(p.z)));
    let [a, b, c, d] = points;
    let far = max(max(reach(a), reach(b)), max(reach(c), reach(d)));
    let error = gamma(16) * far;
    let nearest = min(min(a.z, b.z), min(c.z, d.z));
    let radius = 0.5 * max(curve.widths[0], curve.widths[1]);
    let is_ribbon = curve.form == CURVE_RIBBON;
    let seen = Seen {
        points,
        widths: curve.widths,
        u: curve.u,
        normals: if is_ribbon {
            Ribbon { start: turned(normals.start), end: turned(normals.end), ..*normals }
        } else {
            Ribbon { start: vec3(0.0, 0.0, -1.0), ..*normals }
        },
        is_ribbon,
        error,
        is_ahead: nearest - radius > error,
    };
    let n_halvings = curve.n_halvings;
    let mut best = CurveHit { t: f32::INFINITY, u: 0.0, side: 0.0 };
    // Part `i` of 2^`level`.
    let (mut i, mut level) = (0_u32, 0_u32);
    while i >> level == 0 {
        let step = 1.0 / (1_u32 << level) as f32;
        let (u0, u1) = (i as f32 * step, (i + 1) as f32 * step);
        let is_near = seen.may_meet(u0, u1, best.t);
        if is_near && level < n_halvings {
            level += 1;
            i <<= 1;
        } else {
            if is_near
                && let Some(hit) = seen.hit_between(u0, u1)
                && hit.t < best.t
            {
                best = hit;
            }
            // On to the next part, the largest that starts where this one ends.
            i += 1;
            let up = min_u32(i.trailing_zeros(), level);
            i >>= up;
            level -= up;
        }
    }
    if best.t < f32::INFINITY { Some(CurveHit { t: best.t / length, ..best }) } else { None }
}

#[inline(always)]
fn min_u32(a: u32, b: u32) -> u32 {
    if a < b { a } else { b }
}
