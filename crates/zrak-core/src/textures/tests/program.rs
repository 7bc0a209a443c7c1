//! Programs: what each operation leaves, and dots and fractals by their statistics.

use super::super::{
    ColorInput, FRACTAL_FBM, FRACTAL_WINDY, FRACTAL_WRINKLED, Fractal, MAPPING_PLANAR, MAPPING_UV,
    NO_MAPPING, Noise, OP_CHECKER, OP_DOTS, OP_FRACTAL, OP_LERP_U, OP_LERP_V, OP_MIX, OP_MULTIPLY,
    OP_NOISE, OP_SOLID, OP_UV_CHECKER, OP_VERTEX_COLOR, PATTERN_NOISE, Program, TextureContext,
    TextureMapping, TextureOp, perlin,
};
use crate::math::{Affine, Color, Vec3, vec3};
use crate::scene::{TextureKind, TextureRef};
use crate::testing::{Rng, TestScene};

const A: Color = Color { r: 0.1, g: 0.2, b: 0.3 };
const B: Color = Color { r: 0.5, g: 0.25, b: 1.0 };

fn op(op: u32) -> TextureOp {
    TextureOp { op, slots: 0, index: 0, mapping: NO_MAPPING, color: Color::BLACK, value: 0.0 }
}

fn solid(color: Color, slot: u32) -> TextureOp {
    TextureOp { color, slots: slot, ..op(OP_SOLID) }
}

/// The scene of a program with these operations.
fn scene(ops: &[TextureOp]) -> TestScene {
    let mut scene = TestScene { texture_ops: vec![solid(A, 0); 3], ..TestScene::default() };
    scene.texture_ops.extend(ops);
    scene.programs.push(Program { first_op: 3, n_ops: ops.len() as u32 });
    scene
}

fn run(scene: &TestScene, at: &TextureContext) -> Color {
    let texture = TextureRef::new(TextureKind::Program, 0);
    ColorInput { solid: Color::BLACK, texture }.evaluate(&scene.view(), at)
}

/// The result of an operation on A in slot 1, B in slot 2 and 0.25 in slot 3.
fn of(last: TextureOp, at: &TextureContext) -> Color {
    let slots = 0x3210;
    run(
        &scene(&[
            solid(A, 1),
            solid(B, 2),
            solid(Color::grey(0.25), 3),
            TextureOp { slots, ..last },
        ]),
        at,
    )
}

fn at(p: Vec3, uv: [f32; 2]) -> TextureContext {
    TextureContext {
        uv,
        color: Color::new(0.2, 0.4, 0.6),
        alpha: 0.8,
        ..TextureContext::in_space(p)
    }
}

#[test]
fn operations_do_what_they_say() {
    let here = at(vec3(0.5, 1.5, -0.5), [0.25, 1.75]);
    assert_eq!(of(op(OP_MULTIPLY), &here), A * B);
    assert_eq!(of(op(OP_MIX), &here), Color::lerp(0.25, A, B));
    assert_eq!(of(op(OP_LERP_U), &here), Color::lerp(0.25, A, B));
    assert_eq!(of(op(OP_LERP_V), &here), Color::lerp(1.75, A, B));
    assert_eq!(of(op(OP_UV_CHECKER), &here), B);
    assert_eq!(of(op(OP_UV_CHECKER), &at(Vec3::ZERO, [1.1, 1.9])), A);
    assert_eq!(of(op(OP_UV_CHECKER), &at(Vec3::ZERO, [-0.1, 0.1])), B);
    let checker = |inv_scale| TextureOp { value: inv_scale, ..op(OP_CHECKER) };
    // Cells (0, 1, -1) and (1, 3, -1).
    assert_eq!(of(checker(1.0), &here), A);
    assert_eq!(of(checker(2.0), &here), B);
    for (index, expected) in [
        (0, Color::new(0.2, 0.4, 0.6)),
        (1, Color::grey(0.2)),
        (2, Color::grey(0.4)),
        (3, Color::grey(0.6)),
        (4, Color::grey(0.8)),
    ] {
        assert_eq!(of(TextureOp { index, ..op(OP_VERTEX_COLOR) }, &here), expected);
    }
}

