//! Makes `assets/earth.png`, the project's own map of the Earth, for textures.
//!
//! `cargo run -p zrak-image --example make_earth -- assets/earth.png`

mod map;
mod noise;
mod outlines;

use std::path::PathBuf;

use zrak_image::{Error, Transfer, write};

fn main() -> Result<(), Error> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "assets/earth.png".into());
    write(&PathBuf::from(path), &map::draw(), None, Transfer::Srgb)
}
