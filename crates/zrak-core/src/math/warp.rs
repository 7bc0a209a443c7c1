//! Maps of the unit square to other domains, for sampling them uniformly.
//!
//! To add a warp: write `square_to_x` with the measure and density in its docs, and a chi-squared
//! test in `tests.rs`.

use super::scalar::{max, sqrt};
use super::trig::sin_cos_turns;
use super::vec3::{Vec3, vec3};

/// Uniform direction on the unit sphere (density 1 / (4 pi) per steradian): cylinder projection.
#[inline(always)]
#[must_use]
pub fn square_to_uniform_sphere(u: f32, v: f32) -> Vec3 {
    let z = 1.0 - 2.0 * u;
    let r = sqrt(max(0.0, 1.0 - z * z));
    let (s, c) = sin_cos_turns(v);
    vec3(r * c, r * s, z)
}

/// Uniform point in the unit disk (density 1 / pi per area), as (x, y): polar coordinates.
#[inline(always)]
#[must_use]
pub fn square_to_uniform_disk(u: f32, v: f32) -> (f32, f32) {
    let r = sqrt(u);
    let (s, c) = sin_cos_turns(v);
    (r * c, r * s)
}
