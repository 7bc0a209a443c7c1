//! Sums of octaves of Perlin noise.
//!
//! Musgrave's fractional Brownian motion, in the form of *Physically Based Rendering*, 3rd edition,
//! section 10.6.

use bytemuck::{Pod, Zeroable};

use super::perlin::perlin;
use crate::math::{Color, Vec3};

/// sum over octaves i of roughness^i noise(1.99^i p).
pub const FRACTAL_FBM: u32 = 0;
/// The same with the noise's absolute value.
pub const FRACTAL_WRINKLED: u32 = 1;
/// |fbm(p / 10)| fbm(p), the first with half the roughness's octaves: waves under a wind.
pub const FRACTAL_WINDY: u32 = 2;

/// Blend of two colours by a fractal sum.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Fractal {
    /// Colour at the pattern's value 0.
    pub low: Color,
    /// Noise cells per unit.
    pub scale: f32,
    /// Colour at the pattern's value 1.
    pub high: Color,
    /// [`FRACTAL_FBM`], [`FRACTAL_WRINKLED`] or [`FRACTAL_WINDY`].
    pub pattern: u32,
    /// Octaves.
    pub octaves: u32,
    /// Chooses the gradients.
    pub seed: u32,
    /// Weight of an octave against the one before.
    pub roughness: f32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Fractal>() == 48);

impl Fractal {
    /// Colour at `p`. It goes beyond both ends, but not below black.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn evaluate(&self, p: Vec3) -> Color {
        let p = p * self.scale;
        let value = if self.pattern == FRACTAL_WINDY {
            self.sum(p * 0.1, 3, false).abs() * self.sum(p, self.octaves, false)
        } else {
            self.sum(p, self.octaves, self.pattern == FRACTAL_WRINKLED)
        };
        Color::lerp(value, self.low, self.high).map(|x| crate::math::max(0.0, x))
    }

    #[inline(always)]
    fn sum(&self, p: Vec3, octaves: u32, is_absolute: bool) -> f32 {
        let (mut sum, mut weight, mut q) = (0.0, 1.0, p);
        let mut i = 0;
        while i < octaves {
            let noise = perlin(q, self.seed);
            sum += weight * if is_absolute { noise.abs() } else { noise };
            weight *= self.roughness;
            // Not 2, so that the lattices' points, where all noise is 0, do not coincide.
            q = q * 1.99;
            i += 1;
        }
        sum
    }
}
