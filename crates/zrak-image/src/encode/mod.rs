//! Writing pictures: one codec per file, all into memory, then one atomic replacement.
//!
//! To add a format: 1. name it in [`Format`], with its extension and signature; 2. write its
//! encoder here and its decoder in `decode/`; 3. add it to the `match` of [`encode`] and of
//! `decode`; 4. add it to the round trips in `tests.rs`.

mod exr;
mod hdr;
mod jpeg;
mod pfm;
mod png;
mod replace;
#[cfg(test)]
mod tests;

use std::path::Path;

pub use replace::{check_replaceable, check_writable, replace_file, replace_file_with};

use crate::{Error, Format, Metadata, Picture, srgb};

/// How linear radiance becomes the 8 bits of a PNG or JPEG. The other formats stay linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transfer {
    /// The sRGB curve: what a screen expects.
    #[default]
    Srgb,
    /// The square root, as in "Ray Tracing in One Weekend": for comparison with its pictures.
    Gamma2,
}

/// Writes `picture` to `path` in the format that its extension names.
///
/// The file is replaced whole or not at all; see [`replace_file`].
pub fn write(
    path: &Path,
    picture: &Picture,
    metadata: Option<&Metadata>,
    transfer: Transfer,
) -> Result<(), Error> {
    let format = Format::from_path(path)?;
    replace_file(path, &encode(format, picture, metadata, transfer)?)
}

/// The bytes of a file of `picture`, the same on every machine.
///
/// PNG and JPEG clamp to [0, 1] and show NaN as black. HDR has no negative values, infinities or
/// NaN: it holds 0, its largest value and 0 instead. EXR and PFM keep every bit.
pub fn encode(
    format: Format,
    picture: &Picture,
    metadata: Option<&Metadata>,
    transfer: Transfer,
) -> Result<Vec<u8>, Error> {
    picture.validate()?;
    match format {
        Format::Png => png::encode(picture, metadata, transfer),
        Format::Jpeg => jpeg::encode(picture, transfer),
        Format::Hdr => Ok(hdr::encode(picture, metadata)),
        Format::Exr => exr::encode(picture, metadata),
        Format::Pfm => Ok(pfm::encode(picture)),
    }
}

/// The picture in 8 bits per channel, red, green and blue in turn.
fn quantise(picture: &Picture, transfer: Transfer) -> Vec<u8> {
    let encode_value = match transfer {
        Transfer::Srgb => srgb::linear_to_srgb8,
        Transfer::Gamma2 => srgb::linear_to_gamma2,
    };
    picture.pixels.iter().flatten().map(|&value| encode_value(value)).collect()
}
