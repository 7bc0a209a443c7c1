//! Bilinear patches: surfaces that two families of straight lines sweep over.
//!
//! S(u, v) blends four corners, p00 and p10 where v is 0, p01 and p11 where it is 1. In axes in which
//! the ray runs along z from the origin, as for triangles, a hit is a root of the two equations
//! S_x(u, v) = S_y(u, v) = 0: the origin lies on the line from A(u) = S(u, 0) to B(u) = S(u, 1), so
//! A(u) x B(u) = 0, which is quadratic in u. (Reshetov, *Cool Patches*, Ray Tracing Gems, 2019, section
//! 8, solves the same quadratic in space.) Newton's method for both equations then takes away
//! what the quadratic lost by cancellation, and what is left of them, with a bound of their rounding,
//! bounds the errors of u, v and t.
//!
//! Patches are taken larger than they are by the error of u and v, so rays do not slip through edges that
//! patches or triangles share: both see the same sheared corners. t must exceed its error.

use bytemuck::{Pod, Zeroable};

use super::mesh::{MESH_COLORS, MESH_NORMALS, MESH_UVS, scaled_normal};
use super::triangle::{EDGE_INSET, RayAxes};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Color, Vec3, abs, dot, gamma, max, min, sqrt};
use crate::ray::Ray;
use crate::scene::SceneView;

/// Greatest overlap of a patch, as a share of it.
const MAX_OVERLAP: f32 = 0.01;

/// Bilinear patch of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshPatch {
    /// Indices of the corners in the array of positions: at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1).
    pub vertices: [u32; 4],
    /// Index of its mesh.
    pub mesh: u32,
    /// 1 if the side that its normal points to is the other one, against that of dp/du x dp/dv.
    pub flip: u32,
    /// Nothing.
    pub _pad: [u32; 2],
}

const _: () = assert!(size_of::<MeshPatch>() == 32);

/// Where a ray meets a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchHit {
    pub(super) t: f32,
    /// Within the patch, or outside by the overlap.
    pub(super) uv: [f32; 2],
    /// Bounds of the errors of u and v.
    pub(super) overlap: [f32; 2],
}

/// A point of the plane that the ray pierces at the origin.
#[derive(Clone, Copy)]
struct Flat {
    x: f32,
    y: f32,
}

impl Flat {
    #[inline(always)]
    fn cross(self, o: Self) -> f32 {
        self.x * o.y - self.y * o.x
    }

    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y }
    }

    /// `self` + `s` `o`.
    #[inline(always)]
    fn plus(self, s: f32, o: Self) -> Self {
        Self { x: self.x + s * o.x, y: self.y + s * o.y }
    }

    /// Sum of the absolute values.
    #[inline(always)]
    fn size(self) -> f32 {
        abs(self.x) + abs(self.y)
    }
}

/// A patch in the axes of a ray.
struct Seen {
    p00: Flat,
    p01: Flat,
    /// From p00 to p10.
    e0: Flat,
    /// From p01 to p11.
    e1: Flat,
    /// Parameters of the ray at the depths of the corners.
    t: [f32; 4],
    /// Bounds of the error of a point of the plane: by what it is computed from the sheared corners, and
    /// with that of the corners themselves.
    rounding: f32,
    error: f32,
}

impl Seen {
    /// The hit near (`u`, `v`).
    #[inline(always)]
    fn hit_near(&self, u: f32, v: f32) -> Option<PatchHit> {
        let (mut u, mut v) = (u, v);
        let (mut r, mut ru, mut rv) = self.at(u, v);
        for _ in 0..2 {
            let det = ru.cross(rv);
            let inv_det = if det == 0.0 { 0.0 } else { 1.0 / det };
            let (nu, nv) = (u - r.cross(rv) * inv_det, v - ru.cross(r) * inv_det);
            let (nr, nru, nrv) = self.at(nu, nv);
            // On the outline, where the two roots are one, a step may lead astray. False for NaN.
            if nr.size() < r.size() {
                (u, v, r, ru, rv) = (nu, nv, nr, nru, nrv);
            }
        }
        let det = abs(ru.cross(rv));
        let residual = r.size();
        // False for NaN, and for what is no root.
        if !(abs(u) + abs(v) < 4.0 && residual <= 32.0 * self.rounding && det > 0.0) {
            return None;
        }
        // What the equations leave, seen through the inverse of (ru rv).
        let inv_det = 1.0 / det;
        let rounding = (residual + self.rounding) * inv_det;
        let overlap_u = min(rounding * rv.size(), MAX_OVERLAP);
        let overlap_v = min(rounding * ru.size(), MAX_OVERLAP);
        let [t00, t10, t01, t11] = self.t;
        let (a, b) = (t00 + u * (t10 - t00), t01 + u * (t11 - t01));
        let t = a + v * (b - a);
        let tu = abs((t10 - t00) * (1.0 - v) + (t11 - t01) * v);
        let tv = abs(b - a);
        let largest = max(max(abs(t00), abs(t10)), max(abs(t01), abs(t11)));
        let slope = (tu * rv.size() + tv * ru.size()) * inv_det;
        let delta_t = gamma(12) * largest + (residual + self.error) * slope;
        let is_inside =
            u >= -overlap_u && u <= 1.0 + overlap_u && v >= -overlap_v && v <= 1.0 + overlap_v;
        if is_inside && t > delta_t && t < f32::INFINITY {
            Some(PatchHit { t, uv: [u, v], overlap: [overlap_u, overlap_v] })
        } else {
            None
        }
    }

