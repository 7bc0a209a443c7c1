//! Each BSDF: `sample` against its density, `eval` against `sample`, energy, reciprocity.

mod albedo;
mod energy;
mod principled;

use super::{
    BsdfSample, BsdfValue, Coat, CoatedBase, ConductorBsdf, DielectricBsdf,
    DiffuseTransmissionBsdf, LayeredBsdf, Lobes, TrowbridgeReitz, fresnel_conductor,
    reflectance_to_k, thin_dielectric,
};
use crate::math::{Color, Vec3, vec3};
use crate::sampler::Sampler;
use crate::testing::{ChiSquared, Rng, double, length, sub};

type Sample<'a> = &'a dyn Fn(Vec3, [f32; 3]) -> Option<BsdfSample>;
type Eval<'a> = &'a dyn Fn(Vec3, Vec3) -> BsdfValue;

/// Bins: bands of z times sectors.
const BANDS: usize = 40;
const SECTORS: usize = 20;

fn bin(w: Vec3) -> usize {
    let band = ((f64::from(w.z) * 0.5 + 0.5) * BANDS as f64) as usize;
    let turn = f64::from(w.y).atan2(f64::from(w.x)) / std::f64::consts::TAU + 0.5;
    band.min(BANDS - 1) * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

fn unit(x: f64, y: f64, z: f64) -> Vec3 {
    let l = (x * x + y * y + z * z).sqrt();
    vec3((x / l) as f32, (y / l) as f32, (z / l) as f32)
}

/// Directions to look from: along the normal, slanting, grazing, from below.
fn views() -> [Vec3; 5] {
    [
        vec3(0.0, 0.0, 1.0),
        unit(0.5, 0.3, 1.0),
        unit(-0.9, 0.2, 0.4),
        unit(1.0, 0.4, 0.12),
        unit(0.3, -0.6, -0.8),
    ]
}

/// Integral of the density over each bin, by midpoints.
fn expected(eval: Eval<'_>, wo: Vec3, fine: usize) -> (Vec<f64>, f64) {
    let mut bins = vec![0.0; BANDS * SECTORS];
    let (nz, np) = (BANDS * fine, SECTORS * fine);
    let cell = 2.0 / nz as f64 * std::f64::consts::TAU / np as f64;
    let mut albedo = 0.0;
    for i in 0..nz {
        let z = (i as f64 + 0.5) / nz as f64 * 2.0 - 1.0;
        let r = (1.0 - z * z).sqrt();
        for j in 0..np {
            let phi = ((j as f64 + 0.5) / np as f64 - 0.5) * std::f64::consts::TAU;
            let wi = vec3((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32);
            let value = eval(wo, wi);
            bins[i / fine * SECTORS + j / fine] += f64::from(value.pdf) * cell;
            albedo += f64::from(value.f_cos.g) * cell;
        }
    }
    (bins, albedo)
}

/// How much is done about a BSDF: how many midpoints a bin has along each side, fine enough for its
/// narrowest lobe, and how many samples are drawn.
#[derive(Clone, Copy)]
struct Effort {
    fine: usize,
    n: u32,
}

/// Chi-squared, weights against values, and the share of light against the integral.
fn check(name: &str, n_tests: u32, sample: Sample<'_>, eval: Eval<'_>) {
    check_with(Effort { fine: 32, n: 200_000 }, name, n_tests, sample, eval);
}

fn check_with(effort: Effort, name: &str, n_tests: u32, sample: Sample<'_>, eval: Eval<'_>) {
    let n = effort.n;
    let test = ChiSquared { n_tests };
    let mut rng = Rng::new(7);
    for wo in views() {
        let mut counts = vec![0_u64; BANDS * SECTORS];
        let (mut sum, mut sum2, mut n_none) = (0.0, 0.0, 0_u64);
        for _ in 0..n {
            let u = [rng.unit_f32(), rng.unit_f32(), rng.unit_f32()];
            let Some(s) = sample(wo, u) else {
                n_none += 1;
                continue;
            };
            assert!((length(double(s.wi)) - 1.0).abs() < 1e-5, "{name}: {s:?}");
            counts[bin(s.wi)] += 1;
            let w = f64::from(s.weight.g);
            assert!(w.is_finite() && w >= 0.0, "{name}: {s:?}");
            sum += w;
            sum2 += w * w;
            let value = eval(wo, s.wi);
            check_pdf(name, &s, &value);
            if s.pdf > 1e-3 && value.pdf > 1e-3 {
                let from_eval = f64::from(value.f_cos.g / value.pdf);
                assert!(
                    (from_eval - w).abs() < 2e-2 * w + 1e-4,
                    "{name}: weight {w}, value over density {from_eval}, {wo:?} {s:?} {value:?}"
                );
            }
        }
        let (mut bins, albedo) = expected(eval, wo, effort.fine);
        bins.iter_mut().for_each(|b| *b *= f64::from(n));
        let missing = f64::from(n) - bins.iter().sum::<f64>();
        // What is not scattered is a bin of its own.
        counts.push(n_none);
        bins.push(missing.max(0.0));
        test.check(&format!("{name} from {wo:?}"), &counts, &bins);
        let mean = sum / f64::from(n);
        let error = ((sum2 / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
        assert!(
            (mean - albedo).abs() < 4.0 * error + 5e-3 * albedo,
            "{name} from {wo:?}: samples {mean} +- {error}, integral {albedo}"
        );
        assert!(mean <= 1.0 + 4.0 * error + 1e-5, "{name} makes light: {mean}");
    }
}

/// The density that a sample says it has is the one that it has.
fn check_pdf(name: &str, s: &BsdfSample, value: &BsdfValue) {
    // Where rounding decides on which side of the horizon a facet is, there may be none.
    if s.wi.z.abs() > 1e-3 && s.pdf > 1e-4 {
        let off = (s.pdf - value.pdf).abs();
        assert!(off < 5e-3 * s.pdf, "{name}: {s:?} {value:?}");
    }
}

fn check_reciprocity(name: &str, eval: Eval<'_>, index: f64) {
    let mut rng = Rng::new(3);
    let mut n_lit = 0;
    for _ in 0..20_000 {
        let (a, b) = (rng.direction(), rng.direction());
        if a.z.abs() < 0.02 || b.z.abs() < 0.02 {
            continue;
        }
        // f without the cosine; basic radiance takes the square of the index with it.
        let f = |wo: Vec3, wi: Vec3| f64::from(eval(wo, wi).f_cos.g / wi.z.abs());
        let n2 = |w: Vec3| if w.z < 0.0 { index * index } else { 1.0 };
        let (ab, ba) = (f(a, b) * n2(a), f(b, a) * n2(b));
        assert!((ab - ba).abs() < 2e-3 * (ab + ba) + 1e-5, "{name}: {a:?} {b:?} {ab} {ba}");
        n_lit += u32::from(ab > 1e-3);
    }
    assert!(n_lit > 500, "{name}: {n_lit}");
}

#[test]
fn conductors() {
    let gold = (Color::new(0.143, 0.375, 1.442), Color::new(3.983, 2.386, 1.603));
    for (x, y) in [(0.3, 0.3), (0.15, 0.5), (0.9, 0.9)] {
        let metal = ConductorBsdf { roughness: TrowbridgeReitz::new(x, y), eta: gold.0, k: gold.1 };
        let name = format!("metal {x} {y}");
        check(&name, 15, &|wo, u| metal.sample(wo, u[1], u[2]), &|wo, wi| metal.eval(wo, wi));
        check_reciprocity(&name, &|wo, wi| metal.eval(wo, wi), 1.0);
    }
}

#[test]
fn dielectrics() {
    for (x, y, eta) in [(0.5, 0.5, 1.5), (0.6, 0.9, 1.33), (0.5, 0.5, 1.0 / 1.5)] {
        let glass = DielectricBsdf { roughness: TrowbridgeReitz::new(x, y), eta };
        let name = format!("glass {x} {y} {eta}");
        check(&name, 15, &|wo, u| glass.sample(wo, Lobes::BOTH, u[0], u[1], u[2]), &|wo, wi| {
            glass.eval(wo, wi, Lobes::BOTH)
        });
        check_reciprocity(&name, &|wo, wi| glass.eval(wo, wi, Lobes::BOTH), f64::from(eta));
    }
    // Either way alone: the same directions, more often.
    let glass = DielectricBsdf { roughness: TrowbridgeReitz::new(0.4, 0.4), eta: 1.5 };
    let mut rng = Rng::new(9);
    for wo in views() {
        for lobes in [Lobes::REFLECTION, Lobes::TRANSMISSION] {
            for _ in 0..10_000 {
                let [a, u, v] = [rng.unit_f32(), rng.unit_f32(), rng.unit_f32()];
                let Some(s) = glass.sample(wo, lobes, a, u, v) else { continue };
                assert_eq!(wo.z * s.wi.z > 0.0, lobes.reflection);
                check_pdf("one lobe", &s, &glass.eval(wo, s.wi, lobes));
                let both = glass.eval(wo, s.wi, Lobes::BOTH);
                assert!(both.pdf <= s.pdf * 1.01, "{s:?} {both:?}");
            }
        }
    }
}

#[test]
fn diffuse_transmission() {
    let grey = |r, t| DiffuseTransmissionBsdf {
        reflectance: Color::grey(r),
        transmittance: Color::grey(t),
    };
    for (r, t) in [(0.6, 0.3), (0.0, 0.8), (0.5, 0.0)] {
        let bsdf = grey(r, t);
        let name = format!("diffuse {r} {t}");
        check(&name, 15, &|wo, u| bsdf.sample(wo, u[0], u[1], u[2]), &|wo, wi| bsdf.eval(wo, wi));
        check_reciprocity(&name, &|wo, wi| bsdf.eval(wo, wi), 1.0);
    }
    assert!(grey(0.0, 0.0).sample(vec3(0.0, 0.0, 1.0), 0.5, 0.5, 0.5).is_none());
}

#[test]
fn smooth_surfaces_mirror_and_refract() {
    let smooth = TrowbridgeReitz::new(1e-4, 0.0);
    let glass = DielectricBsdf { roughness: smooth, eta: 1.5 };
    let wo = unit(0.6, 0.0, 0.8);
    let mirrored = glass.sample(wo, Lobes::BOTH, 0.0, 0.3, 0.3).unwrap();
    assert_eq!((mirrored.wi, mirrored.pdf), (vec3(-wo.x, 0.0, wo.z), 0.0));
    let through = glass.sample(wo, Lobes::BOTH, 0.999, 0.3, 0.3).unwrap();
    // Snell: 0.6 / 1.5 = 0.4.
    assert!((through.wi.x + 0.4).abs() < 1e-6 && through.wi.z < 0.0, "{through:?}");
    assert_eq!(through.weight, Color::WHITE);
    // And back again.
    let back = glass.sample(-through.wi, Lobes::BOTH, 0.999, 0.3, 0.3);
    let back = glass.sample(through.wi, Lobes::BOTH, 0.999, 0.3, 0.3).or(back).unwrap();
    assert!((back.wi.z - 0.8).abs() < 1e-5, "{back:?}");
    // A pane sends light on without turning it, and nothing is lost.
    for (u, wi) in [(0.0, vec3(-wo.x, 0.0, wo.z)), (0.99, -wo)] {
        let s = thin_dielectric(wo, 1.5, u);
        assert_eq!((s.wi, s.weight), (wi, Color::WHITE));
    }
}

#[test]
fn metals_reflect_what_fresnel_says() {
    // At right angles: ((n-1)^2 + k^2) / ((n+1)^2 + k^2).
    let f = fresnel_conductor(1.0, Color::grey(0.2), Color::grey(3.9)).g;
    let exact = (0.64 + 15.21) / (1.44 + 15.21);
    assert!((f - exact).abs() < 1e-6);
    // Grazing, everything; and a dielectric is a metal without absorption.
    assert!((fresnel_conductor(0.0, Color::grey(0.2), Color::grey(3.9)).g - 1.0).abs() < 1e-6);
    for i in 1..100 {
        let cos = i as f32 / 100.0;
        let a = fresnel_conductor(cos, Color::grey(1.5), Color::BLACK).g;
        let b = crate::materials::fresnel_dielectric(cos, 1.0 / 1.5);
        assert!((a - b).abs() < 1e-5, "{cos}: {a} {b}");
    }
    for r in [0.04_f32, 0.5, 0.97] {
        let k = reflectance_to_k(Color::grey(r));
        assert!((fresnel_conductor(1.0, Color::WHITE, k).g - r).abs() < 1e-5);
    }
}

fn coated(alpha: f32, base: CoatedBase, albedo: f32) -> LayeredBsdf {
    let roughness = TrowbridgeReitz::new(alpha, alpha);
    LayeredBsdf {
        coat: Coat {
            interface: DielectricBsdf { roughness, eta: 1.5 },
            thickness: if albedo > 0.0 { 0.5 } else { 0.01 },
            albedo: Color::grey(albedo),
            g: 0.3,
            max_depth: 100,
            n_samples: 1,
        },
        base,
    }
}

/// The share of light that paths bring out is the integral of the values, and both are the same
/// distribution: in bins, the mean weight of the samples against the mean value times the bin's angle.
#[test]
fn layers_are_the_same_by_chance_and_by_joining() {
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
        ("metal, smooth, misty", coated(0.0, CoatedBase::Conductor(metal), 0.5)),
    ];
    let mut rng = Rng::new(5);
    for (name, bsdf) in cases {
        for (k, wo) in [vec3(0.0, 0.0, 1.0), unit(0.7, 0.0, 0.6)].into_iter().enumerate() {
            // Coarse bins of the upper half.
            const NZ: usize = 4;
            let bin = |w: Vec3| ((w.z * NZ as f32) as usize).min(NZ - 1);
            let smooth = bsdf.coat.interface.roughness.is_smooth();
            let n = 150_000;
            let mut by_chance = [[0.0_f64; 2]; NZ];
            let mut joined = [[0.0_f64; 2]; NZ];
            for i in 0..n {
                let sampler = Sampler::new(17, i % 512, i / 512, k as u32);
                if let Some(s) = bsdf.sample(wo, &mut sampler.stream(1)) {
                    // The mirror image of a smooth coat has no value to compare with.
                    let mirrored = length(sub(
                        double(s.wi),
                        [-f64::from(wo.x), -f64::from(wo.y), f64::from(wo.z)],
                    ));
                    if !(smooth && mirrored < 1e-5) {
                        let w = f64::from(s.weight.g);
                        by_chance[bin(s.wi)][0] += w;
                        by_chance[bin(s.wi)][1] += w * w;
                    }
                }
                // Uniform over the upper half.
                let z = rng.unit();
                let r = (1.0 - z * z).sqrt();
                let phi = rng.unit() * std::f64::consts::TAU;
                let wi = vec3((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32);
                let f = f64::from(bsdf.eval(wo, wi, &mut sampler.stream(2)).g);
                let w = f * std::f64::consts::TAU;
                joined[bin(wi)][0] += w;
                joined[bin(wi)][1] += w * w;
            }
            for b in 0..NZ {
                let mean = |x: [f64; 2]| {
                    let mean = x[0] / f64::from(n);
                    (mean, ((x[1] / f64::from(n) - mean * mean) / f64::from(n)).sqrt())
                };
                let ((a, ea), (j, ej)) = (mean(by_chance[b]), mean(joined[b]));
                let error = (ea * ea + ej * ej).sqrt();
                assert!(
                    (a - j).abs() < 4.5 * error + 1e-4,
                    "{name} from {wo:?}, bin {b}: {a} +- {ea} by chance, {j} +- {ej} joined"
                );
                assert!(error < 0.05 * (a + j) + 2e-3, "{name}: too noisy, {a} {j} +- {error}");
            }
        }
    }
}

#[test]
fn white_layers_lose_nothing() {
    // A smooth coat without a medium to speak of on a white base: all light comes out in the end.
    let mut bsdf = coated(0.0, CoatedBase::Diffuse(Color::WHITE), 0.0);
    bsdf.coat.thickness = 1e-7;
    bsdf.coat.max_depth = 10_000;
    for wo in [vec3(0.0, 0.0, 1.0), unit(0.9, 0.1, 0.3), unit(0.2, 0.1, -0.5)] {
        let n = 20_000;
        let mut sum = 0.0;
        for i in 0..n {
            let mut stream = Sampler::new(3, i % 128, i / 128, 0).stream(1);
            let s = bsdf.sample(wo, &mut stream).expect("nothing is absorbed");
            assert_eq!(s.wi.z > 0.0, wo.z > 0.0);
            sum += f64::from(s.weight.g);
        }
        assert!((sum / f64::from(n) - 1.0).abs() < 1e-3, "{}", sum / f64::from(n));
    }
}
