//! The processor backend: the reference, on one thread or on all.

mod backend;
mod tile;

#[cfg(test)]
mod tests;

pub use backend::{CpuBackend, Tree};
pub use tile::instruction_set;
