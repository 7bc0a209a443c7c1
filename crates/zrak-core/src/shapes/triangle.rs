//! Triangles.
//!
//! The test is watertight: rays do not slip through edges and vertices that triangles share, because
//! both see the same sheared vertices. Woop, Benthin and Wald, *Watertight Ray/Triangle
//! Intersection*, JCGT 2(1), 2013, with the bounds on the error of t of Pharr, Jakob, Humphreys,
//! *Physically Based Rendering*, 4th ed., section 6.8.7.

use bytemuck::{Pod, Zeroable};

use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, cross, gamma, max, min, vec3};
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

/// Smallest barycentric coordinate that a point on a triangle is given, so that it is not behind
/// another triangle that meets it at an edge.
const EDGE_INSET: f32 = 1.0 / 1_048_576.0;

impl Triangle {
    /// Parameter and barycentric coordinates of the intersection.
    #[inline(always)]
    fn hit(&self, ray: &Ray) -> Option<(f32, [f32; 3])> {
        // Move the origin to zero and turn the axes so that the ray runs mostly along z.
        let along = ray.d.abs();
        let permute = |v: Vec3| {
            if along.z >= along.x && along.z >= along.y {
                v
            } else if along.x >= along.y {
                vec3(v.y, v.z, v.x)
            } else {
                vec3(v.z, v.x, v.y)
            }
        };
        let d = permute(ray.d);
        let [a, b, c] = self.vertices.map(|v| permute(v - ray.o));
        // Shear so that it runs exactly along z.
        let (sx, sy, sz) = (-d.x / d.z, -d.y / d.z, 1.0 / d.z);
        let shear = |v: Vec3| (v.x + sx * v.z, v.y + sy * v.z);
        let ((ax, ay), (bx, by), (cx, cy)) = (shear(a), shear(b), shear(c));
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
}

impl Shape for Triangle {
    fn bounds(&self, _: Shutter) -> Bounds {
        let [a, b, c] = self.vertices;
        Bounds::of_points(a, b).union(Bounds::of_points(c, c)).padded(0.0)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        self.hit(ray).map(|(t, _)| t)
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, _: f32) -> SurfaceInteraction {
        let b = match self.hit(ray) {
            Some((_, b)) => b,
            None => [1.0 / 3.0; 3],
        };
        let inset = |x: f32| max(EDGE_INSET, min(x, 1.0 - 2.0 * EDGE_INSET));
        let (b1, b2) = (inset(b[1]), inset(b[2]));
        let b0 = max(EDGE_INSET, 1.0 - b1 - b2);
        let [v0, v1, v2] = self.vertices;
        let n = cross(v1 - v0, v2 - v0).normalized();
        let (p0, p1, p2) = (v0 * b0, v1 * b1, v2 * b2);
        let p = p0 + p1 + p2;
        let p_error = (p0.abs() + p1.abs() + p2.abs()) * gamma(8);
        let mix = |i: usize| self.uv[0][i] * b0 + self.uv[1][i] * b1 + self.uv[2][i] * b2;
        SurfaceInteraction { p, p_error, n, uv: [mix(0), mix(1)], material: self.material }
    }
}
