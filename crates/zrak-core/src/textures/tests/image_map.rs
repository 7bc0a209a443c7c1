//! Image maps against look-ups in `f64`.

use super::super::{
    CHANNEL_A, CHANNEL_B, CHANNEL_COLOR, CHANNEL_G, CHANNEL_LUMINANCE, CHANNEL_R, FILTER_BILINEAR,
    FILTER_NEAREST, FILTER_TRILINEAR, ImageMap, ImageTexture, MAPPING_CYLINDRICAL, MAPPING_PLANAR,
    MAPPING_SPHERICAL, MAPPING_UV, NO_MAPPING, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM8,
    TEXELS_UNORM16, TextureArrays, TextureContext, TextureMapping, WRAP_BLACK, WRAP_CLAMP,
    WRAP_MIRROR, WRAP_REPEAT,
};
use crate::math::{Affine, Color, Vec3, vec3};
use crate::testing::{Rng, TestScene};

const WIDTH: u32 = 5;
const HEIGHT: u32 = 3;

fn value(x: u32, y: u32) -> f64 {
    f64::from((x * 7 + y * 13) % 11) / 10.0
}

fn map(raster: ImageTexture) -> ImageMap {
    ImageMap {
        raster,
        n_levels: 1,
        filter: FILTER_BILINEAR,
        wrap_u: WRAP_REPEAT,
        wrap_v: WRAP_CLAMP,
        channel: CHANNEL_COLOR,
        mapping: NO_MAPPING,
        scale: 1.0,
        invert: 0,
    }
}

fn raster(format: u32) -> ImageTexture {
    ImageTexture { first_word: 0, width: WIDTH, height: HEIGHT, format, bilinear: 0, _pad: [0; 3] }
}

fn scene() -> TestScene {
    let mut scene = TestScene::default();
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            scene.texels.extend([(value(x, y) as f32).to_bits(); 3]);
        }
    }
    scene
}

/// Texel by indices of any size; `None` is black.
fn index(i: i64, n: u32, wrap: u32) -> Option<u32> {
    let n = i64::from(n);
    let i = match wrap {
        WRAP_REPEAT => i.rem_euclid(n),
        WRAP_CLAMP => i.clamp(0, n - 1),
        WRAP_MIRROR => {
            let i = i.rem_euclid(2 * n);
            if i < n { i } else { 2 * n - 1 - i }
        }
        _ if i < 0 || i >= n => return None,
        _ => i,
    };
    Some(i as u32)
}

