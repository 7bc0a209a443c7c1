//! What is known about the place where a ray meets something.

use crate::math::{Color, Vec3, dot};
use crate::ray::{Ray, offset_ray_origin};
use crate::scene::{MaterialRef, PrimRef};
use crate::textures::TextureContext;

/// Index that stands for no instance: what was hit is in world space.
pub const NO_INSTANCE: u32 = u32::MAX;

/// Closest thing that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where, as the parameter of the ray.
    pub t: f32,
    /// What.
    pub prim: PrimRef,
    /// Index of the instance that it is in, or [`NO_INSTANCE`].
    pub instance: u32,
}

/// A point on a surface, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point, on the surface to within `p_error`.
    pub p: Vec3,
    /// Bound of the error of each coordinate of `p`.
    pub p_error: Vec3,
    /// Outward unit normal of the surface itself.
    pub n: Vec3,
    /// Outward unit normal for shading: of the surface that the mesh stands for.
    pub ns: Vec3,
    /// Change of the point with u; meaningful if texture coordinates were asked for.
    pub dpdu: Vec3,
    /// Change of the point with v.
    pub dpdv: Vec3,
    /// Texture coordinates; meaningful if they were asked for.
    pub uv: [f32; 2],
    /// Colour of the mesh's vertices, white without one.
    pub color: Color,
    /// Alpha of the mesh's vertices, 1 without one.
    pub alpha: f32,
    /// Width of the ray's footprint, in world units.
    pub footprint: f32,
    /// Material of the surface.
    pub material: MaterialRef,
}

impl SurfaceInteraction {
    /// Point of a surface without texture coordinates or shading normal of its own.
    #[inline(always)]
    #[must_use]
    pub const fn plain(p: Vec3, p_error: Vec3, n: Vec3, material: MaterialRef) -> Self {
        Self {
            p,
            p_error,
            n,
            ns: n,
            dpdu: Vec3::ZERO,
            dpdv: Vec3::ZERO,
            uv: [0.0; 2],
            color: Color::WHITE,
            alpha: 1.0,
            footprint: 0.0,
            material,
        }
    }

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

    /// The shading normal on the side that a ray along `d` comes from.
    #[inline(always)]
    #[must_use]
    pub fn ns_toward(&self, d: Vec3) -> Vec3 {
        if self.is_front(d) { self.ns } else { -self.ns }
    }

    /// What textures look at.
    #[inline(always)]
    #[must_use]
    pub fn texture_context(&self) -> TextureContext {
        // Footprint over the length of a step in u or v; a surface that has none is not filtered.
        let share = |d: Vec3| {
            let length = d.length();
            if length > 0.0 { self.footprint / length } else { 0.0 }
        };
        TextureContext {
            p: self.p,
            uv: self.uv,
            duv: [share(self.dpdu), share(self.dpdv)],
            footprint: self.footprint,
            color: self.color,
            alpha: self.alpha,
        }
    }
}
