//! Checker patterns.

use super::super::{Checker, ColorInput};
use crate::math::{Color, Vec3, vec3};
use crate::scene::{TextureKind, TextureRef};
use crate::testing::{Rng, TestScene, solid};
use crate::textures::TextureContext;

const EVEN: Color = Color::new(1.0, 0.0, 0.0);
const ODD: Color = Color::new(0.0, 0.0, 1.0);

fn checker(inv_scale: f32) -> Checker {
    Checker { even: solid(EVEN), odd: solid(ODD), inv_scale, _pad: [0; 3] }
}

#[test]
fn cubes_alternate_on_both_sides_of_zero() {
    let c = checker(1.0);
    for (p, color) in [
        (vec3(0.5, 0.5, 0.5), EVEN),
        (vec3(1.5, 0.5, 0.5), ODD),
        (vec3(-0.5, 0.5, 0.5), ODD),
        (vec3(-0.5, -0.5, 0.5), EVEN),
        (vec3(-0.5, -0.5, -0.5), ODD),
        (vec3(-1.5, 0.5, 0.5), EVEN),
        (vec3(0.0, 0.0, 0.0), EVEN),
        (vec3(-1e-20, 0.0, 0.0), ODD),
        (vec3(-1.0, 0.0, 0.0), ODD),
    ] {
        assert_eq!(c.pick(p).solid, color, "{p:?}");
    }
}

#[test]
fn the_pattern_is_that_of_floors() {
    let mut rng = Rng::new(1);
    for _ in 0..300_000 {
        let c = checker(rng.log_range(1e-2, 1e2) as f32);
        let size = rng.log_range(1e-3, 1e4);
        let p = rng.in_cube(size);
        let cells = p.to_array().map(|x| f64::from(x * c.inv_scale).floor() as i64);
        let even = cells.iter().sum::<i64>().rem_euclid(2) == 0;
        assert_eq!(c.pick(p).solid, if even { EVEN } else { ODD }, "{p:?}");
    }
    // Far beyond the range of i32 there is still a colour.
    let far = checker(1e6).pick(Vec3::splat(-1e12)).solid;
    assert!(far == EVEN || far == ODD);
}

#[test]
fn checkers_nest() {
    let mut scene = TestScene::default();
    let inner = Color::new(0.0, 1.0, 0.0);
    let input = |index| ColorInput {
        solid: Color::BLACK,
        texture: TextureRef::new(TextureKind::Checker, index),
    };
    scene.checkers.push(Checker { even: solid(inner), ..checker(4.0) });
    scene.checkers.push(Checker { even: input(0), ..checker(1.0) });
    let view = scene.view();
    let at = |x: f32| input(1).evaluate(&view, &TextureContext::in_space(vec3(x, 0.01, 0.01)));
    assert_eq!(at(0.1), inner);
    assert_eq!(at(0.3), ODD, "the inner checker is odd there");
    assert_eq!(at(1.1), ODD);
    assert_eq!(at(1.3), ODD);
    assert_eq!(at(2.1), inner);
    assert_eq!(at(-0.1), ODD);
    assert_eq!(at(-1.1), ODD, "the inner checker is odd there");
    assert_eq!(at(-1.3), inner);
    assert_eq!(solid(EVEN).evaluate(&view, &TextureContext::in_space(Vec3::ZERO)), EVEN);
}
