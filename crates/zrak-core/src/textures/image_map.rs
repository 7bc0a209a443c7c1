//! Images with everything that files ask for: levels of detail, wrapping, channels, mappings.

use bytemuck::{Pod, Zeroable};

use super::image::{ImageTexture, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM8};
use super::{TextureArrays, TextureContext};
use crate::math::{Color, floor, ln, max, min};

/// The texel that the point falls into.
pub const FILTER_NEAREST: u32 = 0;
/// Weighted mean of the four nearest texels.
pub const FILTER_BILINEAR: u32 = 1;
/// Blend of the bilinear means of two levels of detail.
pub const FILTER_TRILINEAR: u32 = 2;

/// The image again.
pub const WRAP_REPEAT: u32 = 0;
/// Its outermost texels.
pub const WRAP_CLAMP: u32 = 1;
/// The image mirrored.
pub const WRAP_MIRROR: u32 = 2;
/// Black.
pub const WRAP_BLACK: u32 = 3;

/// Red, green and blue.
pub const CHANNEL_COLOR: u32 = 0;
/// Red, for all three.
pub const CHANNEL_R: u32 = 1;
/// Green, for all three.
pub const CHANNEL_G: u32 = 2;
/// Blue, for all three.
pub const CHANNEL_B: u32 = 3;
/// Alpha, for all three.
pub const CHANNEL_A: u32 = 4;
/// Luminance of red, green and blue (Rec. 709), for all three.
pub const CHANNEL_LUMINANCE: u32 = 5;

/// Most levels of detail: the sides are below 2^16.
pub const MAX_LEVELS: u32 = 16;

/// Index of the mapping of an image that is looked up at the surface's own coordinates.
pub const NO_MAPPING: u32 = u32::MAX;

/// An image and how it is looked up. v is upwards, so the first row is at v = 1.
///
/// Level k + 1 follows level k in the array of texels; its sides are half as long, rounded down, at
/// least one texel.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct ImageMap {
    /// The finest level; `bilinear` is not used.
    pub raster: ImageTexture,
    /// Number of levels of detail.
    pub n_levels: u32,
    /// [`FILTER_NEAREST`], [`FILTER_BILINEAR`] or [`FILTER_TRILINEAR`].
    pub filter: u32,
    /// What is beyond the left and right sides.
    pub wrap_u: u32,
    /// What is beyond the upper and lower sides.
    pub wrap_v: u32,
    /// Which channels are looked at.
    pub channel: u32,
    /// Index into the mappings, or [`NO_MAPPING`].
    pub mapping: u32,
    /// Factor of the values.
    pub scale: f32,
    /// 1 to take one minus the value, before the factor.
    pub invert: u32,
}

const _: () = assert!(size_of::<ImageMap>() == 64);

/// Words of a texel of a format.
#[inline(always)]
#[must_use]
pub const fn words_per_texel(format: u32) -> u32 {
    match format {
        TEXELS_SRGB8 | TEXELS_UNORM8 => 1,
        TEXELS_LINEAR => 3,
        _ => 2,
    }
}

