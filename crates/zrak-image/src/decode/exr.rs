//! OpenEXR by the `exr` crate: the first layer with R, G and B, or else with Y (grey).
//!
//! Half and integer channels become `f32`. The data window is the image; where the display window
//! puts it does not matter to a texture. Deep data and subsampled chroma are not read.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::block::reader::Reader;
use exr::image::read::specific_channels::ReadSpecificChannel;
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude::{Image, ReadChannels, ReadLayers, read};

use super::{Limits, Texels, TextureImage};
use crate::error::Fault;

/// Most channels in a layer: each takes memory while a block is decompressed.
const MAX_CHANNELS: usize = 1024;

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    // The crate means to return errors, but damaged files still reach some of its arithmetic and
    // slicing, which panics. It works on its own data alone, so nothing is left half-done by
    // unwinding. It is built and called without its thread pool, where a panic would abort.
    catch_unwind(AssertUnwindSafe(|| decode_unguarded(bytes, limits)))
        .unwrap_or_else(|_| Err(Fault::damaged("the OpenEXR decoder gave up on it")))
}

fn decode_unguarded(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?;
    for header in reader.headers() {
        check_header(header, bytes.len(), limits)?;
    }
    let has = |header: &Header, name: &str| {
        !header.deep && header.channels.list.iter().any(|channel| channel.name.eq(name))
    };
    let has_colour = |header: &Header| ["R", "G", "B"].iter().all(|name| has(header, name));
    // Y with RY and BY is luminance and subsampled chroma.
    let is_grey = |header: &Header| has(header, "Y") && !has(header, "RY");

    let layers = read().no_deep_data().largest_resolution_level();
    if reader.headers().iter().any(has_colour) {
        let image = layers
            .rgb_channels(
                |size, _| Pixels::new(size),
                |pixels: &mut Pixels, at, (r, g, b): (f32, f32, f32)| pixels.set(at, [r, g, b]),
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(reader)
            .map_err(fault)?;
        Ok(into_texture(image))
    } else if reader.headers().iter().any(is_grey) {
        let image = layers
            .specific_channels()
            .required("Y")
            .collect_pixels(
                |size, _| Pixels::new(size),
                |pixels: &mut Pixels, at, (y,): (f32,)| pixels.set(at, [y; 3]),
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(reader)
            .map_err(fault)?;
        Ok(into_texture(image))
    } else {
        let channels = reader.headers().iter().flat_map(|header| &header.channels.list);
        let names: Vec<String> =
            channels.take(16).map(|channel| channel.name.to_string()).collect();
        Err(Fault::unsupported(format!(
            "no layer has flat channels named R, G and B, or Y (it has: {})",
            names.join(", ").escape_debug()
        )))
    }
}

/// Fails for what would take more memory than the limits, or than the file can be the cause of.
fn check_header(header: &Header, n_file_bytes: usize, limits: &Limits) -> Result<(), Fault> {
    let Vec2(width, height) = header.layer_size;
    limits.check(width as u64, height as u64, 12)?;
    if let BlockDescription::Tiles(tiles) = header.blocks {
        limits.check(tiles.tile_size.0 as u64, tiles.tile_size.1 as u64, 12)?;
    }
    let n_channels = header.channels.list.len();
    if n_channels > MAX_CHANNELS {
        return Err(Fault::unsupported(format!("a layer has {n_channels} channels")));
    }
    // Every chunk takes at least its place in the offset table.
    if header.chunk_count > n_file_bytes / 8 {
        return Err(Fault::damaged(format!(
            "a layer claims {} chunks, more than the file can hold",
            header.chunk_count
        )));
    }
    let n_block_bytes = header.max_block_byte_size() as u64;
    if n_block_bytes > limits.max_bytes {
        return Err(Fault::unsupported(format!("a block of it takes {n_block_bytes} bytes")));
    }
    Ok(())
}

/// Texels while they are read, block by block.
struct Pixels {
    width: usize,
    texels: Vec<[f32; 3]>,
}

impl Pixels {
    fn new(Vec2(width, height): Vec2<usize>) -> Self {
        Self { width, texels: vec![[0.0; 3]; width * height] }
    }

    fn set(&mut self, Vec2(x, y): Vec2<usize>, texel: [f32; 3]) {
        self.texels[y * self.width + x] = texel;
    }
}

fn into_texture<C>(
    image: Image<exr::image::Layer<exr::image::SpecificChannels<Pixels, C>>>,
) -> TextureImage {
    let layer = image.layer_data;
    TextureImage {
        width: layer.size.0 as u32,
        height: layer.size.1 as u32,
        texels: Texels::Linear(layer.channel_data.pixels.texels),
    }
}

fn fault(cause: exr::error::Error) -> Fault {
    match cause {
        exr::error::Error::NotSupported(cause) => Fault::unsupported(cause),
        cause => Fault::damaged(cause),
    }
}