#[test]
fn mappings_move_space_and_coordinates() {
    let map = Affine { rows: [[2.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.25]] };
    let here = at(vec3(0.3, 0.7, 0.9), [0.3, 0.7]);
    let noise = Noise {
        low: Color::BLACK,
        scale: 1.0,
        high: Color::WHITE,
        pattern: PATTERN_NOISE,
        octaves: 1,
        seed: 3,
        _pad: [0; 2],
    };
    let mut noisy = scene(&[TextureOp { mapping: 0, ..op(OP_NOISE) }]);
    noisy.noises.push(noise);
    noisy.mappings.push(TextureMapping { map, kind: MAPPING_PLANAR, _pad: [0; 3] });
    assert_eq!(run(&noisy, &here), noise.evaluate(vec3(1.1, -0.3, 1.15)));
    let slots = 0x210;
    let mut squares =
        scene(&[solid(A, 1), solid(B, 2), TextureOp { slots, mapping: 0, ..op(OP_UV_CHECKER) }]);
    squares.mappings.push(TextureMapping { map, kind: MAPPING_UV, _pad: [0; 3] });
    // (1.1, -0.3)
    assert_eq!(run(&squares, &here), A);
    assert_eq!(run(&squares, &at(Vec3::ZERO, [0.2, 0.7])), B);
}

#[test]
fn half_of_the_squares_have_a_dot_inside() {
    let mut rng = Rng::new(2);
    let (mut inside, n) = (0, 200_000);
    for _ in 0..n {
        let uv = [rng.range(-500.0, 500.0) as f32, rng.range(-500.0, 500.0) as f32];
        inside += u32::from(of(op(OP_DOTS), &at(Vec3::ZERO, uv)) == A);
    }
    // pi 0.35^2 / 2, with some spread from which squares were met.
    let share = f64::from(inside) / f64::from(n);
    assert!((share - 0.1924).abs() < 0.005, "{share}");
    // No dot leaves its square: between squares there is none.
    for i in 0..10_000 {
        let uv = [(i % 100) as f32 + 0.5, i as f32 / 100.0];
        assert_eq!(of(op(OP_DOTS), &at(Vec3::ZERO, uv)), B, "{uv:?}");
    }
}

#[test]
fn fractals_add_up_octaves() {
    let mut rng = Rng::new(4);
    for pattern in [FRACTAL_FBM, FRACTAL_WRINKLED, FRACTAL_WINDY] {
        let fractal = Fractal {
            low: Color::grey(0.5),
            scale: 1.7,
            high: Color::grey(1.5),
            pattern,
            octaves: 4,
            seed: 11,
            roughness: 0.6,
            _pad: 0,
        };
        let mut scene = scene(&[op(OP_FRACTAL)]);
        scene.fractals.push(fractal);
        for _ in 0..500 {
            let p = vec3(
                rng.range(-9.0, 9.0) as f32,
                rng.range(-9.0, 9.0) as f32,
                rng.range(-9.0, 9.0) as f32,
            );
            let sum = |q: Vec3, octaves: i32, absolute: bool| -> f64 {
                (0..octaves)
                    .map(|i| {
                        let noise = f64::from(perlin(q * 1.99_f32.powi(i), 11));
                        0.6_f64.powi(i) * if absolute { noise.abs() } else { noise }
                    })
                    .sum()
            };
            let q = p * 1.7;
            let value = match pattern {
                FRACTAL_FBM => sum(q, 4, false),
                FRACTAL_WRINKLED => sum(q, 4, true),
                _ => sum(q * 0.1, 3, false).abs() * sum(q, 4, false),
            };
            let expected = (0.5 + value).max(0.0);
            let got = run(&scene, &TextureContext::in_space(p));
            assert!((f64::from(got.r) - expected).abs() < 1e-3, "{got:?} {expected}");
        }
    }
}
