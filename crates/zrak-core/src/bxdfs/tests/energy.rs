//! White furnaces and reciprocity of what `check` cannot look at: exact models without loss, layers, and
//! the principled surface where it is reciprocal.

use super::{coated, unit, views};
use crate::bxdfs::tests::principled::defaults;
use crate::bxdfs::{
    CoatedBase, ConductorBsdf, DielectricBsdf, DiffuseTransmissionBsdf, LayeredBsdf, Lobes,
    PrincipledBsdf, PrincipledParams, TrowbridgeReitz, thin_dielectric,
};
use crate::math::{Color, Vec3, abs, vec3};
use crate::sampler::Sampler;
use crate::testing::Rng;

/// Every sample brings all of the light.
#[test]
fn models_without_loss_lose_nothing() {
    let mut rng = Rng::new(1);
    let smooth = TrowbridgeReitz::new(0.0, 0.0);
    let glass = |eta| DielectricBsdf { roughness: smooth, eta };
    let mirror = ConductorBsdf { roughness: smooth, eta: Color::WHITE, k: Color::grey(1e6) };
    let cloth = DiffuseTransmissionBsdf {
        reflectance: Color::new(0.25, 1.0, 0.0),
        transmittance: Color::new(0.75, 0.0, 1.0),
    };
    let (mut sums, mut n) = ([0.0; 3], 0.0);
    for _ in 0..100_000 {
        let (wo, u) = (rng.direction(), [rng.unit_f32(), rng.unit_f32(), rng.unit_f32()]);
        if abs(wo.z) < 1e-3 {
            continue;
        }
        for eta in [1.5, 1.0 / 1.5, 1.0] {
            let s = glass(eta).sample(wo, Lobes::BOTH, u[0], u[1], u[2]).expect("one of two ways");
            assert!((s.weight.g - 1.0).abs() < 1e-5, "{eta} {wo:?}: {s:?}");
            assert_eq!(thin_dielectric(wo, eta, u[0]).weight, Color::WHITE);
        }
        let s = mirror.sample(wo, u[1], u[2]).expect("a mirror");
        assert!((s.weight.g - 1.0).abs() < 1e-5, "{s:?}");
        let s = cloth.sample(wo, u[0], u[1], u[2]).expect("white cloth");
        n += 1.0;
        for (sum, w) in sums.iter_mut().zip(s.weight.to_array()) {
            *sum += f64::from(w);
        }
    }
    // What a sample brings is 1 give or take 1 at most.
    for sum in sums {
        assert!((sum / n - 1.0).abs() < 4.5 / f64::sqrt(n), "{}", sum / n);
    }
}

/// A thin pane reflects 2 R / (1 + R), the sum of all reflections between its sides.
#[test]
fn panes_reflect_their_share() {
    for cos in [1.0_f32, 0.6, 0.2, 0.05] {
        let wo = unit(f64::from(1.0 - cos * cos).sqrt(), 0.0, f64::from(cos));
        let eta = 1.5_f64;
        let c = f64::from(cos);
        let ct = (1.0 - (1.0 - c * c) / (eta * eta)).sqrt();
        let (p, s) = ((eta * c - ct) / (eta * c + ct), (c - eta * ct) / (c + eta * ct));
        let r = 0.5 * (p * p + s * s);
        let n = 100_000;
        let reflected = (0..n)
            .filter(|i| thin_dielectric(wo, 1.5, (*i as f32 + 0.5) / n as f32).wi.z > 0.0)
            .count();
        let share = reflected as f64 / f64::from(n);
        assert!((share - 2.0 * r / (1.0 + r)).abs() < 2e-4, "{cos}: {share} {r}");
    }
}

