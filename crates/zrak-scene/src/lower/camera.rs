//! The camera's vectors.

use zrak_core::camera::Camera;
use zrak_core::math::Vec3;

use crate::desc::{CameraDesc, Triple};

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
    // Size of the picture on the plane in focus.
    let height = 2.0 * libm::tan(half_angle(desc.vfov_deg)) * desc.focus_distance;
    let width = height * f64::from(desc.width) / f64::from(desc.height);
    let to_center = scaled(forward, desc.focus_distance);
    let corner = plus(to_center, plus(scaled(right, -0.5 * width), scaled(up, 0.5 * height)));
    let lens_radius = desc.focus_distance * libm::tan(half_angle(desc.defocus_angle_deg));
    Camera {
        origin: single(desc.look_from),
        shutter_open_s: desc.shutter_open_s as f32,
        corner: single(corner),
        shutter_close_s: desc.shutter_close_s as f32,
        pixel_dx: single(scaled(right, width / f64::from(desc.width))),
        width: desc.width,
        pixel_dy: single(scaled(up, -height / f64::from(desc.height))),
        height: desc.height,
        lens_u: single(scaled(right, lens_radius)),
        has_lens: u32::from(lens_radius > 0.0),
        lens_v: single(scaled(up, lens_radius)),
        _pad: 0,
    }
}
