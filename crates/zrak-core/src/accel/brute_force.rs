//! Tests every primitive: the reference that every tree must agree with.

use super::{Accel, MAX_DEPTH, found, keep_closer, no_hit};
use crate::accessor::{Array, Stack, StackMemory};
use crate::interaction::{Hit, NO_INSTANCE};
use crate::math::{max, reciprocal_or_huge};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimKind, PrimRef, SceneView};
use crate::shapes::primitive_bounds;

/// A list of primitives.
#[derive(Clone, Copy)]
pub struct BruteForce<'a> {
    /// The primitives, in any order.
    pub prims: Array<'a, PrimRef>,
}

impl Accel for BruteForce<'_> {
    fn closest_hit(
        &self,
        scene: &SceneView,
        ray: &Ray,
        sampler: &Sampler,
        t_max: f32,
    ) -> Option<Hit> {
        let mut best = no_hit(t_max);
        for i in 0..self.prims.len() {
            let prim = self.prims.get(i);
            if prim.kind() == Some(PrimKind::Instance) {
                in_instance(&mut best, scene, prim, ray, sampler);
            } else {
                test(&mut best, scene, (prim, NO_INSTANCE), ray, sampler, 0.0);
            }
        }
        found(best)
    }
}

/// Tests a primitive, if the ray passes its bounds.
fn test(
    best: &mut Hit,
    scene: &SceneView,
    (prim, instance): (PrimRef, u32),
    ray: &Ray,
    sampler: &Sampler,
    t_floor: f32,
) {
    let camera = &scene.globals.camera;
    let shutter = [camera.shutter_open_s, camera.shutter_close_s];
    let inv_d = ray.d.map(reciprocal_or_huge);
    if let Some(slab) = primitive_bounds(scene, prim, shutter).slab(ray.o, inv_d) {
        let t_enter = max(slab.t_enter, t_floor);
        keep_closer(best, scene, (prim, instance), ray, sampler, t_enter);
    }
}

/// Tests every primitive of an instance, if the ray passes its bounds.
fn in_instance(best: &mut Hit, scene: &SceneView, prim: PrimRef, ray: &Ray, sampler: &Sampler) {
    let camera = &scene.globals.camera;
    let shutter = [camera.shutter_open_s, camera.shutter_close_s];
    let inv_d = ray.d.map(reciprocal_or_huge);
    let Some(slab) = primitive_bounds(scene, prim, shutter).slab(ray.o, inv_d) else { return };
    let instance = scene.instances.get(prim.index());
    let local = instance.placement_at(scene, ray.time).object_ray(ray);
    let mut memory = StackMemory::<u32, MAX_DEPTH>::new();
    let mut stack = Stack::new(&mut memory);
    stack.push(instance.root2);
    while let Some(node) = stack.pop() {
        for child in scene.nodes2.get(node).children {
            if child == PrimRef::NONE {
                continue;
            }
            if child.is_node() {
                stack.push(child.index());
            } else {
                let placed = (child, prim.index());
                test(best, scene, placed, &local, sampler, slab.t_enter);
            }
        }
    }
}
