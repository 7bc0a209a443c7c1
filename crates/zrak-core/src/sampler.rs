//! Random numbers as a pure function of (seed, pixel, sample, dimension).
//!
//! There is no generator whose state must be kept, so a sample is the same whoever computes it, and
//! whenever. A dimension is a number that belongs to one decision of the path: the decisions at the
//! camera have the dimensions of [`CameraDim`], those at bounce b the dimensions 16 (b + 1) + i.
//! Free flights are drawn during traversal, in an order that depends on the tree, so their
//! dimension is made of the bounce and the medium's index instead.

use crate::math::{lowbias32, pcg4d, unit_f32};

/// Dimensions of the decisions at the camera.
#[repr(u32)]
#[derive(Clone, Copy)]
pub enum CameraDim {
    /// Position in the pixel, x.
    PixelX,
    /// Position in the pixel, y.
    PixelY,
    /// Position on the lens, first coordinate.
    LensU,
    /// Position on the lens, second coordinate.
    LensV,
    /// Time in the shutter interval.
    Time,
}

/// Dimensions of the decisions at a bounce.
#[repr(u32)]
#[derive(Clone, Copy)]
pub enum BounceDim {
    /// New direction, first coordinate.
    DirectionU,
    /// New direction, second coordinate.
    DirectionV,
    /// Which of several lobes.
    Lobe,
    /// Whether there is a hole.
    Alpha,
    /// Which of mixed materials.
    Mix,
    /// Which light.
    Light,
    /// Free flight in the medium that the path is in.
    Flight,
    /// Which channel the flight is drawn for.
    Channel,
    /// Whether a path that carries little goes on.
    Roulette,
}

/// Number of dimensions that a bounce may use.
const DIMS_PER_BOUNCE: u32 = 16;
/// Dimensions from here on belong to free flights.
const FREE_FLIGHT_DIMS: u32 = 1 << 31;

/// Random numbers of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    key: [u32; 2],
    bounce: u32,
}

impl Sampler {
    /// Sampler of the sample with this index of the pixel (`x`, `y`).
    #[inline(always)]
    #[must_use]
    pub fn new(seed: u64, x: u32, y: u32, sample: u32) -> Self {
        // Images are at most 65,536 pixels wide and high, so that a pixel fits one word.
        let [a, b, c, d] = pcg4d([x | (y << 16), sample, seed as u32, (seed >> 32) as u32]);
        Self { key: [a ^ c, b ^ d], bounce: 0 }
    }

    /// Goes on to the next bounce.
    #[inline(always)]
    pub fn next_bounce(&mut self) {
        self.bounce += 1;
    }

    #[inline(always)]
    fn draw(&self, dimension: u32) -> f32 {
        let mixed = lowbias32(dimension.wrapping_mul(0x9e37_79b9) ^ self.key[0]);
        unit_f32(lowbias32(mixed.wrapping_add(self.key[1])))
    }

    /// Number in [0, 1) for a decision at the camera.
    #[inline(always)]
    #[must_use]
    pub fn camera(&self, dim: CameraDim) -> f32 {
        self.draw(dim as u32)
    }

    /// Number in [0, 1) for a decision at the current bounce.
    #[inline(always)]
    #[must_use]
    pub fn at_bounce(&self, dim: BounceDim) -> f32 {
        self.draw((self.bounce + 1) * DIMS_PER_BOUNCE + dim as u32)
    }

    /// Sampler for a ray to a light, whose numbers have nothing to do with the path's own.
    #[inline(always)]
    #[must_use]
    pub fn toward_light(&self) -> Self {
        Self { key: [self.key[0] ^ 0x68bc_21eb, self.key[1]], bounce: self.bounce }
    }

    /// Numbers for a decision that needs many, at the current bounce; `purpose` tells such decisions
    /// apart.
    #[inline(always)]
    #[must_use]
    pub fn stream(&self, purpose: u32) -> Stream {
        let key = lowbias32(self.bounce ^ lowbias32(purpose ^ 0x51ed_270b));
        Stream { key: [self.key[0] ^ key, self.key[1]], i: 0 }
    }

    /// Number in [0, 1) for the free flight in the medium with this index, after the current bounce.
    #[inline(always)]
    #[must_use]
    pub fn free_flight(&self, medium: u32) -> f32 {
        self.draw(FREE_FLIGHT_DIMS | lowbias32(self.bounce ^ lowbias32(medium)))
    }
}

/// Random numbers, one after the other, for what happens at one place of a path.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    key: [u32; 2],
    i: u32,
}

impl Stream {
    /// The next number in [0, 1).
    #[inline(always)]
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f32 {
        self.i += 1;
        let mixed = lowbias32(self.i.wrapping_mul(0x9e37_79b9) ^ self.key[0]);
        unit_f32(lowbias32(mixed.wrapping_add(self.key[1])))
    }
}

#[cfg(test)]
mod tests;
