//! Open cylinders about the z axis, or pieces of them. Elsewhere they stand under an instance.
//!
//! The quadratic is solved as for spheres, without cancellation, and which root is ahead follows from
//! whether the origin is inside.

use core::f32::consts::TAU;

use bytemuck::{Pod, Zeroable};

use super::disk::angle;
use super::sphere::facing;
use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, gamma, sqrt, vec3};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// The points with x^2 + y^2 = `radius`^2, z in [`z_min`, `z_max`] and an angle in [0, `phi_max`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Cylinder {
    /// Radius.
    pub radius: f32,
    /// Lower end.
    pub z_min: f32,
    /// Upper end.
    pub z_max: f32,
    /// Largest angle, in radians; at least a turn for all of it.
    pub phi_max: f32,
    /// Material of the surface.
    pub material: MaterialRef,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Cylinder>() == 32);

impl Cylinder {
    #[inline(always)]
    fn has(&self, p: Vec3) -> bool {
        p.z >= self.z_min
            && p.z <= self.z_max
            && (self.phi_max >= TAU || angle(p.y, p.x) <= self.phi_max)
    }

    /// Where a ray meets it, and whether from outside.
    #[inline(always)]
    fn hit(&self, ray: &Ray) -> Option<(f32, bool)> {
        let (o, d) = (ray.o, ray.d);
        let a = d.x * d.x + d.y * d.y;
        let b = -(d.x * o.x + d.y * o.y);
        let c = o.x * o.x + o.y * o.y - self.radius * self.radius;
        // Distance of the line from the axis, times the direction's length.
        let l = d.x * o.y - d.y * o.x;
        let discriminant = self.radius * self.radius * a - l * l;
        if discriminant < 0.0 || a == 0.0 {
            return None;
        }
        let s = sqrt(discriminant);
        let far = if b >= 0.0 { (b + s) / a } else { c / (b - s) };
        if c > 0.0 {
            if b <= 0.0 {
                return None;
            }
            let near = c / (b + s);
            if self.has(ray.at(near)) {
                return Some((near, true));
            }
        }
        if far > 0.0 && far < f32::INFINITY && self.has(ray.at(far)) {
            Some((far, false))
        } else {
            None
        }
    }
}

impl Shape for Cylinder {
    fn bounds(&self, _: Shutter) -> Bounds {
        let r = self.radius;
        let (lo, hi) = (vec3(-r, -r, self.z_min), vec3(r, r, self.z_max));
        Bounds { lo, hi }.padded(r * 1e-6)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        self.hit(ray).map(|(t, _)| t)
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let is_outside = self.hit(ray).is_none_or(|(_, is_outside)| is_outside);
        let hit = ray.at(t);
        let n = vec3(hit.x, hit.y, 0.0).normalized();
        let arm = n * self.radius;
        let p = vec3(arm.x, arm.y, hit.z);
        // What happens along z does not carry a ray through the surface.
        let p_error = p.abs() * gamma(10);
        let height = self.z_max - self.z_min;
        SurfaceInteraction {
            uv: [angle(p.y, p.x) / self.phi_max, (p.z - self.z_min) / height],
            dpdu: vec3(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: vec3(0.0, 0.0, height),
            ..SurfaceInteraction::plain(p, p_error, facing(ray, n, is_outside), self.material)
        }
    }
}
