//! Fuzzy mirrors against geometry and numeric integration in `f64`.

use super::super::{Metal, reflect};
use super::{WHITE, responses, surface};
use crate::math::{Color, Vec3, vec3};
use crate::scene::MaterialKind;
use crate::testing::{
    ChiSquared, D3, Rng, TestScene, add, cross, dot, double, length, scaled, single, solid, sub,
    unit,
};

fn scene(fuzz: f32, tint: Color) -> TestScene {
    let mut scene = TestScene::default();
    scene.metals.push(Metal { reflectance: solid(tint), fuzz, _pad: [0; 3] });
    scene
}

#[test]
fn mirrors_reflect() {
    let mut rng = Rng::new(1);
    let tint = Color::new(0.5, 0.25, 1.0);
    let scene = scene(0.0, tint);
    let view = scene.view();
    for _ in 0..100_000 {
        let (n, d) = (rng.direction(), rng.direction());
        let cos = -dot(double(d), double(n));
        let exact = add(double(d), scaled(double(n), 2.0 * cos));
        assert!(length(sub(double(reflect(d, n)), exact)) < 5e-7);
        if cos.abs() < 1e-6 {
            continue;
        }
        let s = surface(n, MaterialKind::Metal);
        let response = responses(&view, &s, d, 1).next().unwrap();
        let scatter = response.scatter.expect("a mirror absorbs nothing");
        assert_eq!((scatter.attenuation, response.emitted), (tint, Color::BLACK));
        assert!(length(sub(double(scatter.wi), exact)) < 1e-6);
        assert!((length(double(scatter.wi)) - 1.0).abs() < 3e-7);
        // It stays on the side that the light came from.
        assert_eq!(dot(double(scatter.wi), double(n)) > 0.0, cos > 0.0);
    }
}

/// Directions have the density of the projection of a sphere of radius `fuzz` around the tip of
/// the reflected unit vector, as seen from its foot; below the surface they are absorbed. Both are
/// integrated by midpoints over the sphere.
#[test]
fn fuzz_is_a_uniform_sphere_around_the_tip() {
    let n = vec3(0.0, 1.0, 0.0);
    let test = ChiSquared { n_tests: 9 };
    for fuzz in [0.1_f32, 0.5, 1.0] {
        for elevation in [1.5_f64, 0.6, 0.1] {
            let scene = scene(fuzz, WHITE);
            let view = scene.view();
            let d = single([elevation.cos(), -elevation.sin(), 0.0]);
            let tip = double(reflect(d, n));
            let s = surface(n, MaterialKind::Metal);
            // Bins: cosine to the reflected direction and side, and whether it is absorbed.
            let t = unit(cross(tip, [0.3, 0.4, -0.8]));
            let b = cross(tip, t);
            let (n_cos, n_phi) = (40, 8);
            let lowest = (1.0 - f64::from(fuzz * fuzz)).max(0.0).sqrt();
            let bin = |w: D3| {
                let c = ((dot(w, tip) - lowest) / (1.0 - lowest)).clamp(0.0, 0.999_999);
                let phi = dot(w, b).atan2(dot(w, t)) / std::f64::consts::TAU + 0.5;
                (c * n_cos as f64) as usize * n_phi + ((phi * n_phi as f64) as usize).min(n_phi - 1)
            };
            let mut counts = vec![0_u64; n_cos * n_phi + 1];
            let n_samples = 200_000;
            for response in responses(&view, &s, d, n_samples) {
                match response.scatter {
                    Some(scatter) => {
                        let w = double(scatter.wi);
                        assert!(w[1] > 0.0 && (length(w) - 1.0).abs() < 3e-7);
                        assert_eq!(scatter.attenuation, WHITE);
                        counts[bin(w)] += 1;
                    }
                    None => counts[n_cos * n_phi] += 1,
                }
            }
            let mut expected = vec![0.0; counts.len()];
            let (n_z, n_angle) = (1200, 1200);
            let weight = f64::from(n_samples) / f64::from(n_z * n_angle);
            for i in 0..n_z {
                let z = 2.0 * (f64::from(i) + 0.5) / f64::from(n_z) - 1.0;
                let r = (1.0 - z * z).sqrt();
                for j in 0..n_angle {
                    let angle = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(n_angle);
                    let point = [r * angle.cos(), r * angle.sin(), z];
                    let w = add(tip, scaled(point, f64::from(fuzz)));
                    let below = w[1] <= 0.0 || length(w) < 1e-6;
                    expected[if below { n_cos * n_phi } else { bin(unit(w)) }] += weight;
                }
            }
            test.check(&format!("fuzz {fuzz}, elevation {elevation}"), &counts, &expected);
        }
    }
}

#[test]
fn both_sides_are_mirrors() {
    let mut rng = Rng::new(2);
    let scene = scene(0.3, WHITE);
    let view = scene.view();
    for _ in 0..1000 {
        let (n, d): (Vec3, Vec3) = (rng.direction(), rng.direction());
        let one = surface(n, MaterialKind::Metal);
        let other = surface(-n, MaterialKind::Metal);
        assert!(responses(&view, &one, d, 5).eq(responses(&view, &other, d, 5)));
    }
}
