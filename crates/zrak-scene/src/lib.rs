//! Scenes: their description, their files, and their lowering to the arena that renders.

pub mod desc;