/// Mean of an estimate and its standard error.
fn mean(n: u32, mut estimate: impl FnMut(u32) -> f64) -> (f64, f64) {
    let (mut sum, mut sum2) = (0.0, 0.0);
    for i in 0..n {
        let x = estimate(i);
        (sum, sum2) = (sum + x, sum2 + x * x);
    }
    let mean = sum / f64::from(n);
    (mean, ((sum2 / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt())
}

/// Light takes the same ways through the layers in both directions.
#[test]
fn layers_are_reciprocal() {
    let metal = ConductorBsdf {
        roughness: TrowbridgeReitz::new(0.3, 0.3),
        eta: Color::grey(0.3),
        k: Color::grey(2.0),
    };
    let cases = [
        ("diffuse, smooth", coated(0.0, CoatedBase::Diffuse(Color::grey(0.5)), 0.0)),
        ("diffuse, rough", coated(0.3, CoatedBase::Diffuse(Color::grey(0.5)), 0.0)),
        ("diffuse, misty", coated(0.2, CoatedBase::Diffuse(Color::grey(0.6)), 0.7)),
        ("metal, rough", coated(0.25, CoatedBase::Conductor(metal), 0.0)),
        ("metal, smooth", coated(0.0, CoatedBase::Conductor(metal), 0.0)),
        ("metal, smooth, misty", coated(0.0, CoatedBase::Conductor(metal), 0.5)),
    ];
    let (a, b) = (unit(0.2, 0.1, 0.9), unit(-0.8, 0.3, 0.5));
    for (name, bsdf) in cases {
        let f = |wo: Vec3, wi: Vec3, purpose: u32| {
            mean(200_000, |i| {
                let mut stream = Sampler::new(2, i % 256, i / 256, 0).stream(purpose);
                f64::from(bsdf.eval(wo, wi, &mut stream).g / abs(wi.z))
            })
        };
        let ((ab, e1), (ba, e2)) = (f(a, b, 1), f(b, a, 2));
        let error = e1.hypot(e2);
        assert!((ab - ba).abs() < 4.5 * error + 1e-5, "{name}: {ab} {ba} +- {error}");
        assert!(error < 0.03 * ab, "{name}: too noisy, {ab} +- {error}");
        // And the same from below.
        let (turned, e3) = f(-a, -b, 3);
        assert!((ab - turned).abs() < 4.5 * e1.hypot(e3) + 1e-5, "{name}: {ab} {turned}");
    }
}

/// What is below a smooth coat, against the closed form: Fresnel's share twice, and the geometric series
/// of what is reflected inside, whose mean share for light from all directions is integrated here.
#[test]
fn a_smooth_coat_on_a_diffuse_base_has_a_closed_form() {
    let fresnel = |c: f64, eta: f64| {
        let sin2 = (1.0 - c * c) / (eta * eta);
        if sin2 >= 1.0 {
            return 1.0;
        }
        let ct = (1.0 - sin2).sqrt();
        let (p, s) = ((eta * c - ct) / (eta * c + ct), (c - eta * ct) / (c + eta * ct));
        0.5 * (p * p + s * s)
    };
    let eta = 1.5;
    const N: usize = 100_000;
    // Share that the coat's inside reflects of diffuse light.
    let inside: f64 = (0..N)
        .map(|i| {
            let c = (i as f64 + 0.5) / N as f64;
            fresnel(c, 1.0 / eta) * 2.0 * c / N as f64
        })
        .sum();
    for albedo in [0.2_f32, 0.8, 1.0] {
        let mut bsdf = coated(0.0, CoatedBase::Diffuse(Color::grey(albedo)), 0.0);
        bsdf.coat.thickness = 1e-7;
        bsdf.coat.max_depth = 1000;
        for (wo, wi) in [
            (vec3(0.0, 0.0, 1.0), unit(0.3, 0.2, 0.8)),
            (unit(0.9, 0.0, 0.3), unit(-0.2, 0.7, 0.4)),
        ] {
            let a = f64::from(albedo);
            let t = |w: Vec3| 1.0 - fresnel(f64::from(w.z), eta);
            let exact = t(wo) * t(wi) * a / (std::f64::consts::PI * eta * eta * (1.0 - a * inside));
            let (got, error) = mean(100_000, |i| {
                let mut stream = Sampler::new(4, i % 256, i / 256, 0).stream(1);
                f64::from(bsdf.eval(wo, wi, &mut stream).g / wi.z)
            });
            assert!(
                (got - exact).abs() < 4.5 * error + 1e-5,
                "{albedo}: {got} +- {error}, {exact}"
            );
        }
    }
}

/// Layers whose parts absorb nothing bring all light out; those of metal what its facets do not lose.
#[test]
fn white_metal_under_a_coat_keeps_light() {
    let metal = ConductorBsdf {
        roughness: TrowbridgeReitz::new(0.0, 0.0),
        eta: Color::WHITE,
        k: Color::grey(1e5),
    };
    let mut bsdf: LayeredBsdf = coated(0.0, CoatedBase::Conductor(metal), 0.0);
    bsdf.coat.thickness = 1e-7;
    bsdf.coat.max_depth = 10_000;
    for wo in views() {
        let (albedo, error) = mean(20_000, |i| {
            let mut stream = Sampler::new(3, i % 128, i / 128, 0).stream(1);
            bsdf.sample(wo, &mut stream).map_or(0.0, |s| f64::from(s.weight.g))
        });
        assert!((albedo - 1.0).abs() < 4.5 * error + 1e-4, "{wo:?}: {albedo} +- {error}");
    }
}

/// The principled surface gives each layer what the viewer sees it get, so it is not reciprocal as a whole.
/// Where there is nothing to give, it is; and where there is little, nearly.
#[test]
fn the_principled_surface_is_reciprocal_where_it_can_be() {
    let matte = PrincipledParams { specular_weight: 0.0, ..defaults() };
    let rough = PrincipledParams { base_diffuse_roughness: 0.8, ..matte };
    let metal = PrincipledParams { base_metalness: 1.0, specular_roughness: 0.3, ..defaults() };
    let glass =
        PrincipledParams { transmission_weight: 1.0, specular_roughness: 0.5, ..defaults() };
    let leaf = PrincipledParams {
        geometry_thin_walled: true,
        subsurface_weight: 1.0,
        specular_weight: 0.0,
        ..defaults()
    };
    let plain = PrincipledParams { specular_roughness: 0.6, ..defaults() };
    for (name, p, index, allowed) in [
        ("matte", matte, 1.0, 1e-4),
        ("rough and matte", rough, 1.0, 1e-4),
        ("leaf", leaf, 1.0, 1e-4),
        // The light that facets reflect several times is given back by the viewer's angle.
        ("metal", metal, 1.0, 0.1),
        ("glass", glass, 1.5, 0.12),
        ("glossy", plain, 1.0, 0.25),
    ] {
        let f = |wo: Vec3, wi: Vec3| match PrincipledBsdf::new(&p, wo) {
            Some(bsdf) => f64::from(bsdf.eval(wi).f_cos.g / wi.z.abs()),
            None => 0.0,
        };
        let n2 = |w: Vec3| if w.z < 0.0 { index * index } else { 1.0 };
        let mut rng = Rng::new(6);
        let mut n_lit = 0;
        for _ in 0..20_000 {
            let (a, b) = (rng.direction(), rng.direction());
            if a.z.abs() < 0.2 || b.z.abs() < 0.2 {
                continue;
            }
            let (ab, ba) = (f(a, b) * n2(a), f(b, a) * n2(b));
            assert!(
                (ab - ba).abs() < allowed * ab.max(ba) + 1e-5,
                "{name}: {a:?} {b:?}: {ab} {ba}"
            );
            n_lit += u32::from(ab > 1e-3);
        }
        assert!(n_lit > 500, "{name}: {n_lit}");
    }
}
