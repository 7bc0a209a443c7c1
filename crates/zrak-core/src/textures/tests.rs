//! Tests.

mod checker;
mod image;
mod image_map;
mod noise;
mod program;
