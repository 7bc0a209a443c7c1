//! Glass against the laws of Snell and Fresnel in `f64`.

use super::super::{
    Dielectric, FRESNEL_EXACT, FRESNEL_SCHLICK, fresnel_dielectric, refract, schlick,
};
use super::{WHITE, responses, surface};
use crate::math::vec3;
use crate::scene::MaterialKind;
use crate::testing::{
    D3, Rng, TestScene, add, cross, dot, double, length, scaled, single, sub, unit,
};

/// Fresnel's equations by angles, where the code goes by cosines: Born and Wolf, section 1.5.
fn exact_fresnel(cos_i: f64, eta: f64) -> f64 {
    let sin_t = eta * (1.0 - cos_i * cos_i).sqrt();
    if sin_t >= 1.0 {
        return 1.0;
    }
    let (i, t) = (cos_i.acos(), sin_t.asin());
    if i < 1e-6 {
        return ((1.0 - eta) / (1.0 + eta)).powi(2);
    }
    let perpendicular = ((i - t).sin() / (i + t).sin()).powi(2);
    let parallel = ((i - t).tan() / (i + t).tan()).powi(2);
    0.5 * (perpendicular + parallel)
}

#[test]
fn fresnel_is_that_of_the_equations() {
    let mut rng = Rng::new(1);
    for _ in 0..300_000 {
        let ior = rng.log_range(0.3, 4.0);
        if (ior - 1.0).abs() < 1e-3 {
            continue;
        }
        let cos = if rng.chance(0.3) { rng.log_range(1e-4, 1.0) } else { rng.range(1e-4, 1.0) };
        let (cos, eta) = (cos as f32, (1.0 / ior) as f32);
        let ours = f64::from(fresnel_dielectric(cos, eta));
        let exact = exact_fresnel(f64::from(cos), f64::from(eta));
        // Near the angle of total reflection it is steep.
        let sin_t = f64::from(eta) * (1.0 - f64::from(cos).powi(2)).sqrt();
        let tolerance = 3e-6 + 3e-6 / (1.0 - sin_t.min(1.0)).sqrt().max(1e-4);
        assert!((ours - exact).abs() < tolerance, "{ours} {exact}: cos {cos}, eta {eta}");
        assert!((0.0..=1.0 + 1e-6).contains(&ours));
    }
}

#[test]
fn fresnel_at_special_angles() {
    let close = |a: f32, b: f64| assert!((f64::from(a) - b).abs() < 1e-6, "{a} {b}");
    for ior in [1.33_f64, 1.5, 2.4] {
        let eta = (1.0 / ior) as f32;
        let r0 = ((ior - 1.0) / (ior + 1.0)).powi(2);
        // Straight on, from either side.
        close(fresnel_dielectric(1.0, eta), r0);
        close(fresnel_dielectric(1.0, ior as f32), r0);
        // Brewster: all that is reflected is perpendicular; the two rays are at a right angle.
        let brewster = ior.atan();
        let half = 0.5 * ((brewster - (std::f64::consts::FRAC_PI_2 - brewster)).sin()).powi(2);
        close(fresnel_dielectric(brewster.cos() as f32, eta), half);
        // Grazing.
        close(fresnel_dielectric(0.0, eta), 1.0);
        // Beyond the critical angle, from inside.
        let critical = (1.0 / ior).asin();
        assert_eq!(fresnel_dielectric((critical + 0.001).cos() as f32, ior as f32), 1.0);
        assert!(fresnel_dielectric((critical - 0.001).cos() as f32, ior as f32) < 0.9);
    }
    // No surface at all.
    assert!(fresnel_dielectric(0.7, 1.0) < 1e-12);
}

#[test]
fn as_much_is_reflected_from_inside_as_from_outside() {
    let mut rng = Rng::new(2);
    for _ in 0..100_000 {
        let eta = rng.log_range(0.3, 1.0) as f32;
        let cos_i = rng.range(0.01, 1.0);
        let sin_t = f64::from(eta) * (1.0 - cos_i * cos_i).sqrt();
        let cos_t = (1.0 - sin_t * sin_t).sqrt();
        let there = fresnel_dielectric(cos_i as f32, eta);
        let back = fresnel_dielectric(cos_t as f32, 1.0 / eta);
        // Back at grazing angles the cosine is ill determined.
        assert!((there - back).abs() < 2e-5 / cos_i as f32, "{there} {back} {cos_i} {eta}");
    }
}

#[test]
fn schlick_is_his_formula() {
    let mut rng = Rng::new(3);
    for _ in 0..100_000 {
        let (cos, eta) = (rng.unit_f32(), rng.log_range(0.3, 3.0) as f32);
        let r0 = ((1.0 - f64::from(eta)) / (1.0 + f64::from(eta))).powi(2);
        let exact = r0 + (1.0 - r0) * (1.0 - f64::from(cos)).powi(5);
        assert!((f64::from(schlick(cos, eta)) - exact).abs() < 1e-6);
    }
}

