//! Tests.

mod checker;
mod image;
mod noise;
