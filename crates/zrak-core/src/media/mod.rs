//! Participating media.
//!
//! # To add a medium
//! Write its record and its free flight in a file of its own here, add its array and kind as for a
//! shape, and let `integrators/naive.rs` handle its collisions. Draw with
//! [`Sampler::free_flight`](crate::sampler::Sampler::free_flight), with indices that no other medium
//! has, never with a dimension that depends on the order of visiting.

mod constant;
mod homogeneous;

#[cfg(test)]
mod tests;

pub use constant::{ConstantMedium, NO_PLACEMENT};
pub use homogeneous::{
    Flight, HomogeneousMedium, VACUUM, henyey_greenstein, sample_henyey_greenstein, tangents,
};
