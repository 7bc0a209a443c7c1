//! Pictures for zrak: textures in, renders out, and their comparison.
//!
//! A [`Picture`] is what a render yields: linear sRGB radiance, three `f32` per pixel.
//! [`write()`] puts it into a PNG, JPEG, Radiance HDR, OpenEXR or PFM file, [`read_picture`] reads
//! it back and [`compare()`] says how two of them differ. [`read_texture`] reads the same formats
//! for a scene, within [`Limits`], and keeps 8-bit texels as they are.
//!
//! Three promises hold for all formats:
//!
//! - **The same on every machine.** A file's bytes are a function of the picture and its
//!   metadata; a texel is a function of the file's bytes. No SIMD decoder, no `f32::powf` (std's
//!   differs by platform) and no hash map's order comes between them.
//! - **Whole or not at all.** A file is written beside its place and renamed (see
//!   [`replace_file`]), so that a full disk never costs the picture that was there before.
//! - **Hostile files are only errors.** Sizes are checked before memory is taken, and damaged
//!   data ends in an [`Error`] that names the file and what to do.

mod compare;
mod decode;
mod encode;
mod error;
mod format;
mod metadata;
mod picture;
mod srgb;

pub use compare::{Comparison, compare};
pub use decode::{
    Limits, Texels, TextureImage, decode_texture, read_image_file, read_picture, read_texture,
    texel_bytes,
};
pub use encode::{
    Transfer, check_replaceable, check_writable, encode, replace_file, replace_file_with, write,
};
pub use error::{Error, ErrorKind};
pub use format::Format;
pub use metadata::Metadata;
pub use picture::Picture;
pub use srgb::{linear_to_srgb8, srgb8_to_linear_table, srgb16_to_linear};
