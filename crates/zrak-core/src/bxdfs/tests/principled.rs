//! The principled surface: sampling, energy, and the simpler models that it is at its corners.

use super::{Effort, check_with, unit, views};
use crate::bxdfs::{BsdfSample, DielectricBsdf, Lobes, PrincipledBsdf, PrincipledParams};
use crate::bxdfs::{TrowbridgeReitz, fresnel_f82, thin_dielectric};
use crate::math::{Color, Vec3, vec3};
use crate::testing::Rng;

/// The specification's defaults.
pub(super) fn defaults() -> PrincipledParams {
    PrincipledParams {
        base_weight: 1.0,
        base_color: Color::grey(0.8),
        base_metalness: 0.0,
        base_diffuse_roughness: 0.0,
        specular_weight: 1.0,
        specular_color: Color::WHITE,
        specular_roughness: 0.3,
        specular_roughness_anisotropy: 0.0,
        specular_ior: 1.5,
        transmission_weight: 0.0,
        transmission_color: Color::WHITE,
        subsurface_weight: 0.0,
        subsurface_color: Color::grey(0.8),
        coat_weight: 0.0,
        coat_color: Color::WHITE,
        coat_roughness: 0.0,
        coat_roughness_anisotropy: 0.0,
        coat_ior: 1.6,
        coat_darkening: 1.0,
        fuzz_weight: 0.0,
        fuzz_color: Color::WHITE,
        fuzz_roughness: 0.5,
        thin_film_weight: 0.0,
        thin_film_thickness: 0.5,
        thin_film_ior: 1.4,
        geometry_thin_walled: false,
    }
}

fn white() -> PrincipledParams {
    PrincipledParams { base_color: Color::WHITE, subsurface_color: Color::WHITE, ..defaults() }
}

fn sample(p: &PrincipledParams, wo: Vec3, u: [f32; 3]) -> Option<BsdfSample> {
    PrincipledBsdf::new(p, wo)?.sample(u[0], u[1], u[2])
}

