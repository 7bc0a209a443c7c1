//! The lowered camera against its description.

use zrak_core::math::Vec3;
use zrak_core::sampler::{CameraDim, Sampler};

use super::{Rng, arena, scene};
use crate::desc::{CameraDesc, Triple};

fn double(v: Vec3) -> Triple {
    v.to_array().map(f64::from)
}

fn sub(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Triple) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: Triple) -> Triple {
    a.map(|x| x / length(a))
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn random(rng: &mut Rng) -> CameraDesc {
    CameraDesc {
        look_from: rng.triple(10.0),
        look_at: rng.triple(10.0),
        vup: rng.triple(1.0),
        vfov_deg: rng.range(1.0, 170.0),
        width: 1 + rng.range(0.0, 300.0) as u32,
        height: 1 + rng.range(0.0, 300.0) as u32,
        defocus_angle_deg: if rng.range(0.0, 1.0) < 0.5 { 0.0 } else { rng.range(0.1, 20.0) },
        focus_distance: rng.range(0.5, 20.0),
        shutter_open_s: 0.25,
        shutter_close_s: 0.75,
        ..CameraDesc::default()
    }
}

/// Angles of rays are those of a view through a window of height 2 tan(vfov / 2) at distance 1.
#[test]
fn rays_go_where_the_description_says() {
    let mut rng = Rng(1);
    for _ in 0..2000 {
        let desc = random(&mut rng);
        let mut scene = scene(Vec::new());
        scene.camera = desc.clone();
        let camera = arena(&scene).globals().camera;
        let forward = unit(sub(desc.look_at, desc.look_from));
        let right = unit(cross(forward, desc.vup));
        let up = cross(right, forward);
        let half_height = (desc.vfov_deg / 2.0).to_radians().tan();
        let half_width = half_height * f64::from(desc.width) / f64::from(desc.height);
        let (x, y) = (
            rng.range(0.0, f64::from(desc.width)) as u32,
            rng.range(0.0, f64::from(desc.height)) as u32,
        );
        let sampler = Sampler::new(3, x, y, 1);
        let ray = camera.ray(x, y, &sampler);
        // The point of the ray on the plane in focus, seen from the lens' centre.
        let from_lens = sub(double(ray.o), desc.look_from);
        let d = double(ray.d);
        let t = (desc.focus_distance - dot(from_lens, forward)) / dot(d, forward);
        let at: Triple = std::array::from_fn(|i| (from_lens[i] + d[i] * t) / desc.focus_distance);
        let sx = (dot(at, right) / half_width + 1.0) / 2.0 * f64::from(desc.width);
        let sy = (1.0 - dot(at, up) / half_height) / 2.0 * f64::from(desc.height);
        let px = f64::from(x) + f64::from(sampler.camera(CameraDim::PixelX));
        let py = f64::from(y) + f64::from(sampler.camera(CameraDim::PixelY));
        // Rounding of positions near 10 and of directions, in pixels.
        let pixels_per_unit = f64::from(desc.height) / (2.0 * half_height);
        let slant = 1.0 + half_width * half_width + half_height * half_height;
        let tolerance = pixels_per_unit * (4e-6 / desc.focus_distance + 4e-7 * slant);
        assert!((sx - px).abs() < tolerance && (sy - py).abs() < tolerance, "{sx} {px} {sy} {py}");
        // The lens lies across the view, as large as its cone says.
        let radius = desc.focus_distance * (desc.defocus_angle_deg / 2.0).to_radians().tan();
        assert!(length(from_lens) <= radius + 1e-5 && dot(from_lens, forward).abs() < 1e-5);
        assert!((0.25..=0.75).contains(&ray.time));
    }
}

#[test]
fn the_lens_is_filled_to_its_rim() {
    let mut scene = scene(Vec::new());
    scene.camera.defocus_angle_deg = 10.0;
    let camera = arena(&scene).globals().camera;
    let radius = 10.0 * 5.0_f64.to_radians().tan();
    let distances: Vec<f64> = (0..2000)
        .map(|i| {
            let o = double(camera.ray(0, 0, &Sampler::new(0, 0, 0, i)).o);
            length(sub(o, [0.0, 0.0, 5.0]))
        })
        .collect();
    let largest = distances.iter().fold(0.0, |m: f64, &r| m.max(r));
    assert!((0.99 * radius..=1.000_01 * radius).contains(&largest), "{largest} {radius}");
    // Half of the points are within the root of a half.
    let inner = distances.iter().filter(|&&r| r < radius * 0.5_f64.sqrt()).count();
    assert!((900..1100).contains(&inner), "{inner}");
}

#[test]
fn centres_and_corners_of_a_view_90_degrees_high() {
    // 40 x 20 pixels, from (0, 0, 5) towards -z.
    let camera = arena(&scene(Vec::new())).globals().camera;
    assert_eq!(camera.origin, Vec3 { x: 0.0, y: 0.0, z: 5.0 });
    let close = |v: Vec3, expected: Triple| {
        assert!(length(sub(double(v), expected)) < 1e-5, "{v:?} {expected:?}");
    };
    close(camera.corner, [-20.0, 10.0, -10.0]);
    close(camera.pixel_dx, [1.0, 0.0, 0.0]);
    close(camera.pixel_dy, [0.0, -1.0, 0.0]);
    assert_eq!((camera.width, camera.height, camera.has_lens), (40, 20, 0));
}

#[test]
fn globals_are_those_of_the_description() {
    let mut scene = scene(Vec::new());
    scene.render.seed = 0x1234_5678_9abc_def0;
    scene.render.max_depth = 17;
    scene.background =
        crate::desc::BackgroundDesc::Gradient { bottom: [0.1, 0.2, 0.3], top: [0.4, 0.5, 0.6] };
    let arena = arena(&scene);
    let globals = arena.globals();
    assert_eq!((globals.seed(), globals.max_depth), (0x1234_5678_9abc_def0, 17));
    assert_eq!(globals.background.bottom.to_array(), [0.1, 0.2, 0.3]);
    assert_eq!(globals.background.top.to_array(), [0.4, 0.5, 0.6]);
}
