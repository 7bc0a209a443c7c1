//! What a surface has besides its material: holes, mixtures, normals, light, media.

use super::super::{
    Conductor, Lambertian, Mix, Principled, SIDES_BOTH, SIDES_FRONT, SURFACE_ALPHA, SURFACE_BUMP,
    SURFACE_CUTOFF, SURFACE_EMISSION, SURFACE_MEDIUM, SURFACE_NORMAL_MAP, SURFACE_ONE_SIDED,
    Surface, evaluate, medium_towards, resolve, respond,
};
use super::{responses, surface};
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, dot, vec3};
use crate::sampler::Sampler;
use crate::scene::{MaterialKind, MaterialRef, TextureKind, TextureRef};
use crate::testing::{D3, Rng, TestScene, add, cross, double, length, scaled, solid, sub, unit};
use crate::textures::{ImageTexture, ScalarInput, TEXELS_LINEAR};

/// A matte surface with more about it.
fn scene(record: Surface) -> TestScene {
    let mut scene = TestScene::default();
    scene.lambertians.push(Lambertian { albedo: solid(Color::grey(0.5)) });
    scene.surfaces.push(record);
    scene
}

fn with_flags(flags: u32) -> Surface {
    Surface { flags, base: MaterialRef::new(MaterialKind::Lambertian, 0), ..Surface::default() }
}

/// A flat surface in which u and v run along a right-handed frame, or a left-handed one.
fn frame(rng: &mut Rng, is_mirrored: bool) -> (SurfaceInteraction, [D3; 3]) {
    let n = double(rng.direction());
    let t = unit(cross(n, double(rng.direction())));
    let b = scaled(cross(n, t), if is_mirrored { -1.0 } else { 1.0 });
    let mut s = surface(single(n), MaterialKind::Surface);
    (s.dpdu, s.dpdv) = (single(scaled(t, 2.0)), single(scaled(b, 3.0)));
    (s, [t, b, n])
}

fn single(v: D3) -> Vec3 {
    crate::testing::single(v)
}

/// Adds a linear image of the values, and gives its handle.
fn image(scene: &mut TestScene, width: u32, bilinear: u32, texels: &[[f64; 3]]) -> TextureRef {
    let first_word = scene.texels.len() as u32;
    scene.texels.extend(texels.iter().flatten().map(|x| (*x as f32).to_bits()));
    let height = texels.len() as u32 / width;
    let format = TEXELS_LINEAR;
    scene.images.push(ImageTexture { first_word, width, height, format, bilinear, _pad: [0; 3] });
    TextureRef::new(TextureKind::Image, scene.images.len() as u32 - 1)
}

#[test]
fn alpha_is_the_chance_to_be_there() {
    for (alpha, cutoff, share) in [
        (0.3, None, 0.3),
        (0.0, None, 0.0),
        (1.0, None, 1.0),
        (0.49, Some(0.5), 0.0),
        (0.5, Some(0.5), 1.0),
    ] {
        let flags = SURFACE_ALPHA | if cutoff.is_some() { SURFACE_CUTOFF } else { 0 };
        let mut record = with_flags(flags);
        record.alpha = ScalarInput::solid(alpha);
        record.alpha_cutoff = cutoff.unwrap_or(0.5);
        let scene = scene(record);
        let view = scene.view();
        let n = 100_000;
        let n_there = (0..n)
            .filter(|i| {
                let mut s = surface(vec3(0.0, 0.0, 1.0), MaterialKind::Surface);
                let sampler = Sampler::new(5, i % 100, 0, i / 100);
                !resolve(&view, &mut s, vec3(0.0, 0.0, -1.0), &sampler).is_hole
            })
            .count();
        let (n, n_there): (f64, f64) = (f64::from(n), n_there as f64);
        let sigma = (n * share * (1.0 - share)).sqrt();
        assert!((n_there - n * share).abs() <= 4.5 * sigma, "{n_there} of {n} for {alpha}");
    }
}

