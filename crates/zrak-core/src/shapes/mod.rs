//! Shapes: where a ray meets them, and what is there.
//!
//! # To add a shape
//! 1. Write its record and its [`Shape`] in a file of its own here, with tests against `f64`.
//! 2. Add its array to [`crate::for_each_scene_array!`] and its kind to [`PrimKind`].
//! 3. Add it to the three `match`es of this file and to `SceneView::kinds_in_use`.
//! 4. On the host: describe it (`zrak-scene`, `desc.rs`), validate it, lower it, and check its handles
//!    (`arena/check.rs`).
//!
//! # What a hit is
//! A ray hits a primitive if it passes the slab test of the primitive's bounds *and* the shape's own
//! intersection; its parameter is then at least the one where it enters the bounds. With that
//! definition a tree may cull by boxes alone and never changes the picture; see
//! [`Bounds`].

mod box3;
mod curve;
mod cylinder;
mod disk;
mod instance;
mod mesh;
mod partial_sphere;
mod patch;
mod quad;
mod sphere;
mod triangle;

#[cfg(test)]
mod tests;

pub use box3::Box3;
pub use curve::{CURVE_CYLINDER, CURVE_FLAT, CURVE_RIBBON, Curve, MAX_HALVINGS, Ribbon};
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use instance::{Instance, Motion, NO_MOTION, Placement};
pub use mesh::{MESH_COLORS, MESH_NORMALS, MESH_TANGENTS, MESH_UVS, Mesh, MeshTriangle};
pub use partial_sphere::PartialSphere;
pub use patch::MeshPatch;
pub use quad::Quad;
pub use sphere::{MovingSphere, NEEDS_UV, Sphere};
pub use triangle::Triangle;

use crate::interaction::{Hit, NO_INSTANCE, SurfaceInteraction};
use crate::math::{Bounds, Vec3, max};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{MaterialRef, PrimKind, PrimRef, SceneView};

/// Shutter interval, in seconds.
pub type Shutter = [f32; 2];

/// A surface.
pub trait Shape {
    /// Box that holds the shape at all times of the shutter interval, with a margin for rounding.
    fn bounds(&self, shutter: Shutter) -> Bounds;

    /// Parameter of the first intersection ahead of the ray's origin.
    fn intersect(&self, ray: &Ray) -> Option<f32>;

    /// What is at parameter `t`, which [`Shape::intersect`] returned for the same ray, in the space
    /// of the ray.
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction;
}

/// The closed convex volume inside some shapes, which can hold a medium.
pub trait Convex {
    /// Part of the ray ahead of its origin that lies inside, if there is one.
    fn interval(&self, ray: &Ray) -> Option<[f32; 2]>;

    /// Whether `p`, known to within `p_error` in each coordinate, is inside for certain.
    fn surely_contains(&self, p: Vec3, p_error: Vec3, time: f32) -> bool;
}

/// Bounds of a primitive; [`Bounds::EMPTY`] for what is none.
#[must_use]
pub fn primitive_bounds(scene: &SceneView, prim: PrimRef, shutter: Shutter) -> Bounds {
    let i = prim.index();
    match prim.kind() {
        Some(PrimKind::Sphere) => scene.spheres.get(i).bounds(shutter),
        Some(PrimKind::MovingSphere) => scene.moving_spheres.get(i).bounds(shutter),
        Some(PrimKind::Quad) => scene.quads.get(i).bounds(shutter),
        Some(PrimKind::Box) => scene.boxes.get(i).bounds(shutter),
        Some(PrimKind::Triangle) => scene.triangles.get(i).bounds(shutter),
        Some(PrimKind::MeshTriangle) => scene.mesh_triangles.get(i).bounds(scene),
        Some(PrimKind::Disk) => scene.disks.get(i).bounds(shutter),
        Some(PrimKind::Cylinder) => scene.cylinders.get(i).bounds(shutter),
        Some(PrimKind::PartialSphere) => scene.partial_spheres.get(i).bounds(shutter),
        Some(PrimKind::MeshPatch) => scene.mesh_patches.get(i).bounds(scene),
        Some(PrimKind::Curve) => scene.curves.get(i).bounds(),
        Some(PrimKind::Instance) => scene.instances.get(i).bounds(scene, shutter),
        Some(PrimKind::Medium) => {
            let medium = scene.media.get(i);
            let bounds = primitive_bounds(scene, medium.boundary, shutter);
            match medium.placement(scene) {
                Some(placement) => placement.bounds(bounds),
                None => bounds,
            }
        }
        Some(PrimKind::Node) | None => Bounds::EMPTY,
    }
}

