//! The principled surface as a material: parameters from textures, directions in world space.

use super::super::{PRINCIPLED_THIN_WALLED, Principled, evaluate};
use super::{responses, surface};
use crate::bxdfs::evaluate_principled;
use crate::math::{Color, dot, vec3};
use crate::sampler::Sampler;
use crate::scene::MaterialKind;
use crate::testing::{Rng, TestScene, solid};
use crate::textures::{ScalarInput, TextureContext};

/// A coat, fuzz and diffuse light that goes through.
fn leaf() -> Principled {
    let number = ScalarInput::solid;
    let white = solid(Color::WHITE);
    Principled {
        base_color: solid(Color::new(0.7, 0.5, 0.2)),
        specular_color: white,
        transmission_color: white,
        subsurface_color: solid(Color::new(0.3, 0.9, 0.1)),
        coat_color: white,
        fuzz_color: white,
        base_weight: number(1.0),
        base_metalness: number(0.0),
        base_diffuse_roughness: number(0.5),
        specular_weight: number(1.0),
        specular_roughness: number(0.5),
        specular_roughness_anisotropy: number(0.0),
        transmission_weight: number(0.0),
        // More than all of it, as a texture may say: all of it.
        subsurface_weight: number(1.5),
        coat_weight: number(0.5),
        coat_roughness: number(0.4),
        coat_roughness_anisotropy: number(0.0),
        coat_darkening: number(1.0),
        fuzz_weight: number(0.3),
        fuzz_roughness: number(0.5),
        thin_film_weight: number(0.0),
        thin_film_thickness: number(0.0),
        specular_ior: 1.5,
        coat_ior: 1.6,
        thin_film_ior: 1.4,
        flags: PRINCIPLED_THIN_WALLED,
    }
}

#[test]
fn it_is_the_same_however_the_surface_is_turned() {
    let mut scene = TestScene::default();
    scene.principleds.push(leaf());
    let view = scene.view();
    let at = TextureContext::in_space(crate::math::Vec3::ZERO);
    let params = view.principleds.get(0).evaluate(&view, &at);
    assert_eq!(params.subsurface_weight, 1.0);
    let mut rng = Rng::new(1);
    let sampler = Sampler::new(0, 0, 0, 0);
    for _ in 0..20_000 {
        let (n, d, wi) = (rng.direction(), rng.direction(), rng.direction());
        let s = surface(n, MaterialKind::Principled);
        // It is isotropic: cosines and the angle between the directions say all.
        let (o, i) = (-dot(d, n), dot(wi, n));
        if o.abs() < 0.05 || i.abs() < 0.05 || o.abs() > 0.999 || i.abs() > 0.999 {
            continue;
        }
        let (ro, ri) = ((1.0 - o * o).sqrt(), (1.0 - i * i).sqrt());
        let cos = ((-dot(d, wi) - o * i) / (ro * ri)).clamp(-1.0, 1.0);
        let there = vec3(ri * cos, ri * (1.0 - cos * cos).sqrt(), i);
        let local = evaluate_principled(&params, vec3(ro, 0.0, o), there).f_cos;
        let world = evaluate(&view, &s, d, wi, &sampler);
        let off = (world.g - local.g).abs();
        assert!(off < 2e-3 * local.g + 1e-5, "{n:?} {d:?} {wi:?}: {world:?} {local:?}");
    }
}

#[test]
fn light_is_reflected_and_goes_through() {
    let mut scene = TestScene::default();
    scene.principleds.push(leaf());
    let view = scene.view();
    let mut rng = Rng::new(2);
    for _ in 0..4 {
        let (n, d) = (rng.direction(), rng.direction());
        let s = surface(n, MaterialKind::Principled);
        let (mut back, mut through) = (Color::BLACK, Color::BLACK);
        let count = 20_000;
        for scatter in responses(&view, &s, d, count).filter_map(|r| r.scatter) {
            let side = if dot(scatter.wi, n) * dot(d, n) < 0.0 { &mut back } else { &mut through };
            *side += scatter.attenuation * (1.0 / count as f32);
        }
        // What goes through is green, and half of what the subsurface has; white is on the rest.
        assert!(through.g > 0.15 && through.g > 2.0 * through.r, "{through:?}");
        assert!(back.g > through.g && back.g + through.g < 1.0, "{back:?} {through:?}");
    }
}
