//! Parallelograms.

use bytemuck::{Pod, Zeroable};

use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, dot, gamma, max, min};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// Least overlap of a quad, as a share of its edge.
#[cfg(not(target_arch = "nvptx64"))]
const MIN_OVERLAP: f64 = 1.0 / 1_048_576.0;
/// Greatest overlap, for quads so far from the origin that single precision hardly resolves them.
#[cfg(not(target_arch = "nvptx64"))]
const MAX_OVERLAP: f64 = 0.01;

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
    /// Share of `u` by which the quad is taken as larger at both ends when a ray is tested, so that
    /// quads which meet leave no gap to slip through by rounding. Points on the quad keep twice as far
    /// away from its rim, so that they are not behind another surface that meets it there.
    pub alpha_overlap: f32,
    /// Vector whose product with a point's position relative to the corner is alpha.
    pub alpha_axis: Vec3,
    /// The same share of `v`.
    pub beta_overlap: f32,
    /// Vector whose product with a point's position relative to the corner is beta.
    pub beta_axis: Vec3,
    /// Nothing.
    pub _pad0: u32,
    /// Edge.
    pub u: Vec3,
    /// Nothing.
    pub _pad1: u32,
    /// Edge.
    pub v: Vec3,
    /// Nothing.
    pub _pad2: u32,
}

const _: () = assert!(size_of::<Quad>() == 96);

#[cfg(not(target_arch = "nvptx64"))]
impl Quad {
    /// The quad with this corner and these edges, which must span an area. Computed in `f64` from the
    /// rounded edges, which are the ones that are rendered.
    #[must_use]
    pub fn new(corner: Vec3, u: Vec3, v: Vec3, material: MaterialRef) -> Self {
        type Double = [f64; 3];
        let double = |a: Vec3| a.to_array().map(f64::from);
        let single = |a: Double| Vec3::from_array(a.map(|x| x as f32));
        let scaled = |a: Double, s: f64| a.map(|x| x * s);
        let dot = |a: Double, b: Double| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: Double, b: Double| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let (du, dv) = (double(u), double(v));
        let across = cross(du, dv);
        let area = dot(across, across).sqrt();
        let n = scaled(across, 1.0 / area);
        // Corners and points are rounded by their distance from the origin, not by the edge's length.
        let reach = (corner.abs() + u.abs() + v.abs()).max_component();
        let rounding = 8.0 * f64::from(f32::EPSILON) * f64::from(reach);
        let overlap = |edge: Double| {
            (MIN_OVERLAP + rounding / dot(edge, edge).sqrt()).min(MAX_OVERLAP) as f32
        };
        Self {
            corner,
            material,
            normal: single(n),
            alpha_overlap: overlap(du),
            alpha_axis: single(scaled(cross(dv, n), 1.0 / area)),
            beta_overlap: overlap(dv),
            beta_axis: single(scaled(cross(n, du), 1.0 / area)),
            _pad0: 0,
            u,
            _pad1: 0,
            v,
            _pad2: 0,
        }
    }
}

impl Shape for Quad {
    fn bounds(&self, _: Shutter) -> Bounds {
        let (u, v) = (self.u, self.v);
        let diagonal = Bounds::of_points(self.corner, self.corner + u + v);
        let other = Bounds::of_points(self.corner + u, self.corner + v);
        let overlap = u.length() * self.alpha_overlap + v.length() * self.beta_overlap;
        diagonal.union(other).padded(2.0 * overlap)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let t = dot(self.normal, self.corner - ray.o) / dot(self.normal, ray.d);
        let from_corner = ray.at(t) - self.corner;
        let inside = |x: f32, overlap: f32| (-overlap..=1.0 + overlap).contains(&x);
        // False for the NaN and the infinities of a parallel ray.
        if t > 0.0
            && t < f32::INFINITY
            && inside(dot(self.alpha_axis, from_corner), self.alpha_overlap)
            && inside(dot(self.beta_axis, from_corner), self.beta_overlap)
        {
            Some(t)
        } else {
            None
        }
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let from_corner = ray.at(t) - self.corner;
        let inset = |x: f32, by: f32| max(by, min(x, 1.0 - by));
        let alpha = inset(dot(self.alpha_axis, from_corner), 2.0 * self.alpha_overlap);
        let beta = inset(dot(self.beta_axis, from_corner), 2.0 * self.beta_overlap);
        let (au, bv) = (self.u * alpha, self.v * beta);
        let p = self.corner + au + bv;
        let p_error = (self.corner.abs() + au.abs() + bv.abs()) * gamma(10);
        SurfaceInteraction {
            uv: [alpha, beta],
            dpdu: self.u,
            dpdv: self.v,
            ..SurfaceInteraction::plain(p, p_error, self.normal, self.material)
        }
    }
}
