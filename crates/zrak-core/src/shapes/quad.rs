//! Parallelograms.

use bytemuck::{Pod, Zeroable};

use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, dot, gamma, max, min};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// Share of an edge by which a quad is taken as larger when a ray is tested, so that quads which share
/// an edge leave no gap to slip through by rounding.
const EDGE_OVERLAP: f32 = 1.0 / 1_048_576.0;
/// Share of an edge by which points on the quad keep away from its rim, so that they are not behind
/// another surface that meets it there.
const EDGE_INSET: f32 = 2.0 * EDGE_OVERLAP;

/// Parallelogram of the points `corner + alpha u + beta v` with alpha and beta in [0, 1], which are
/// its texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Quad {
    /// Corner.
    pub corner: Vec3,
    /// Material of the surface.
    pub material: MaterialRef,
    /// Unit normal, rounded once from its exact direction, so that its error is relative to each
    /// of its components.
    pub normal: Vec3,
    /// Nothing.
    pub _pad0: u32,
    /// Vector whose product with a point's position relative to the corner is alpha.
    pub alpha_axis: Vec3,
    /// Nothing.
    pub _pad1: u32,
    /// Vector whose product with a point's position relative to the corner is beta.
    pub beta_axis: Vec3,
    /// Nothing.
    pub _pad2: u32,
    /// Edge.
    pub u: Vec3,
    /// Nothing.
    pub _pad3: u32,
    /// Edge.
    pub v: Vec3,
    /// Nothing.
    pub _pad4: u32,
}

const _: () = assert!(size_of::<Quad>() == 96);

impl Shape for Quad {
    fn bounds(&self, _: Shutter) -> Bounds {
        let (u, v) = (self.u, self.v);
        let diagonal = Bounds::of_points(self.corner, self.corner + u + v);
        let other = Bounds::of_points(self.corner + u, self.corner + v);
        diagonal.union(other).padded((u.length() + v.length()) * (2.0 * EDGE_OVERLAP))
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let t = dot(self.normal, self.corner - ray.o) / dot(self.normal, ray.d);
        let from_corner = ray.at(t) - self.corner;
        let inside = |x: f32| (-EDGE_OVERLAP..=1.0 + EDGE_OVERLAP).contains(&x);
        // False for the NaN and the infinities of a parallel ray.
        if t > 0.0
            && t < f32::INFINITY
            && inside(dot(self.alpha_axis, from_corner))
            && inside(dot(self.beta_axis, from_corner))
        {
            Some(t)
        } else {
            None
        }
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let from_corner = ray.at(t) - self.corner;
        let inset = |x: f32| max(EDGE_INSET, min(x, 1.0 - EDGE_INSET));
        let alpha = inset(dot(self.alpha_axis, from_corner));
        let beta = inset(dot(self.beta_axis, from_corner));
        let (au, bv) = (self.u * alpha, self.v * beta);
        let p = self.corner + au + bv;
        let p_error = (self.corner.abs() + au.abs() + bv.abs()) * gamma(10);
        SurfaceInteraction {
            p,
            p_error,
            n: self.normal,
            uv: [alpha, beta],
            material: self.material,
        }
    }
}
