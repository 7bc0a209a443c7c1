//! JPEG, baseline and progressive, to the same bytes on every machine.
//!
//! `zune-jpeg` picks AVX2 or NEON code at run time, and its options cannot turn all of that off:
//! the flags of each instruction set stay on under `set_use_unsafe(false)` and `new_safe()`. So
//! the workspace depends on it without its default features, which leaves only the scalar integer
//! code in the build. A crate that enabled its `x86` or `neon` feature elsewhere in the
//! dependency tree (as `image` does with its `jpeg` feature) would undo this.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::{Limits, Texels, TextureImage};
use crate::error::Fault;

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    // Strict, or a truncated file would be padded with grey.
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(limits.max_width as usize)
        .set_max_height(limits.max_height as usize);

    // The size, before the decoder's own check of it, whose message would be about its options.
    let mut header = JpegDecoder::new_with_options(
        ZCursor::new(bytes),
        options.set_max_width(usize::MAX).set_max_height(usize::MAX),
    );
    header.decode_headers().map_err(Fault::damaged)?;
    let (width, height) = header.dimensions().unwrap_or_default();
    limits.check(width as u64, height as u64, 4)?;
    if !has_end(bytes) {
        return Err(Fault::damaged("its end is missing"));
    }
    let is_grey = header.input_colorspace() == Some(ColorSpace::Luma);

    let colour_space = if is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
    let options = options.jpeg_set_out_colorspace(colour_space);
    let samples = JpegDecoder::new_with_options(ZCursor::new(bytes), options)
        .decode()
        .map_err(Fault::damaged)?;

    let texels: Vec<[u8; 4]> = if is_grey {
        samples.iter().map(|&grey| [grey, grey, grey, 255]).collect()
    } else {
        samples.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect()
    };
    if texels.len() != width * height {
        return Err(Fault::unsupported("its colour space is not grey, YCbCr, RGB or CMYK"));
    }
    Ok(TextureImage { width: width as u32, height: height as u32, texels: Texels::Srgb8(texels) })
}

/// Whether the last scan is followed by the end-of-image marker.
///
/// The decoder reads ahead and does without the last bytes. Within a scan neither marker can
/// occur, and an embedded thumbnail comes before the scans of the image.
fn has_end(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    const START_OF_SCAN: u8 = 0xda;
    const END_OF_IMAGE: u8 = 0xd9;
    last(END_OF_IMAGE) > last(START_OF_SCAN)
}
