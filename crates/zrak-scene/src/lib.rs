//! Scenes: their description, their files, and their lowering to the arena that renders.

pub mod builtin;
pub mod desc;

mod suggest;
