//! Thin-lens camera with a shutter.

use bytemuck::{Pod, Zeroable};

use crate::math::{Vec3, lerp, square_to_uniform_disk};
use crate::ray::Ray;
use crate::sampler::{CameraDim, Sampler};

/// A thin lens at `origin`, in perfect focus on the plane that the pixel vectors span.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Camera {
    /// Centre of the lens.
    pub origin: Vec3,
    /// When the shutter opens, in seconds.
    pub shutter_open_s: f32,
    /// From the centre of the lens to the upper left corner of the picture on the plane in focus.
    pub corner: Vec3,
    /// When the shutter closes, in seconds.
    pub shutter_close_s: f32,
    /// From one pixel to the next on its right.
    pub pixel_dx: Vec3,
    /// Width of the picture in pixels.
    pub width: u32,
    /// From one pixel to the next below.
    pub pixel_dy: Vec3,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Radius of the lens, to the right.
    pub lens_u: Vec3,
    /// 1 if the lens has an area, 0 for a pinhole.
    pub has_lens: u32,
    /// Radius of the lens, upwards.
    pub lens_v: Vec3,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Camera>() == 96);

impl Camera {
    /// Ray of a sample of pixel (`x`, `y`), counted from the upper left: uniform over the pixel, the
    /// lens and the shutter interval. The direction is of unit length.
    #[inline(always)]
    #[must_use]
    pub fn ray(&self, x: u32, y: u32, sampler: &Sampler) -> Ray {
        let px = x as f32 + sampler.camera(CameraDim::PixelX);
        let py = y as f32 + sampler.camera(CameraDim::PixelY);
        let target = self.corner + self.pixel_dx * px + self.pixel_dy * py;
        let lens = if self.has_lens != 0 {
            let (u, v) = square_to_uniform_disk(
                sampler.camera(CameraDim::LensU),
                sampler.camera(CameraDim::LensV),
            );
            self.lens_u * u + self.lens_v * v
        } else {
            Vec3::ZERO
        };
        let time = if self.shutter_open_s == self.shutter_close_s {
            self.shutter_open_s
        } else {
            lerp(sampler.camera(CameraDim::Time), self.shutter_open_s, self.shutter_close_s)
        };
        Ray { o: self.origin + lens, d: (target - lens).normalized(), time }
    }
}

#[cfg(test)]
mod tests;
