//! Exact sums of samples.
//!
//! A channel is a 128-bit fixed-point number with 64 bits behind the point. Every sample value from
//! 2^-41 to 2^38 is added without any rounding, so the sum of a set of samples does not depend on
//! their order or grouping: films of any tiles and sample ranges merge to the same bytes.

use bytemuck::{Pod, Zeroable};

use crate::math::Color;

/// Largest sample value that the film takes, 2^38; larger ones (and infinity) count as this.
pub const MAX_SAMPLE: f32 = 274_877_906_944.0;

/// Non-negative sum with 64 bits before and 64 behind the point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct FixedSum {
    /// Behind the point, in units of 2^-64.
    pub fraction: u64,
    /// Before the point.
    pub whole: u64,
}

impl FixedSum {
    /// Zero.
    pub const ZERO: Self = Self { fraction: 0, whole: 0 };

    #[inline(always)]
    const fn bits(self) -> u128 {
        self.fraction as u128 | (self.whole as u128) << 64
    }

    #[inline(always)]
    const fn from_bits(bits: u128) -> Self {
        Self { fraction: bits as u64, whole: (bits >> 64) as u64 }
    }

    /// The value of a sample. NaN and negative values count as 0, values above [`MAX_SAMPLE`] as
    /// that; bits below 2^-64 are dropped.
    #[inline(always)]
    #[must_use]
    pub fn from_f32(value: f32) -> Self {
        if value.is_nan() || value <= 0.0 {
            return Self::ZERO;
        }
        let value = if value < MAX_SAMPLE { value } else { MAX_SAMPLE };
        let bits = value.to_bits();
        // value = mantissa 2^(exponent - 150); subnormals are below 2^-64 and vanish in the shift.
        let exponent = bits >> 23;
        let mantissa = u64::from((bits & 0x007f_ffff) | 0x0080_0000);
        // In units of 2^-64 that is mantissa 2^(exponent - 86), with exponent - 86 at most 79.
        if exponent >= 86 {
            Self::from_bits(u128::from(mantissa) << (exponent - 86))
        } else {
            let shift = 86 - exponent;
            Self { fraction: if shift < 24 { mantissa >> shift } else { 0 }, whole: 0 }
        }
    }

    /// Sum, exact.
    #[inline(always)]
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self::from_bits(self.bits().wrapping_add(other.bits()))
    }

    /// Value, rounded to the nearest `f64`.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        // The conversion from u128 rounds to nearest; the scaling is exact.
        self.bits() as f64 * (1.0 / 18_446_744_073_709_551_616.0)
    }
}

/// What is known of one pixel: sums over its samples so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct PixelSum {
    /// Sums of radiance: red, green, blue.
    pub radiance: [FixedSum; 3],
    /// Number of samples.
    pub n_samples: u64,
    /// Number of rays that they traced.
    pub n_rays: u64,
}

const _: () = assert!(size_of::<PixelSum>() == 64);

impl PixelSum {
    /// No sample.
    pub const ZERO: Self = Self { radiance: [FixedSum::ZERO; 3], n_samples: 0, n_rays: 0 };

    /// Adds one sample that traced `n_rays` rays.
    #[inline(always)]
    pub fn add_sample(&mut self, radiance: Color, n_rays: u32) {
        let [r, g, b] = radiance.to_array();
        self.radiance[0] = self.radiance[0].plus(FixedSum::from_f32(r));
        self.radiance[1] = self.radiance[1].plus(FixedSum::from_f32(g));
        self.radiance[2] = self.radiance[2].plus(FixedSum::from_f32(b));
        self.n_samples += 1;
        self.n_rays += u64::from(n_rays);
    }

    /// Adds the samples of another film for the same pixel.
    #[inline(always)]
    pub fn merge(&mut self, other: &Self) {
        // By index: iterators over both became a loop over pointers on the GPU.
        for i in 0..3 {
            self.radiance[i] = self.radiance[i].plus(other.radiance[i]);
        }
        self.n_samples += other.n_samples;
        self.n_rays += other.n_rays;
    }

    /// Mean radiance; black without samples. Host only: it divides in `f64`.
    #[must_use]
    pub fn mean(&self) -> Color {
        if self.n_samples == 0 {
            return Color::BLACK;
        }
        let n = self.n_samples as f64;
        let [r, g, b] = self.radiance.map(|sum| (sum.to_f64() / n) as f32);
        Color::new(r, g, b)
    }
}

#[cfg(test)]
mod tests;
