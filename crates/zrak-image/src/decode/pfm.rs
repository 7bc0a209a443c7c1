//! Portable float map, colour (`PF`) and grey (`Pf`), of either byte order.
//!
//! The scale's sign is the byte order; its size is a unit that no program agrees on, and is
//! ignored.

use super::{Limits, Texels, TextureImage};
use crate::error::Fault;

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<TextureImage, Fault> {
    // Four words, each ended by one or more blanks, but the last by exactly one.
    let mut rest = bytes;
    let magic = next_word(&mut rest)?;
    let width: u32 = parse(next_word(&mut rest)?, "width")?;
    let height: u32 = parse(next_word(&mut rest)?, "height")?;
    let scale: f32 = parse(next_word(&mut rest)?, "scale")?;
    let n_channels = match magic {
        "PF" => 3,
        "Pf" => 1,
        _ => return Err(Fault::damaged("its first word is neither PF nor Pf")),
    };
    if scale == 0.0 || !scale.is_finite() {
        return Err(Fault::damaged(format!("its scale is {scale}")));
    }
    let n_texels = limits.check(width.into(), height.into(), 12)?;
    let n_bytes = n_texels * n_channels * 4;
    if rest.len() < n_bytes {
        return Err(Fault::damaged(format!(
            "{width}x{height} texels take {n_bytes} bytes and it has {}",
            rest.len()
        )));
    }

    let value = |word: &[u8]| {
        let word = [word[0], word[1], word[2], word[3]];
        if scale < 0.0 { f32::from_le_bytes(word) } else { f32::from_be_bytes(word) }
    };
    // The file's first row is the bottom one.
    let mut texels = Vec::with_capacity(n_texels);
    for row in rest[..n_bytes].chunks_exact(width as usize * n_channels * 4).rev() {
        texels.extend(row.chunks_exact(n_channels * 4).map(|texel| match n_channels {
            1 => [value(texel); 3],
            _ => [value(texel), value(&texel[4..]), value(&texel[8..])],
        }));
    }
    Ok(TextureImage { width, height, texels: Texels::Linear(texels) })
}

/// Takes a word and the one blank after it, skipping blanks before it.
fn next_word<'a>(rest: &mut &'a [u8]) -> Result<&'a str, Fault> {
    let start = rest.trim_ascii_start();
    let word = start.iter().position(u8::is_ascii_whitespace).and_then(|end| {
        *rest = &start[end + 1..];
        std::str::from_utf8(&start[..end]).ok()
    });
    word.ok_or_else(|| Fault::damaged("its header is incomplete"))
}

fn parse<T: std::str::FromStr>(word: &str, what: &str) -> Result<T, Fault> {
    word.parse().map_err(|_| Fault::damaged(format!("its {what} is '{}'", word.escape_debug())))
}
