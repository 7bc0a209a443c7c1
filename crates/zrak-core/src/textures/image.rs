//! Images.

use bytemuck::{Pod, Zeroable};

use super::TextureArrays;
use crate::math::{Color, floor, max, min};

/// Texels are one word: red, green, blue as 8-bit sRGB codes, red in the lowest bits, and alpha as a share
/// of 255.
pub const TEXELS_SRGB8: u32 = 0;
/// Texels are three words: linear red, green, blue as bits of `f32`.
pub const TEXELS_LINEAR: u32 = 1;
/// Texels are one word: red, green, blue, alpha as shares of 255, red in the lowest bits.
pub const TEXELS_UNORM8: u32 = 2;
/// Texels are two words: red, green, blue, alpha as shares of 65535, red in the lowest bits of the first.
pub const TEXELS_UNORM16: u32 = 3;

/// Image that covers [0, 1] x [0, 1], v upwards; it repeats in u and ends in v.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct ImageTexture {
    /// Index of the first word of the upper left texel in the array of texels; rows follow from
    /// the top.
    pub first_word: u32,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// [`TEXELS_SRGB8`] or [`TEXELS_LINEAR`]; in an [`ImageMap`](super::ImageMap) also [`TEXELS_UNORM8`] or
    /// [`TEXELS_UNORM16`].
    pub format: u32,
    /// 1 for the weighted mean of four texels, 0 for the nearest one.
    pub bilinear: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<ImageTexture>() == 32);

impl ImageTexture {
    /// Colour at texture coordinates `uv`.
    #[inline(always)]
    #[must_use]
    pub(crate) fn evaluate(&self, scene: &TextureArrays, uv: [f32; 2]) -> Color {
        // Without the bounds, huge coordinates would lead out of the image.
        let u = max(0.0, min(1.0, uv[0] - floor(uv[0]) as f32));
        let v = max(0.0, min(1.0, uv[1]));
        let x = u * self.width as f32;
        let y = (1.0 - v) * self.height as f32;
        if self.bilinear == 0 {
            return self.texel(scene, floor(x), floor(y));
        }
        // Texel centres are at half-integers.
        let (x, y) = (x - 0.5, y - 0.5);
        let (ix, iy) = (floor(x), floor(y));
        let (fx, fy) = (x - ix as f32, y - iy as f32);
        let row =
            |iy: i32| Color::lerp(fx, self.texel(scene, ix, iy), self.texel(scene, ix + 1, iy));
        Color::lerp(fy, row(iy), row(iy + 1))
    }

    /// Linear colour of a texel, given by indices up to one image beyond its rim.
    #[inline(always)]
    fn texel(&self, scene: &TextureArrays, ix: i32, iy: i32) -> Color {
        let (width, height) = (self.width as i32, self.height as i32);
        let x = if ix < 0 {
            ix + width
        } else if ix >= width {
            ix - width
        } else {
            ix
        };
        let y = iy.max(0).min(height - 1);
        let index = y as u32 * self.width + x as u32;
        if self.format == TEXELS_LINEAR {
            let channel = |i| f32::from_bits(scene.texels.get(self.first_word + index * 3 + i));
            Color::new(channel(0), channel(1), channel(2))
        } else {
            let word = scene.texels.get(self.first_word + index);
            let channel = |shift: u32| scene.srgb_table.get(word >> shift & 0xff);
            Color::new(channel(0), channel(8), channel(16))
        }
    }
}
