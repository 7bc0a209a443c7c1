//! Scenes: their description, their files, and their lowering to the arena that renders.

pub mod arena;
pub mod builtin;
pub mod desc;
pub mod lower;

mod suggest;
