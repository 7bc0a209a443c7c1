//! Spheres, standing still or moving on a line.
//!
//! The quadratic is solved in the form that does not cancel: the discriminant from the distance
//! between centre and ray (Haines et al., *Precision Improvements for Ray/Sphere Intersection*, Ray
//! Tracing Gems, 2019), the roots by whichever of -b + s and -b - s adds. Which root is ahead follows
//! from whether the origin is inside, so a ray that leaves the surface cannot meet it again at a
//! root that rounding made positive.

use core::f32::consts::{PI, TAU};

use bytemuck::{Pod, Zeroable};

use super::{Convex, Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, atan2, dot, gamma, sqrt, vec3};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// Flag of a sphere whose material looks at texture coordinates: they cost two arc tangents.
pub const NEEDS_UV: u32 = 1;

/// Sphere.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Sphere {
    /// Centre.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
    /// Material of the surface.
    pub material: MaterialRef,
    /// [`NEEDS_UV`] or 0.
    pub flags: u32,
    /// Nothing.
    pub _pad: [u32; 2],
}

const _: () = assert!(size_of::<Sphere>() == 32);

/// Sphere whose centre moves on a line with time.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MovingSphere {
    /// Centre at time 0.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
    /// Way of the centre from time 0 to time 1.
    pub displacement: Vec3,
    /// Material of the surface.
    pub material: MaterialRef,
    /// [`NEEDS_UV`] or 0.
    pub flags: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<MovingSphere>() == 48);

impl MovingSphere {
    /// The sphere as it is at a time.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, time: f32) -> Sphere {
        Sphere {
            center: self.center + self.displacement * time,
            radius: self.radius,
            material: self.material,
            flags: self.flags,
            _pad: [0; 2],
        }
    }
}

/// Both roots' ingredients for a ray against a sphere.
pub(super) struct Roots {
    /// Squared length of the direction.
    a: f32,
    /// From the origin to the point nearest the centre, times `a`.
    pub(super) b: f32,
    /// Signed power of the origin: below zero inside.
    pub(super) c: f32,
    /// From that point to either root, times `a`.
    s: f32,
}

impl Roots {
    #[inline(always)]
    pub(super) fn of(center: Vec3, radius: f32, ray: &Ray) -> Option<Self> {
        let oc = center - ray.o;
        let a = dot(ray.d, ray.d);
        let b = dot(ray.d, oc);
        let r2 = radius * radius;
        // From the nearest point of the line to the centre, times a, so that a miss needs no
        // division.
        let l = oc * a - ray.d * b;
        let discriminant = r2 * (a * a) - dot(l, l);
        if discriminant < 0.0 {
            return None;
        }
        Some(Self { a, b, c: dot(oc, oc) - r2, s: sqrt(discriminant / a) })
    }

    /// Root behind the nearest point, for `b` + `s` > 0.
    #[inline(always)]
    pub(super) fn far(&self) -> f32 {
        // Either form is exact in the reals; take the one that adds.
        if self.b >= 0.0 { (self.b + self.s) / self.a } else { self.c / (self.b - self.s) }
    }

    /// Root before the nearest point, for an origin outside and `b` > 0.
    #[inline(always)]
    pub(super) fn near(&self) -> f32 {
        self.c / (self.b + self.s)
    }
}

impl Sphere {
    #[inline(always)]
    fn roots(&self, ray: &Ray) -> Option<Roots> {
        Roots::of(self.center, self.radius, ray)
    }
}

/// The normal, turned by a few roundings if it would have a grazing ray come from the other side than it
/// does, where the path would go on in the wrong half of space.
#[inline(always)]
pub(super) fn facing(ray: &Ray, n: Vec3, is_outside: bool) -> Vec3 {
    const MARGIN: f32 = 1.0 / (1 << 21) as f32;
    let along = dot(ray.d, n);
    if is_outside == (along < 0.0) && along != 0.0 {
        return n;
    }
    let (a, length) = (dot(ray.d, ray.d), ray.d.length());
    let turn = 2.0 * along / a + if is_outside { MARGIN } else { -MARGIN } / length;
    (n - ray.d * turn).normalized()
}

impl Shape for Sphere {
    fn bounds(&self, _: Shutter) -> Bounds {
        let r = Vec3::splat(self.radius);
        Bounds { lo: self.center - r, hi: self.center + r }.padded(self.radius * 1e-6)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let roots = self.roots(ray)?;
        if roots.c > 0.0 {
            // Outside: ahead if the centre is.
            if roots.b > 0.0 { Some(roots.near()) } else { None }
        } else {
            Some(roots.far())
        }
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let oc = self.center - ray.o;
        let is_outside = dot(oc, oc) > self.radius * self.radius;
        let n = facing(ray, (ray.at(t) - self.center).normalized(), is_outside);
        let arm = n * self.radius;
        let p = self.center + arm;
        // The arm is off by the normalisation, the sum by one rounding, and the next ray's view
        // of the surface by five more operations.
        let p_error = arm.abs() * gamma(8) + (p.abs() + self.center.abs()) * gamma(1);
        let mut surface = SurfaceInteraction::plain(p, p_error, n, self.material);
        if self.flags & NEEDS_UV != 0 {
            surface.uv = sphere_uv(n);
            // u turns about the y axis, v runs from pole to pole.
            let around = vec3(n.z, 0.0, -n.x);
            let sin = sqrt(n.x * n.x + n.z * n.z);
            surface.dpdu = around * (self.radius * TAU);
            if sin > 0.0 {
                let up = vec3(-n.x * n.y / sin, sin, -n.z * n.y / sin);
                surface.dpdv = up * (self.radius * PI);
            }
        }
        surface
    }
}

impl Convex for Sphere {
    #[inline(always)]
    fn interval(&self, ray: &Ray) -> Option<[f32; 2]> {
        let roots = self.roots(ray)?;
        if roots.c > 0.0 {
            if roots.b > 0.0 { Some([roots.near(), roots.far()]) } else { None }
        } else {
            Some([0.0, roots.far()])
        }
    }

    #[inline(always)]
    fn surely_contains(&self, p: Vec3, p_error: Vec3, _: f32) -> bool {
        let to_p = (p - self.center).abs() + p_error + (p.abs() + self.center.abs()) * gamma(2);
        dot(to_p, to_p) < self.radius * self.radius * (1.0 - gamma(8))
    }
}

impl Shape for MovingSphere {
    fn bounds(&self, shutter: Shutter) -> Bounds {
        self.at(shutter[0]).bounds(shutter).union(self.at(shutter[1]).bounds(shutter))
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        self.at(ray.time).intersect(ray)
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        self.at(ray.time).interaction(ray, t)
    }
}

impl Convex for MovingSphere {
    #[inline(always)]
    fn interval(&self, ray: &Ray) -> Option<[f32; 2]> {
        self.at(ray.time).interval(ray)
    }

    #[inline(always)]
    fn surely_contains(&self, p: Vec3, p_error: Vec3, time: f32) -> bool {
        self.at(time).surely_contains(p, p_error, time)
    }
}

/// Texture coordinates of the point of the unit sphere at `n`: u runs around the y axis from -x over
/// +z, +x and -z; v from the south pole (-y) to the north pole (+y). Both in [0, 1].
#[inline(always)]
#[must_use]
pub(super) fn sphere_uv(n: Vec3) -> [f32; 2] {
    let around = atan2(-n.z, n.x) + PI;
    let up = atan2(sqrt(n.x * n.x + n.z * n.z), -n.y);
    [around * (1.0 / TAU), up * (1.0 / PI)]
}