/// A mixture of mixtures: shares multiply, though one random number serves all choices.
#[test]
fn mixtures_have_their_shares() {
    let mut scene = TestScene::default();
    let matte = |i| MaterialRef::new(MaterialKind::Lambertian, i);
    let mix = |i| MaterialRef::new(MaterialKind::Mix, i);
    let amount = ScalarInput::solid;
    scene.mixes.push(Mix { amount: amount(0.25), materials: [matte(0), matte(1)] });
    scene.mixes.push(Mix { amount: amount(0.9), materials: [matte(2), matte(3)] });
    scene.mixes.push(Mix { amount: amount(0.4), materials: [mix(0), mix(1)] });
    let view = scene.view();
    let n = 200_000;
    let mut counts = [0_u64; 4];
    for i in 0..n {
        let mut s = surface(vec3(0.0, 0.0, 1.0), MaterialKind::Mix);
        s.material = mix(2);
        let sampler = Sampler::new(6, i % 100, 0, i / 100);
        let _ = resolve(&view, &mut s, vec3(0.0, 0.0, -1.0), &sampler);
        counts[s.material.index() as usize] += 1;
    }
    let shares = [0.6 * 0.75, 0.6 * 0.25, 0.4 * 0.1, 0.4 * 0.9];
    let expected = shares.map(|x| x * f64::from(n));
    crate::testing::ChiSquared { n_tests: 1 }.check("mixtures", &counts, &expected);
    // All or nothing.
    for (share, index) in [(0.0, 0), (1.0, 1), (-3.0, 0), (7.0, 1)] {
        scene.mixes[0].amount = ScalarInput::solid(share);
        let view = scene.view();
        for i in 0..1000 {
            let mut s = surface(vec3(0.0, 0.0, 1.0), MaterialKind::Mix);
            let _ = resolve(&view, &mut s, vec3(0.0, 0.0, -1.0), &Sampler::new(7, i, 0, 0));
            assert_eq!(s.material, matte(index));
        }
    }
}

/// The map's x is along u and its y along v, also where the picture lies mirrored on the surface.
#[test]
fn normal_maps_turn_the_normal_in_the_frame_of_the_texture() {
    let mut rng = Rng::new(1);
    for case in 0..2000 {
        let texel = [rng.range(0.2, 0.8), rng.range(0.2, 0.8), rng.range(0.6, 1.0)];
        let strength = rng.range(0.0, 2.0);
        let mut record = with_flags(SURFACE_NORMAL_MAP);
        record.normal_scale = strength as f32;
        let mut scene = scene(record);
        scene.surfaces[0].normal_map = image(&mut scene, 1, 0, &[texel]);
        let view = scene.view();
        let (mut s, [t, b, n]) = frame(&mut rng, case % 2 == 1);
        let geometric = s.n;
        let sampler = Sampler::new(0, 0, 0, 0);
        let _ = resolve(&view, &mut s, rng.direction(), &sampler);
        let [x, y, z] = texel.map(|c| 2.0 * c - 1.0);
        let expected =
            unit(add(add(scaled(t, x * strength), scaled(b, y * strength)), scaled(n, z)));
        assert!(length(sub(double(s.ns), expected)) < 2e-6, "{:?} {expected:?}", s.ns);
        assert_eq!(s.n, geometric);
    }
}

/// Of a wavy height: the normal of the displaced surface, without a shift to one side.
#[test]
fn bumps_turn_the_normal_by_the_slope() {
    const N: u32 = 256;
    let waves = |x: f64| 0.05 * (std::f64::consts::TAU * 2.0 * x).sin();
    let slope =
        |x: f64| 0.05 * std::f64::consts::TAU * 2.0 * (std::f64::consts::TAU * 2.0 * x).cos();
    let texels: Vec<[f64; 3]> =
        (0..N).map(|i| [waves((f64::from(i) + 0.5) / f64::from(N)); 3]).collect();
    let mut scene = scene(with_flags(SURFACE_BUMP));
    let texture = image(&mut scene, N, 1, &texels);
    scene.surfaces[0].bump = ScalarInput { value: 0.0, texture };
    let view = scene.view();
    let mut rng = Rng::new(2);
    for case in 0..4000 {
        let (mut s, [t, _, n]) = frame(&mut rng, case % 2 == 1);
        let u = rng.unit();
        s.uv = [u as f32, 0.5];
        // Footprints of up to a tenth of a wave; u is 2 units long.
        s.footprint = rng.range(0.0, 0.1) as f32;
        let _ = resolve(&view, &mut s, rng.direction(), &Sampler::new(0, 0, 0, 0));
        // Along u the surface is 2 long: its slope is half of that in u.
        let expected = unit(sub(n, scaled(t, slope(u) / 2.0)));
        let off = length(sub(double(s.ns), expected));
        assert!(off < 0.01, "at {u}, footprint {}: off by {off}", s.footprint);
    }
}

