//! Reading pictures and textures: one codec per file, all from bytes in memory.
//!
//! The content decides the format, not the name's extension. A file's size is known before it is
//! read and its header is checked against [`Limits`] before texels are allocated.

mod exr;
mod hdr;
mod jpeg;
mod pfm;
mod png;
#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::Fault;
use crate::{Error, ErrorKind, Format, Picture, srgb};

/// The texels of a [`TextureImage`], row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// sRGB codes of red, green and blue, and an alpha of 255 where the file has none: what an
    /// 8-bit PNG or a JPEG holds. [`srgb8_to_linear_table`](crate::srgb8_to_linear_table) makes
    /// the codes linear.
    Srgb8(Vec<[u8; 4]>),
    /// The same with 16 bits a channel: what a 16-bit PNG holds. [`srgb16_to_linear`](crate::srgb16_to_linear)
    /// makes the codes linear.
    Srgb16(Vec<[u16; 4]>),
    /// Linear sRGB, finite and not negative: what the other files hold. Alpha is dropped.
    Linear(Vec<[f32; 3]>),
}

/// An image for a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureImage {
    /// Texels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// `width * height` texels.
    pub texels: Texels,
}

/// How large an image may be that comes from a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most texels per row.
    pub max_width: u32,
    /// Most rows.
    pub max_height: u32,
    /// Most bytes of texels in memory, and of the file.
    pub max_bytes: u64,
}

impl Default for Limits {
    /// 16,384 texels to a side, and what such an image takes as 32-bit float RGB: 3 GiB.
    fn default() -> Self {
        Self { max_width: 16384, max_height: 16384, max_bytes: 3 << 30 }
    }
}

impl Limits {
    /// For renders that come back: they are as large as somebody could make them.
    const PICTURE: Self = Self { max_width: 65535, max_height: 65535, max_bytes: 16 << 30 };

    /// Fails for an image without texels, and for one above the limits; else the texel count.
    fn check(&self, width: u64, height: u64, bytes_per_texel: u64) -> Result<usize, Fault> {
        if width == 0 || height == 0 {
            return Err(Fault::damaged(format!("its header says {width}x{height} texels")));
        }
        if width > self.max_width.into() || height > self.max_height.into() {
            return Err(Fault::new(
                ErrorKind::TooLarge,
                format!(
                    "it has {width}x{height} texels and the limit is {}x{}",
                    self.max_width, self.max_height
                ),
            ));
        }
        let n_bytes = width * height * bytes_per_texel;
        if n_bytes > self.max_bytes {
            return Err(Fault::too_many_bytes(width, height, n_bytes, self.max_bytes));
        }
        Ok((width * height) as usize)
    }
}

/// Reads a picture of any of the five formats, for comparison.
///
/// PNG and JPEG are taken for sRGB and made linear. Negative, infinite and NaN values of float
/// formats come back as they are.
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    let TextureImage { width, height, texels } = read(path, &Limits::PICTURE)?;
    let pixels = match texels {
        Texels::Linear(pixels) => pixels,
        Texels::Srgb16(texels) => {
            texels.iter().map(|&[r, g, b, _]| [r, g, b].map(srgb::srgb16_to_linear)).collect()
        }
        Texels::Srgb8(texels) => {
            let table = srgb::srgb8_to_linear_table();
            texels.iter().map(|&[r, g, b, _]| [r, g, b].map(|v| table[usize::from(v)])).collect()
        }
    };
    Ok(Picture { width, height, pixels })
}

/// Reads an image for a texture.
///
/// Grey is expanded to RGB. Colour profiles, gamma chunks and EXIF orientation are not applied:
/// PNG and JPEG are sRGB, the others linear sRGB. A texel of a float format that is negative,
/// infinite or NaN is an error that names it, since it would spread over the render.
pub fn read_texture(path: &Path, limits: &Limits) -> Result<TextureImage, Error> {
    decode_texture(&read_bytes(path, limits)?, path, limits)
}

