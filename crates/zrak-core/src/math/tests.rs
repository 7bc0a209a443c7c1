//! Tests.

mod affine;
mod bounds;
mod hash;
mod scalar;
mod trig;
mod warp;
