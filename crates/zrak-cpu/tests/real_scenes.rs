//! What real scenes add, against closed forms: lights without a surface, holes, mixed materials, media
//! that surfaces bound, instances.

mod common;

use common::scenes::{cuboid, lambertian, light, quad, scene, sphere};
use common::{arena, mean_and_error, render};
use zrak_cpu::Tree;
use zrak_scene::desc::{
    LightDesc, LightSides, MaterialDesc, MediumDesc, MediumInterfaceDesc, ObjectDesc, ScalarDesc,
    SceneDesc, SpotFalloff, TransformStep,
};

/// A floor of albedo 0.5 at y = 0, whose origin one pixel looks at from (0, 3, 4).
fn floor(n_samples: u32) -> SceneDesc {
    let mut desc = scene([1, 1], 0.0);
    desc.camera.look_from = [0.0, 3.0, 4.0];
    desc.camera.vfov_deg = 1e-3;
    desc.render.samples_per_pixel = n_samples;
    desc.materials.insert("floor".to_owned(), lambertian(0.5));
    desc.objects.push(quad([-50.0, 0.0, 50.0], [100.0, 0.0, 0.0], [0.0, 0.0, -100.0], "floor"));
    desc
}

/// Values of many independent renders of one pixel, by channel.
fn values(desc: &SceneDesc, n: u64) -> Vec<[f64; 3]> {
    let mut desc = desc.clone();
    (0..n)
        .map(|seed| {
            desc.render.seed = seed;
            let film = render(&arena(&desc), 1, Tree::Wide, desc.render.samples_per_pixel);
            film.pixels[0].mean().to_array().map(f64::from)
        })
        .collect()
}

#[track_caller]
fn check_exact(desc: &SceneDesc, expected: [f64; 3]) {
    let [value] = values(desc, 1)[..] else { unreachable!() };
    for (value, expected) in value.into_iter().zip(expected) {
        assert!((value - expected).abs() <= 2e-5 * expected, "{value} is not {expected}");
    }
}

#[track_caller]
fn check_mean(desc: &SceneDesc, expected: [f64; 3]) {
    let values = values(desc, 60);
    for channel in 0..3 {
        let of_channel: Vec<f64> = values.iter().map(|v| v[channel]).collect();
        let (mean, error) = mean_and_error(&of_channel);
        let z = (mean - expected[channel]) / error.max(1e-6 * expected[channel]);
        assert!(z.abs() < 4.0, "channel {channel}: {mean} +- {error}, not {}", expected[channel]);
        assert!(error < 0.05 * expected[channel], "too noisy: {mean} +- {error}");
    }
}

#[test]
fn lights_without_a_surface_light_a_floor() {
    let pi = std::f64::consts::PI;
    let intensity = [10.0, 20.0, 5.0];
    let (x, y) = (1.5_f64, 2.0_f64);
    let d2 = x * x + y * y;
    let cos = y / d2.sqrt();
    let point = LightDesc::Point { position: [x, y, 0.0], intensity };
    let expected = intensity.map(|i| 0.5 / pi * i * cos / d2);
    let mut desc = floor(4);
    desc.lights = vec![point.clone()];
    check_exact(&desc, expected);
    // A spot whose axis points at the origin, and one that misses it halfway.
    for (tilt_deg, share) in [(0.0_f64, 1.0), (15.0, 0.5), (25.0, 0.0)] {
        // Between 10 and 20 degrees x is half at the angle whose cosine is between theirs.
        let (c0, c1) = (10.0_f64.to_radians().cos(), 20.0_f64.to_radians().cos());
        let tilt = if share == 0.5 { (0.5 * (c0 + c1)).acos() } else { tilt_deg.to_radians() };
        let angle = (-y).atan2(-x) + tilt;
        desc.lights = vec![LightDesc::Spot {
            position: [x, y, 0.0],
            direction: [angle.cos(), angle.sin(), 0.0],
            intensity,
            cone_angle_deg: 20.0,
            falloff_start_deg: 10.0,
            falloff: SpotFalloff::Smoothstep,
        }];
        if share == 0.5 {
            // Where the falloff is steep, the cosine's rounding counts.
            desc.render.samples_per_pixel = 1;
            let value = values(&desc, 1)[0][0] / expected[0];
            assert!((value - share).abs() < 1e-3, "{value}");
        } else {
            check_exact(&desc, expected.map(|e| e * share));
        }
    }
    let irradiance = [3.0, 2.0, 1.0];
    let sun = LightDesc::Distant { direction: [1.0, -2.0, 0.0], irradiance };
    desc.lights = vec![sun.clone()];
    let from_sun = irradiance.map(|e| 0.5 / pi * e * 2.0 / 5.0_f64.sqrt());
    check_exact(&desc, from_sun);
    // Both: one is chosen each time.
    desc.lights = vec![point, sun];
    desc.render.samples_per_pixel = 64;
    check_mean(&desc, std::array::from_fn(|i| expected[i] + from_sun[i]));
    // Something in the way of one.
    desc.materials.insert("black".to_owned(), lambertian(0.0));
    desc.objects.push(sphere([0.75, 1.0, 0.0], 0.1, "black"));
    check_mean(&desc, from_sun);
    // A ray to a light is a segment.
    desc.render.max_depth = 1;
    assert_eq!(values(&desc, 1), [[0.0; 3]]);
}

