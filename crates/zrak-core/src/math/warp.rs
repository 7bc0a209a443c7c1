//! Maps of the unit square to other domains, for sampling them uniformly.
//!
//! To add a warp: write `square_to_x` with the measure and density in its docs, and a chi-squared
//! test in `tests.rs`.

use super::scalar::{abs, max, sqrt};
use super::trig::{atan2, sin_cos_turns};
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

/// Direction on the unit sphere for a point of the unit square, so that equal areas stay equal
/// (density 1 / (4 pi) per steradian): +z in the middle of the square, -z at its corners.
///
/// Clarberg, *Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD*, 2008.
#[inline(always)]
#[must_use]
pub fn equal_area_square_to_sphere(x: f32, y: f32) -> Vec3 {
    let (u, v) = (2.0 * x - 1.0, 2.0 * y - 1.0);
    let (au, av) = (abs(u), abs(v));
    let signed_distance = 1.0 - (au + av);
    let r = 1.0 - abs(signed_distance);
    // An eighth of a turn times the place along the side of the square of this radius.
    let turns = if r == 0.0 { 0.125 } else { ((av - au) / r + 1.0) * 0.125 };
    let (s, c) = sin_cos_turns(turns);
    let height = 1.0 - r * r;
    let z = if signed_distance < 0.0 { -height } else { height };
    let reach = r * sqrt(max(0.0, 2.0 - r * r));
    vec3(if u < 0.0 { -c } else { c } * reach, if v < 0.0 { -s } else { s } * reach, z)
}

/// Point of the unit square that [`equal_area_square_to_sphere`] takes to the unit direction `d`.
#[inline(always)]
#[must_use]
pub fn equal_area_sphere_to_square(d: Vec3) -> (f32, f32) {
    let (x, y, z) = (abs(d.x), abs(d.y), abs(d.z));
    let r = sqrt(max(0.0, 1.0 - z));
    // Place along the side of the square of radius r, from 0 to 1.
    let along = atan2(y, x) * core::f32::consts::FRAC_2_PI;
    let (mut u, mut v) = (r * (1.0 - along), r * along);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    let signed = |x: f32, sign: f32| if sign < 0.0 { -x } else { x };
    (0.5 * (1.0 + signed(u, d.x)), 0.5 * (1.0 + signed(v, d.y)))
}

/// Uniform point in the unit disk (density 1 / pi per area), as (x, y): polar coordinates.
#[inline(always)]
#[must_use]
pub fn square_to_uniform_disk(u: f32, v: f32) -> (f32, f32) {
    let r = sqrt(u);
    let (s, c) = sin_cos_turns(v);
    (r * c, r * s)
}