/// Bytes that the texels of an image will take, by its header: to make room for them, or not, before
/// they are decoded. `path` is what errors call it.
pub fn texel_bytes(bytes: &[u8], path: &Path, limits: &Limits) -> Result<u64, Error> {
    // A decoder that may take nothing says how much it would have taken.
    match decode(bytes, &Limits { max_bytes: 0, ..*limits }) {
        Ok(_) => Ok(0),
        Err(Fault { n_bytes: Some(n), .. }) => Ok(n),
        Err(fault) => Err(fault.at(path)),
    }
}

/// The bytes of an image's file, which is a regular file within the limits.
pub fn read_image_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, Error> {
    read_bytes(path, limits)
}

/// As [`read_texture`], for bytes in memory; `path` is what errors call them.
pub fn decode_texture(bytes: &[u8], path: &Path, limits: &Limits) -> Result<TextureImage, Error> {
    let image = decode(bytes, limits).map_err(|fault| fault.at(path))?;
    if let Texels::Linear(texels) = &image.texels {
        check_texels(image.width, texels).map_err(|fault| fault.at(path))?;
    }
    Ok(image)
}

fn read(path: &Path, limits: &Limits) -> Result<TextureImage, Error> {
    let bytes = read_bytes(path, limits)?;
    decode(&bytes, limits).map_err(|fault| fault.at(path))
}

/// The content of the regular file at `path`.
fn read_bytes(path: &Path, limits: &Limits) -> Result<Vec<u8>, Error> {
    let io_error = |cause: std::io::Error| {
        Error::io("read", path, &cause, "check the path and its permissions")
    };
    // The kind is asked before opening: opening a pipe would wait for its other end.
    let metadata = std::fs::metadata(path).map_err(io_error)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
        return Err(Error::new(
            ErrorKind::NotAFile,
            format!("cannot read '{}': it is {what}; give the path of an image", path.display()),
        ));
    }
    let n_bytes = metadata.len();
    if n_bytes > limits.max_bytes {
        let cause = format!("it has {n_bytes} bytes and the limit is {}", limits.max_bytes);
        return Err(Fault::new(ErrorKind::TooLarge, cause).at(path));
    }
    let mut bytes = Vec::with_capacity(n_bytes as usize);
    let file = File::open(path).map_err(io_error)?;
    // The file may be growing meanwhile.
    file.take(limits.max_bytes).read_to_end(&mut bytes).map_err(io_error)?;
    Ok(bytes)
}

fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    match Format::sniff(bytes) {
        Some(Format::Png) => png::decode(bytes, limits),
        Some(Format::Jpeg) => jpeg::decode(bytes, limits),
        Some(Format::Hdr) => hdr::decode(bytes, limits),
        Some(Format::Exr) => exr::decode(bytes, limits),
        Some(Format::Pfm) => pfm::decode(bytes, limits),
        None if bytes.is_empty() => Err(Fault::damaged("it is empty")),
        None => Err(Fault::new(
            ErrorKind::UnknownFormat,
            "its content is not PNG, JPEG, Radiance HDR, OpenEXR or PFM, whatever its name says",
        )),
    }
}

/// Fails at the first texel that is not finite or is negative.
fn check_texels(width: u32, texels: &[[f32; 3]]) -> Result<(), Fault> {
    let is_bad = |value: &f32| !value.is_finite() || *value < 0.0;
    let Some(texel_idx) = texels.iter().position(|texel| texel.iter().any(is_bad)) else {
        return Ok(());
    };
    let (x, y) = (texel_idx % width as usize, texel_idx / width as usize);
    let [r, g, b] = texels[texel_idx];
    let cause = format!("its texel in column {x}, row {y} is ({r}, {g}, {b})");
    Err(Fault::new(ErrorKind::BadTexel, cause))
}