#[test]
fn refraction_obeys_snell() {
    let mut rng = Rng::new(4);
    for _ in 0..300_000 {
        let n = rng.direction();
        let d = rng.direction();
        let cos_i = -dot(double(d), double(n));
        if cos_i <= 1e-3 {
            continue;
        }
        let eta = rng.log_range(0.3, 3.0) as f32;
        let sin_i = (1.0 - cos_i * cos_i).max(0.0).sqrt();
        let sin_t = f64::from(eta) * sin_i;
        match refract(d, n, cos_i as f32, eta) {
            Some(t) => {
                assert!(sin_t < 1.0 + 1e-5);
                let (t, n) = (double(t), double(n));
                assert!((length(t) - 1.0).abs() < 3e-7);
                // In the plane of d and n, on the far side.
                assert!(dot(t, n) < 1e-6);
                let plane = cross(double(d), n);
                assert!(dot(t, plane).abs() < 2e-6);
                let sine = length(cross(t, n));
                // A small angle comes out of the rounding of a cosine near 1.
                let tolerance = 3e-6
                    + 3e-6 / (1.0 - sin_t.min(1.0)).sqrt().max(1e-3)
                    + (2e-7 / sin_i.max(3e-4)) * f64::from(eta);
                assert!((sine - sin_t).abs() < tolerance, "{sine} {sin_t}");
                assert!(dot(cross(t, n), plane) > -1e-6, "bent the wrong way");
            }
            None => assert!(sin_t > 1.0 - 1e-5, "{sin_t}"),
        }
    }
}

fn scene(ior: f32, fresnel: u32) -> TestScene {
    let mut scene = TestScene::default();
    scene.dielectrics.push(Dielectric { ior, fresnel, _pad: [0; 2] });
    scene
}

/// As often as Fresnel (or Schlick) says, light is reflected; else it is refracted. All of it.
#[test]
fn shares_of_reflection_and_refraction() {
    let mut rng = Rng::new(5);
    let n_samples = 20_000;
    for case in 0..200 {
        let ior = rng.log_range(0.5, 2.5) as f32;
        let model = if case % 2 == 0 { FRESNEL_EXACT } else { FRESNEL_SCHLICK };
        let scene = scene(ior, model);
        let view = scene.view();
        let s = surface(rng.direction(), MaterialKind::Dielectric);
        let d = rng.direction();
        let (n, eta) = if s.is_front(d) {
            (double(s.n), 1.0 / f64::from(ior))
        } else {
            (scaled(double(s.n), -1.0), f64::from(ior))
        };
        let cos_i = -dot(double(d), n);
        let sin_t = eta * (1.0 - cos_i * cos_i).max(0.0).sqrt();
        if (sin_t - 1.0).abs() < 1e-3 || cos_i < 1e-3 {
            continue;
        }
        let share = if sin_t >= 1.0 {
            1.0
        } else if model == FRESNEL_EXACT {
            exact_fresnel(cos_i, eta)
        } else {
            let r0 = ((1.0 - eta) / (1.0 + eta)).powi(2);
            r0 + (1.0 - r0) * (1.0 - cos_i).powi(5)
        };
        let mirrored = add(double(d), scaled(n, 2.0 * cos_i));
        let refracted: D3 = add(
            scaled(double(d), eta),
            scaled(n, eta * cos_i - (1.0 - sin_t * sin_t).max(0.0).sqrt()),
        );
        let mut n_reflected = 0;
        for response in responses(&view, &s, d, n_samples) {
            let scatter = response.scatter.expect("glass absorbs nothing");
            assert_eq!(scatter.attenuation, WHITE);
            let w = double(scatter.wi);
            assert!((length(w) - 1.0).abs() < 3e-7);
            if dot(w, n) > 0.0 {
                n_reflected += 1;
                assert!(length(sub(w, mirrored)) < 1e-5);
            } else {
                assert!(sin_t < 1.0);
                assert!(length(sub(w, unit(refracted))) < 1e-4);
            }
        }
        let expected = share * f64::from(n_samples);
        let sigma = (expected * (1.0 - share)).max(0.0).sqrt();
        let off = (f64::from(n_reflected) - expected).abs();
        assert!(off <= 4.5 * sigma + 1.0, "{n_reflected} of {n_samples}, expected {expected}");
    }
}

#[test]
fn a_bubble_reflects_totally_from_outside() {
    let scene = scene(1.0 / 1.5, FRESNEL_EXACT);
    let view = scene.view();
    let s = surface(vec3(0.0, 1.0, 0.0), MaterialKind::Dielectric);
    for (angle, total) in [(0.5_f64, false), (0.9, true)] {
        let d = single([angle.sin(), -angle.cos(), 0.0]);
        let n_through = responses(&view, &s, d, 1000)
            .filter(|response| response.scatter.unwrap().wi.y < 0.0)
            .count();
        assert_eq!(n_through == 0, total, "{n_through} at {angle}");
    }
}
