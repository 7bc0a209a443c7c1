//! The fits of albedos against integration in `f64`, and what the models of diffuse reflection, fuzz and
//! films promise.

use super::unit;
use crate::bxdfs::{
    Fuzz, ThinFilm, dielectric_albedo, fresnel_f82, mirror_albedo, oren_nayar, schlick_from,
};
use crate::math::{Color, Vec3, vec3};
use crate::testing::{ChiSquared, Rng};

/// Fresnel's equations, from outside.
fn fresnel(c: f64, eta: f64) -> f64 {
    let ct = (1.0 - (1.0 - c * c) / (eta * eta)).sqrt();
    let (p, s) = ((eta * c - ct) / (eta * c + ct), (c - eta * ct) / (c + eta * ct));
    0.5 * (p * p + s * s)
}

/// Albedo of mirrors and of dielectrics, by midpoints over visible normals (Dupuy and Benyoub, *Sampling
/// Visible GGX Normals with Spherical Caps*, 2023).
fn albedos(mu: f64, alpha: f64, etas: &[f64]) -> (f64, Vec<f64>) {
    const N: usize = 200;
    let s = (1.0 - mu * mu).max(0.0).sqrt();
    let l = (alpha * alpha * s * s + mu * mu).sqrt();
    let w = [alpha * s / l, mu / l];
    let slant = |z: f64| (z * z + alpha * alpha * (1.0 - z * z)).sqrt();
    let mut mirror = 0.0;
    let mut dielectric = vec![0.0; etas.len()];
    for i in 0..N {
        let phi = std::f64::consts::TAU * (i as f64 + 0.5) / N as f64;
        for j in 0..N {
            let hz = (1.0 - (j as f64 + 0.5) / N as f64) * (1.0 + w[1]);
            let z = hz - w[1];
            let r = (1.0 - z * z).max(0.0).sqrt();
            let m = [alpha * (r * phi.cos() + w[0]), alpha * r * phi.sin(), hz];
            let length = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
            let m = m.map(|x| x / length);
            let c = (m[0] * s + m[2] * mu).min(1.0);
            let zi = 2.0 * c * m[2] - mu;
            if zi > 0.0 {
                let g2 = 2.0 * mu * zi / (mu * slant(zi) + zi * slant(mu));
                let share = g2 * (mu + slant(mu)) / (2.0 * mu * (N * N) as f64);
                mirror += share;
                for (sum, &eta) in dielectric.iter_mut().zip(etas) {
                    *sum += share * fresnel(c, eta);
                }
            }
        }
    }
    (mirror, dielectric)
}

#[test]
fn albedo_fits_are_near_and_never_too_small() {
    let etas = [1.1, 1.33, 1.5, 1.9, 2.5];
    let (mut mean, mut n) = (0.0, 0.0);
    let mut mean_dielectric = 0.0;
    for i in 0..24 {
        let mu = ((f64::from(i) + 0.3) / 23.5).min(1.0);
        for alpha in [0.002, 0.05, 0.12, 0.22, 0.35, 0.5, 0.64, 0.8, 0.93, 1.0] {
            let (mirror, dielectric) = albedos(mu, alpha, &etas);
            let over = f64::from(mirror_albedo(mu as f32, alpha as f32)) - mirror;
            assert!((-3e-4..0.0175).contains(&over), "mirror at {mu}, {alpha}: {over}");
            (mean, n) = (mean + over, n + 1.0);
            for (&eta, exact) in etas.iter().zip(dielectric) {
                let fit = dielectric_albedo(mu as f32, alpha as f32, eta as f32);
                let over = f64::from(fit) - exact;
                let limits = if mu < 0.15 { -6e-3..0.1 } else { -2.5e-3..0.032 };
                assert!(limits.contains(&over), "index {eta} at {mu}, {alpha}: {over}");
                mean_dielectric += over / etas.len() as f64;
            }
        }
    }
    assert!(mean / n < 0.005 && mean_dielectric / n < 0.006, "{mean} {mean_dielectric} of {n}");
}

