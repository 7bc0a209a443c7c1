//! Finding the closest hit.
//!
//! Every [`Accel`] must return the same hit: the smallest (t, primitive handle) among all primitives
//! whose bounds the ray passes. A tree may visit them in any order.

mod brute_force;
mod bvh;

pub use brute_force::BruteForce;
pub use bvh::{Bvh, Bvh2, Bvh8, MAX_DEPTH, Node};

use crate::interaction::{Hit, NO_INSTANCE};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimRef, SceneView};
use crate::shapes::intersect_primitive;

/// A way to find the closest hit.
pub trait Accel: Copy {
    /// The closest hit ahead of the ray's origin and before `t_max`. `sampler` decides the free
    /// flights in media.
    fn closest_hit(
        &self,
        scene: &SceneView,
        ray: &Ray,
        sampler: &Sampler,
        t_max: f32,
    ) -> Option<Hit>;
}

/// No hit so far: every hit before `t_max` is closer.
#[inline(always)]
const fn no_hit(t_max: f32) -> Hit {
    Hit { t: t_max, prim: PrimRef::NONE, instance: NO_INSTANCE }
}

/// Replaces `best` by the hit of a primitive whose bounds the ray enters at `t_enter`, if that is
/// closer; of equally close ones, the smaller handles count. `ray` is in the space of `instance`.
#[inline(always)]
fn keep_closer(
    best: &mut Hit,
    scene: &SceneView,
    (prim, instance): (PrimRef, u32),
    ray: &Ray,
    sampler: &Sampler,
    t_enter: f32,
) {
    if let Some(t) = intersect_primitive(scene, prim, ray, sampler, t_enter)
        && (t < best.t || (t == best.t && (prim, instance) < (best.prim, best.instance)))
    {
        *best = Hit { t, prim, instance };
    }
}

#[inline(always)]
fn found(best: Hit) -> Option<Hit> {
    if best.prim == PrimRef::NONE { None } else { Some(best) }
}
