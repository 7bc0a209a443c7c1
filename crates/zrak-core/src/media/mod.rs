//! Participating media.
//!
//! # To add a medium
//! Write its record and its free flight in a file of its own here, add its array and kind as for a
//! shape, and draw with [`Sampler::free_flight`](crate::sampler::Sampler::free_flight), never with
//! a dimension that depends on the order of visiting.

mod constant;

#[cfg(test)]
mod tests;

pub use constant::ConstantMedium;
