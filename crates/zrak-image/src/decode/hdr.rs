//! Radiance HDR (RGBE): flat scanlines, and both run-length codings. See `encode/hdr.rs`.
//!
//! Rows must be stored top down and left to right, as everything but Radiance's own tools does.

use super::{Limits, Texels, TextureImage};
use crate::error::Fault;

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    let mut rest = bytes;
    let exposure = read_header(&mut rest)?;
    let (width, height) = parse_size(next_line(&mut rest)?)?;
    limits.check(width.into(), height.into(), 12)?;

    // Memory is taken row by row, as the data comes.
    let mut texels = Vec::new();
    let mut scanline = Vec::with_capacity(width as usize);
    for y in 0..height {
        scanline.clear();
        read_scanline(&mut rest, width as usize, &mut scanline)
            .map_err(|cause| Fault::damaged(format!("{cause} in row {y} of {height}")))?;
        texels.extend(scanline.iter().map(|&rgbe| rgbe_to_rgb(rgbe, exposure)));
    }
    Ok(TextureImage { width, height, texels: Texels::Linear(texels) })
}

/// Takes the header up to its empty line; the exposure that the pixels were multiplied by.
fn read_header(rest: &mut &[u8]) -> Result<f64, Fault> {
    let mut exposure = 1.0;
    loop {
        let line = next_line(rest)?;
        if line.is_empty() {
            return Ok(exposure);
        }
        // Lines that are not text are somebody's comments.
        let Some((name, value)) = std::str::from_utf8(line).ok().and_then(|l| l.split_once('='))
        else {
            continue;
        };
        match name.trim() {
            "FORMAT" if value.trim() != "32-bit_rle_rgbe" => {
                let value = value.trim().escape_debug();
                return Err(Fault::unsupported(format!("its pixels are '{value}', not RGBE")));
            }
            "EXPOSURE" => match value.trim().parse::<f64>() {
                // A product: each program that changed the exposure adds a line.
                Ok(factor) if factor.is_finite() && factor > 0.0 => exposure *= factor,
                _ => return Err(Fault::damaged("its exposure is not a positive number")),
            },
            _ => {}
        }
    }
}

/// Width and height from a line such as `-Y 480 +X 640`.
fn parse_size(line: &[u8]) -> Result<(u32, u32), Fault> {
    let text = String::from_utf8_lossy(line);
    match text.split_ascii_whitespace().collect::<Vec<_>>()[..] {
        ["-Y", height, "+X", width] => match (width.parse(), height.parse()) {
            (Ok(width), Ok(height)) => Ok((width, height)),
            _ => Err(Fault::damaged(format!("its size is '{}'", text.escape_debug()))),
        },
        [y, _, x, _] if y.len() == 2 && x.len() == 2 => {
            Err(Fault::unsupported(format!("its rows are ordered '{y} {x}', not '-Y +X'")))
        }
        _ => Err(Fault::damaged("its header has no size")),
    }
}

/// Takes one scanline into the empty `scanline`, of `width` pixels.
fn read_scanline(
    rest: &mut &[u8],
    width: usize,
    scanline: &mut Vec<[u8; 4]>,
) -> Result<(), &'static str> {
    let first = take(rest)?;
    if let [2, 2, high, low] = first
        && high < 128
    {
        if usize::from(high) << 8 | usize::from(low) != width {
            return Err("a scanline of another width");
        }
        scanline.resize(width, [0; 4]);
        return (0..4).try_for_each(|channel| read_component(rest, scanline, channel));
    }

    // Flat pixels, among which (1, 1, 1, n) repeats the pixel before: the older coding. Markers
    // in a row are digits of one count, the lowest first.
    let mut pixel = first;
    let mut shift = 0;
    loop {
        if let [1, 1, 1, count] = pixel {
            let n_repeats = usize::from(count) << shift;
            let Some(&previous) = scanline.last() else {
                return Err("a run before any pixel");
            };
            if n_repeats > width - scanline.len() {
                return Err("a run beyond the scanline");
            }
            scanline.extend(std::iter::repeat_n(previous, n_repeats));
            // More digits would exceed any width; the check above then ends it.
            shift = (shift + 8).min(24);
        } else {
            scanline.push(pixel);
            shift = 0;
        }
        if scanline.len() == width {
            return Ok(());
        }
        pixel = take(rest)?;
    }
}

/// Takes the run-length coding of one channel of a scanline.
fn read_component(
    rest: &mut &[u8],
    scanline: &mut [[u8; 4]],
    channel: usize,
) -> Result<(), &'static str> {
    let mut x = 0;
    while x < scanline.len() {
        let [code] = take(rest)?;
        let n_pixels = usize::from(if code > 128 { code - 128 } else { code });
        if n_pixels == 0 {
            return Err("a run of no pixels");
        }
        let pixels = scanline.get_mut(x..x + n_pixels).ok_or("a run beyond the scanline")?;
        if code > 128 {
            let [value] = take(rest)?;
            pixels.iter_mut().for_each(|pixel| pixel[channel] = value);
        } else {
            for pixel in pixels {
                [pixel[channel]] = take(rest)?;
            }
        }
        x += n_pixels;
    }
    Ok(())
}

fn rgbe_to_rgb([r, g, b, exponent]: [u8; 4], exposure: f64) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    let scale = libm::ldexp(1.0, i32::from(exponent) - 136) / exposure;
    [r, g, b].map(|mantissa| (f64::from(mantissa) * scale) as f32)
}

/// Takes `N` bytes.
fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], &'static str> {
    let (bytes, tail) = rest.split_first_chunk().ok_or("the end of the file")?;
    *rest = tail;
    Ok(*bytes)
}

/// Takes a line and its end, which is a line feed.
fn next_line<'a>(rest: &mut &'a [u8]) -> Result<&'a [u8], Fault> {
    let end = rest.iter().position(|&byte| byte == b'\n');
    let end = end.ok_or_else(|| Fault::damaged("its header is incomplete"))?;
    let line = &rest[..end];
    *rest = &rest[end + 1..];
    Ok(line.strip_suffix(b"\r").unwrap_or(line))
}
