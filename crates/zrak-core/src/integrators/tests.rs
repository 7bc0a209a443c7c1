//! The naive estimator's bookkeeping; whole pictures are tested in `zrak-cpu`.

use super::render_pixel;
use crate::accel::BruteForce;
use crate::accessor::Array;
use crate::film::PixelSum;
use crate::lights::{LIGHT_DISTANT, LIGHT_POINT, Light};
use crate::materials::{DiffuseLight, Lambertian, SIDES_BOTH};
use crate::math::{Color, Vec3, vec3};
use crate::scene::{Background, MaterialKind, MaterialRef, PrimKind, SceneView};
use crate::shapes::{Box3, Sphere};
use crate::testing::{TestScene, globals, prim, solid};

/// A sphere in front of the camera, in a closed light.
fn scene(albedo: f32, emitted: f32) -> TestScene {
    let mut scene = TestScene::default();
    scene.lambertians.push(Lambertian { albedo: solid(Color::grey(albedo)) });
    scene.diffuse_lights.push(DiffuseLight {
        radiance: solid(Color::grey(emitted)),
        sides: SIDES_BOTH,
        _pad: [0; 3],
    });
    scene.spheres.push(Sphere {
        center: vec3(0.0, 0.0, -5.0),
        radius: 4.5,
        material: MaterialRef::new(MaterialKind::Lambertian, 0),
        flags: 0,
        _pad: [0; 2],
    });
    scene.boxes.push(Box3 {
        lo: Vec3::splat(-20.0),
        material: MaterialRef::new(MaterialKind::DiffuseLight, 0),
        hi: Vec3::splat(20.0),
        _pad: 0,
    });
    scene
}

fn pixel(view: &SceneView, first: u32, count: u32) -> PixelSum {
    let prims = [prim(PrimKind::Sphere, 0), prim(PrimKind::Box, 0)];
    render_pixel(view, BruteForce { prims: Array::new(&prims) }, 0, 0, first, count)
}

#[test]
fn a_path_adds_what_it_meets_times_its_throughput() {
    let scene = scene(0.25, 8.0);
    let view = scene.view();
    for i in 0..200 {
        let sum = pixel(&view, i, 1);
        // The light at once, or after one bounce.
        let expected = if sum.n_rays == 1 { 8.0 } else { 2.0 };
        assert_eq!((sum.mean().to_array(), sum.n_samples), ([expected; 3], 1));
        assert!(sum.n_rays <= 2);
    }
}

#[test]
fn max_depth_counts_ray_segments() {
    let scene = scene(1.0, 1.0);
    for (max_depth, lit) in [(1, false), (2, true)] {
        let mut view = scene.view();
        view.globals.max_depth = max_depth;
        // A sample that meets the sphere first.
        let i = (0..100).find(|&i| pixel(&scene.view(), i, 1).n_rays == 2).unwrap();
        let sum = pixel(&view, i, 1);
        assert_eq!(sum.n_rays, u64::from(max_depth));
        assert_eq!(sum.mean() == Color::WHITE, lit);
    }
}

#[test]
fn samples_of_a_pixel_add_up_in_any_grouping() {
    let scene = scene(0.3, 0.7);
    let view = scene.view();
    let whole = pixel(&view, 3, 50);
    let mut parts = PixelSum::ZERO;
    for (first, count) in [(20, 33), (3, 1), (4, 16), (9, 0)] {
        parts.merge(&pixel(&view, first, count));
    }
    assert_eq!(parts, whole);
    assert_eq!(pixel(&view, 0, 0), PixelSum::ZERO);
}

#[test]
fn backgrounds_blend_by_height_and_constants_are_exact() {
    let (bottom, top) = (Color::new(1.0, 0.0, 0.3), Color::new(0.0, 1.0, 0.3));
    let sky = Background { bottom, top };
    assert_eq!(sky.radiance(vec3(0.0, -1.0, 0.0)), bottom);
    assert_eq!(sky.radiance(vec3(0.0, 1.0, 0.0)), top);
    assert_eq!(sky.radiance(vec3(1.0, 0.0, 0.0)), Color::new(0.5, 0.5, 0.3));
    for i in 0..1000 {
        let y = i as f32 / 500.0 - 1.0;
        assert_eq!(sky.radiance(vec3(0.0, y, 0.0)).b, 0.3);
    }
    // A camera with nothing before it sees it.
    let empty = TestScene::default();
    let background = Background { bottom: Color::grey(0.1), top: Color::grey(0.1) };
    let view = empty.view_with(crate::scene::Globals { background, ..globals() });
    let sum = render_pixel(&view, BruteForce { prims: Array::new(&[]) }, 0, 0, 0, 9);
    assert_eq!((sum.mean(), sum.n_rays), (Color::grey(0.1), 9));
}