/// Mean weight of samples, its standard error, and how many of the samples there are.
fn albedo(p: &PrincipledParams, wo: Vec3, n: u32) -> (f64, f64) {
    let mut rng = Rng::new(11);
    let (mut sum, mut sum2) = (0.0, 0.0);
    for _ in 0..n {
        let u = [rng.unit_f32(), rng.unit_f32(), rng.unit_f32()];
        if let Some(s) = sample(p, wo, u) {
            let w = f64::from(s.weight.max_channel());
            assert!(w.is_finite() && w >= 0.0, "{p:?} {wo:?} {s:?}");
            (sum, sum2) = (sum + w, sum2 + w * w);
        }
    }
    let mean = sum / f64::from(n);
    (mean, ((sum2 / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt())
}

#[test]
fn directions_have_their_density() {
    let rough = PrincipledParams { specular_roughness: 0.6, ..defaults() };
    let cases = [
        ("glossy", rough),
        (
            "metal",
            PrincipledParams {
                base_metalness: 1.0,
                specular_roughness_anisotropy: 0.4,
                specular_color: Color::new(1.0, 0.8, 0.7),
                ..rough
            },
        ),
        ("glass", PrincipledParams { transmission_weight: 1.0, specular_roughness: 0.75, ..rough }),
        (
            "a pane",
            PrincipledParams {
                transmission_weight: 0.6,
                geometry_thin_walled: true,
                subsurface_weight: 0.5,
                ..rough
            },
        ),
        (
            "all of it",
            PrincipledParams {
                base_metalness: 0.3,
                base_diffuse_roughness: 0.7,
                transmission_weight: 0.4,
                subsurface_weight: 0.5,
                coat_weight: 0.6,
                coat_roughness: 0.6,
                coat_color: Color::new(0.9, 0.7, 0.5),
                fuzz_weight: 0.5,
                thin_film_weight: 0.5,
                ..rough
            },
        ),
    ];
    for (name, p) in cases {
        let eval = |wo: Vec3, wi: Vec3| PrincipledBsdf::new(&p, wo).unwrap().eval(wi);
        let effort = Effort { fine: 16, n: 60_000 };
        check_with(effort, name, 25, &|wo, u| sample(&p, wo, u), &eval);
    }
}

/// Everything white: nothing more comes out than went in, and not much less.
#[test]
fn white_surfaces_make_no_light() {
    let mut cases = Vec::new();
    for roughness in [0.0, 0.2, 0.5, 0.8, 1.0] {
        let p = PrincipledParams { specular_roughness: roughness, ..white() };
        // How much may be lost: what is left of several reflections among facets, and errors of fits.
        cases.push((p, 0.03));
        cases.push((PrincipledParams { base_metalness: 1.0, ..p }, 0.025));
        cases.push((PrincipledParams { base_metalness: 0.5, specular_ior: 2.2, ..p }, 0.04));
        cases.push((PrincipledParams { base_diffuse_roughness: 1.0, ..p }, 0.03));
        cases.push((PrincipledParams { fuzz_weight: 1.0, fuzz_roughness: 0.4, ..p }, 0.03));
        cases.push((PrincipledParams { subsurface_weight: 0.5, ..p }, 0.03));
        let coated = PrincipledParams { coat_weight: 1.0, coat_roughness: roughness, ..p };
        cases.push((coated, 0.06));
        cases.push((PrincipledParams { base_metalness: 1.0, ..coated }, 0.06));
        cases.push((PrincipledParams { coat_darkening: 0.0, fuzz_weight: 0.7, ..coated }, 0.06));
        // Facets of glass lose what they send to other facets: at grazing angles even smooth ones, and
        // rough ones half of what they reflect totally.
        let rough = f64::from(roughness * roughness);
        let lost = if roughness == 0.0 { 1e-3 } else { 0.1 + 0.5 * rough };
        let glass = PrincipledParams { transmission_weight: 1.0, ..p };
        cases.push((glass, lost));
        cases.push((PrincipledParams { geometry_thin_walled: true, ..glass }, lost + 0.4));
        cases.push((PrincipledParams { specular_ior: 0.7, ..glass }, lost + 0.02));
        cases.push((PrincipledParams { transmission_weight: 0.5, ..p }, lost + 0.03));
        let thin = PrincipledParams { geometry_thin_walled: true, subsurface_weight: 1.0, ..p };
        cases.push((thin, 0.03));
        let iridescent = PrincipledParams { thin_film_weight: 1.0, ..p };
        cases.push((iridescent, 0.2));
        // Strongly directed roughness is made up for by the smaller one only.
        let brushed = PrincipledParams { specular_roughness_anisotropy: 0.8, ..p };
        cases.push((PrincipledParams { base_metalness: 1.0, ..brushed }, 0.6));
    }
    for (p, lost) in cases {
        for wo in views() {
            let (mean, error) = albedo(&p, wo, 10_000);
            assert!(mean < 1.0 + 4.0 * error + 1e-4, "{mean} +- {error} of 1: {wo:?} {p:?}");
            assert!(mean > 1.0 - lost - 4.0 * error, "{mean} +- {error} of 1: {wo:?} {p:?}");
        }
    }
}

#[test]
fn colours_only_take_light_away() {
    let mut rng = Rng::new(21);
    let mut color = || {
        let c = [rng.unit(), rng.unit(), rng.unit()].map(|x| if x < 0.2 { 0.0 } else { x });
        Color::from_array(c.map(|x| x as f32))
    };
    let colors: Vec<[Color; 6]> = (0..60).map(|_| [(); 6].map(|()| color())).collect();
    let mut rng = Rng::new(22);
    for c in colors {
        let mut x = |hi: f64| if rng.chance(0.3) { 0.0 } else { rng.range(0.0, hi) as f32 };
        let p = PrincipledParams {
            base_weight: x(1.0),
            base_color: c[0],
            base_metalness: x(1.0),
            base_diffuse_roughness: x(1.0),
            specular_weight: x(1.0),
            specular_color: c[1],
            specular_roughness: x(1.0),
            specular_roughness_anisotropy: x(1.0),
            specular_ior: 1.0 + x(2.0),
            transmission_weight: x(1.0),
            transmission_color: c[2],
            subsurface_weight: x(1.0),
            subsurface_color: c[3],
            coat_weight: x(1.0),
            coat_color: c[4],
            coat_roughness: x(1.0),
            coat_roughness_anisotropy: x(1.0),
            coat_ior: 1.0 + x(2.0),
            coat_darkening: x(1.0),
            fuzz_weight: x(1.0),
            fuzz_color: c[5],
            fuzz_roughness: x(1.0),
            thin_film_weight: 0.0,
            thin_film_thickness: 0.5,
            thin_film_ior: 1.4,
            geometry_thin_walled: x(1.0) > 0.5,
        };
        for wo in views() {
            let (mean, error) = albedo(&p, wo, 3_000);
            assert!(mean < 1.0 + 5.0 * error + 1e-3, "{mean} +- {error}: {wo:?} {p:?}");
            // What is drawn is what is evaluated.
            let Some(bsdf) = PrincipledBsdf::new(&p, wo) else { continue };
            let s = bsdf.sample(x(0.999), 0.4, 0.3);
            if let Some(s) = s.filter(|s| s.pdf > 0.0) {
                assert_eq!(bsdf.eval(s.wi).pdf, s.pdf);
            }
        }
    }
}

/// Any numbers that validation lets through give finite light.
#[test]
fn edges_of_parameters_are_safe() {
    let mut rng = Rng::new(31);
    for _ in 0..100_000 {
        let mut edge = || [0.0, 1.0, 0.5, 1e-4, 0.999][rng.below(5) as usize];
        let mut p = white();
        p.base_color = Color::new(edge(), edge(), edge());
        p.base_metalness = edge();
        p.base_diffuse_roughness = edge();
        p.specular_weight = edge();
        p.specular_roughness = edge();
        p.specular_roughness_anisotropy = edge();
        p.transmission_weight = edge();
        p.coat_weight = edge();
        p.coat_color = Color::new(edge(), 1.0, edge());
        p.coat_roughness = edge();
        p.coat_roughness_anisotropy = edge();
        p.fuzz_weight = edge();
        p.fuzz_roughness = edge();
        p.subsurface_weight = edge();
        p.thin_film_weight = edge();
        p.thin_film_thickness = edge();
        p.geometry_thin_walled = edge() > 0.9;
        p.specular_ior = [1.0, 1.0001, 1.5, 0.6, 3.0, 100.0][rng.below(6) as usize];
        p.coat_ior = [1.0, 1.5, 3.0][rng.below(3) as usize];
        p.thin_film_ior = [1.0, 1.5, 3.0][rng.below(3) as usize];
        let wo = match rng.below(4) {
            0 => vec3(0.0, 0.0, 1.0),
            1 => unit(1.0, 0.2, rng.log_range(1e-7, 1.0)),
            _ => rng.direction(),
        };
        let u = [rng.unit_f32(), rng.unit_f32(), rng.unit_f32()];
        if let Some(s) = sample(&p, wo, u) {
            let w = s.weight.to_array();
            let ok = w.iter().all(|w| w.is_finite() && *w >= 0.0) && s.pdf.is_finite();
            assert!(ok && (s.wi.length() - 1.0).abs() < 1e-4, "{s:?} {wo:?} {p:?}");
        }
    }
}

#[test]
fn corners_are_simpler_models() {
    let mut rng = Rng::new(5);
    let rough = PrincipledParams { specular_roughness: 0.6, ..defaults() };
    let facets = TrowbridgeReitz::new(0.36, 0.36);
    let glass = PrincipledParams { transmission_weight: 1.0, ..rough };
    let exact = DielectricBsdf { roughness: facets, eta: 1.5 };
    for _ in 0..20_000 {
        let (wo, wi) = (rng.direction(), rng.direction());
        if wo.z.abs() < 0.01 || wi.z.abs() < 0.01 {
            continue;
        }
        // Glass is the rough dielectric.
        let a = PrincipledBsdf::new(&glass, wo).unwrap().eval(wi).f_cos.g;
        let b = exact.eval(wo, wi, Lobes::BOTH).f_cos.g;
        let above = a - b;
        // Its facets get back what they lose to each other when they reflect.
        let more = if wo.z * wi.z > 0.0 { 0.3 } else { 2e-3 };
        assert!((-2e-3 * b - 1e-5..more * b + 1e-5).contains(&above), "{wo:?} {wi:?}: {a} {b}");
    }
    // Smooth glass is the mirror image and the refracted direction, thin glass the pane.
    let wo = unit(0.6, 0.0, 0.8);
    let smooth = PrincipledParams { specular_roughness: 0.0, transmission_weight: 1.0, ..white() };
    let pane = PrincipledParams { geometry_thin_walled: true, ..smooth };
    let exact = DielectricBsdf { roughness: TrowbridgeReitz::new(0.0, 0.0), eta: 1.5 };
    for u in [0.0, 0.9999] {
        let a = sample(&smooth, wo, [u, 0.5, 0.5]).unwrap();
        let b = exact.sample(wo, Lobes::BOTH, u, 0.5, 0.5).unwrap();
        assert_eq!((a.wi, a.pdf), (b.wi, b.pdf));
        assert!((a.weight.g - b.weight.g).abs() < 1e-5, "{a:?} {b:?}");
        let (a, b) = (sample(&pane, wo, [u, 0.5, 0.5]).unwrap(), thin_dielectric(wo, 1.5, u));
        assert!((a.wi.z - b.wi.z).abs() < 1e-6 && (a.wi.x - b.wi.x).abs() < 1e-6, "{a:?} {b:?}");
        assert!((a.weight.g - b.weight.g).abs() < 1e-5, "{a:?} {b:?}");
    }
    // Smooth metal is a coloured mirror.
    let metal = PrincipledParams { base_metalness: 1.0, specular_roughness: 0.0, ..defaults() };
    let s = sample(&metal, wo, [0.5; 3]).unwrap();
    let f = fresnel_f82(0.8, Color::grey(0.8), Color::WHITE);
    assert!((s.weight.g - f.g).abs() < 1e-5 && s.pdf == 0.0, "{s:?}");
    // Without a reflection, ideal diffuse reflection.
    let matte = PrincipledParams { specular_weight: 0.0, ..defaults() };
    let f = PrincipledBsdf::new(&matte, wo).unwrap().eval(vec3(0.0, 0.0, 1.0)).f_cos.g;
    assert!((f - 0.8 / std::f32::consts::PI).abs() < 1e-4, "{f}");
}
