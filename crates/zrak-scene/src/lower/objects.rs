//! Shapes and media: brought into world space where their type allows it, put under an instance
//! where not.

use std::collections::HashMap;

use zrak_core::math::{Vec3, vec3};
use zrak_core::media::ConstantMedium;
use zrak_core::scene::{MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{Box3, Instance, MovingSphere, NEEDS_UV, Quad, Sphere, Triangle};

use super::surfaces::LoweredMaterial;
use super::transform::Transform;
use crate::arena::SceneArrays;
use crate::desc::{BoundaryDesc, ObjectDesc, SceneDesc, Triple};

/// Lowers all objects; returns the primitives that rays are traced against.
pub(super) fn lower(
    desc: &SceneDesc,
    materials: &HashMap<&str, LoweredMaterial>,
    arrays: &mut SceneArrays,
) -> Vec<PrimRef> {
    let mut lowering = Lowering { materials, arrays, prims: Vec::new() };
    for object in &desc.objects {
        lowering.object(object, &Transform::IDENTITY);
    }
    lowering.prims
}

struct Lowering<'a> {
    materials: &'a HashMap<&'a str, LoweredMaterial>,
    arrays: &'a mut SceneArrays,
    prims: Vec<PrimRef>,
}

/// Material of the boundaries of media: never looked at.
const NO_MATERIAL: LoweredMaterial = LoweredMaterial {
    handle: MaterialRef::new(zrak_core::scene::MaterialKind::Isotropic, 0),
    needs_uv: false,
};

fn single(v: Triple) -> Vec3 {
    let [x, y, z] = v.map(|x| x as f32);
    vec3(x, y, z)
}

impl Lowering<'_> {
    fn object(&mut self, object: &ObjectDesc, parent: &Transform) {
        match object {
            ObjectDesc::Sphere { center, center_end, radius, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                let prim = self.sphere(*center, *center_end, *radius, material, &to_world);
                self.prims.push(prim);
            }
            ObjectDesc::Box { min, max, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                let prim = self.box3(*min, *max, material, &to_world);
                self.prims.push(prim);
            }
            ObjectDesc::Quad { corner, u, v, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                self.arrays.quads.push(quad(*corner, *u, *v, material.handle, &to_world));
                let index = self.arrays.quads.len() as u32 - 1;
                self.prims.push(PrimRef::new(PrimKind::Quad, index));
            }
            ObjectDesc::Triangle { vertices, uv, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                let triangle = triangle(*vertices, *uv, material.handle, &to_world);
                self.arrays.triangles.push(triangle);
                let index = self.arrays.triangles.len() as u32 - 1;
                self.prims.push(PrimRef::new(PrimKind::Triangle, index));
            }
            ObjectDesc::Medium { boundary, density, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let boundary = match boundary {
                    BoundaryDesc::Sphere { center, center_end, radius, transform } => {
                        let to_world = Transform::of_steps(transform).then(&to_world);
                        self.sphere(*center, *center_end, *radius, NO_MATERIAL, &to_world)
                    }
                    BoundaryDesc::Box { min, max, transform } => {
                        let to_world = Transform::of_steps(transform).then(&to_world);
                        self.box3(*min, *max, NO_MATERIAL, &to_world)
                    }
                };
                self.arrays.media.push(ConstantMedium {
                    boundary,
                    material: self.materials[material.as_str()].handle,
                    neg_mean_free_path: (-1.0 / density) as f32,
                    _pad: 0,
                });
                let index = self.arrays.media.len() as u32 - 1;
                self.prims.push(PrimRef::new(PrimKind::Medium, index));
            }
            ObjectDesc::Mesh { .. }
            | ObjectDesc::Disk { .. }
            | ObjectDesc::Cylinder { .. }
            | ObjectDesc::Instance { .. } => {}
            ObjectDesc::Group { objects, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                for object in objects {
                    self.object(object, &to_world);
                }
            }
        }
    }

    fn sphere(
        &mut self,
        center: Triple,
        center_end: Option<Triple>,
        radius: f64,
        material: LoweredMaterial,
        to_world: &Transform,
    ) -> PrimRef {
        // A turned sphere is the same sphere, unless its texture turns with it.
        let scale =
            to_world.uniform_scale().filter(|_| !material.needs_uv || to_world.keeps_axes());
        let (place, scale) = match scale {
            Some(scale) => (*to_world, scale),
            None => (Transform::IDENTITY, 1.0),
        };
        let start = place.point(center);
        let flags = if material.needs_uv { NEEDS_UV } else { 0 };
        let prim = match center_end {
            None => {
                self.arrays.spheres.push(Sphere {
                    center: single(start),
                    radius: (radius * scale) as f32,
                    material: material.handle,
                    flags,
                    _pad: [0; 2],
                });
                PrimRef::new(PrimKind::Sphere, self.arrays.spheres.len() as u32 - 1)
            }
            Some(end) => {
                let end = place.point(end);
                self.arrays.moving_spheres.push(MovingSphere {
                    center: single(start),
                    radius: (radius * scale) as f32,
                    displacement: single([end[0] - start[0], end[1] - start[1], end[2] - start[2]]),
                    material: material.handle,
                    flags,
                    _pad: [0; 3],
                });
                let index = self.arrays.moving_spheres.len() as u32 - 1;
                PrimRef::new(PrimKind::MovingSphere, index)
            }
        };
        if to_world.uniform_scale().is_some() && place == *to_world {
            prim
        } else {
            self.instance(prim, to_world)
        }
    }

    fn box3(
        &mut self,
        min: Triple,
        max: Triple,
        material: LoweredMaterial,
        to_world: &Transform,
    ) -> PrimRef {
        let is_plain = to_world.keeps_axes();
        let place = if is_plain { *to_world } else { Transform::IDENTITY };
        self.arrays.boxes.push(Box3 {
            lo: single(place.point(min)),
            material: material.handle,
            hi: single(place.point(max)),
            _pad: 0,
        });
        let prim = PrimRef::new(PrimKind::Box, self.arrays.boxes.len() as u32 - 1);
        if is_plain { prim } else { self.instance(prim, to_world) }
    }

    fn instance(&mut self, target: PrimRef, to_world: &Transform) -> PrimRef {
        // Validation refuses maps that cannot be inverted.
        let back = to_world.inverse().unwrap_or(Transform::IDENTITY);
        self.arrays.instances.push(Instance {
            world_from_object: to_world.to_affine(),
            object_from_world: back.to_affine(),
            target,
            _pad: [0; 3],
        });
        PrimRef::new(PrimKind::Instance, self.arrays.instances.len() as u32 - 1)
    }
}

fn quad(corner: Triple, u: Triple, v: Triple, material: MaterialRef, to_world: &Transform) -> Quad {
    let (u, v) = (single(to_world.vector(u)), single(to_world.vector(v)));
    let mut quad = Quad::new(single(to_world.point(corner)), u, v, material);
    // A reflection turns u x v around, but the side that shines is still the same one.
    if to_world.determinant() < 0.0 {
        quad.normal = -quad.normal;
    }
    quad
}

fn triangle(
    vertices: [Triple; 3],
    uv: [[f64; 2]; 3],
    material: MaterialRef,
    to_world: &Transform,
) -> Triangle {
    let mut vertices = vertices.map(|p| single(to_world.point(p)));
    let mut uv = uv.map(|c| c.map(|x| x as f32));
    // A reflection turns the order of the corners around.
    if to_world.determinant() < 0.0 {
        vertices.swap(1, 2);
        uv.swap(1, 2);
    }
    Triangle { vertices, uv, material }
}
