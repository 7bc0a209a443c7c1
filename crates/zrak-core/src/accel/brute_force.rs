//! Tests every primitive: the reference that every tree must agree with.

use super::{Accel, NO_HIT, found, keep_closer};
use crate::accessor::Array;
use crate::interaction::Hit;
use crate::math::reciprocal_or_huge;
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimRef, SceneView};
use crate::shapes::primitive_bounds;

/// A list of primitives.
#[derive(Clone, Copy)]
pub struct BruteForce<'a> {
    /// The primitives, in any order.
    pub prims: Array<'a, PrimRef>,
}

impl Accel for BruteForce<'_> {
    fn closest_hit(&self, scene: &SceneView, ray: &Ray, sampler: &Sampler) -> Option<Hit> {
        let camera = &scene.globals.camera;
        let shutter = [camera.shutter_open_s, camera.shutter_close_s];
        let inv_d = ray.d.map(reciprocal_or_huge);
        let mut best = NO_HIT;
        for i in 0..self.prims.len() {
            let prim = self.prims.get(i);
            if let Some(slab) = primitive_bounds(scene, prim, shutter).slab(ray.o, inv_d) {
                keep_closer(&mut best, scene, prim, ray, sampler, slab.t_enter);
            }
        }
        found(best)
    }
}