/// Integral of `f` over the upper half.
fn integral(f: impl Fn(Vec3) -> f64) -> f64 {
    const N: usize = 300;
    let mut sum = 0.0;
    for i in 0..N {
        let z = (i as f64 + 0.5) / N as f64;
        let r = (1.0 - z * z).sqrt();
        for j in 0..N {
            let phi = std::f64::consts::TAU * (j as f64 + 0.5) / N as f64;
            sum += f(vec3((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32));
        }
    }
    sum * std::f64::consts::TAU / (N * N) as f64
}

fn slants() -> [Vec3; 4] {
    [vec3(0.0, 0.0, 1.0), unit(0.5, 0.3, 1.0), unit(-0.9, 0.2, 0.4), unit(1.0, 0.4, 0.1)]
}

#[test]
fn rough_diffuse_surfaces_keep_light() {
    for roughness in [0.0, 0.1, 0.5, 1.0] {
        for wo in slants() {
            let f = |wi: Vec3| {
                let f = oren_nayar(Color::new(1.0, 0.5, 0.0), roughness, wo, wi);
                let back = oren_nayar(Color::new(1.0, 0.5, 0.0), roughness, wi, wo);
                assert!((f.r - back.r).abs() < 1e-5 && (f.g - back.g).abs() < 1e-5);
                assert!(f.r >= 0.0 && f.g >= 0.0 && f.b == 0.0);
                (f64::from(f.r * wi.z), f64::from(f.g * wi.z))
            };
            let (white, grey) = (integral(|wi| f(wi).0), integral(|wi| f(wi).1));
            // The paper's approximation of the albedo is off by as much.
            assert!((white - 1.0).abs() < 2e-3, "{roughness} {wo:?}: {white}");
            assert!(grey < 0.5 + 2e-3 && grey > 0.4, "{roughness} {wo:?}: {grey}");
        }
    }
}

#[test]
fn fuzz_scatters_its_albedo() {
    let mut rng = Rng::new(4);
    let test = ChiSquared { n_tests: 16 };
    for roughness in [0.05, 0.3, 0.7, 1.0] {
        for wo in slants() {
            let fuzz = Fuzz::new(wo, roughness);
            assert!((0.0..=1.0).contains(&fuzz.albedo));
            let all = integral(|wi| f64::from(fuzz.pdf(wi)));
            assert!((all - 1.0).abs() < 0.02, "{roughness} {wo:?}: {all}");
            // Bins of z alone, by integration of the density.
            const N: usize = 12;
            let bin = |w: Vec3| ((w.z * N as f32) as usize).min(N - 1);
            let mut counts = [0_u64; N];
            let n = 40_000;
            for _ in 0..n {
                counts[bin(fuzz.sample(rng.unit_f32(), rng.unit_f32()))] += 1;
            }
            let expected: Vec<f64> = (0..N)
                .map(|k| {
                    let inside = |wi| if bin(wi) == k { f64::from(fuzz.pdf(wi)) } else { 0.0 };
                    integral(inside) / all * f64::from(n)
                })
                .collect();
            test.check(&format!("fuzz {roughness} {wo:?}"), &counts, &expected);
        }
    }
    // Most at grazing angles, where fibres stand in line.
    let at = |z: f64| Fuzz::new(unit(1.0, 0.0, z), 0.3).albedo;
    assert!(at(0.1) > at(0.5) && at(0.5) > at(3.0));
}

#[test]
fn metals_dip_where_they_are_told_to() {
    let (f0, f82) = (Color::new(0.9, 0.5, 0.0), Color::new(1.0, 0.6, 0.2));
    let at = |cos| fresnel_f82(cos, f0, f82);
    for (a, b) in at(1.0).to_array().into_iter().zip(f0.to_array()) {
        assert!((a - b).abs() < 1e-6);
    }
    assert_eq!(at(0.0), Color::WHITE);
    let exact = f82 * f0.map(|f0| schlick_from(f0, 1.0 / 7.0));
    let off = at(1.0 / 7.0) - exact;
    assert!(off.to_array().iter().all(|x| x.abs() < 1e-6), "{off:?}");
}

#[test]
fn films_colour_by_their_thickness() {
    let film = |thickness_um, ior| ThinFilm { thickness_um, ior };
    let base = Color::grey(1.5);
    // No film to speak of, or one of the base's own index: what the base reflects, 0.04.
    for f in [film(0.0, 1.33), film(0.5, 1.5)] {
        let r = f.reflectance(1.0, base).to_array();
        assert!(r.iter().all(|r| (r - 0.04).abs() < 3e-3), "{f:?}: {r:?}");
    }
    // A quarter of a green wave of the right index between air and glass: next to no reflection.
    let coating = film(0.55 / 4.0 / 1.2247, 1.2247).reflectance(1.0, base);
    assert!(coating.g < 0.004 && coating.r > coating.g && coating.b > coating.g, "{coating:?}");
    // A soap film is black where it is thin and the base is air.
    let soap = film(0.01, 1.33).reflectance(1.0, Color::WHITE);
    assert!(soap.max_channel() < 0.01, "{soap:?}");
    let mut rng = Rng::new(8);
    for _ in 0..20_000 {
        let f = film(rng.range(0.0, 3.0) as f32, rng.range(1.0, 2.5) as f32);
        let n = rng.range(1.0, 20.0) as f32;
        let r = f.reflectance(rng.unit_f32(), Color::new(n, 1.5, 40.0));
        assert!(r.to_array().iter().all(|r| (0.0..=1.0).contains(r)), "{f:?} {r:?}");
    }
}
