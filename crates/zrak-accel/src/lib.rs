//! Builders of bounding volume hierarchies.
//!
//! The tree never changes the picture (see [`zrak_core::accel`]), so everything here is about speed
//! alone, and may change freely. It is the same on every machine and any number of threads all the
//! same, so that arenas can be compared.
//!
//! Reading order: [`Trees`], the binary tree (`binary`, `bins`, `sweep`), the wide one made of it
//! (`wide`).

mod binary;
mod bins;
mod progress;
mod record;
mod sah;
mod sweep;
mod trees;
mod wide;

#[cfg(test)]
mod tests;

pub use progress::BuildOptions;
pub use sah::{sah_cost, sah_cost_of};
pub use trees::{Trees, build_trees, build_trees_with};