/// Parameter at which a ray that entered the bounds of `prim` at `t_enter` hits it. Both are in the
/// space that the primitive is in; instances are left to the traversal.
#[inline(always)]
#[must_use]
pub fn intersect_primitive(
    scene: &SceneView,
    prim: PrimRef,
    ray: &Ray,
    sampler: &Sampler,
    t_enter: f32,
) -> Option<f32> {
    let i = prim.index();
    let has = |kind| scene.kinds.has_prim(kind);
    let t = match prim.kind() {
        Some(kind @ PrimKind::Sphere) if has(kind) => scene.spheres.get(i).intersect(ray),
        Some(kind @ PrimKind::MovingSphere) if has(kind) => {
            scene.moving_spheres.get(i).intersect(ray)
        }
        Some(kind @ PrimKind::Quad) if has(kind) => scene.quads.get(i).intersect(ray),
        Some(kind @ PrimKind::Box) if has(kind) => scene.boxes.get(i).intersect(ray),
        Some(kind @ PrimKind::Triangle) if has(kind) => scene.triangles.get(i).intersect(ray),
        Some(kind @ PrimKind::MeshTriangle) if has(kind) => {
            scene.mesh_triangles.get(i).intersect(scene, ray)
        }
        Some(kind @ PrimKind::Disk) if has(kind) => scene.disks.get(i).intersect(ray),
        Some(kind @ PrimKind::Cylinder) if has(kind) => scene.cylinders.get(i).intersect(ray),
        Some(kind @ PrimKind::PartialSphere) if has(kind) => {
            scene.partial_spheres.get(i).intersect(ray)
        }
        Some(kind @ PrimKind::MeshPatch) if has(kind) => {
            scene.mesh_patches.get(i).intersect(scene, ray)
        }
        Some(kind @ PrimKind::Curve) if has(kind) => scene.curves.get(i).intersect(scene, ray),
        Some(kind @ PrimKind::Medium) if has(kind) => {
            scene.media.get(i).intersect(scene, i, ray, sampler, t_enter)
        }
        _ => None,
    };
    t.map(|t| max(t, t_enter))
}

/// What is where a ray hits a surface.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn surface_interaction(scene: &SceneView, hit: &Hit, ray: &Ray) -> SurfaceInteraction {
    if scene.kinds.has_prim(PrimKind::Instance) && hit.instance != NO_INSTANCE {
        let instance = scene.instances.get(hit.instance);
        let placement = instance.placement_at(scene, ray.time);
        let local = local_interaction(scene, hit.prim, &placement.object_ray(ray), hit.t);
        instance.to_world(&placement, &local)
    } else {
        local_interaction(scene, hit.prim, ray, hit.t)
    }
}

/// What is at the hit of a ray on the surface `prim`, in the space of both.
#[inline(always)]
#[must_use]
fn local_interaction(scene: &SceneView, prim: PrimRef, ray: &Ray, t: f32) -> SurfaceInteraction {
    let i = prim.index();
    let has = |kind| scene.kinds.has_prim(kind);
    match prim.kind() {
        Some(kind @ PrimKind::Sphere) if has(kind) => scene.spheres.get(i).interaction(ray, t),
        Some(kind @ PrimKind::MovingSphere) if has(kind) => {
            scene.moving_spheres.get(i).interaction(ray, t)
        }
        Some(kind @ PrimKind::Quad) if has(kind) => scene.quads.get(i).interaction(ray, t),
        Some(kind @ PrimKind::Box) if has(kind) => scene.boxes.get(i).interaction(ray, t),
        Some(kind @ PrimKind::Triangle) if has(kind) => scene.triangles.get(i).interaction(ray, t),
        Some(kind @ PrimKind::MeshTriangle) if has(kind) => {
            scene.mesh_triangles.get(i).interaction(scene, ray)
        }
        Some(kind @ PrimKind::Disk) if has(kind) => scene.disks.get(i).interaction(ray, t),
        Some(kind @ PrimKind::Cylinder) if has(kind) => scene.cylinders.get(i).interaction(ray, t),
        Some(kind @ PrimKind::PartialSphere) if has(kind) => {
            scene.partial_spheres.get(i).interaction(ray, t)
        }
        Some(kind @ PrimKind::MeshPatch) if has(kind) => {
            scene.mesh_patches.get(i).interaction(scene, ray)
        }
        Some(kind @ PrimKind::Curve) if has(kind) => scene.curves.get(i).interaction(scene, ray),
        // Not surfaces: never asked for.
        _ => SurfaceInteraction::plain(ray.at(t), Vec3::ZERO, Vec3::ZERO, MaterialRef::default()),
    }
}

/// Part of the ray inside the boundary of a medium; see [`Convex`].
#[inline(always)]
#[must_use]
pub fn boundary_interval(
    scene: &SceneView,
    boundary: PrimRef,
    placement: Option<Placement>,
    ray: &Ray,
) -> Option<[f32; 2]> {
    let simple = |prim: PrimRef, ray: &Ray| {
        let i = prim.index();
        match prim.kind() {
            Some(PrimKind::Sphere) => scene.spheres.get(i).interval(ray),
            Some(PrimKind::MovingSphere) => scene.moving_spheres.get(i).interval(ray),
            Some(PrimKind::Box) => scene.boxes.get(i).interval(ray),
            _ => None,
        }
    };
    match placement {
        Some(placement) => simple(boundary, &placement.object_ray(ray)),
        None => simple(boundary, ray),
    }
}

/// Whether a world-space point is certainly inside the boundary of a medium; see [`Convex`].
#[inline(always)]
#[must_use]
pub fn boundary_surely_contains(
    scene: &SceneView,
    boundary: PrimRef,
    placement: Option<Placement>,
    p: Vec3,
    p_error: Vec3,
    time: f32,
) -> bool {
    let simple = |prim: PrimRef, p: Vec3, p_error: Vec3| {
        let i = prim.index();
        match prim.kind() {
            Some(PrimKind::Sphere) => scene.spheres.get(i).surely_contains(p, p_error, time),
            Some(PrimKind::MovingSphere) => {
                scene.moving_spheres.get(i).surely_contains(p, p_error, time)
            }
            Some(PrimKind::Box) => scene.boxes.get(i).surely_contains(p, p_error, time),
            _ => false,
        }
    };
    match placement {
        Some(placement) => {
            let to_object = &placement.object_from_world;
            let error = to_object.abs_vector(p_error) + to_object.point_rounding(p);
            simple(boundary, to_object.point(p), error)
        }
        None => simple(boundary, p, p_error),
    }
}
