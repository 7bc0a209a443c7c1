//! Parts of spheres about the z axis: cut off below and above, and covering a part of a turn. Elsewhere
//! they stand under an instance.
//!
//! The roots are those of whole spheres; see there. A ray that passes the part that is missing meets the
//! other side from inside.

use core::f32::consts::TAU;

use bytemuck::{Pod, Zeroable};

use super::disk::angle;
use super::sphere::{Roots, facing};
use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, abs, atan2, gamma, max, min, sqrt, vec3};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// The points at the distance `radius` from the origin with z in [`z_min`, `z_max`] and an angle about z,
/// from the x axis towards y, in [0, `phi_max`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct PartialSphere {
    /// Radius.
    pub radius: f32,
    /// Lower end; below `-radius` by far if nothing is cut off there.
    pub z_min: f32,
    /// Upper end; above `radius` by far if nothing is cut off there.
    pub z_max: f32,
    /// Largest angle, in radians; at least a turn for all of it.
    pub phi_max: f32,
    /// Angle between the z axis and the lower rim, in radians: where texture v is 0.
    pub theta_low: f32,
    /// Angle between the z axis and the upper rim, where v is 1, minus `theta_low`: below 0.
    pub theta_span: f32,
    /// Material of the surface.
    pub material: MaterialRef,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<PartialSphere>() == 32);

impl PartialSphere {
    #[inline(always)]
    fn has(&self, p: Vec3) -> bool {
        p.z >= self.z_min
            && p.z <= self.z_max
            && (self.phi_max >= TAU || angle(p.y, p.x) <= self.phi_max)
    }

    /// Where a ray meets it, and whether from outside.
    #[inline(always)]
    fn hit(&self, ray: &Ray) -> Option<(f32, bool)> {
        let roots = Roots::of(Vec3::ZERO, self.radius, ray)?;
        if roots.c > 0.0 {
            if roots.b <= 0.0 {
                return None;
            }
            let near = roots.near();
            if self.has(ray.at(near)) {
                return Some((near, true));
            }
        }
        let far = roots.far();
        if far > 0.0 && far < f32::INFINITY && self.has(ray.at(far)) {
            Some((far, false))
        } else {
            None
        }
    }
}

impl Shape for PartialSphere {
    fn bounds(&self, _: Shutter) -> Bounds {
        let r = self.radius;
        let (z_min, z_max) = (max(self.z_min, -r), min(self.z_max, r));
        // Widest where the equator is, or at the rim that is nearest to it.
        let z = if z_min > 0.0 {
            z_min
        } else if z_max < 0.0 {
            z_max
        } else {
            0.0
        };
        let wide = sqrt(max(r * r - z * z, 0.0));
        // The rim's place is rounded, and flat there the width grows fast.
        let wide = min(wide + r * 1e-3, r);
        let (lo, hi) = (vec3(-wide, -wide, z_min), vec3(wide, wide, z_max));
        Bounds { lo, hi }.padded(r * 2e-6)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        self.hit(ray).map(|(t, _)| t)
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let is_outside = self.hit(ray).is_none_or(|(_, is_outside)| is_outside);
        let n = facing(ray, ray.at(t).normalized(), is_outside);
        let p = n * self.radius;
        // As for whole spheres.
        let p_error = p.abs() * gamma(9);
        let around = sqrt(n.x * n.x + n.y * n.y);
        let theta = atan2(around, n.z);
        // Away from the z axis; at a pole any direction will do.
        let (cos, sin) = if around > 0.0 { (n.x / around, n.y / around) } else { (1.0, 0.0) };
        let v = (theta - self.theta_low) / self.theta_span;
        SurfaceInteraction {
            uv: [angle(p.y, p.x) / self.phi_max, min(max(v, 0.0), 1.0)],
            dpdu: vec3(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: vec3(p.z * cos, p.z * sin, -self.radius * abs(around)) * self.theta_span,
            ..SurfaceInteraction::plain(p, p_error, n, self.material)
        }
    }
}
