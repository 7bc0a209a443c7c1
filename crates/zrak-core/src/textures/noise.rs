//! Patterns made of Perlin noise.

use bytemuck::{Pod, Zeroable};

use super::perlin::{perlin, turbulence};
use crate::math::{Color, Vec3, min, sin};

/// (1 + noise(s p)) / 2.
pub const PATTERN_NOISE: u32 = 0;
/// turbulence(s p), at most 1.
pub const PATTERN_TURBULENCE: u32 = 1;
/// (1 + sin(s p.z + 10 turbulence(p))) / 2.
pub const PATTERN_MARBLE: u32 = 2;

/// Blend of two colours by a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Noise {
    /// Colour at the pattern's value 0.
    pub low: Color,
    /// Scale s, per world unit.
    pub scale: f32,
    /// Colour at the pattern's value 1.
    pub high: Color,
    /// [`PATTERN_NOISE`], [`PATTERN_TURBULENCE`] or [`PATTERN_MARBLE`].
    pub pattern: u32,
    /// Octaves of turbulence.
    pub octaves: u32,
    /// Chooses the gradients.
    pub seed: u32,
    /// Nothing.
    pub _pad: [u32; 2],
}

const _: () = assert!(size_of::<Noise>() == 48);

impl Noise {
    /// Colour at the world-space point `p`.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[must_use]
    pub fn evaluate(&self, p: Vec3) -> Color {
        let value = match self.pattern {
            PATTERN_MARBLE => {
                let bend = 10.0 * turbulence(p, self.octaves, self.seed);
                0.5 * (1.0 + sin(self.scale * p.z + bend))
            }
            PATTERN_TURBULENCE => turbulence(p * self.scale, self.octaves, self.seed),
            _ => 0.5 * (1.0 + perlin(p * self.scale, self.seed)),
        };
        // Turbulence may exceed 1 a little.
        Color::lerp(min(value, 1.0), self.low, self.high)
    }
}
