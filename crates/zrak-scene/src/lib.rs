//! Scenes: their description, their files, and their lowering to the arena that renders.

pub mod arena;
pub mod builtin;
pub mod compiled;
pub mod defaults;
pub mod desc;
pub mod error;
pub mod file;
pub mod lower;
pub mod progress;
pub mod schema;
pub mod validate;

pub mod suggest;