#[test]
fn roulette_keeps_the_mean_and_saves_rays() {
    // In a box that reflects half of the light, and with a background that nobody sees: the emission of
    // the sphere's surroundings comes back 1 + 1/2 + 1/4 + ... times.
    let scene = scene(0.5, 1.0);
    let (n, mut means, mut rays) = (40_000, [0.0; 2], [0; 2]);
    let mut squares = [0.0; 2];
    for (k, rr_depth) in [u32::MAX, 1].into_iter().enumerate() {
        let mut view = scene.view();
        view.globals.rr_depth = rr_depth;
        for i in 0..n {
            let sum = pixel(&view, i, 1);
            let x = f64::from(sum.mean().r);
            means[k] += x / f64::from(n);
            squares[k] += x * x / f64::from(n);
            rays[k] += sum.n_rays;
        }
    }
    let variance = squares[0] - means[0] * means[0] + squares[1] - means[1] * means[1];
    let z = (means[1] - means[0]) / (variance / f64::from(n)).sqrt();
    assert!(z.abs() < 4.0, "{means:?}, z = {z}");
    assert!(rays[1] < rays[0], "{rays:?}");
}

#[test]
fn roulette_leaves_paths_alone_that_lose_nothing() {
    let scene = scene(1.0, 0.75);
    let mut view = scene.view();
    for i in 0..200 {
        view.globals.rr_depth = u32::MAX;
        let without = pixel(&view, i, 1);
        view.globals.rr_depth = 1;
        assert_eq!(pixel(&view, i, 1), without);
    }
}

/// Lights without a surface, chosen by chance: together they give what each gives alone, and what is in the
/// way of one does not hide the others.
#[test]
fn chosen_lights_add_up() {
    let mut scene = TestScene::default();
    scene.lambertians.push(Lambertian { albedo: solid(Color::grey(0.5)) });
    // A wall at z = -5, and a ball between it and the last light.
    scene.quads.push(crate::testing::quad(
        vec3(-50.0, -50.0, -5.0),
        vec3(100.0, 0.0, 0.0),
        vec3(0.0, 100.0, 0.0),
    ));
    scene.spheres.push(Sphere {
        center: vec3(20.0, 0.0, 5.0),
        radius: 1.0,
        material: MaterialRef::new(MaterialKind::Lambertian, 0),
        flags: 0,
        _pad: [0; 2],
    });
    let light = |kind, position: Vec3, direction: Vec3, intensity: f32| Light {
        position,
        kind,
        direction,
        cos_start: 1.0,
        intensity: Color::grey(intensity),
        cos_rim: 0.0,
        falloff: 0,
        _pad: [0; 3],
    };
    let down = vec3(0.0, 0.0, -1.0);
    scene.lights.push(light(LIGHT_DISTANT, Vec3::ZERO, down, 3.0));
    scene.lights.push(light(LIGHT_POINT, vec3(0.0, 0.0, -3.0), down, 8.0));
    scene.lights.push(light(LIGHT_POINT, vec3(40.0, 0.0, 15.0), down, 1e6));
    let black = Background { bottom: Color::BLACK, top: Color::BLACK };
    let mut globals = crate::scene::Globals { background: black, ..globals() };
    // All rays of the pixel go to one point of the wall, right ahead.
    globals.camera.corner = vec3(0.0, 0.0, -1.0);
    globals.camera.pixel_dx = Vec3::ZERO;
    globals.camera.pixel_dy = Vec3::ZERO;
    let view = scene.view_with(globals);
    let prims = [prim(PrimKind::Quad, 0), prim(PrimKind::Sphere, 0)];
    let n = 60_000;
    let sum = render_pixel(&view, BruteForce { prims: Array::new(&prims) }, 0, 0, 0, n);
    // f = 0.5 / pi, and 8 / 2^2 from the point.
    let exact = 0.5 / std::f64::consts::PI * (3.0 + 2.0);
    let got = f64::from(sum.mean().g);
    // One of three lights: values of 3 e1, 3 e2 and 0, with a deviation of about their mean.
    assert!((got / exact - 1.0).abs() < 5.0 / f64::from(n).sqrt(), "{got} {exact}");
}
