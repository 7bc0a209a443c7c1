//! Lights against closed forms.

use super::{FALLOFF_SMOOTHSTEP, FALLOFF_SQUARE, LIGHT_DISTANT, LIGHT_POINT, LIGHT_SPOT, Light};
use crate::math::{Color, Vec3, vec3};
use crate::testing::{Rng, dot, double, length, scaled, sub};

fn light(kind: u32) -> Light {
    Light {
        position: vec3(1.0, 2.0, 3.0),
        kind,
        direction: vec3(0.0, -1.0, 0.0),
        cos_start: 0.9,
        intensity: Color::new(1.0, 2.0, 4.0),
        cos_rim: 0.5,
        falloff: FALLOFF_SMOOTHSTEP,
        _pad: [0; 3],
    }
}

#[test]
fn intensity_falls_with_the_square_of_the_distance() {
    let mut rng = Rng::new(1);
    for _ in 0..1000 {
        let p = rng.in_cube(10.0);
        let sample = light(LIGHT_POINT).sample(p);
        let to_light = sub([1.0, 2.0, 3.0], double(p));
        let d = length(to_light);
        assert!((f64::from(sample.distance) / d - 1.0).abs() < 1e-6);
        assert!((f64::from(sample.irradiance.g) * d * d / 2.0 - 1.0).abs() < 1e-6);
        let wi = scaled(to_light, 1.0 / d);
        assert!(length(sub(double(sample.wi), wi)) < 1e-6);
    }
}

#[test]
fn spots_fall_off_between_their_angles() {
    let mut rng = Rng::new(2);
    for falloff in [FALLOFF_SMOOTHSTEP, FALLOFF_SQUARE] {
        let spot = Light { falloff, ..light(LIGHT_SPOT) };
        let mut seen = [0; 3];
        for _ in 0..10_000 {
            let p = rng.in_cube(10.0);
            let from_light = sub(double(p), [1.0, 2.0, 3.0]);
            let d = length(from_light);
            let cos = dot(from_light, [0.0, -1.0, 0.0]) / d;
            let x = (cos - 0.5) / (0.9 - 0.5);
            let share = match x {
                x if x <= 0.0 => 0.0,
                x if x >= 1.0 => 1.0,
                x if falloff == FALLOFF_SQUARE => x * x,
                x => x * x * (3.0 - 2.0 * x),
            };
            seen[usize::from(share > 0.0) + usize::from(share == 1.0)] += 1;
            let got = f64::from(spot.sample(p).irradiance.b) * d * d / 4.0;
            assert!((got - share).abs() < 1e-5, "{got} {share}");
        }
        assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
    }
}

#[test]
fn distant_light_is_the_same_everywhere() {
    let sun = light(LIGHT_DISTANT);
    for p in [Vec3::ZERO, vec3(1e6, -5.0, 3.0)] {
        let sample = sun.sample(p);
        assert_eq!(sample.wi, vec3(0.0, 1.0, 0.0));
        assert_eq!(sample.distance, f32::INFINITY);
        assert_eq!(sample.irradiance, sun.intensity);
    }
}
