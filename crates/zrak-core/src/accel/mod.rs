//! Finding the closest hit.
//!
//! Every [`Accel`] must return the same hit: the smallest (t, primitive handle) among all primitives
//! whose bounds the ray passes. A tree may visit them in any order.

mod brute_force;
mod bvh;

pub use brute_force::BruteForce;
pub use bvh::{Bvh, Bvh2, Bvh8, MAX_DEPTH, Node};

use crate::interaction::Hit;
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimRef, SceneView};
use crate::shapes::intersect_primitive;

/// A way to find the closest hit.
pub trait Accel: Copy {
    /// The closest hit ahead of the ray's origin. `sampler` decides the free flights in media.
    fn closest_hit(&self, scene: &SceneView, ray: &Ray, sampler: &Sampler) -> Option<Hit>;
}

/// No hit so far: every hit is closer.
const NO_HIT: Hit = Hit { t: f32::INFINITY, prim: PrimRef::NONE };

/// Replaces `best` by the hit of a primitive whose bounds the ray enters at `t_enter`, if that is
/// closer; of equally close ones, the smaller handle counts.
#[inline(always)]
fn keep_closer(
    best: &mut Hit,
    scene: &SceneView,
    prim: PrimRef,
    ray: &Ray,
    sampler: &Sampler,
    t_enter: f32,
) {
    if let Some(t) = intersect_primitive(scene, prim, ray, sampler, t_enter)
        && (t < best.t || (t == best.t && prim < best.prim))
    {
        *best = Hit { t, prim };
    }
}

#[inline(always)]
fn found(best: Hit) -> Option<Hit> {
    if best.prim == PrimRef::NONE { None } else { Some(best) }
}