impl ImageMap {
    /// Value at a point.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    pub(super) fn evaluate(&self, arrays: &TextureArrays, at: &TextureContext) -> Color {
        let (uv, duv) = if self.mapping == NO_MAPPING {
            (at.uv, at.duv)
        } else {
            arrays.mappings.get(self.mapping).uv(at)
        };
        let mut value = self.lookup(arrays, uv, duv);
        if self.invert != 0 {
            value = value.map(|x| 1.0 - x);
        }
        value * self.scale
    }

    /// Value at texture coordinates, on the finest level.
    #[inline(always)]
    pub(crate) fn at_uv(&self, arrays: &TextureArrays, uv: [f32; 2]) -> Color {
        self.lookup(arrays, uv, [0.0; 2])
    }

    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn lookup(&self, arrays: &TextureArrays, uv: [f32; 2], duv: [f32; 2]) -> Color {
        let (width, height) = (self.raster.width as f32, self.raster.height as f32);
        if self.filter == FILTER_NEAREST {
            let [x, y] = self.place(uv, width, height);
            return self.texel(arrays, &self.raster, floor(x), floor(y));
        }
        // Texels that the footprint is wide, from one on, and the level on which it is one texel wide.
        // A footprint that is not a number counts as none.
        let wide = |texels: f32| {
            if texels > 1.0 { if texels < 65536.0 { texels } else { 65536.0 } } else { 1.0 }
        };
        let texels = max(wide(duv[0] * width), wide(duv[1] * height));
        let last = (self.n_levels - 1) as f32;
        let detail = min(last, ln(texels) * core::f32::consts::LOG2_E);
        let detail = if self.filter == FILTER_TRILINEAR { max(0.0, detail) } else { 0.0 };
        let finer = floor(detail);
        let between = detail - finer as f32;
        let mut level = self.raster;
        let mut i = 0;
        while i < finer {
            level = Self::coarser(&level);
            i += 1;
        }
        let mut value = self.bilinear(arrays, &level, uv);
        if between > 0.0 {
            let coarse = self.bilinear(arrays, &Self::coarser(&level), uv);
            value = Color::lerp(between, value, coarse);
        }
        value
    }

    /// The next level of detail.
    #[inline(always)]
    fn coarser(level: &ImageTexture) -> ImageTexture {
        let n_words = level.width * level.height * words_per_texel(level.format);
        ImageTexture {
            first_word: level.first_word + n_words,
            width: (level.width / 2).max(1),
            height: (level.height / 2).max(1),
            ..*level
        }
    }

    /// Where a point is on an image of this size, in texels from its upper left corner; at most one image
    /// beyond its rim.
    #[inline(always)]
    fn place(&self, uv: [f32; 2], width: f32, height: f32) -> [f32; 2] {
        // Comparisons and not `min` and `max`: what these make of NaN is not the same on all machines.
        let between = |x: f32, low: f32, high: f32| {
            if x > low { if x < high { x } else { high } } else { low }
        };
        // From 2^24 on every coordinate is a whole number.
        const WHOLE: f32 = 16_777_216.0;
        let within = |x: f32, wrap: u32| match wrap {
            WRAP_REPEAT => {
                let x = if x > -WHOLE && x < WHOLE { x } else { 0.0 };
                between(x - floor(x) as f32, 0.0, 1.0)
            }
            WRAP_MIRROR => {
                let x = if x > -WHOLE && x < WHOLE { x } else { 0.0 };
                between(x - 2.0 * floor(0.5 * x) as f32, 0.0, 2.0)
            }
            _ => between(x, -1.0, 2.0),
        };
        let (u, v) = (within(uv[0], self.wrap_u), within(1.0 - uv[1], self.wrap_v));
        [u * width, v * height]
    }

    #[inline(always)]
    fn bilinear(&self, arrays: &TextureArrays, level: &ImageTexture, uv: [f32; 2]) -> Color {
        let [x, y] = self.place(uv, level.width as f32, level.height as f32);
        // Texel centres are at half-integers.
        let (x, y) = (x - 0.5, y - 0.5);
        let (ix, iy) = (floor(x), floor(y));
        let (fx, fy) = (x - ix as f32, y - iy as f32);
        // A loop and not four calls: less code on the GPU.
        let mut sum = Color::BLACK;
        let mut corner = 0;
        while corner < 4 {
            let (dx, dy) = (corner & 1, corner >> 1);
            let weight = |d: i32, f: f32| if d == 1 { f } else { 1.0 - f };
            let texel = self.texel(arrays, level, ix + dx, iy + dy);
            sum += texel * (weight(dx, fx) * weight(dy, fy));
            corner += 1;
        }
        sum
    }

    /// Index along an axis of `n` texels, of an index up to twice as many beyond the rim; `None` for black.
    #[inline(always)]
    fn wrapped(i: i32, n: i32, wrap: u32) -> Option<i32> {
        match wrap {
            WRAP_REPEAT => Some(if i < 0 {
                i + n
            } else if i >= n {
                i - n
            } else {
                i
            }),
            WRAP_MIRROR => {
                let i = if i < 0 { -1 - i } else { i };
                let i = if i >= 2 * n { i - 2 * n } else { i };
                Some(if i >= n { 2 * n - 1 - i } else { i })
            }
            WRAP_CLAMP => Some(i.max(0).min(n - 1)),
            _ if i < 0 || i >= n => None,
            _ => Some(i),
        }
    }

    #[inline(always)]
    fn texel(&self, arrays: &TextureArrays, level: &ImageTexture, ix: i32, iy: i32) -> Color {
        let x = Self::wrapped(ix, level.width as i32, self.wrap_u);
        let y = Self::wrapped(iy, level.height as i32, self.wrap_v);
        let (Some(x), Some(y)) = (x, y) else { return Color::BLACK };
        let index = y as u32 * level.width + x as u32;
        let first = level.first_word + index * words_per_texel(level.format);
        let word = |i: u32| arrays.texels.get(first + i);
        let (color, alpha) = match level.format {
            TEXELS_LINEAR => {
                let channel = |i: u32| f32::from_bits(word(i));
                (Color::new(channel(0), channel(1), channel(2)), 1.0)
            }
            TEXELS_SRGB8 => {
                let bits = word(0);
                let code = |shift: u32| arrays.srgb_table.get(bits >> shift & 0xff);
                (Color::new(code(0), code(8), code(16)), (bits >> 24) as f32 / 255.0)
            }
            TEXELS_UNORM8 => {
                let bits = word(0);
                let share = |shift: u32| (bits >> shift & 0xff) as f32 / 255.0;
                (Color::new(share(0), share(8), share(16)), share(24))
            }
            _ => {
                let (rg, ba) = (word(0), word(1));
                let share = |bits: u32| (bits & 0xffff) as f32 / 65535.0;
                (Color::new(share(rg), share(rg >> 16), share(ba)), share(ba >> 16))
            }
        };
        match self.channel {
            CHANNEL_COLOR => color,
            CHANNEL_R => Color::grey(color.r),
            CHANNEL_G => Color::grey(color.g),
            CHANNEL_B => Color::grey(color.b),
            CHANNEL_A => Color::grey(alpha),
            _ => Color::grey(0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b),
        }
    }
}