#[test]
fn light_and_holes_are_on_the_sides_that_they_should_be() {
    let mut rng = Rng::new(3);
    let radiance = Color::new(1.0, 2.0, 3.0);
    for sides in [SIDES_BOTH, SIDES_FRONT] {
        let mut record = with_flags(SURFACE_EMISSION);
        record.emission = solid(radiance);
        record.emission_strength = 2.0;
        record.emission_sides = sides;
        let lit = scene(record);
        let hole = scene(with_flags(SURFACE_ONE_SIDED));
        for _ in 0..2000 {
            let (mut s, d) = (surface(rng.direction(), MaterialKind::Surface), rng.direction());
            let is_front = s.is_front(d);
            let sampler = Sampler::new(0, 0, 0, 0);
            let resolved = resolve(&lit.view(), &mut s, d, &sampler);
            let shines = sides == SIDES_BOTH || is_front;
            assert_eq!(resolved.emitted, if shines { radiance * 2.0 } else { Color::BLACK });
            // It scatters, too.
            assert_eq!(s.material, MaterialRef::new(MaterialKind::Lambertian, 0));
            let mut s = surface(s.n, MaterialKind::Surface);
            assert_eq!(resolve(&hole.view(), &mut s, d, &sampler).is_hole, !is_front);
        }
    }
}

#[test]
fn media_are_on_their_sides() {
    let mut record = with_flags(SURFACE_MEDIUM);
    (record.inside, record.outside) = (4, 7);
    let scene = scene(record);
    let mut s = surface(vec3(0.0, 1.0, 0.0), MaterialKind::Surface);
    let resolved = resolve(&scene.view(), &mut s, vec3(0.0, -1.0, 0.0), &Sampler::new(0, 0, 0, 0));
    let media = resolved.media.unwrap();
    assert_eq!(medium_towards(media, s.n, vec3(0.0, 1.0, 0.0)), 7);
    assert_eq!(medium_towards(media, s.n, vec3(0.0, -1.0, 0.0)), 4);
}

/// However a map turns the normal, an opaque surface lets no light through.
#[test]
fn turned_normals_do_not_let_light_through() {
    let mut scene = TestScene::default();
    scene.lambertians.push(Lambertian { albedo: solid(Color::WHITE) });
    let rough = ScalarInput::solid(0.5);
    let mut conductor: Conductor = bytemuck::Zeroable::zeroed();
    (conductor.roughness.u, conductor.roughness.v) = (rough, rough);
    (conductor.eta, conductor.k) = (Color::WHITE, Color::grey(9.0));
    scene.conductors.push(conductor);
    let mut principled: Principled = bytemuck::Zeroable::zeroed();
    (principled.base_weight, principled.specular_roughness) = (ScalarInput::solid(1.0), rough);
    principled.base_color = solid(Color::WHITE);
    principled.specular_weight = ScalarInput::solid(1.0);
    principled.specular_color = solid(Color::WHITE);
    (principled.specular_ior, principled.coat_ior, principled.thin_film_ior) = (1.5, 1.6, 1.4);
    scene.principleds.push(principled);
    let view = scene.view();
    let mut rng = Rng::new(4);
    for kind in [MaterialKind::Lambertian, MaterialKind::Conductor, MaterialKind::Principled] {
        let (mut n_scattered, mut n_lit) = (0, 0);
        for _ in 0..2000 {
            let mut s = surface(rng.direction(), kind);
            s.ns = unit_vec(double(s.n), double(rng.direction()));
            let d = rng.direction();
            for response in responses(&view, &s, d, 10) {
                let Some(scatter) = response.scatter else { continue };
                n_scattered += 1;
                let through = dot(s.n, d) * dot(s.n, scatter.wi) > 0.0;
                assert!(!through, "{kind:?}: {s:?} {d:?} {scatter:?}");
            }
            let wi = rng.direction();
            let f = evaluate(&view, &s, d, wi, &Sampler::new(0, 0, 0, 0));
            n_lit += u32::from(f != Color::BLACK);
            assert!(f == Color::BLACK || dot(s.n, d) * dot(s.n, wi) <= 0.0, "{kind:?}: {s:?}");
        }
        assert!(n_scattered > 5000 && n_lit > 200, "{kind:?}: {n_scattered} {n_lit}");
    }
    // Where nothing is turned, nothing is lost.
    let s = surface(vec3(0.0, 0.0, 1.0), MaterialKind::Lambertian);
    for i in 0..1000 {
        let grazing = vec3(1.0, 0.0, -1e-4).normalized();
        assert!(respond(&view, &s, grazing, &Sampler::new(1, i, 0, 0)).scatter.is_some());
    }
}

/// `n` turned towards `w` by a moderate angle.
fn unit_vec(n: D3, w: D3) -> Vec3 {
    single(unit(add(n, scaled(w, 0.7))))
}
