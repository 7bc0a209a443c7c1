//! Triangle meshes: indexed triangles that share vertices.
//!
//! The test of a ray is that of single triangles, so it is watertight across shared edges: both
//! triangles see the same sheared vertices. A mesh's records say where the attributes of its
//! vertices are; what it does not have costs nothing.

use bytemuck::{Pod, Zeroable};

use super::triangle::{blend_uv, derivatives, hit_triangle, place_on_triangle};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Color, Vec3, cross, dot, max, vec3};
use crate::ray::Ray;
use crate::scene::{MaterialRef, SceneView};

/// Flag of a mesh that has normals at its vertices.
pub const MESH_NORMALS: u32 = 1;
/// Flag of a mesh that has texture coordinates.
pub const MESH_UVS: u32 = 2;
/// Flag of a mesh that has tangents.
pub const MESH_TANGENTS: u32 = 4;
/// Flag of a mesh that has colours.
pub const MESH_COLORS: u32 = 8;

/// A mesh: what its triangles have in common.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Mesh {
    /// Material of the surface.
    pub material: MaterialRef,
    /// Which attributes there are.
    pub flags: u32,
    /// What leads, added to a vertex's index (modulo 2^32), to its normal.
    pub normal_offset: u32,
    /// The same for texture coordinates.
    pub uv_offset: u32,
    /// The same for tangents.
    pub tangent_offset: u32,
    /// The same for colours.
    pub color_offset: u32,
    /// Nothing.
    pub _pad: [u32; 2],
}

const _: () = assert!(size_of::<Mesh>() == 32);

/// Triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshTriangle {
    /// Indices of the corners in the array of positions, counter-clockwise seen from where the
    /// normal points.
    pub vertices: [u32; 3],
    /// Index of its mesh.
    pub mesh: u32,
}

const _: () = assert!(size_of::<MeshTriangle>() == 16);

/// Texture coordinates of the corners of triangles without any.
const DEFAULT_UV: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];

impl MeshTriangle {
    #[inline(always)]
    fn corners(&self, scene: &SceneView) -> [Vec3; 3] {
        self.vertices.map(|v| scene.positions.get(v))
    }

    /// Box that holds the triangle, with a margin for rounding.
    #[must_use]
    pub fn bounds(&self, scene: &SceneView) -> Bounds {
        let [a, b, c] = self.corners(scene);
        Bounds::of_points(a, b).union(Bounds::of_points(c, c)).padded(0.0)
    }

    /// Parameter of the intersection ahead of the ray's origin.
    #[inline(always)]
    #[must_use]
    pub fn intersect(&self, scene: &SceneView, ray: &Ray) -> Option<f32> {
        hit_triangle(self.corners(scene), ray).map(|(t, _)| t)
    }

    /// What is where the ray hits the triangle.
    #[inline(always)]
    #[must_use]
    pub fn interaction(&self, scene: &SceneView, ray: &Ray) -> SurfaceInteraction {
        let mesh = scene.meshes.get(self.mesh);
        let corners = self.corners(scene);
        let place = place_on_triangle(corners, ray);
        let mut n = face_normal(corners);
        let uv = if mesh.flags & MESH_UVS != 0 {
            self.vertices.map(|v| scene.uvs.get(v.wrapping_add(mesh.uv_offset)))
        } else {
            DEFAULT_UV
        };
        let [mut dpdu, dpdv] = derivatives(corners, uv);
        let mut ns = n;
        if mesh.flags & MESH_NORMALS != 0 {
            let at = |v: u32| scene.normals.get(v.wrapping_add(mesh.normal_offset));
            let blend = blend(self.vertices.map(at), place.b);
            // Normals may cancel each other; then the face's own will do.
            if blend.length_squared() > 1e-12 {
                ns = blend.normalized();
                // The sides are the ones that the normals tell apart.
                n = if dot(n, ns) < 0.0 { -n } else { n };
            }
        }
        if mesh.flags & MESH_TANGENTS != 0 {
            let at = |v: u32| scene.tangents.get(v.wrapping_add(mesh.tangent_offset));
            let tangents = self.vertices.map(at);
            let t = blend(tangents.map(|t| vec3(t[0], t[1], t[2])), place.b);
            if t.length_squared() > 1e-12 {
                dpdu = t.normalized() * max(dpdu.length(), 1e-12);
            }
        }
        let mut surface = SurfaceInteraction::plain(place.p, place.p_error, n, mesh.material);
        surface.ns = ns;
        surface.uv = blend_uv(uv, place.b);
        surface.dpdu = dpdu;
        surface.dpdv = dpdv;
        if mesh.flags & MESH_COLORS != 0 {
            let at = |v: u32| scene.colors.get(v.wrapping_add(mesh.color_offset));
            let [a, b, c] = self.vertices.map(at);
            let mix = |i: usize| a[i] * place.b[0] + b[i] * place.b[1] + c[i] * place.b[2];
            surface.color = Color::new(mix(0), mix(1), mix(2));
            surface.alpha = mix(3);
        }
        surface
    }
}

#[inline(always)]
fn blend([a, b, c]: [Vec3; 3], w: [f32; 3]) -> Vec3 {
    a * w[0] + b * w[1] + c * w[2]
}

/// Unit normal of a triangle of any size; of one without an area, any unit vector.
#[inline(always)]
fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    scaled_normal(b - a, c - a)
}

/// Direction of `e1` x `e2`, which may be of any size; if it has none, any unit vector.
#[inline(always)]
pub(super) fn scaled_normal(e1: Vec3, e2: Vec3) -> Vec3 {
    // Brought to size 1 first: squares of small areas vanish in single precision.
    let size = max(e1.abs().max_component(), e2.abs().max_component());
    if size == 0.0 {
        return vec3(0.0, 0.0, 1.0);
    }
    let scale = 1.0 / size;
    let n = cross(e1 * scale, e2 * scale);
    let length = n.length();
    if length > 0.0 { n / length } else { vec3(0.0, 0.0, 1.0) }
}
