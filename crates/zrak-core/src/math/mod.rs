//! Arithmetic that gives the same bits on every target.

mod affine;
mod bounds;
mod color;
mod exp;
mod hash;
mod scalar;
mod trig;
mod vec3;
mod warp;

#[cfg(test)]
mod tests;

pub use affine::Affine;
pub use bounds::{Bounds, SLAB_SLACK, Slab};
pub use color::Color;
pub use exp::exp;
pub use hash::{lowbias32, pcg3d, pcg4d, unit_f32};
pub use scalar::{
    EPSILON, abs, floor, gamma, lerp, max, min, next_down, next_up, reciprocal_or_huge, sqrt,
};
pub use trig::{atan2, ln, sin, sin_cos_turns};
pub use vec3::{Vec3, cross, dot, vec3};
pub use warp::{
    equal_area_sphere_to_square, equal_area_square_to_sphere, square_to_uniform_disk,
    square_to_uniform_sphere,
};
