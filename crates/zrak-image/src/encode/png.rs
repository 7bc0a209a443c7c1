//! PNG (ISO/IEC 15948): 8-bit RGB, its transfer curve and the render's metadata as text.

use png::{BitDepth, ColorType, Encoder, EncodingError, ScaledFloat, SrgbRenderingIntent};

use super::{Transfer, quantise};
use crate::{Error, ErrorKind, Metadata, Picture};

pub(super) fn encode(
    picture: &Picture,
    metadata: Option<&Metadata>,
    transfer: Transfer,
) -> Result<Vec<u8>, Error> {
    encode_rgb8(picture, &quantise(picture, transfer), metadata, transfer).map_err(|cause| {
        let (width, height) = (picture.width, picture.height);
        Error::new(
            ErrorKind::InvalidInput,
            format!("cannot encode a {width}x{height} PNG: {cause}; write EXR or PFM instead"),
        )
    })
}

fn encode_rgb8(
    picture: &Picture,
    rgb: &[u8],
    metadata: Option<&Metadata>,
    transfer: Transfer,
) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    match transfer {
        Transfer::Srgb => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
        // The chunk holds the exponent of encoding.
        Transfer::Gamma2 => encoder.set_source_gamma(ScaledFloat::new(0.5)),
    }
    for (name, text) in metadata.iter().flat_map(|metadata| metadata.to_text()) {
        // tEXt is Latin-1, which most readers take for ASCII; anything else goes to UTF-8 iTXt.
        if text.is_ascii() {
            encoder.add_text_chunk(name.to_owned(), text)?;
        } else {
            encoder.add_itxt_chunk(name.to_owned(), text)?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(bytes)
}
