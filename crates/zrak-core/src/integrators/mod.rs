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
/// ended starts the next sample at once instead of waiting for the longest path of its warp. It has
/// a single exit, at its head: with a `return` from inside, ptxas (13.0 and 13.5, above -O0) made
/// code that lost samples.
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
    let mut n_done = 0;
    let mut path = Path::start(scene, x, y, first);
    while n_done < count {
        if !path.advance(scene, accel) {
            sum.add_sample(path.radiance, path.n_rays);
            n_done += 1;
            path = Path::start(scene, x, y, first.wrapping_add(n_done));
        }
    }
    sum
}