#[test]
fn holes_let_their_share_of_light_through() {
    let pi = std::f64::consts::PI;
    let mut desc = floor(64);
    desc.lights = vec![LightDesc::Point { position: [0.0, 2.0, 0.0], intensity: [8.0; 3] }];
    desc.materials.insert("black".to_owned(), lambertian(0.0));
    let mut gauze = MaterialDesc::surface("black");
    let MaterialDesc::Surface { alpha, .. } = &mut gauze else { unreachable!() };
    *alpha = Some(ScalarDesc::Value(0.25));
    desc.materials.insert("gauze".to_owned(), gauze.clone());
    // Two layers between light and floor, and one before the camera.
    for y in [1.0, 1.2] {
        desc.objects.push(quad([-0.2, y, 0.2], [0.4, 0.0, 0.0], [0.0, 0.0, -0.4], "gauze"));
    }
    desc.objects.push(quad([-1.0, 2.0, 3.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], "gauze"));
    let bare = 0.5 / pi * 8.0 / 4.0;
    check_mean(&desc, [bare * 0.75 * 0.75 * 0.75; 3]);
    // With a cutoff they are there or not; holes are no segments.
    desc.render.max_depth = 2;
    for (cutoff, there) in [(0.2, true), (0.3, false)] {
        let MaterialDesc::Surface { alpha_cutoff, .. } = &mut gauze else { unreachable!() };
        *alpha_cutoff = Some(cutoff);
        desc.materials.insert("gauze".to_owned(), gauze.clone());
        check_exact(&desc, [if there { 0.0 } else { bare }; 3]);
    }
}

/// A box from (-3, 0.5, -3) to (3, 1, 3) that bounds a medium, over the floor.
fn slab(sigma_a: [f64; 3], sigma_s: [f64; 3]) -> SceneDesc {
    let mut desc = floor(64);
    desc.media.insert("mist".to_owned(), MediumDesc { sigma_a, sigma_s, g: 0.3 });
    desc.materials.insert("nothing".to_owned(), MaterialDesc::Interface);
    let mut shell = MaterialDesc::surface("nothing");
    let MaterialDesc::Surface { medium, .. } = &mut shell else { unreachable!() };
    *medium = Some(MediumInterfaceDesc { inside: Some("mist".to_owned()), outside: None });
    desc.materials.insert("shell".to_owned(), shell);
    desc.objects.push(cuboid([-3.0, 0.5, -3.0], [3.0, 1.0, 3.0], "shell"));
    desc
}

#[test]
fn media_absorb_exponentially() {
    let pi = std::f64::consts::PI;
    let sigma = [0.5, 1.0, 2.0];
    let mut desc = slab(sigma, [0.0; 3]);
    // Straight down through half a unit; the camera's ray crosses half a unit over its cosine.
    desc.lights = vec![LightDesc::Point { position: [0.0, 2.0, 0.0], intensity: [8.0; 3] }];
    let bare = 0.5 / pi * 8.0 / 4.0;
    let path = 0.5 + 0.5 * 5.0 / 3.0;
    check_exact(&desc, sigma.map(|s| bare * (-s * path).exp()));
    // A camera that is in the medium everywhere, in front of a light.
    let mut desc = scene([1, 1], 0.0);
    desc.camera.vfov_deg = 1e-3;
    desc.media.insert("mist".to_owned(), MediumDesc { sigma_a: sigma, sigma_s: [0.0; 3], g: 0.0 });
    desc.camera.medium = Some("mist".to_owned());
    desc.materials.insert("lamp".to_owned(), light(3.0, LightSides::Both));
    desc.objects.push(quad([-1.0, -1.0, 4.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], "lamp"));
    check_exact(&desc, sigma.map(|s| 3.0 * (-s).exp()));
}

#[test]
fn media_that_only_scatter_are_invisible_in_a_glow() {
    let mut desc = slab([0.0; 3], [0.5, 0.7, 1.0]);
    desc.background = zrak_scene::desc::BackgroundDesc::Constant { color: [1.0; 3] };
    desc.materials.insert("floor".to_owned(), lambertian(1.0));
    desc.render.max_depth = 60_000;
    desc.render.samples_per_pixel = 256;
    check_mean(&desc, [1.0; 3]);
}

