//! Builders of bounding volume hierarchies.
//!
//! The tree never changes the picture (see [`zrak_core::accel`]), so everything here is about speed
//! alone, and may change freely.

mod binary;
mod collapse;
mod emit;

#[cfg(test)]
mod tests;

pub use binary::{BinaryTree, build};
pub use emit::{Trees, build_trees};
