//! Tests.

mod affine;
mod bounds;
mod exp;
mod hash;
mod scalar;
mod trig;
mod warp;
