//! A camera and a light for geometry that comes without: what importers fall back on.

use crate::desc::{BackgroundDesc, CameraDesc, Triple};

/// Vertical field of view, in degrees.
const VFOV_DEG: f64 = 40.0;

/// From the middle of the scene to the camera: in front, to the right and above, with y up and the
/// front towards +z.
const THREE_QUARTER: Triple = [0.55, 0.4, 1.0];

/// A camera that shows everything in `bounds` (smallest and largest corner) from a three-quarter view,
/// with +y up, in a picture of 16:9 and this height.
#[must_use]
pub fn frame_camera(bounds: [Triple; 2], height: u32) -> CameraDesc {
    let [lo, hi] = bounds;
    let middle = [0, 1, 2].map(|i| lo[i] + (hi[i] - lo[i]) / 2.0);
    let length = |v: Triple| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let radius = length([0, 1, 2].map(|i| (hi[i] - lo[i]) / 2.0));
    // A single point is looked at from a distance that single precision can tell from it.
    let radius = radius.max(1e-3 * length(middle)).max(1e-6);
    // The sphere around everything just fits between the lower and the upper rim.
    let half_angle = VFOV_DEG * (std::f64::consts::PI / 360.0);
    let distance = radius / libm::sin(half_angle);
    let scale = distance / length(THREE_QUARTER);
    let height = height.max(1);
    CameraDesc {
        look_from: [0, 1, 2].map(|i| middle[i] + THREE_QUARTER[i] * scale),
        look_at: middle,
        vup: [0.0, 1.0, 0.0],
        vfov_deg: VFOV_DEG,
        width: (u64::from(height) * 16).div_ceil(9).min(65_536) as u32,
        height,
        focus_distance: distance,
        ..CameraDesc::default()
    }
}

/// A soft, slightly blue sky over a grey ground.
#[must_use]
pub fn default_background() -> BackgroundDesc {
    BackgroundDesc::Gradient { bottom: [0.3, 0.3, 0.3], top: [0.9, 0.95, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::{default_background, frame_camera};
    use crate::desc::SceneDesc;
    use crate::validate::validate;

    #[test]
    fn any_bounds_make_a_good_camera() {
        for bounds in [
            [[-1.0; 3], [1.0; 3]],
            [[0.0; 3], [0.0; 3]],
            [[1000.0; 3], [1000.0; 3]],
            [[-1e9; 3], [1e9; 3]],
            [[-1e-6; 3], [1e-6, 0.0, 2e-6]],
            [[0.0, 5.0, 0.0], [1e6, 5.0, 0.0]],
        ] {
            let camera = frame_camera(bounds, 720);
            assert_eq!((camera.width, camera.height), (1280, 720));
            let background = default_background();
            let scene = SceneDesc { camera, background, ..SceneDesc::default() };
            assert_eq!(validate(&scene), [], "{bounds:?}");
        }
    }

    #[test]
    fn everything_is_in_view() {
        let [lo, hi] = [[-3.0, 0.0, 2.0], [5.0, 1.0, 2.5]];
        let camera = frame_camera([lo, hi], 90);
        let to = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - camera.look_from[i]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let view = to(camera.look_at);
        for i in 0..8 {
            let corner = [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { lo[axis] } else { hi[axis] });
            let v = to(corner);
            let cosine = dot(v, view) / (dot(v, v) * dot(view, view)).sqrt();
            // Half of the 40 degrees, as the sphere around the box touches that cone.
            assert!(cosine >= 20.0_f64.to_radians().cos() - 1e-12, "{corner:?}: {cosine}");
        }
    }
}
