//! Shapes, meshes, instances and media: brought into world space where their type allows it, put
//! under an instance where not.
//!
//! The renderer knows two levels: a tree over the world, and trees under instances. Prototypes that
//! place other prototypes are flattened: what is placed is a *part*, a set of primitives with a map,
//! and placing a prototype places each of its parts under the product of the maps.

use std::collections::HashMap;
use std::rc::Rc;

use zrak_core::math::{Vec3, vec3};
use zrak_core::media::{ConstantMedium, NO_PLACEMENT};
use zrak_core::scene::{MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{
    Box3, Cylinder, Disk, Instance, Motion, MovingSphere, NEEDS_UV, NO_MOTION, PartialSphere,
    Placement, Quad, Sphere, Triangle,
};

use super::budget;
use super::curves::{self, CurveParts};
use super::meshes::Meshes;
use super::surfaces::LoweredMaterial;
use super::transform::Transform;
use crate::arena::SceneArrays;
use crate::desc::{BoundaryDesc, ObjectDesc, SceneDesc, TransformStep, Triple};
use crate::validate::Problem;

/// Most instances that a scene may have once its prototypes are flattened.
pub(super) const INSTANCES_MAX: usize = 1 << 26;

/// What the lowering of the objects leaves to be built: trees over sets of primitives.
pub(super) struct LoweredObjects {
    /// The primitives of the world, without its instances.
    pub(super) world: Vec<PrimRef>,
    /// Sets of primitives that instances place.
    pub(super) sets: Vec<Vec<PrimRef>>,
    /// For each instance of the arrays, the set that it places.
    pub(super) set_of_instance: Vec<u32>,
}

impl LoweredObjects {
    /// About the bytes of the trees over all of it: a binary node for each primitive, and a wide one for
    /// every third.
    pub(super) fn n_tree_bytes(&self, n_instances: usize) -> u64 {
        let nodes = |n: usize| n as u64 * 64 + n.div_ceil(3) as u64 * 256;
        self.sets.iter().map(|set| nodes(set.len().max(1))).sum::<u64>()
            + nodes(self.world.len() + n_instances)
    }
}

/// A set of primitives, and where it stands.
#[derive(Clone, Copy)]
struct Part {
    set: u32,
    start: Transform,
    /// Where it is at time 1, if it moves.
    end: Option<Transform>,
}

/// What a list of objects comes to: primitives in its own space, and parts.
#[derive(Default)]
struct Content {
    prims: Vec<PrimRef>,
    parts: Vec<Part>,
    /// The set that the curves before were put into, and its map.
    curves: Option<(Transform, u32)>,
}

/// Lowers all objects.
pub(super) fn lower(
    desc: &SceneDesc,
    materials: &HashMap<&str, LoweredMaterial>,
    meshes: &mut Meshes<'_>,
    arrays: &mut SceneArrays,
) -> Result<LoweredObjects, Vec<Problem>> {
    let mut lowering = Lowering {
        desc,
        materials,
        meshes,
        arrays,
        sets: Vec::new(),
        set_of_instance: Vec::new(),
        prototypes: HashMap::new(),
        mesh_sets: HashMap::new(),
        problems: Vec::new(),
    };
    let content = lowering.content(&desc.objects);
    for part in &content.parts {
        lowering.place(part);
    }
    if !lowering.problems.is_empty() {
        return Err(lowering.problems);
    }
    let Lowering { sets, set_of_instance, .. } = lowering;
    Ok(LoweredObjects { world: content.prims, sets, set_of_instance })
}

struct Lowering<'a, 'b, 'm> {
    desc: &'a SceneDesc,
    materials: &'b HashMap<&'a str, LoweredMaterial>,
    meshes: &'b mut Meshes<'m>,
    arrays: &'b mut SceneArrays,
    sets: Vec<Vec<PrimRef>>,
    set_of_instance: Vec<u32>,
    prototypes: HashMap<&'a str, Rc<Vec<Part>>>,
    /// Sets of meshes that are placed more than once, by mesh and materials.
    mesh_sets: HashMap<(&'a str, Vec<MaterialRef>, bool), u32>,
    problems: Vec<Problem>,
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

impl<'a> Lowering<'a, '_, '_> {
    fn content(&mut self, objects: &'a [ObjectDesc]) -> Content {
        let mut content = Content::default();
        for object in objects {
            self.object(object, &Transform::IDENTITY, &mut content);
        }
        content
    }

    fn object(&mut self, object: &'a ObjectDesc, parent: &Transform, content: &mut Content) {
        match object {
            ObjectDesc::Sphere {
                center,
                center_end,
                radius,
                z_min,
                z_max,
                phi_max_deg,
                material,
                transform,
            } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                if z_min.is_some() || z_max.is_some() || phi_max_deg.is_some() {
                    let part = partial_sphere(
                        *radius,
                        [z_min.unwrap_or(-radius), z_max.unwrap_or(*radius)],
                        phi_max_deg.unwrap_or(360.0),
                        material.handle,
                    );
                    self.arrays.partial_spheres.push(part);
                    let index = self.arrays.partial_spheres.len() as u32 - 1;
                    let prim = PrimRef::new(PrimKind::PartialSphere, index);
                    let at = |center: Triple| {
                        Transform::of_steps(&[TransformStep::Translate(center)]).then(&to_world)
                    };
                    let start = at(*center);
                    let end = center_end.map(at);
                    if start == Transform::IDENTITY && end.is_none() {
                        content.prims.push(prim);
                    } else {
                        self.sets.push(vec![prim]);
                        let set = self.sets.len() as u32 - 1;
                        content.parts.push(Part { set, start, end });
                    }
                    return;
                }
                let (prim, placed) =
                    self.sphere(*center, *center_end, *radius, material, &to_world);
                self.put(prim, placed.then_some(to_world), content);
            }
            ObjectDesc::Box { min, max, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                let (prim, placed) = self.box3(*min, *max, material, &to_world);
                self.put(prim, placed.then_some(to_world), content);
            }
            ObjectDesc::Quad { corner, u, v, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                self.arrays.quads.push(quad(*corner, *u, *v, material.handle, &to_world));
                let index = self.arrays.quads.len() as u32 - 1;
                content.prims.push(PrimRef::new(PrimKind::Quad, index));
            }
            ObjectDesc::Triangle { vertices, uv, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()];
                let triangle = triangle(*vertices, *uv, material.handle, &to_world);
                self.arrays.triangles.push(triangle);
                let index = self.arrays.triangles.len() as u32 - 1;
                content.prims.push(PrimRef::new(PrimKind::Triangle, index));
            }
            ObjectDesc::Disk { height, radius, inner_radius, phi_max_deg, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()].handle;
                let sizes = [*height, *radius, *inner_radius, *phi_max_deg];
                self.arrays.disks.push(disk(sizes, material, &to_world));
                let index = self.arrays.disks.len() as u32 - 1;
                content.prims.push(PrimRef::new(PrimKind::Disk, index));
            }
            ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                self.arrays.cylinders.push(Cylinder {
                    radius: *radius as f32,
                    z_min: *z_min as f32,
                    z_max: *z_max as f32,
                    phi_max: phi_max_deg.to_radians() as f32,
                    material: self.materials[material.as_str()].handle,
                    _pad: [0; 3],
                });
                let index = self.arrays.cylinders.len() as u32 - 1;
                let prim = PrimRef::new(PrimKind::Cylinder, index);
                self.put(prim, (to_world != Transform::IDENTITY).then_some(to_world), content);
            }
            ObjectDesc::Curve { points, widths, form, normals, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let material = self.materials[material.as_str()].handle;
                let curve = CurveParts { points, widths: *widths, form: *form, normals, material };
                self.curve(&curve, &to_world, content);
            }
            ObjectDesc::Mesh { mesh, material, group_materials, flip, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let materials: Vec<MaterialRef> = std::iter::once(material)
                    .chain(group_materials)
                    .map(|name| self.materials[name.as_str()].handle)
                    .collect();
                self.mesh(mesh, materials, *flip, &to_world, content);
            }
            ObjectDesc::Instance { prototype, transform, transform_end } => {
                let start = Transform::of_steps(transform).then(parent);
                let end = transform_end.as_ref().map(|t| Transform::of_steps(t).then(parent));
                let parts = self.prototype(prototype);
                if content.parts.len() + parts.len() > INSTANCES_MAX {
                    let message = format!(
                        "the scene's prototypes come to more than {INSTANCES_MAX} instances once they \
                         are placed"
                    );
                    self.refuse(message, "place fewer of those that contain others");
                    return;
                }
                // Small files can ask for many parts by prototypes in prototypes.
                let n_bytes = parts.len() as u64 * size_of::<Part>() as u64;
                if let Err(message) = self.meshes.budget.spend(n_bytes) {
                    self.refuse(message, budget::HELP);
                    return;
                }
                content.parts.extend(parts.iter().map(|part| Part {
                    set: part.set,
                    start: part.start.then(&start),
                    end: match (part.end, end) {
                        (None, None) => None,
                        (inner, outer) => {
                            Some(inner.unwrap_or(part.start).then(&outer.unwrap_or(start)))
                        }
                    },
                }));
            }
            ObjectDesc::Medium { boundary, density, material, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                let (boundary, placement) = match boundary {
                    BoundaryDesc::Sphere { center, center_end, radius, transform } => {
                        let to_world = Transform::of_steps(transform).then(&to_world);
                        let (prim, placed) =
                            self.sphere(*center, *center_end, *radius, NO_MATERIAL, &to_world);
                        (prim, placed.then_some(to_world))
                    }
                    BoundaryDesc::Box { min, max, transform } => {
                        let to_world = Transform::of_steps(transform).then(&to_world);
                        let (prim, placed) = self.box3(*min, *max, NO_MATERIAL, &to_world);
                        (prim, placed.then_some(to_world))
                    }
                };
                let placement = placement.map_or(NO_PLACEMENT, |to_world| {
                    self.arrays.placements.push(placement_of(&to_world));
                    self.arrays.placements.len() as u32 - 1
                });
                self.arrays.media.push(ConstantMedium {
                    boundary,
                    material: self.materials[material.as_str()].handle,
                    neg_mean_free_path: (-1.0 / density) as f32,
                    placement,
                });
                let index = self.arrays.media.len() as u32 - 1;
                content.prims.push(PrimRef::new(PrimKind::Medium, index));
            }
            ObjectDesc::Group { objects, transform } => {
                let to_world = Transform::of_steps(transform).then(parent);
                for object in objects {
                    self.object(object, &to_world, content);
                }
            }
        }
    }

    /// Adds a primitive: as it is, or under a map as a part of its own.
    fn put(&mut self, prim: PrimRef, map: Option<Transform>, content: &mut Content) {
        match map {
            None => content.prims.push(prim),
            Some(start) => {
                self.sets.push(vec![prim]);
                let set = self.sets.len() as u32 - 1;
                content.parts.push(Part { set, start, end: None });
            }
        }
    }

    /// Adds the parts of a curve: in the world if widths stay widths there, else under the map.
    fn curve(&mut self, curve: &CurveParts<'_>, to_world: &Transform, content: &mut Content) {
        let (map, placed) = match curves::scale(to_world) {
            Some(scale) => (Some((to_world, scale)), false),
            None => (None, true),
        };
        let Some(prims) = curves::add(curve, map, self.arrays) else {
            let message = "the scene's curves come to more than 2^28 parts".to_owned();
            if self.problems.iter().all(|p| p.message != message) {
                self.problems.push(Problem { path: Default::default(), message, help: None });
            }
            return;
        };
        if !placed {
            content.prims.extend(prims);
            return;
        }
        // Hairs come by the thousand under one map: they share an instance.
        match content.curves {
            Some((map, set)) if map == *to_world => self.sets[set as usize].extend(prims),
            _ => {
                self.sets.push(prims.collect());
                let set = self.sets.len() as u32 - 1;
                content.parts.push(Part { set, start: *to_world, end: None });
                content.curves = Some((*to_world, set));
            }
        }
    }

    fn mesh(
        &mut self,
        name: &'a str,
        materials: Vec<MaterialRef>,
        flip: bool,
        to_world: &Transform,
        content: &mut Content,
    ) {
        if !self.meshes.is_shared(name) {
            match self.meshes.add(name, &materials, flip, to_world, self.arrays) {
                Ok(prims) => content.prims.extend(prims),
                Err(problem) => self.problems.push(problem),
            }
            return;
        }
        let key = (name, materials, flip);
        let set = match self.mesh_sets.get(&key) {
            Some(&set) => set,
            None => {
                let identity = Transform::IDENTITY;
                match self.meshes.add(name, &key.1, flip, &identity, self.arrays) {
                    Ok(prims) => self.sets.push(prims.collect()),
                    Err(problem) => {
                        self.problems.push(problem);
                        return;
                    }
                }
                let set = self.sets.len() as u32 - 1;
                self.mesh_sets.insert(key, set);
                set
            }
        };
        content.parts.push(Part { set, start: *to_world, end: None });
    }

    /// The parts of a prototype, lowered when it is first asked for. Validation has made sure that it
    /// exists and does not contain itself.
    fn prototype(&mut self, name: &'a str) -> Rc<Vec<Part>> {
        if let Some(done) = self.prototypes.get(name) {
            return Rc::clone(done);
        }
        let desc = self.desc;
        let mut content = self.content(&desc.prototypes[name]);
        if !content.prims.is_empty() {
            self.sets.push(content.prims);
            let set = self.sets.len() as u32 - 1;
            content.parts.push(Part { set, start: Transform::IDENTITY, end: None });
        }
        let parts = Rc::new(content.parts);
        self.prototypes.insert(name, Rc::clone(&parts));
        parts
    }

    /// Notes a problem of the whole scene, once.
    fn refuse(&mut self, message: String, help: &str) {
        if self.problems.iter().all(|p| p.message != message) {
            let help = Some(help.to_owned());
            self.problems.push(Problem { path: Default::default(), message, help });
        }
    }

    /// Makes an instance of a part.
    fn place(&mut self, part: &Part) {
        let motion = match part.end {
            Some(end) if end != part.start => {
                let motion = Motion { start: part.start.to_affine(), end: end.to_affine() };
                self.arrays.motions.push(motion);
                self.arrays.motions.len() as u32 - 1
            }
            _ => NO_MOTION,
        };
        self.arrays.instances.push(Instance {
            placement: placement_of(&part.start),
            root2: 0,
            root8: 0,
            motion,
            _pad: 0,
        });
        self.set_of_instance.push(part.set);
    }

    /// The primitive, and whether it must be placed by the map; so does the next.
    fn sphere(
        &mut self,
        center: Triple,
        center_end: Option<Triple>,
        radius: f64,
        material: LoweredMaterial,
        to_world: &Transform,
    ) -> (PrimRef, bool) {
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
        (prim, !(to_world.uniform_scale().is_some() && place == *to_world))
    }

    fn box3(
        &mut self,
        min: Triple,
        max: Triple,
        material: LoweredMaterial,
        to_world: &Transform,
    ) -> (PrimRef, bool) {
        let is_plain = to_world.keeps_axes();
        let place = if is_plain { *to_world } else { Transform::IDENTITY };
        self.arrays.boxes.push(Box3 {
            lo: single(place.point(min)),
            material: material.handle,
            hi: single(place.point(max)),
            _pad: 0,
        });
        (PrimRef::new(PrimKind::Box, self.arrays.boxes.len() as u32 - 1), !is_plain)
    }
}

