//! Rendering of one tile, compiled for the instruction sets that are worth it.
//!
//! The code is the same and so are its results: rustc contracts and reorders no floating-point
//! operation, it only does eight of them at a time.

use zrak_core::accel::Accel;
use zrak_core::film::PixelSum;
use zrak_core::integrators::render_pixel;
use zrak_core::scene::SceneView;
use zrak_render::{Region, SampleRange};

/// Vector instructions that tiles are rendered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simd {
    /// What every processor of its architecture has.
    Baseline,
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Simd {
    /// The best that this processor has.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::is_x86_feature_detected!("avx2")
            && std::is_x86_feature_detected!("bmi1")
            && std::is_x86_feature_detected!("bmi2")
            && std::is_x86_feature_detected!("lzcnt")
            && std::is_x86_feature_detected!("popcnt")
        {
            return Self::Avx2;
        }
        Self::Baseline
    }

    /// Name for people.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Self::Baseline => "SSE2",
            #[cfg(not(target_arch = "x86_64"))]
            Self::Baseline => "baseline",
        }
    }
}

/// Name of the vector instructions that this processor's tiles are rendered with.
#[must_use]
pub fn instruction_set() -> &'static str {
    Simd::detect().name()
}

/// Renders samples of the pixels of a region, row by row.
pub(crate) fn render_tile(
    simd: Simd,
    scene: &SceneView,
    accel: impl Accel,
    region: Region,
    samples: SampleRange,
) -> Vec<PixelSum> {
    match simd {
        #[cfg(target_arch = "x86_64")]
        Simd::Avx2 => {
            #[allow(unsafe_code)]
            // SAFETY: `Simd::detect` makes this value only where the processor has these features.
            unsafe {
                render_tile_avx2(scene, accel, region, samples)
            }
        }
        Simd::Baseline => render_tile_inline(scene, accel, region, samples),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn render_tile_avx2(
    scene: &SceneView,
    accel: impl Accel,
    region: Region,
    samples: SampleRange,
) -> Vec<PixelSum> {
    render_tile_inline(scene, accel, region, samples)
}

#[inline(always)]
fn render_tile_inline(
    scene: &SceneView,
    accel: impl Accel,
    region: Region,
    samples: SampleRange,
) -> Vec<PixelSum> {
    let mut pixels = Vec::with_capacity(region.n_pixels());
    for y in region.y..region.y + region.height {
        for x in region.x..region.x + region.width {
            pixels.push(render_pixel(scene, accel, x, y, samples.first, samples.count));
        }
    }
    pixels
}
