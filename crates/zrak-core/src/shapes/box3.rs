//! Boxes along the axes.

use bytemuck::{Pod, Zeroable};

use super::{Convex, Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, gamma, max, min, reciprocal_or_huge, vec3};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// Solid box from `lo` to `hi`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Box3 {
    /// Smallest coordinates.
    pub lo: Vec3,
    /// Material of the surface.
    pub material: MaterialRef,
    /// Largest coordinates.
    pub hi: Vec3,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Box3>() == 32);

/// Where a ray crosses the three pairs of planes, and the box itself.
struct Crossing {
    near: Vec3,
    far: Vec3,
    t_enter: f32,
    t_leave: f32,
}

impl Box3 {
    #[inline(always)]
    fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let inv_d = ray.d.map(reciprocal_or_huge);
        // The signs of the differences are exact, so is the side of a plane that the origin is on.
        let t0 = (self.lo - ray.o) * inv_d;
        let t1 = (self.hi - ray.o) * inv_d;
        let near = t0.zip(t1, min);
        let far = t0.zip(t1, max);
        let t_enter = max(near.x, max(near.y, near.z));
        let t_leave = min(far.x, min(far.y, far.z));
        if t_enter <= t_leave && t_leave > 0.0 {
            Some(Crossing { near, far, t_enter, t_leave })
        } else {
            None
        }
    }
}

impl Shape for Box3 {
    fn bounds(&self, _: Shutter) -> Bounds {
        Bounds { lo: self.lo, hi: self.hi }.padded(0.0)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let c = self.crossing(ray)?;
        Some(if c.t_enter > 0.0 { c.t_enter } else { c.t_leave })
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        // The face is that of the plane that decided `t`.
        let (toward, axis) = match self.crossing(ray) {
            Some(c) if c.t_enter > 0.0 => (-1.0, axis_of(c.near, c.t_enter)),
            Some(c) => (1.0, axis_of(c.far, c.t_leave)),
            None => (1.0, 0),
        };
        let clamped = ray.at(t).zip(self.lo, max).zip(self.hi, min);
        // A side that rounding made flat has one coordinate only.
        let share = |part: f32, whole: f32| if whole > 0.0 { part / whole } else { 0.0 };
        let rel = (clamped - self.lo).zip(self.hi - self.lo, share);
        // On the face, its coordinate is exact; u and v run so that u x v is the outward normal.
        let face = |d: f32, lo: f32, hi: f32| if d * toward > 0.0 { hi } else { lo };
        let sign = |d: f32| if d * toward > 0.0 { 1.0 } else { -1.0 };
        let flip = |x: f32, s: f32| if s > 0.0 { x } else { 1.0 - x };
        let (p, n, uv) = match axis {
            0 => {
                let s = sign(ray.d.x);
                let x = face(ray.d.x, self.lo.x, self.hi.x);
                (vec3(x, clamped.y, clamped.z), vec3(s, 0.0, 0.0), [flip(rel.z, -s), rel.y])
            }
            1 => {
                let s = sign(ray.d.y);
                let y = face(ray.d.y, self.lo.y, self.hi.y);
                (vec3(clamped.x, y, clamped.z), vec3(0.0, s, 0.0), [rel.x, flip(rel.z, -s)])
            }
            _ => {
                let s = sign(ray.d.z);
                let z = face(ray.d.z, self.lo.z, self.hi.z);
                (vec3(clamped.x, clamped.y, z), vec3(0.0, 0.0, s), [flip(rel.x, s), rel.y])
            }
        };
        let p_error = p.abs() * gamma(3);
        // Along u and v of the face, whose product is the outward normal.
        let size = self.hi - self.lo;
        let (dpdu, dpdv) = match axis {
            0 => (vec3(0.0, 0.0, -n.x * size.z), vec3(0.0, size.y, 0.0)),
            1 => (vec3(size.x, 0.0, 0.0), vec3(0.0, 0.0, -n.y * size.z)),
            _ => (vec3(n.z * size.x, 0.0, 0.0), vec3(0.0, size.y, 0.0)),
        };
        let plain = SurfaceInteraction::plain(p, p_error, n, self.material);
        SurfaceInteraction { uv, dpdu, dpdv, ..plain }
    }
}

impl Convex for Box3 {
    #[inline(always)]
    fn interval(&self, ray: &Ray) -> Option<[f32; 2]> {
        let c = self.crossing(ray)?;
        Some([max(c.t_enter, 0.0), c.t_leave])
    }

    #[inline(always)]
    fn surely_contains(&self, p: Vec3, p_error: Vec3, _: f32) -> bool {
        let margin = p_error + p.abs() * gamma(2);
        let lo = p - margin;
        let hi = p + margin;
        lo.x > self.lo.x
            && lo.y > self.lo.y
            && lo.z > self.lo.z
            && hi.x < self.hi.x
            && hi.y < self.hi.y
            && hi.z < self.hi.z
    }
}

/// Axis whose value is `t`.
#[inline(always)]
fn axis_of(v: Vec3, t: f32) -> u32 {
    if v.x == t {
        0
    } else if v.y == t {
        1
    } else {
        2
    }
}