fn placement_of(to_world: &Transform) -> Placement {
    // Validation refuses maps that cannot be inverted.
    let back = to_world.inverse().unwrap_or(Transform::IDENTITY);
    Placement { world_from_object: to_world.to_affine(), object_from_world: back.to_affine() }
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

/// A part of a sphere about the origin.
fn partial_sphere(
    radius: f64,
    [z_min, z_max]: [f64; 2],
    phi_max_deg: f64,
    material: MaterialRef,
) -> PartialSphere {
    let theta = |z: f64| libm::acos((z / radius).clamp(-1.0, 1.0));
    // Where nothing is cut off, rounding must not do it.
    PartialSphere {
        radius: radius as f32,
        z_min: if z_min > -radius { z_min } else { -2.0 * radius } as f32,
        z_max: if z_max < radius { z_max } else { 2.0 * radius } as f32,
        phi_max: phi_max_deg.to_radians() as f32,
        theta_low: theta(z_min) as f32,
        theta_span: (theta(z_max) - theta(z_min)) as f32,
        material,
        _pad: 0,
    }
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

fn disk(
    [height, radius, inner_radius, phi_max_deg]: [f64; 4],
    material: MaterialRef,
    to_world: &Transform,
) -> Disk {
    let scaled = |a: Triple, s: f64| a.map(|x| x * s);
    let dot = |a: Triple, b: Triple| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: Triple, b: Triple| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let u = to_world.vector([radius, 0.0, 0.0]);
    let v = to_world.vector([0.0, radius, 0.0]);
    let across = cross(u, v);
    let area = dot(across, across).sqrt();
    let n = scaled(across, 1.0 / area);
    let side = if to_world.determinant() < 0.0 { -1.0 } else { 1.0 };
    Disk {
        center: single(to_world.point([0.0, 0.0, height])),
        material,
        normal: single(scaled(n, side)),
        inner: (inner_radius / radius) as f32,
        x_axis: single(scaled(cross(v, n), 1.0 / area)),
        phi_max: phi_max_deg.to_radians() as f32,
        y_axis: single(scaled(cross(n, u), 1.0 / area)),
        _pad0: 0,
        u: single(u),
        _pad1: 0,
        v: single(v),
        _pad2: 0,
    }
}
