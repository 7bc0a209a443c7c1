//! OpenEXR: scanlines of 32-bit float B, G and R, compressed losslessly by ZIP.
//!
//! Written here, and not by the `exr` crate that reads: that crate keeps attributes in a hash map
//! and so writes them in another order each time. The layout is that of "OpenEXR File Layout"
//! (openexr.com): magic, version, attributes, a table of chunk offsets, chunks of 16 lines.

use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};
use rayon::prelude::*;

use crate::{Error, ErrorKind, Metadata, Picture};

/// Lines per chunk, fixed by the ZIP compression.
const LINES_PER_CHUNK: usize = 16;
/// zlib's own middle way; higher levels gain nothing on the noise of a render.
const ZIP_LEVEL: Compression = Compression::new(6);
/// Rec. 709 primaries and D65 white: x and y of red, green, blue, white.
const CHROMATICITIES: [f32; 8] = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];

pub(super) fn encode(picture: &Picture, metadata: Option<&Metadata>) -> Result<Vec<u8>, Error> {
    let (Ok(width), Ok(height)) = (i32::try_from(picture.width), i32::try_from(picture.height))
    else {
        return Err(Error::new(
            ErrorKind::InvalidInput,
            "cannot encode an EXR with 2^31 pixels or more to a side; render a smaller picture",
        ));
    };
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    push_header(&mut bytes, width, height, metadata);

    let lines: Vec<&[[f32; 3]]> = picture.rows().collect();
    let chunks: Vec<Vec<u8>> = lines.par_chunks(LINES_PER_CHUNK).map(compress).collect();
    let mut offset = (bytes.len() + 8 * chunks.len()) as u64;
    for chunk in &chunks {
        bytes.extend(offset.to_le_bytes());
        offset += 8 + chunk.len() as u64;
    }
    for (chunk_idx, chunk) in chunks.iter().enumerate() {
        bytes.extend(((chunk_idx * LINES_PER_CHUNK) as i32).to_le_bytes());
        bytes.extend((chunk.len() as i32).to_le_bytes());
        bytes.extend(chunk);
    }
    Ok(bytes)
}

/// Appends the attributes: those that every EXR needs, the colour space, and the metadata.
fn push_header(bytes: &mut Vec<u8>, width: i32, height: i32, metadata: Option<&Metadata>) {
    let mut attribute = |name: &str, type_name: &str, value: &[u8]| {
        for text in [name, type_name] {
            bytes.extend(text.as_bytes());
            bytes.push(0);
        }
        bytes.extend((value.len() as i32).to_le_bytes());
        bytes.extend(value);
    };
    let window: Vec<u8> = [0, 0, width - 1, height - 1].map(i32::to_le_bytes).concat();

    attribute("channels", "chlist", &channel_list());
    attribute("chromaticities", "chromaticities", &CHROMATICITIES.map(f32::to_le_bytes).concat());
    attribute("compression", "compression", &[3]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    if let Some(metadata) = metadata {
        for (name, text) in metadata.to_text() {
            match name {
                "samplesPerPixel" => {
                    let samples = i32::try_from(metadata.samples_per_pixel).unwrap_or(i32::MAX);
                    attribute(name, "int", &samples.to_le_bytes());
                }
                "renderTime" => attribute(name, "double", &metadata.render_time_s.to_le_bytes()),
                _ => attribute(name, "string", text.as_bytes()),
            }
        }
    }
    bytes.push(0);
}

/// The channels in the order of their names: 32-bit float, not subsampled.
fn channel_list() -> Vec<u8> {
    const FLOAT: i32 = 2;
    let mut list = Vec::new();
    for name in [b'B', b'G', b'R'] {
        list.extend([name, 0]);
        // Type; the linear flag and three reserved bytes; x and y sampling.
        list.extend([FLOAT, 0, 1, 1].map(i32::to_le_bytes).concat());
    }
    list.push(0);
    list
}

/// One chunk's bytes: compressed, or as they are where that is not shorter.
fn compress(lines: &[&[[f32; 3]]]) -> Vec<u8> {
    let mut raw = Vec::with_capacity(lines.len() * lines[0].len() * 12);
    for line in lines {
        for channel in [2, 1, 0] {
            raw.extend(line.iter().flat_map(|rgb| rgb[channel].to_le_bytes()));
        }
    }

    // Put bytes of even index before those of odd index: like goes to like.
    let mut bytes: Vec<u8> = Vec::with_capacity(raw.len());
    bytes.extend(raw.iter().step_by(2));
    bytes.extend(raw.iter().skip(1).step_by(2));
    // Replace each byte by its difference to the one before, plus 128.
    for i in (1..bytes.len()).rev() {
        bytes[i] = bytes[i].wrapping_sub(bytes[i - 1]).wrapping_add(128);
    }
    let mut zip = ZlibEncoder::new(Vec::new(), ZIP_LEVEL);
    zip.write_all(&bytes).expect("a Vec takes any number of bytes");
    let zipped = zip.finish().expect("a Vec takes any number of bytes");
    if zipped.len() < raw.len() { zipped } else { raw }
}
