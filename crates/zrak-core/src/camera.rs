//! Cameras with a shutter: a thin lens in perspective or parallel projection, and all directions at once.

use bytemuck::{Pod, Zeroable};

use crate::math::{Vec3, equal_area_square_to_sphere, lerp, sin_cos_turns, square_to_uniform_disk};
use crate::ray::Ray;
use crate::sampler::{CameraDim, Sampler};

/// Straight lines through the lens.
pub const PROJECTION_PERSPECTIVE: u32 = 0;
/// Parallel lines.
pub const PROJECTION_ORTHOGRAPHIC: u32 = 1;
/// All directions by longitude and latitude.
pub const PROJECTION_EQUIRECTANGULAR: u32 = 2;
/// All directions by an equal-area map.
pub const PROJECTION_EQUAL_AREA: u32 = 3;

/// A camera.
///
/// In perspective, a thin lens at `origin`, in perfect focus on the plane that the pixel vectors span.
/// In parallel projection that plane goes through `origin`, and focus is `forward` from it. Where all
/// directions are seen, x of the corner and the pixel vectors is where a pixel is on the map's width of
/// 1, y on its height, `lens_u`, `lens_v` and `forward` are unit vectors to the right, up and ahead.
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
    /// Angle between the rays of neighbouring pixels, in radians.
    pub spread: f32,
    /// Ahead.
    pub forward: Vec3,
    /// [`PROJECTION_PERSPECTIVE`] or another of them.
    pub projection: u32,
}

const _: () = assert!(size_of::<Camera>() == 112);

impl Camera {
    /// Ray of a sample of pixel (`x`, `y`), counted from the upper left: uniform over the pixel, the
    /// lens and the shutter interval. The direction is of unit length.
    #[inline(always)]
    #[must_use]
    pub fn ray(&self, x: u32, y: u32, sampler: &Sampler) -> Ray {
        let px = x as f32 + sampler.camera(CameraDim::PixelX);
        let py = y as f32 + sampler.camera(CameraDim::PixelY);
        let on_plane = self.corner + self.pixel_dx * px + self.pixel_dy * py;
        let time = if self.shutter_open_s == self.shutter_close_s {
            self.shutter_open_s
        } else {
            lerp(sampler.camera(CameraDim::Time), self.shutter_open_s, self.shutter_close_s)
        };
        if self.projection >= PROJECTION_EQUIRECTANGULAR {
            return Ray { o: self.origin, d: self.direction(on_plane.x, on_plane.y), time };
        }
        let lens = if self.has_lens != 0 {
            let (u, v) = square_to_uniform_disk(
                sampler.camera(CameraDim::LensU),
                sampler.camera(CameraDim::LensV),
            );
            self.lens_u * u + self.lens_v * v
        } else {
            Vec3::ZERO
        };
        let (o, target) = if self.projection == PROJECTION_ORTHOGRAPHIC {
            (self.origin + on_plane, self.forward)
        } else {
            (self.origin, on_plane)
        };
        Ray { o: o + lens, d: (target - lens).normalized(), time }
    }

    /// Unit direction that falls on the point (x, y) of the map of all directions.
    #[inline(always)]
    fn direction(&self, x: f32, y: f32) -> Vec3 {
        let local = if self.projection == PROJECTION_EQUAL_AREA {
            equal_area_square_to_sphere(x, y)
        } else {
            let (sin_phi, cos_phi) = sin_cos_turns(x);
            let (sin_theta, cos_theta) = sin_cos_turns(0.5 * y);
            // Longitude 0 is behind, at the left side of the picture.
            crate::math::vec3(-sin_theta * sin_phi, -sin_theta * cos_phi, cos_theta)
        };
        (self.lens_u * local.x + self.forward * local.y + self.lens_v * local.z).normalized()
    }
}

#[cfg(test)]
mod tests;
