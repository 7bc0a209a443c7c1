//! Image lookups.

use super::super::{ImageTexture, TEXELS_LINEAR, TEXELS_SRGB8};
use crate::math::Color;
use crate::scene::SceneView;
use crate::testing::{Rng, TestScene};
use crate::textures::TextureArrays;

const WIDTH: u32 = 5;
const HEIGHT: u32 = 3;

/// Texel (x, y), y from the top.
fn texel(x: u32, y: u32) -> Color {
    Color::new(x as f32 / 8.0, y as f32 / 4.0, (x * y) as f32 / 16.0)
}

fn image(format: u32, bilinear: u32, first_word: u32) -> ImageTexture {
    ImageTexture { first_word, width: WIDTH, height: HEIGHT, format, bilinear, _pad: [0; 3] }
}

/// The picture as linear texels, after some words of another one.
fn linear_scene() -> TestScene {
    let mut scene = TestScene { texels: vec![f32::NAN.to_bits(); 7], ..TestScene::default() };
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            scene.texels.extend(texel(x, y).to_array().map(f32::to_bits));
        }
    }
    scene
}

#[test]
fn nearest_is_the_texel_that_the_point_falls_into() {
    let scene = linear_scene();
    let view = scene.view();
    let image = image(TEXELS_LINEAR, 0, 7);
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            for (du, dv) in [(0.5, 0.5), (0.01, 0.01), (0.99, 0.99)] {
                let u = (x as f32 + du) / WIDTH as f32;
                // v runs upwards, rows downwards.
                let v = 1.0 - (y as f32 + dv) / HEIGHT as f32;
                assert_eq!(
                    image.evaluate(&TextureArrays::of(&view), [u, v]),
                    texel(x, y),
                    "{u} {v}"
                );
            }
        }
    }
    // Repeats in u, ends in v.
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [1.1, 0.9]), texel(0, 0));
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [-0.1, 0.9]), texel(4, 0));
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [0.1, 7.0]), texel(0, 0));
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [0.1, -7.0]), texel(0, 2));
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [1.0, 1.0]), texel(0, 0));
    assert_eq!(image.evaluate(&TextureArrays::of(&view), [0.0, 0.0]), texel(0, 2));
}

/// Bilinear lookup in `f64`.
fn exact(u: f64, v: f64, channel: usize) -> f64 {
    let u = u - u.floor();
    let v = v.clamp(0.0, 1.0);
    let (x, y) = (u * f64::from(WIDTH) - 0.5, (1.0 - v) * f64::from(HEIGHT) - 0.5);
    let at = |ix: f64, iy: f64| {
        let x = (ix as i64).rem_euclid(i64::from(WIDTH)) as u32;
        let y = (iy as i64).clamp(0, i64::from(HEIGHT) - 1) as u32;
        f64::from(texel(x, y).to_array()[channel])
    };
    let (ix, iy) = (x.floor(), y.floor());
    let (fx, fy) = (x - ix, y - iy);
    (1.0 - fy) * ((1.0 - fx) * at(ix, iy) + fx * at(ix + 1.0, iy))
        + fy * ((1.0 - fx) * at(ix, iy + 1.0) + fx * at(ix + 1.0, iy + 1.0))
}

fn check_bilinear(view: &SceneView, u: f32, v: f32) {
    let color = image(TEXELS_LINEAR, 1, 7).evaluate(&TextureArrays::of(view), [u, v]).to_array();
    for (channel, x) in color.into_iter().enumerate() {
        let exact = exact(f64::from(u), f64::from(v), channel);
        assert!((f64::from(x) - exact).abs() < 1e-5, "{x} {exact} at {u} {v}");
    }
}

#[test]
fn bilinear_is_the_weighted_mean_of_four() {
    let scene = linear_scene();
    let view = scene.view();
    let mut rng = Rng::new(1);
    for _ in 0..100_000 {
        check_bilinear(&view, rng.range(-2.0, 3.0) as f32, rng.range(-0.5, 1.5) as f32);
    }
    for u in [0.0, 1.0, 0.1, 0.5, 0.9, 1.0_f32.next_down(), -0.0, -1e-9, 1e-9] {
        for v in [0.0, 1.0, 0.5, 1.0_f32.next_down(), -0.0, 1e-9] {
            check_bilinear(&view, u, v);
        }
    }
}

#[test]
fn codes_go_through_the_table() {
    let srgb_table = (0..256).map(|i| i as f32 * 3.0).collect();
    let mut scene = TestScene { srgb_table, ..TestScene::default() };
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            scene.texels.push(u32::from_le_bytes([x as u8, y as u8, 200 + x as u8, 255]));
        }
    }
    let view = scene.view();
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let uv = [(x as f32 + 0.5) / WIDTH as f32, 1.0 - (y as f32 + 0.5) / HEIGHT as f32];
            let expected = Color::new(3.0 * x as f32, 3.0 * y as f32, 600.0 + 3.0 * x as f32);
            assert_eq!(image(TEXELS_SRGB8, 0, 0).evaluate(&TextureArrays::of(&view), uv), expected);
        }
    }
    // The mean is of linear values, not of codes.
    scene.srgb_table = (0..256).map(|i| (i * i) as f32).collect();
    let view = scene.view();
    let between =
        image(TEXELS_SRGB8, 1, 0).evaluate(&TextureArrays::of(&view), [2.0 / WIDTH as f32, 0.5]);
    assert!((between.r - 2.5).abs() < 1e-4, "{between:?}");
}

#[test]
fn extreme_coordinates_read_some_texel() {
    let scene = linear_scene();
    let view = scene.view();
    for bilinear in [0, 1] {
        for u in [1e9, -1e9, 1e20, -1e20, f32::MAX, f32::MIN] {
            for v in [1e9, -1e9, f32::MAX, f32::MIN] {
                let color =
                    image(TEXELS_LINEAR, bilinear, 7).evaluate(&TextureArrays::of(&view), [u, v]);
                assert!((0.0..=1.0).contains(&color.g), "{color:?} at {u} {v}");
            }
        }
    }
}

#[test]
fn a_single_texel_is_everywhere() {
    let texels = [0.25_f32, 0.5, 1.0].map(f32::to_bits).to_vec();
    let scene = TestScene { texels, ..TestScene::default() };
    let view = scene.view();
    let mut rng = Rng::new(2);
    for bilinear in [0, 1] {
        let image = ImageTexture { width: 1, height: 1, ..image(TEXELS_LINEAR, bilinear, 0) };
        for _ in 0..1000 {
            let uv = [rng.range(-2.0, 2.0) as f32, rng.range(-2.0, 2.0) as f32];
            let c = image.evaluate(&TextureArrays::of(&view), uv);
            assert!((c.r - 0.25).abs() < 1e-6 && (c.b - 1.0).abs() < 1e-6);
        }
    }
}
