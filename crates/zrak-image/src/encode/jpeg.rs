//! JPEG: baseline, quality 95, full chroma resolution.
//!
//! The encoder is built without its SIMD paths and computes in integers, so that a picture gives
//! the same bytes everywhere.

use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

use super::{Transfer, quantise};
use crate::{Error, ErrorKind, Picture};

const QUALITY: u8 = 95;

pub(super) fn encode(picture: &Picture, transfer: Transfer) -> Result<Vec<u8>, Error> {
    let too_large = |cause: &str| {
        let (width, height) = (picture.width, picture.height);
        Error::new(
            ErrorKind::InvalidInput,
            format!("cannot encode a {width}x{height} JPEG: {cause}; write PNG or EXR instead"),
        )
    };
    let (Ok(width), Ok(height)) = (u16::try_from(picture.width), u16::try_from(picture.height))
    else {
        return Err(too_large("a side has at most 65535 pixels"));
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, QUALITY);
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    encoder
        .encode(&quantise(picture, transfer), width, height, ColorType::Rgb)
        .map_err(|cause| too_large(&cause.to_string()))?;
    Ok(bytes)
}
