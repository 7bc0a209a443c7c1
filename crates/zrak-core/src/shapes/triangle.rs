//! Triangles.
//!
//! The test is watertight: rays do not slip through edges and vertices that triangles share, because
//! both see the same sheared vertices. Woop, Benthin and Wald, *Watertight Ray/Triangle
//! Intersection*, JCGT 2(1), 2013, with the bounds on the error of t of Pharr, Jakob, Humphreys,
//! *Physically Based Rendering*, 4th ed., section 6.8.7.

use bytemuck::{Pod, Zeroable};

use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, abs, cross, gamma, max, min, vec3};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// Triangle.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Triangle {
    /// Corners, counter-clockwise seen from where the normal points.
    pub vertices: [Vec3; 3],
    /// Texture coordinates of the corners.
    pub uv: [[f32; 2]; 3],
    /// Material of the surface.
    pub material: MaterialRef,
}

const _: () = assert!(size_of::<Triangle>() == 64);

/// Smallest barycentric coordinate that a point on a triangle or patch is given, so that it is
/// not behind another one that meets it at an edge.
pub(super) const EDGE_INSET: f32 = 1.0 / 1_048_576.0;

/// Axes in which a ray starts at the origin and runs exactly along z: what its shapes look like in them
/// depends on each vertex alone, so shapes that share vertices share edges.
#[derive(Clone, Copy)]
pub(super) struct RayAxes {
    o: Vec3,
    along: Vec3,
    sx: f32,
    sy: f32,
    /// Parameter of the ray per unit of z.
    pub(super) sz: f32,
}

impl RayAxes {
    #[inline(always)]
    pub(super) fn of(ray: &Ray) -> Self {
        let along = ray.d.abs();
        let axes = Self { o: ray.o, along, sx: 0.0, sy: 0.0, sz: 0.0 };
        let d = axes.permute(ray.d);
        Self { sx: -d.x / d.z, sy: -d.y / d.z, sz: 1.0 / d.z, ..axes }
    }

    /// Turns the axes so that the ray runs mostly along z.
    #[inline(always)]
    fn permute(&self, v: Vec3) -> Vec3 {
        let along = self.along;
        if along.z >= along.x && along.z >= along.y {
            v
        } else if along.x >= along.y {
            vec3(v.y, v.z, v.x)
        } else {
            vec3(v.z, v.x, v.y)
        }
    }

    /// A point relative to the ray's origin, before the shear.
    #[inline(always)]
    pub(super) fn relative(&self, p: Vec3) -> Vec3 {
        self.permute(p - self.o)
    }

    /// The same after the shear, without its z.
    #[inline(always)]
    pub(super) fn shear(&self, v: Vec3) -> (f32, f32) {
        (v.x + self.sx * v.z, v.y + self.sy * v.z)
    }
}

