//! Tests.

mod boxes;
mod curve;
mod instance;
mod mesh;
mod parts;
mod patch;
mod quad;
mod round;
mod spawn;
mod sphere;
mod triangle;
mod watertight;

use crate::interaction::SurfaceInteraction;
use crate::math::Vec3;
use crate::testing::{D3, dot, double, length};

/// Asserts what holds for every interaction: a unit normal, and a sane error.
fn check_interaction(s: &SurfaceInteraction) {
    assert!((length(double(s.n)) - 1.0).abs() < 5e-7, "{s:?}");
    assert!(s.p_error.to_array().iter().all(|e| *e >= 0.0 && e.is_finite()), "{s:?}");
}

/// How far the box of errors around a point reaches along a unit normal.
fn reach(p_error: Vec3, n: D3) -> f64 {
    dot(double(p_error), n.map(f64::abs))
}
