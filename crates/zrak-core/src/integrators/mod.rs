//! Integrators: how light is gathered along paths.

mod naive;

#[cfg(test)]
mod tests;

pub use naive::Path;

use crate::accel::Accel;
use crate::film::PixelSum;
use crate::scene::SceneView;

/// Renders samples `first` to `first + count` of the pixel (`x`, `y`).
///
/// The loop over samples and the loop over bounces are one, so that on the GPU a thread whose path
/// ended starts the next sample at once instead of waiting for the longest path of its warp.
#[inline(always)]
#[must_use]
pub fn render_pixel(
    scene: &SceneView,
    accel: impl Accel,
    x: u32,
    y: u32,
    first: u32,
    count: u32,
) -> PixelSum {
    let mut sum = PixelSum::ZERO;
    if count == 0 {
        return sum;
    }
    let mut n_left = count;
    let mut path = Path::start(scene, x, y, first);
    loop {
        if !path.advance(scene, accel) {
            sum.add_sample(path.radiance, path.n_rays);
            n_left -= 1;
            if n_left == 0 {
                return sum;
            }
            path = Path::start(scene, x, y, first + (count - n_left));
        }
    }
}
