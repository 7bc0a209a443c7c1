//! What is known about the place where a ray meets something.

use crate::math::{Vec3, dot};
use crate::ray::{Ray, offset_ray_origin};
use crate::scene::MaterialRef;

/// Closest thing that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where, as the parameter of the ray.
    pub t: f32,
    /// What.
    pub prim: crate::scene::PrimRef,
}

/// A point on a surface, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point, on the surface to within `p_error`.
    pub p: Vec3,
    /// Bound of the error of each coordinate of `p`.
    pub p_error: Vec3,
    /// Outward unit normal.
    pub n: Vec3,
    /// Texture coordinates; meaningful if they were asked for.
    pub uv: [f32; 2],
    /// Material of the surface.
    pub material: MaterialRef,
}

impl SurfaceInteraction {
    /// Ray that leaves the surface along the unit vector `w`.
    #[inline(always)]
    #[must_use]
    pub fn spawn(&self, w: Vec3, time: f32) -> Ray {
        Ray { o: offset_ray_origin(self.p, self.p_error, self.n, w), d: w, time }
    }

    /// Whether a ray along `d` comes from the side that the normal points to.
    #[inline(always)]
    #[must_use]
    pub fn is_front(&self, d: Vec3) -> bool {
        dot(d, self.n) < 0.0
    }
}
