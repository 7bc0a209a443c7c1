//! Radiance HDR (RGBE): one byte of mantissa per channel, and one exponent for the three.
//!
//! The format is that of Ward, "Real Pixels" (Graphics Gems II, 1991), with the run-length
//! coding of Radiance's `color.c`. Mantissas are rounded, since readers of today take a byte m
//! for m and not for m + 1/2 as Radiance itself does. The exponent comes from the bits of the
//! float: a logarithm would be the platform's.

use crate::{Metadata, Picture};

/// Widths that the run-length coding can express; other scanlines are stored flat.
const RLE_WIDTHS: std::ops::RangeInclusive<u32> = 8..=32767;
/// Bytes in the longest run, and in the longest stretch of literal bytes.
const MAX_RUN: usize = 127;
const MAX_LITERALS: usize = 128;
/// A run shorter than this is not worth its two bytes.
const MIN_RUN: usize = 4;

pub(super) fn encode(picture: &Picture, metadata: Option<&Metadata>) -> Vec<u8> {
    let mut header = String::from("#?RADIANCE\n");
    for (name, text) in metadata.iter().flat_map(|metadata| metadata.to_text()) {
        header += &format!("# {name}: {text}\n");
    }
    header += "FORMAT=32-bit_rle_rgbe\n\n";
    header += &format!("-Y {} +X {}\n", picture.height, picture.width);

    let mut bytes = header.into_bytes();
    let mut component = Vec::with_capacity(picture.width as usize);
    for row in picture.rows() {
        if !RLE_WIDTHS.contains(&picture.width) {
            // Flat pixels cannot be mistaken for a scanline's start (2, 2, < 128) or for a run
            // (1, 1, 1): the largest mantissa of a pixel is 128 or more, or the pixel is zero.
            bytes.extend(row.iter().flat_map(|&rgb| rgb_to_rgbe(rgb)));
            continue;
        }
        bytes.extend([2, 2, (picture.width >> 8) as u8, picture.width as u8]);
        let row: Vec<[u8; 4]> = row.iter().map(|&rgb| rgb_to_rgbe(rgb)).collect();
        for channel in 0..4 {
            component.clear();
            component.extend(row.iter().map(|rgbe| rgbe[channel]));
            push_runs(&mut bytes, &component);
        }
    }
    bytes
}

/// The nearest RGBE pixel: channel = mantissa * 2^(exponent - 136).
fn rgb_to_rgbe(rgb: [f32; 3]) -> [u8; 4] {
    // Neither negative values nor NaN exist here.
    let rgb = rgb.map(|value| if value > 0.0 { f64::from(value.min(f32::MAX)) } else { 0.0 });
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    // largest = fraction * 2^exponent, with the fraction in [1/2, 1).
    let (fraction, mut exponent) = libm::frexp(largest);
    // Rounding may carry the largest mantissa to 256.
    if fraction * 256.0 >= 255.5 {
        exponent += 1;
    }
    if largest == 0.0 || exponent < -127 {
        return [0; 4];
    }
    if exponent > 127 {
        exponent = 127;
    }
    // Above the largest exponent the cast saturates at 255.
    let [r, g, b] = rgb.map(|value| (libm::ldexp(value, 8 - exponent) + 0.5) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// Appends the run-length coding of one channel of a scanline.
fn push_runs(bytes: &mut Vec<u8>, component: &[u8]) {
    let mut rest = component;
    while !rest.is_empty() {
        // Take literals up to the next run that pays.
        let mut n_literals = 0;
        let mut run = run_length(rest);
        while run < MIN_RUN && n_literals < rest.len() {
            n_literals += run;
            run = run_length(&rest[n_literals..]);
        }
        let (literals, tail) = rest.split_at(n_literals);
        for chunk in literals.chunks(MAX_LITERALS) {
            bytes.push(chunk.len() as u8);
            bytes.extend(chunk);
        }
        if run >= MIN_RUN {
            bytes.extend([128 + run as u8, tail[0]]);
            rest = &tail[run..];
        } else {
            rest = tail;
        }
    }
}

/// How often the first byte is repeated, up to the longest run; 0 for no bytes.
fn run_length(bytes: &[u8]) -> usize {
    bytes.iter().take(MAX_RUN).take_while(|&&byte| byte == bytes[0]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mantissas_are_rounded_and_share_the_exponent() {
        for (rgb, rgbe) in [
            ([0.0, 0.0, 0.0], [0, 0, 0, 0]),
            ([1.0, 0.5, 0.25], [128, 64, 32, 129]),
            ([0.998, 0.0, 0.0], [255, 0, 0, 128]),
            // Would round to 256.
            ([0.999, 0.0, 0.0], [128, 0, 0, 129]),
            ([-1.0, f32::NAN, 1.0], [0, 0, 128, 129]),
            ([f32::INFINITY, 0.0, 0.0], [255, 0, 0, 255]),
            ([f32::MAX, 1e38, 0.0], [255, 150, 0, 255]),
            ([1e-45, 0.0, 0.0], [0, 0, 0, 0]),
        ] {
            assert_eq!(rgb_to_rgbe(rgb), rgbe, "{rgb:?}");
        }
    }

    #[test]
    fn runs_are_cut_at_their_longest() {
        let mut bytes = Vec::new();
        push_runs(&mut bytes, &[7; 130]);
        assert_eq!(bytes, [255, 7, 3, 7, 7, 7]);
        bytes.clear();
        push_runs(&mut bytes, &[1, 2, 2, 3, 3, 3, 3]);
        assert_eq!(bytes, [3, 1, 2, 2, 132, 3]);
    }
}
