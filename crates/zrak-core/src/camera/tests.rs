//! Camera rays against their formula in `f64`.

use crate::math::{Vec3, vec3};
use crate::sampler::{CameraDim, Sampler};
use crate::testing::{
    ChiSquared, D3, Rng, add, camera, cross, dot, double, length, scaled, single, sub, unit,
};

#[test]
fn rays_go_through_their_pixels() {
    let mut rng = Rng::new(1);
    for _ in 0..20_000 {
        let mut camera = camera(200, 100);
        let forward = double(rng.direction());
        let right = unit(cross(forward, double(rng.direction())));
        let up = cross(right, forward);
        let focus = rng.log_range(0.01, 100.0);
        let pixel = rng.log_range(1e-4, 0.02) * focus;
        let radius = rng.log_range(1e-3, 0.2) * focus;
        camera.origin = rng.in_cube(10.0);
        camera.corner = single(add(
            scaled(forward, focus),
            add(scaled(right, -100.0 * pixel), scaled(up, 50.0 * pixel)),
        ));
        camera.pixel_dx = single(scaled(right, pixel));
        camera.pixel_dy = single(scaled(up, -pixel));
        camera.lens_u = single(scaled(right, radius));
        camera.lens_v = single(scaled(up, radius));
        camera.has_lens = rng.below(2);
        (camera.shutter_open_s, camera.shutter_close_s) = (0.25, 0.75);
        let (x, y) = (rng.below(200), rng.below(100));
        let sampler = Sampler::new(rng.bits(), x, y, 0);
        let ray = camera.ray(x, y, &sampler);

        let drawn = |dim| f64::from(sampler.camera(dim));
        let pixels = |n: u32, dim| f64::from(n) + drawn(dim);
        let target: D3 = add(
            double(camera.corner),
            add(
                scaled(double(camera.pixel_dx), pixels(x, CameraDim::PixelX)),
                scaled(double(camera.pixel_dy), pixels(y, CameraDim::PixelY)),
            ),
        );
        let lens = if camera.has_lens == 1 {
            let r = drawn(CameraDim::LensU).sqrt();
            let angle = std::f64::consts::TAU * drawn(CameraDim::LensV);
            add(
                scaled(double(camera.lens_u), r * angle.cos()),
                scaled(double(camera.lens_v), r * angle.sin()),
            )
        } else {
            [0.0; 3]
        };
        let o = add(double(camera.origin), lens);
        assert!(length(sub(double(ray.o), o)) < 1e-6 * (length(o) + radius) + 1e-6);
        let d = unit(sub(target, lens));
        assert!(length(sub(double(ray.d), d)) < 2e-6, "{:?} {d:?}", ray.d);
        assert!((length(double(ray.d)) - 1.0).abs() < 3e-7);
        let time = 0.25 + 0.5 * drawn(CameraDim::Time);
        assert!((f64::from(ray.time) - time).abs() < 1e-7);
        assert!((0.25..0.75).contains(&ray.time));
    }
}

#[test]
fn a_closed_shutter_is_one_moment_and_a_pinhole_one_point() {
    let mut camera = camera(4, 4);
    (camera.shutter_open_s, camera.shutter_close_s) = (0.3, 0.3);
    camera.origin = vec3(1.0, 2.0, 3.0);
    for s in 0..100 {
        let ray = camera.ray(1, 1, &Sampler::new(0, 1, 1, s));
        assert_eq!((ray.time, ray.o), (0.3, camera.origin));
    }
}

#[test]
fn samples_cover_pixel_lens_and_shutter_evenly() {
    let mut camera = camera(3, 3);
    camera.has_lens = 1;
    camera.lens_u = vec3(0.5, 0.0, 0.0);
    camera.lens_v = vec3(0.0, 0.5, 0.0);
    let (mut places, mut lens, mut times) = (vec![0_u64; 256], vec![0_u64; 256], vec![0_u64; 256]);
    let index = |a: f64, b: f64| (a * 16.0) as usize * 16 + (b * 16.0) as usize;
    for s in 0..200_000 {
        let ray = camera.ray(1, 1, &Sampler::new(3, 1, 1, s));
        // Where it passes the plane in focus, z = -1, in pixels.
        let at = ray.o + ray.d * (-1.0 / ray.d.z);
        let fraction = |x: f32| (f64::from(x * 1.5) + 0.5).clamp(0.0, 0.999_999_9);
        places[index(fraction(at.x), fraction(-at.y))] += 1;
        let (x, y) = (2.0 * f64::from(ray.o.x), 2.0 * f64::from(ray.o.y));
        let turn = (y.atan2(x) / std::f64::consts::TAU + 0.5).min(0.999_999_9);
        lens[index((x * x + y * y).min(0.999_999_9), turn)] += 1;
        times[(ray.time * 256.0) as usize] += 1;
    }
    let test = ChiSquared { n_tests: 3 };
    test.check_uniform("pixel", &places);
    test.check_uniform("lens", &lens);
    test.check_uniform("shutter", &times);
}

#[test]
fn corners_of_the_picture() {
    // 90 degrees high: the corners are at 45 degrees.
    let camera = camera(1000, 1000);
    for (x, y, corner) in [
        (0, 0, [-1.0, 1.0, -1.0]),
        (999, 0, [1.0, 1.0, -1.0]),
        (0, 999, [-1.0, -1.0, -1.0]),
        (999, 999, [1.0, -1.0, -1.0]),
    ] {
        let ray = camera.ray(x, y, &Sampler::new(0, x, y, 0));
        assert!(dot(double(ray.d), unit(corner)) > 1.0 - 1e-5);
    }
    assert_eq!(camera.ray(0, 0, &Sampler::new(0, 0, 0, 0)).o, Vec3::ZERO);
}