fn exact(map: &ImageMap, uv: [f32; 2]) -> f64 {
    let (x, y) =
        (f64::from(uv[0]) * f64::from(WIDTH), (1.0 - f64::from(uv[1])) * f64::from(HEIGHT));
    let at = |ix: f64, iy: f64| match (
        index(ix as i64, WIDTH, map.wrap_u),
        index(iy as i64, HEIGHT, map.wrap_v),
    ) {
        (Some(x), Some(y)) => value(x, y),
        _ => 0.0,
    };
    if map.filter == FILTER_NEAREST {
        return at(x.floor(), y.floor());
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let row = |iy: f64| (1.0 - fx) * at(x.floor(), iy) + fx * at(x.floor() + 1.0, iy);
    (1.0 - fy) * row(y.floor()) + fy * row(y.floor() + 1.0)
}

fn at(uv: [f32; 2], duv: [f32; 2]) -> TextureContext {
    TextureContext { uv, duv, ..TextureContext::in_space(Vec3::ZERO) }
}

#[test]
fn every_wrapping_agrees_with_its_definition() {
    let scene = scene();
    let view = scene.view();
    let arrays = TextureArrays::of(&view);
    let mut rng = Rng::new(5);
    for wrap_u in [WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR, WRAP_BLACK] {
        for wrap_v in [WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR, WRAP_BLACK] {
            let map = ImageMap { wrap_u, wrap_v, ..map(raster(TEXELS_LINEAR)) };
            for _ in 0..20_000 {
                let uv = [rng.range(-3.0, 4.0) as f32, rng.range(-3.0, 4.0) as f32];
                let expected = exact(&map, uv);
                let got = f64::from(map.evaluate(&arrays, &at(uv, [0.0; 2])).g);
                assert!((got - expected).abs() < 2e-5, "{got} {expected} {uv:?} {wrap_u}");
            }
            // In the middle of texels, where rounding cannot lead to the neighbour.
            let nearest = ImageMap { filter: FILTER_NEAREST, ..map };
            for i in -15..20 {
                for j in -9..12 {
                    let place = |i: i32, n: u32| (i as f32 + 0.5) / n as f32;
                    let uv = [place(i, WIDTH), place(j, HEIGHT)];
                    let got = f64::from(nearest.evaluate(&arrays, &at(uv, [0.0; 2])).g);
                    assert!((got - exact(&nearest, uv)).abs() < 1e-7, "{uv:?}");
                }
            }
            for extreme in [1e9, -1e9, f32::MAX, f32::MIN, f32::INFINITY, f32::NAN] {
                for filter in [FILTER_NEAREST, FILTER_BILINEAR, FILTER_TRILINEAR] {
                    let map = ImageMap { filter, ..map };
                    let context = at([extreme, 0.3], [extreme; 2]);
                    let got = map.evaluate(&arrays, &context).g;
                    assert!((0.0..1.000_001).contains(&got), "{got} {extreme} {filter} {wrap_u}");
                }
            }
        }
    }
}

#[test]
fn formats_and_channels_are_what_they_say() {
    let srgb_table = (0..256).map(|i| (i * i) as f32).collect();
    let mut scene = TestScene { srgb_table, ..TestScene::default() };
    let codes = [10_u8, 20, 30, 51];
    scene.texels.push(u32::from_le_bytes(codes));
    scene.texels.extend([1000 | 2000 << 16, 3000 | 13107 << 16]);
    let view = scene.view();
    let arrays = TextureArrays::of(&view);
    let unorm8 = codes.map(|c| f32::from(c) / 255.0);
    let unorm16 = [1000.0, 2000.0, 3000.0, 13107.0].map(|c| c / 65535.0);
    for (format, first_word, [r, g, b, a]) in [
        (TEXELS_SRGB8, 0, [100.0, 400.0, 900.0, 0.2]),
        (TEXELS_UNORM8, 0, unorm8),
        (TEXELS_UNORM16, 1, unorm16),
    ] {
        let raster =
            ImageTexture { first_word, width: 1, height: 1, format, bilinear: 0, _pad: [0; 3] };
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        for (channel, expected) in [
            (CHANNEL_COLOR, Color::new(r, g, b)),
            (CHANNEL_R, Color::grey(r)),
            (CHANNEL_G, Color::grey(g)),
            (CHANNEL_B, Color::grey(b)),
            (CHANNEL_A, Color::grey(a)),
            (CHANNEL_LUMINANCE, Color::grey(luminance)),
        ] {
            let map = ImageMap { channel, filter: FILTER_NEAREST, ..map(raster) };
            assert_eq!(map.evaluate(&arrays, &at([0.3, 0.6], [0.0; 2])), expected);
            let other = ImageMap { invert: 1, scale: 2.0, ..map };
            let flipped = expected.map(|x| 2.0 * (1.0 - x));
            assert_eq!(other.evaluate(&arrays, &at([0.3, 0.6], [0.0; 2])), flipped);
        }
    }
}

/// Each level of detail has one value: 0 the finest, 1, 2, 3.
#[test]
fn the_footprint_chooses_the_level() {
    let mut scene = TestScene::default();
    for (level, side) in [8_usize, 4, 2, 1].into_iter().enumerate() {
        let bits = (level as f32).to_bits();
        scene.texels.extend(std::iter::repeat_n(bits, 3 * side * side));
    }
    let view = scene.view();
    let arrays = TextureArrays::of(&view);
    let raster = ImageTexture { width: 8, height: 8, ..raster(TEXELS_LINEAR) };
    let map = ImageMap { n_levels: 4, filter: FILTER_TRILINEAR, ..map(raster) };
    for (footprint, level) in [
        (0.0, 0.0),
        (0.5 / 8.0, 0.0),
        (1.0 / 8.0, 0.0),
        (2.0 / 8.0, 1.0),
        (4.0 / 8.0, 2.0),
        (1.0, 3.0),
        (100.0, 3.0),
        (f32::INFINITY, 3.0),
        (2.0_f32.sqrt() / 8.0, 0.5),
        (3.0 / 8.0, 3.0_f32.log2()),
    ] {
        for duv in [[footprint, 0.0], [0.0, footprint]] {
            let got = map.evaluate(&arrays, &at([0.4, 0.7], duv)).r;
            assert!((got - level).abs() < 1e-5, "{footprint}: {got}, not {level}");
        }
    }
    let bilinear = ImageMap { filter: FILTER_BILINEAR, ..map };
    assert_eq!(bilinear.evaluate(&arrays, &at([0.4, 0.7], [1.0; 2])).r, 0.0);
}

/// The change of (u, v) over a footprint is that of points so far away.
#[test]
fn mappings_give_coordinates_and_how_fast_they_change() {
    let rows = [[1.0, 0.5, -0.2, 0.3], [0.1, -0.8, 0.4, 2.0], [0.3, 0.2, 0.9, -0.5]];
    let mut rng = Rng::new(9);
    for kind in [MAPPING_UV, MAPPING_PLANAR, MAPPING_SPHERICAL, MAPPING_CYLINDRICAL] {
        let mapping = TextureMapping { map: Affine { rows }, kind, _pad: [0; 3] };
        for _ in 0..200 {
            let p = vec3(
                rng.range(-3.0, 3.0) as f32,
                rng.range(-3.0, 3.0) as f32,
                rng.range(-3.0, 3.0) as f32,
            );
            let context = TextureContext {
                p,
                uv: [p.x, p.y],
                duv: [0.01, 0.02],
                footprint: 0.01,
                ..TextureContext::in_space(p)
            };
            let (uv, duv) = mapping.uv(&context);
            let q = match kind {
                MAPPING_UV => mapping.map.point(vec3(p.x, p.y, 0.0)),
                _ => mapping.map.point(p),
            };
            let (x, y, z) = (f64::from(q.x), f64::from(q.y), f64::from(q.z));
            let turns = (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0);
            let [u, v] = match kind {
                MAPPING_UV | MAPPING_PLANAR => [x, y],
                MAPPING_SPHERICAL => [turns, x.hypot(y).atan2(z) / std::f64::consts::PI],
                _ => [turns, z],
            };
            assert!((f64::from(uv[0]) - u).abs() < 1e-5 && (f64::from(uv[1]) - v).abs() < 1e-5);
            assert!(duv.iter().all(|d| *d > 0.0));
            let expected = match kind {
                MAPPING_UV => [0.01 + 0.5 * 0.02, 0.1 * 0.01 + 0.8 * 0.02],
                MAPPING_PLANAR => {
                    [0.01 * (1.0_f64 + 0.25 + 0.04).sqrt(), 0.01 * (0.01_f64 + 0.64 + 0.16).sqrt()]
                }
                _ => {
                    let width = 0.01 * (0.09_f64 + 0.04 + 0.81).sqrt();
                    let du = width / std::f64::consts::TAU / x.hypot(y);
                    let r = (x * x + y * y + z * z).sqrt();
                    let dv = width / std::f64::consts::PI / r;
                    [du, if kind == MAPPING_SPHERICAL { dv } else { width }]
                }
            };
            for i in 0..2 {
                assert!((f64::from(duv[i]) / expected[i] - 1.0).abs() < 1e-4, "{kind} {duv:?}");
            }
        }
    }
}
