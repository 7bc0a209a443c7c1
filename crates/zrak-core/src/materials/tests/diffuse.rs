//! Lambertian surfaces, isotropic phase functions and lights.

use super::super::{DiffuseLight, Isotropic, Lambertian, SIDES_BOTH, SIDES_FRONT, respond};
use super::{WHITE, local, responses, sector, surface};
use crate::math::{Color, Vec3, vec3};
use crate::sampler::Sampler;
use crate::scene::MaterialKind;
use crate::testing::{ChiSquared, Rng, TestScene, double, length, solid};

#[test]
fn lambertian_directions_have_density_cos_over_pi() {
    let mut rng = Rng::new(1);
    let (n_rings, n_sectors, n) = (30, 30, 400_000);
    let test = ChiSquared { n_tests: 6 };
    let mut scene = TestScene::default();
    let albedo = Color::new(0.25, 0.5, 1.0);
    scene.lambertians.push(Lambertian { albedo: solid(albedo) });
    let view = scene.view();
    for case in 0..6 {
        let normal = if case == 0 { vec3(0.0, 0.0, 1.0) } else { rng.direction() };
        let s = surface(normal, MaterialKind::Lambertian);
        let d = rng.direction();
        // The side that the light comes from.
        let side = if s.is_front(d) { double(normal) } else { double(-normal) };
        let mut counts = vec![0_u64; n_rings * n_sectors];
        for response in responses(&view, &s, d, n) {
            let scatter = response.scatter.unwrap();
            assert_eq!((scatter.attenuation, response.emitted), (albedo, Color::BLACK));
            let w = local(side, scatter.wi);
            assert!((length(w) - 1.0).abs() < 1e-6);
            assert!(w[2] > 0.0, "below the surface");
            // cos / pi projects to a uniform disk: cos^2 is uniform.
            let ring = ((w[2] * w[2] * n_rings as f64) as usize).min(n_rings - 1);
            counts[ring * n_sectors + sector(w, n_sectors)] += 1;
        }
        test.check_uniform(&format!("case {case}"), &counts);
    }
}

#[test]
fn the_point_opposite_of_the_normal_is_no_trap() {
    let mut rng = Rng::new(2);
    for _ in 0..200_000 {
        // Near u = 1 the point of the sphere is -z.
        let n = vec3(0.0, 0.0, 1.0);
        let u = 1.0 - rng.log_range(1e-8, 1e-2) as f32;
        let wi = super::super::lambertian::sample_cosine(n, u, rng.unit_f32());
        assert!((wi.length() - 1.0).abs() < 1e-6 && wi.z > 0.0, "{wi:?}");
    }
}

#[test]
fn isotropic_directions_are_uniform() {
    let mut scene = TestScene::default();
    let albedo = Color::new(0.3, 0.6, 0.9);
    scene.isotropics.push(Isotropic { albedo: solid(albedo) });
    let view = scene.view();
    let (n_bands, n_sectors) = (30, 30);
    let mut counts = vec![0_u64; n_bands * n_sectors];
    for i in 0..400_000 {
        let sampler = Sampler::new(1, i % 100, 0, i / 100);
        let scatter = view.isotropics.get(0).scatter(&view, Vec3::ZERO, &sampler);
        assert_eq!(scatter.attenuation, albedo);
        let w = double(scatter.wi);
        assert!((length(w) - 1.0).abs() < 3e-7);
        let band = (((w[2] + 1.0) * 0.5 * n_bands as f64) as usize).min(n_bands - 1);
        counts[band * n_sectors + sector(w, n_sectors)] += 1;
    }
    ChiSquared { n_tests: 1 }.check_uniform("isotropic", &counts);
}

#[test]
fn lights_shine_on_the_sides_that_they_should() {
    let mut rng = Rng::new(3);
    let radiance = Color::new(1.0, 2.0, 3.0);
    for sides in [SIDES_BOTH, SIDES_FRONT] {
        let mut scene = TestScene::default();
        scene.diffuse_lights.push(DiffuseLight { radiance: solid(radiance), sides, _pad: [0; 3] });
        let view = scene.view();
        for _ in 0..10_000 {
            let s = surface(rng.direction(), MaterialKind::DiffuseLight);
            let d = rng.direction();
            let response = respond(&view, &s, d, &Sampler::new(0, 0, 0, 0));
            assert_eq!(response.scatter, None);
            let from_front = crate::math::dot(d, s.n) < 0.0;
            let shines = sides == SIDES_BOTH || from_front;
            assert_eq!(response.emitted, if shines { radiance } else { Color::BLACK });
        }
    }
}

#[test]
fn a_phase_function_on_a_surface_absorbs() {
    let mut scene = TestScene::default();
    scene.isotropics.push(Isotropic { albedo: solid(WHITE) });
    let s = surface(vec3(0.0, 1.0, 0.0), MaterialKind::Isotropic);
    let response = respond(&scene.view(), &s, vec3(0.0, -1.0, 0.0), &Sampler::new(0, 0, 0, 0));
    assert_eq!((response.emitted, response.scatter), (Color::BLACK, None));
}
