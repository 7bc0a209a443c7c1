//! PNG: every colour type and depth. Up to 8 bits become 8-bit codes, 16 bits stay.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Limits as PngLimits, Transformations};

use super::{Limits, Texels, TextureImage};
use crate::error::Fault;

/// Room for the decoder's own needs: text chunks, a palette, a few rows.
const WORKING_BYTES: usize = 64 << 20;

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_limits(PngLimits { bytes: WORKING_BYTES });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // Palettes, transparent colours and depths below 8 bits become 8-bit channels.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(fault)?;
    let (width, height) = (header.width, header.height);
    let is_deep = header.bit_depth == BitDepth::Sixteen;
    let bytes_per_texel = if is_deep { 8 } else { 4 };
    let n_texels = limits.check(width.into(), height.into(), bytes_per_texel)?;

    let mut reader = decoder.read_info().map_err(fault)?;
    let n_channels = match reader.output_color_type().0 {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        ColorType::Indexed => return Err(Fault::unsupported("its palette was not expanded")),
    };
    let n_samples = n_texels * n_channels;
    let mut samples = vec![0; if is_deep { 2 * n_samples } else { n_samples }];
    reader.next_frame(&mut samples).map_err(fault)?;
    // The end of the file has to be there as well, or it was cut off.
    reader.finish().map_err(fault)?;

    let texels = if is_deep {
        let code = |texel: &[u8], channel: usize| {
            u16::from_be_bytes([texel[2 * channel], texel[2 * channel + 1]])
        };
        Texels::Srgb16(
            samples
                .chunks_exact(2 * n_channels)
                .map(|texel| {
                    let c = |channel| code(texel, channel);
                    match n_channels {
                        1 => [c(0), c(0), c(0), u16::MAX],
                        2 => [c(0), c(0), c(0), c(1)],
                        3 => [c(0), c(1), c(2), u16::MAX],
                        _ => [c(0), c(1), c(2), c(3)],
                    }
                })
                .collect(),
        )
    } else {
        Texels::Srgb8(
            samples
                .chunks_exact(n_channels)
                .map(|texel| match *texel {
                    [grey] => [grey, grey, grey, 255],
                    [grey, alpha] => [grey, grey, grey, alpha],
                    [r, g, b] => [r, g, b, 255],
                    _ => [texel[0], texel[1], texel[2], texel[3]],
                })
                .collect(),
        )
    };
    Ok(TextureImage { width, height, texels })
}

fn fault(cause: DecodingError) -> Fault {
    match cause {
        DecodingError::LimitsExceeded => {
            Fault::unsupported("its chunks need more memory than any image should")
        }
        cause => Fault::damaged(cause),
    }
}
