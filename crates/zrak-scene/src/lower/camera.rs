//! The camera's vectors.

use zrak_core::camera::{
    Camera, PROJECTION_EQUAL_AREA, PROJECTION_EQUIRECTANGULAR, PROJECTION_ORTHOGRAPHIC,
    PROJECTION_PERSPECTIVE,
};
use zrak_core::math::Vec3;

use crate::desc::{CameraDesc, ProjectionDesc, Triple};

pub(super) fn lower(desc: &CameraDesc) -> Camera {
    let scaled = |v: Triple, s: f64| v.map(|x| x * s);
    let plus = |a: Triple, b: Triple| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let minus = |a: Triple, b: Triple| plus(a, scaled(b, -1.0));
    let cross = |a: Triple, b: Triple| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let normalized = |v: Triple| {
        let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let v = scaled(v, 1.0 / largest);
        scaled(v, 1.0 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt())
    };
    let single = |v: Triple| Vec3::from_array(v.map(|x| x as f32));
    let half_angle = |deg: f64| deg * (std::f64::consts::PI / 360.0);

    let forward = normalized(minus(desc.look_at, desc.look_from));
    let right = normalized(cross(forward, desc.vup));
    let up = cross(right, forward);
    let right = if desc.flip_x { scaled(right, -1.0) } else { right };
    let size = [f64::from(desc.width), f64::from(desc.height)];
    // Size of the whole view in pixels, of which the picture is a part.
    let [x0, x1, y0, y1] = desc.window;
    let whole = [size[0] / (x1 - x0), size[1] / (y1 - y0)];
    let lens_radius = desc.focus_distance * libm::tan(half_angle(desc.defocus_angle_deg));
    let common = Camera {
        origin: single(desc.look_from),
        shutter_open_s: desc.shutter_open_s as f32,
        corner: Vec3::ZERO,
        shutter_close_s: desc.shutter_close_s as f32,
        pixel_dx: Vec3::ZERO,
        width: desc.width,
        pixel_dy: Vec3::ZERO,
        height: desc.height,
        lens_u: single(scaled(right, lens_radius)),
        has_lens: u32::from(lens_radius > 0.0),
        lens_v: single(scaled(up, lens_radius)),
        spread: 0.0,
        forward: single(forward),
        projection: PROJECTION_PERSPECTIVE,
    };
    // A flat picture of this height around the middle.
    let flat = |height: f64, middle: Triple, camera: Camera| {
        let width = height * whole[0] / whole[1];
        let left = scaled(right, width * (x0 - 0.5));
        let top = scaled(up, height * (0.5 - y0));
        Camera {
            corner: single(plus(middle, plus(left, top))),
            pixel_dx: single(scaled(right, width / whole[0])),
            pixel_dy: single(scaled(up, -height / whole[1])),
            ..camera
        }
    };
    match desc.projection {
        ProjectionDesc::Perspective => {
            let height = 2.0 * libm::tan(half_angle(desc.vfov_deg)) * desc.focus_distance;
            let spread = height / whole[1] / desc.focus_distance;
            let camera = Camera { spread: spread as f32, ..common };
            flat(height, scaled(forward, desc.focus_distance), camera)
        }
        ProjectionDesc::Orthographic { height } => {
            // The lens gathers what is parallel: its radius is that of a perspective camera.
            let camera = Camera {
                forward: single(scaled(forward, desc.focus_distance)),
                projection: PROJECTION_ORTHOGRAPHIC,
                ..common
            };
            flat(height, [0.0; 3], camera)
        }
        ProjectionDesc::Equirectangular | ProjectionDesc::EqualArea => Camera {
            corner: single([x0, y0, 0.0]),
            pixel_dx: single([1.0 / whole[0], 0.0, 0.0]),
            pixel_dy: single([0.0, 1.0 / whole[1], 0.0]),
            lens_u: single(right),
            has_lens: 0,
            lens_v: single(up),
            spread: (std::f64::consts::PI / whole[1]) as f32,
            projection: match desc.projection {
                ProjectionDesc::EqualArea => PROJECTION_EQUAL_AREA,
                _ => PROJECTION_EQUIRECTANGULAR,
            },
            ..common
        },
    }
}