    /// The point at (u, v), and its change with u and with v.
    #[inline(always)]
    fn at(&self, u: f32, v: f32) -> (Flat, Flat, Flat) {
        let a = self.p00.plus(u, self.e0);
        let b = self.p01.plus(u, self.e1);
        let rv = b.sub(a);
        let ru = self.e0.plus(v, self.e1.sub(self.e0));
        (a.plus(v, rv), ru, rv)
    }

    /// The v for which the line at u is nearest to the origin.
    #[inline(always)]
    fn v_on_line(&self, u: f32) -> f32 {
        let a = self.p00.plus(u, self.e0);
        let rv = self.p01.plus(u, self.e1).sub(a);
        -(a.x * rv.x + a.y * rv.y) / (rv.x * rv.x + rv.y * rv.y)
    }
}

/// The first intersection ahead of the ray's origin.
#[inline(always)]
pub(super) fn hit_patch(corners: [Vec3; 4], ray: &Ray) -> Option<PatchHit> {
    let axes = RayAxes::of(ray);
    let relative = corners.map(|p| axes.relative(p));
    let [p00, p10, p01, p11] = relative.map(|p| {
        let (x, y) = axes.shear(p);
        Flat { x, y }
    });
    let across = max(max(p00.size(), p10.size()), max(p01.size(), p11.size()));
    let reach = |p: Vec3| abs(p.x) + abs(p.y) + abs(p.z);
    let [a, b, c, d] = relative;
    let far = max(max(reach(a), reach(b)), max(reach(c), reach(d)));
    let seen = Seen {
        p00,
        p01,
        e0: p10.sub(p00),
        e1: p11.sub(p01),
        t: relative.map(|p| p.z * axes.sz),
        rounding: gamma(8) * across,
        error: gamma(8) * across + gamma(4) * far,
    };
    // (1 - u)^2 c0 + u (1 - u) c1 + u^2 c2.
    let c0 = p00.cross(p01);
    let c1 = p00.cross(p11) + p10.cross(p01);
    let c2 = p10.cross(p11);
    // Brought to size 1: squares of areas leave the range of single precision.
    let size = max(abs(c0), max(abs(c1), abs(c2)));
    if size == 0.0 {
        return None;
    }
    let scale = 1.0 / size;
    let (c0, c1, c2) = (c0 * scale, c1 * scale, c2 * scale);
    let (qa, qb) = (c0 - c1 + c2, c1 - 2.0 * c0);
    // Both roots are one within rounding: the origin may be on the patch's outline.
    let discriminant = c1 * c1 - 4.0 * c0 * c2;
    let slack = gamma(16) * (c1 * c1 + 4.0 * abs(c0 * c2));
    if discriminant.is_nan() || discriminant < -slack {
        return None;
    }
    let root = sqrt(max(discriminant, 0.0));
    // By whichever sum does not cancel.
    let q = -0.5 * (if qb < 0.0 { qb - root } else { qb + root });
    let (u0, u1) = (q / qa, c0 / q);
    let candidate = |u: f32| {
        // False for the NaN of no equation at all, and for the infinity of a linear one.
        if u > -1.0 && u < 2.0 { seen.hit_near(u, seen.v_on_line(u)) } else { None }
    };
    match (candidate(u0), candidate(u1)) {
        (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// The blend of the corners' values at (u, v), as weights.
#[inline(always)]
fn weights([u, v]: [f32; 2]) -> [f32; 4] {
    let (a, b) = (1.0 - u, 1.0 - v);
    [a * b, u * b, a * v, u * v]
}

#[inline(always)]
fn blend([a, b, c, d]: [Vec3; 4], w: [f32; 4]) -> Vec3 {
    a * w[0] + b * w[1] + c * w[2] + d * w[3]
}

/// Without texture coordinates of its own, a patch has (u, v).
const DEFAULT_UV: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];

impl MeshPatch {
    #[inline(always)]
    fn corners(&self, scene: &SceneView) -> [Vec3; 4] {
        self.vertices.map(|v| scene.positions.get(v))
    }

    /// Box that holds the patch, with a margin for rounding and for the overlap.
    #[must_use]
    pub fn bounds(&self, scene: &SceneView) -> Bounds {
        let [a, b, c, d] = self.corners(scene);
        let all = Bounds::of_points(a, b).union(Bounds::of_points(c, d));
        // A patch is a blend of its corners. It is longer by the overlap only as seen by rays that
        // cannot tell; those whose hits are not in the box miss.
        all.padded((all.hi - all.lo).max_component() * 1e-6)
    }

    /// Parameter of the first intersection ahead of the ray's origin.
    #[inline(always)]
    #[must_use]
    pub fn intersect(&self, scene: &SceneView, ray: &Ray) -> Option<f32> {
        hit_patch(self.corners(scene), ray).map(|hit| hit.t)
    }

    /// What is where the ray hits the patch.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn interaction(&self, scene: &SceneView, ray: &Ray) -> SurfaceInteraction {
        let mesh = scene.meshes.get(self.mesh);
        let corners = self.corners(scene);
        // Inside by twice the overlap, so as not to be behind another patch that meets it there.
        let inset = |x: f32, overlap: f32| {
            let by = max(EDGE_INSET, 2.0 * overlap);
            max(by, min(x, 1.0 - by))
        };
        let [u, v] = match hit_patch(corners, ray) {
            Some(hit) => [inset(hit.uv[0], hit.overlap[0]), inset(hit.uv[1], hit.overlap[1])],
            None => [0.5; 2],
        };
        let w = weights([u, v]);
        let [p00, p10, p01, p11] = corners;
        let p = blend(corners, w);
        let p_error = blend(corners.map(Vec3::abs), w) * gamma(12);
        let by_u = (p10 - p00) * (1.0 - v) + (p11 - p01) * v;
        let by_v = (p01 - p00) * (1.0 - u) + (p11 - p10) * u;
        let mut n = scaled_normal(by_u, by_v);
        n = if self.flip != 0 { -n } else { n };
        let mut ns = n;
        if mesh.flags & MESH_NORMALS != 0 {
            let at = |v: u32| scene.normals.get(v.wrapping_add(mesh.normal_offset));
            let blend = blend(self.vertices.map(at), w);
            // As for triangles: the sides are the ones that the normals tell apart.
            if blend.length_squared() > 1e-12 {
                ns = blend.normalized();
                n = if dot(n, ns) < 0.0 { -n } else { n };
            }
        }
        let (mut dpdu, mut dpdv, mut uv) = (by_u, by_v, [u, v]);
        if mesh.flags & MESH_UVS != 0 {
            let at = self.vertices.map(|v| scene.uvs.get(v.wrapping_add(mesh.uv_offset)));
            if at != DEFAULT_UV {
                let mix = |i: usize| {
                    at[0][i] * w[0] + at[1][i] * w[1] + at[2][i] * w[2] + at[3][i] * w[3]
                };
                uv = [mix(0), mix(1)];
                // Change of the texture coordinates with those of the patch, inverted.
                let su = |i: usize| (at[1][i] - at[0][i]) * (1.0 - v) + (at[3][i] - at[2][i]) * v;
                let sv = |i: usize| (at[2][i] - at[0][i]) * (1.0 - u) + (at[3][i] - at[1][i]) * u;
                let determinant = su(0) * sv(1) - sv(0) * su(1);
                [dpdu, dpdv] = if abs(determinant) < 1e-30 {
                    [Vec3::ZERO; 2]
                } else {
                    let inverse = 1.0 / determinant;
                    [
                        (by_u * sv(1) - by_v * su(1)) * inverse,
                        (by_v * su(0) - by_u * sv(0)) * inverse,
                    ]
                };
            }
        }
        let plain = SurfaceInteraction::plain(p, p_error, n, mesh.material);
        let mut surface = SurfaceInteraction { ns, uv, dpdu, dpdv, ..plain };
        if mesh.flags & MESH_COLORS != 0 {
            let at = |v: u32| scene.colors.get(v.wrapping_add(mesh.color_offset));
            let c = self.vertices.map(at);
            let mix = |i: usize| c[0][i] * w[0] + c[1][i] * w[1] + c[2][i] * w[2] + c[3][i] * w[3];
            surface.color = Color::new(mix(0), mix(1), mix(2));
            surface.alpha = mix(3);
        }
        surface
    }
}