#[test]
fn single_scattering_is_that_of_the_integral() {
    // A thin ray through a medium that scatters evenly, lit by distant light from the side: the
    // radiance is the integral of sigma_s phase E exp(-sigma_t (x + y)) along it.
    let (sigma_s, sigma_t) = (0.7_f64, 1.1_f64);
    let mut desc = scene([1, 1], 0.0);
    desc.camera.vfov_deg = 1e-3;
    desc.camera.look_from = [-5.0, 0.0, 0.0];
    desc.render.samples_per_pixel = 4000;
    // The camera ray, one scattering, the ray to the light.
    desc.render.max_depth = 2;
    desc.media.insert(
        "mist".to_owned(),
        MediumDesc { sigma_a: [sigma_t - sigma_s; 3], sigma_s: [sigma_s; 3], g: 0.0 },
    );
    desc.materials.insert("nothing".to_owned(), MaterialDesc::Interface);
    let mut shell = MaterialDesc::surface("nothing");
    let MaterialDesc::Surface { medium, .. } = &mut shell else { unreachable!() };
    *medium = Some(MediumInterfaceDesc { inside: Some("mist".to_owned()), outside: None });
    desc.materials.insert("shell".to_owned(), shell);
    desc.objects.push(cuboid([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0], "shell"));
    desc.lights = vec![LightDesc::Distant { direction: [0.0, -1.0, 0.0], irradiance: [10.0; 3] }];
    let phase = 0.25 / std::f64::consts::PI;
    let along = (1.0 - (-2.0 * sigma_t).exp()) / sigma_t;
    check_mean(&desc, [sigma_s * phase * 10.0 * (-sigma_t).exp() * along; 3]);
}

#[test]
fn mixes_blend_materials() {
    let pi = std::f64::consts::PI;
    let mut desc = floor(256);
    desc.lights = vec![LightDesc::Point { position: [0.0, 2.0, 0.0], intensity: [8.0; 3] }];
    for (name, albedo) in [("a", 0.1), ("b", 0.5), ("c", 0.9)] {
        desc.materials.insert(name.to_owned(), lambertian(albedo));
    }
    let mix = |a: &str, b: &str, amount| MaterialDesc::Mix {
        materials: [a.to_owned(), b.to_owned()],
        amount: ScalarDesc::Value(amount),
    };
    desc.materials.insert("inner".to_owned(), mix("b", "c", 0.25));
    desc.materials.insert("floor".to_owned(), mix("a", "inner", 0.6));
    let albedo = 0.4 * 0.1 + 0.6 * (0.75 * 0.5 + 0.25 * 0.9);
    check_mean(&desc, [albedo / pi * 8.0 / 4.0; 3]);
}

#[test]
fn instances_look_like_what_they_place() {
    // The workshop's shared mesh once under instances, once written out.
    let workshop = (zrak_scene::builtin::find("workshop").unwrap().build)();
    let ball = workshop.meshes["ball"].clone();
    let placed = |names: [&str; 2]| {
        let mut desc = scene([40, 40], 0.7);
        desc.materials.insert("m".to_owned(), lambertian(0.5));
        for (name, x) in names.into_iter().zip([-0.7, 0.8]) {
            desc.meshes.insert(name.to_owned(), ball.clone());
            desc.objects.push(ObjectDesc::Mesh {
                mesh: name.to_owned(),
                material: "m".to_owned(),
                group_materials: Vec::new(),
                flip: false,
                transform: vec![
                    TransformStep::RotateXDeg(20.0),
                    TransformStep::Translate([x, 0.1, 0.0]),
                ],
            });
        }
        desc.lights =
            vec![LightDesc::Distant { direction: [1.0, -1.0, -1.0], irradiance: [2.0; 3] }];
        arena(&desc)
    };
    let (shared, copied) = (placed(["a", "a"]), placed(["a", "b"]));
    assert_eq!((shared.view().instances.len(), copied.view().instances.len()), (2, 0));
    let n = shared.view().mesh_triangles.len();
    assert_eq!(copied.view().mesh_triangles.len(), 2 * n);
    let [a, b] = [shared, copied].map(|scene| render(&scene, 2, Tree::Wide, 64));
    let mut worst: f32 = 0.0;
    for (a, b) in a.pixels.iter().zip(&b.pixels) {
        worst = worst.max((a.mean().g - b.mean().g).abs());
    }
    // The same paths but for rounding; now and then one goes another way.
    assert!(worst < 0.02, "{worst}");
}
