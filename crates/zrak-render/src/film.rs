//! The film: exact sums for every pixel of a region.

use zrak_core::film::PixelSum;
use zrak_image::Picture;

use crate::Region;

/// Sums of samples of the pixels of a region, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    /// The region.
    pub region: Region,
    /// Its pixels.
    pub pixels: Vec<PixelSum>,
}

impl Film {
    /// Film without samples.
    #[must_use]
    pub fn new(region: Region) -> Self {
        // Zeroed by the system, page by page as it is written to.
        Self { region, pixels: bytemuck::zeroed_vec(region.n_pixels()) }
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.pixels.fill(PixelSum::ZERO);
    }

    /// Adds the samples of a film whose region lies inside this one's. The sums are exact, so
    /// neither the order of merging nor the split into films matters.
    ///
    /// # Panics
    /// If the other region is not inside.
    pub fn merge(&mut self, other: &Self) {
        assert!(other.region.is_inside(&self.region), "a film can only take in a part of itself");
        let width = other.region.width as usize;
        for (row, source) in other.pixels.chunks_exact(width.max(1)).enumerate() {
            let y = other.region.y - self.region.y + row as u32;
            let x = other.region.x - self.region.x;
            let start = y as usize * self.region.width as usize + x as usize;
            for (sum, o) in self.pixels[start..start + width].iter_mut().zip(source) {
                sum.merge(o);
            }
        }
    }

    /// Mean radiance of every pixel.
    #[must_use]
    pub fn to_picture(&self) -> Picture {
        Picture {
            width: self.region.width,
            height: self.region.height,
            pixels: self.pixels.iter().map(|sum| sum.mean().to_array()).collect(),
        }
    }

    /// Number of rays traced.
    #[must_use]
    pub fn n_rays(&self) -> u64 {
        self.pixels.iter().map(|sum| sum.n_rays).sum()
    }
}
