//! Medium of constant density.
//!
//! The distance to the first collision is exponentially distributed: with extinction coefficient
//! s, the chance to get farther than x is exp(-s x), so x = -ln(1 - u) / s. Each medium draws its own
//! distance along the part of the ray inside its boundary, and the nearest of all events is taken:
//! the minimum of independent exponentials has the sum of their coefficients, so overlapping media
//! add up. No state says which media a ray is in, hence none can be wrong: a camera may stand
//! inside, and a boundary may touch or coincide with other surfaces.

use bytemuck::{Pod, Zeroable};

use crate::math::{gamma, ln, max, min};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{MaterialRef, PrimRef, SceneView};
use crate::shapes::{Placement, boundary_interval, boundary_surely_contains};

/// Homogeneous medium inside a closed convex boundary.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct ConstantMedium {
    /// A sphere, moving sphere or box.
    pub boundary: PrimRef,
    /// Its phase function.
    pub material: MaterialRef,
    /// Mean free path with the sign turned: -1 over the extinction coefficient.
    pub neg_mean_free_path: f32,
    /// Index of the map that places the boundary, or [`NO_PLACEMENT`].
    pub placement: u32,
}

const _: () = assert!(size_of::<ConstantMedium>() == 16);

/// Index that stands for no map.
pub const NO_PLACEMENT: u32 = u32::MAX;

impl ConstantMedium {
    /// The map that places the boundary, if there is one.
    #[inline(always)]
    #[must_use]
    pub fn placement(&self, scene: &SceneView) -> Option<Placement> {
        if self.placement == NO_PLACEMENT {
            None
        } else {
            Some(scene.placements.get(self.placement))
        }
    }

    /// Parameter of the first collision of a unit-length ray, at least `t_enter`; `index` is the
    /// medium's own.
    #[inline(always)]
    #[must_use]
    pub fn intersect(
        &self,
        scene: &SceneView,
        index: u32,
        ray: &Ray,
        sampler: &Sampler,
        t_enter: f32,
    ) -> Option<f32> {
        let placement = self.placement(scene);
        let [start, end] = boundary_interval(scene, self.boundary, placement, ray)?;
        let u = sampler.free_flight(index);
        let mut t = max(start + self.neg_mean_free_path * ln(1.0 - u), t_enter);
        if t >= end {
            return None;
        }
        // From a point that rounding put outside, light would leave without crossing the surface that
        // the medium fills. So an event within rounding of where the ray enters is moved on until it
        // is inside for certain, at most to the middle, and one within rounding of where it leaves is
        // not taken. Dropping both would let light through a medium whose free paths are that short.
        let middle = 0.5 * (start + end);
        let mut step = (middle - t) * (1.0 / 1_048_576.0);
        let mut inside = false;
        let mut searching = true;
        while searching {
            let p = ray.at(t);
            let p_error = (ray.o.abs() + (ray.d * t).abs()) * gamma(3);
            inside =
                boundary_surely_contains(scene, self.boundary, placement, p, p_error, ray.time);
            searching = !inside && t < middle;
            if searching {
                // Never zero, or a boundary smaller than the smallest numbers would keep the search here.
                step = 4.0 * max(step, max(p_error.max_component(), f32::MIN_POSITIVE));
                t = min(t + step, middle);
            }
        }
        if inside { Some(t) } else { None }
    }
}