/// Parameter and barycentric coordinates of the intersection of a ray with a triangle.
#[inline(always)]
pub(super) fn hit_triangle(vertices: [Vec3; 3], ray: &Ray) -> Option<(f32, [f32; 3])> {
    let axes = RayAxes::of(ray);
    let sz = axes.sz;
    let [a, b, c] = vertices.map(|v| axes.relative(v));
    let ((ax, ay), (bx, by), (cx, cy)) = (axes.shear(a), axes.shear(b), axes.shear(c));
    // Edge functions: signed areas that the origin spans with the edges.
    let mut e0 = bx * cy - by * cx;
    let mut e1 = cx * ay - cy * ax;
    let mut e2 = ax * by - ay * bx;
    if e0 == 0.0 || e1 == 0.0 || e2 == 0.0 {
        let area = |px: f32, py: f32, qx: f32, qy: f32| {
            (f64::from(px) * f64::from(qy) - f64::from(py) * f64::from(qx)) as f32
        };
        e0 = area(bx, by, cx, cy);
        e1 = area(cx, cy, ax, ay);
        e2 = area(ax, ay, bx, by);
    }
    if (e0 < 0.0 || e1 < 0.0 || e2 < 0.0) && (e0 > 0.0 || e1 > 0.0 || e2 > 0.0) {
        return None;
    }
    let det = e0 + e1 + e2;
    if det == 0.0 {
        return None;
    }
    let (az, bz, cz) = (a.z * sz, b.z * sz, c.z * sz);
    let inv_det = 1.0 / det;
    let t = (e0 * az + e1 * bz + e2 * cz) * inv_det;
    // Ahead of the origin for certain?
    let largest = |x: f32, y: f32, z: f32| max(x.abs(), max(y.abs(), z.abs()));
    let max_z = largest(az, bz, cz);
    let max_x = largest(ax, bx, cx);
    let max_y = largest(ay, by, cy);
    let delta_z = gamma(3) * max_z;
    let delta_x = gamma(5) * (max_x + max_z);
    let delta_y = gamma(5) * (max_y + max_z);
    let delta_e = 2.0 * (gamma(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
    let max_e = largest(e0, e1, e2);
    let delta_t =
        3.0 * (gamma(3) * max_e * max_z + delta_e * max_z + delta_z * max_e) * inv_det.abs();
    if t > delta_t && t < f32::INFINITY {
        Some((t, [e0 * inv_det, e1 * inv_det, e2 * inv_det]))
    } else {
        None
    }
}

/// A point on a triangle.
pub(super) struct Place {
    pub(super) p: Vec3,
    pub(super) p_error: Vec3,
    /// Barycentric coordinates, inside by [`EDGE_INSET`].
    pub(super) b: [f32; 3],
}

/// Where a ray that hits the triangle does so.
#[inline(always)]
pub(super) fn place_on_triangle(vertices: [Vec3; 3], ray: &Ray) -> Place {
    let b = match hit_triangle(vertices, ray) {
        Some((_, b)) => b,
        None => [1.0 / 3.0; 3],
    };
    let inset = |x: f32| max(EDGE_INSET, min(x, 1.0 - 2.0 * EDGE_INSET));
    let (b1, b2) = (inset(b[1]), inset(b[2]));
    let b0 = max(EDGE_INSET, 1.0 - b1 - b2);
    let [v0, v1, v2] = vertices;
    let (p0, p1, p2) = (v0 * b0, v1 * b1, v2 * b2);
    let p = p0 + p1 + p2;
    let p_error = (p0.abs() + p1.abs() + p2.abs()) * gamma(8);
    Place { p, p_error, b: [b0, b1, b2] }
}

/// Texture coordinates of the point with barycentric coordinates `b`.
#[inline(always)]
pub(super) fn blend_uv(uv: [[f32; 2]; 3], b: [f32; 3]) -> [f32; 2] {
    let mix = |i: usize| uv[0][i] * b[0] + uv[1][i] * b[1] + uv[2][i] * b[2];
    [mix(0), mix(1)]
}

/// Change of the point with u and v; zero where the texture coordinates span no area.
#[inline(always)]
pub(super) fn derivatives(vertices: [Vec3; 3], uv: [[f32; 2]; 3]) -> [Vec3; 2] {
    let (dp02, dp12) = (vertices[0] - vertices[2], vertices[1] - vertices[2]);
    let (du02, dv02) = (uv[0][0] - uv[2][0], uv[0][1] - uv[2][1]);
    let (du12, dv12) = (uv[1][0] - uv[2][0], uv[1][1] - uv[2][1]);
    let determinant = du02 * dv12 - dv02 * du12;
    if abs(determinant) < 1e-30 {
        return [Vec3::ZERO; 2];
    }
    let inverse = 1.0 / determinant;
    [(dp02 * dv12 - dp12 * dv02) * inverse, (dp12 * du02 - dp02 * du12) * inverse]
}

impl Shape for Triangle {
    fn bounds(&self, _: Shutter) -> Bounds {
        let [a, b, c] = self.vertices;
        Bounds::of_points(a, b).union(Bounds::of_points(c, c)).padded(0.0)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        hit_triangle(self.vertices, ray).map(|(t, _)| t)
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, _: f32) -> SurfaceInteraction {
        let place = place_on_triangle(self.vertices, ray);
        let [v0, v1, v2] = self.vertices;
        let n = cross(v1 - v0, v2 - v0).normalized();
        let [dpdu, dpdv] = derivatives(self.vertices, self.uv);
        SurfaceInteraction {
            uv: blend_uv(self.uv, place.b),
            dpdu,
            dpdv,
            ..SurfaceInteraction::plain(place.p, place.p_error, n, self.material)
        }
    }
}
