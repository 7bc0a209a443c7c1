//! Perlin's noise and the patterns made of it.

use super::super::{Noise, PATTERN_MARBLE, PATTERN_NOISE, PATTERN_TURBULENCE, perlin, turbulence};
use crate::math::{Color, Vec3, pcg3d, vec3};
use crate::testing::{D3, Rng, add, dot, double, length, scaled, single};

/// The same noise in `f64`: gradients from the hash, quadratic and cubic by their formulas.
fn exact(p: D3, seed: u32) -> f64 {
    let cell = p.map(f64::floor);
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let offset = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
        let lattice = add(cell, offset);
        let [x, y, z] = lattice.map(|c| c as i64 as u32);
        let h = pcg3d([x ^ seed, y.wrapping_add(seed), z]);
        let g = h.map(|bits| f64::from(bits >> 8) - 8_388_608.0 + 0.5);
        let g = scaled(g, 1.0 / length(g));
        let to_p: D3 = std::array::from_fn(|i| p[i] - lattice[i]);
        let weight: f64 = to_p
            .iter()
            .map(|t| {
                let t = 1.0 - t.abs();
                t * t * (3.0 - 2.0 * t)
            })
            .product();
        sum += weight * dot(g, to_p);
    }
    sum
}

#[test]
fn noise_is_its_formula() {
    let mut rng = Rng::new(1);
    for _ in 0..200_000 {
        let size = rng.log_range(0.1, 1e3);
        let p = rng.in_cube(size);
        let seed = rng.below(4);
        let (ours, exact) = (f64::from(perlin(p, seed)), exact(double(p), seed));
        assert!((ours - exact).abs() < 1e-6, "{ours} {exact} at {p:?}");
        assert!(ours.abs() < 1.0);
    }
}

#[test]
fn noise_is_zero_at_lattice_points_and_bounded_everywhere() {
    let mut rng = Rng::new(2);
    for _ in 0..100_000 {
        let p = vec3(
            rng.below(2000) as f32 - 1000.0,
            rng.below(2000) as f32 - 1000.0,
            rng.below(2000) as f32 - 1000.0,
        );
        assert_eq!(perlin(p, 7), 0.0, "{p:?}");
    }
    // However far away.
    for _ in 0..300_000 {
        let size = rng.log_range(1.0, 1e24);
        let p = rng.in_cube(size);
        let x = perlin(p, 0);
        assert!(x.abs() < 1.0, "{x} at {p:?}");
    }
}

#[test]
fn noise_and_its_slope_are_continuous_across_cells() {
    let mut rng = Rng::new(3);
    let h = 1e-4;
    for _ in 0..50_000 {
        // A point on the border of a cell, and the slope across it on either side.
        let mut p: D3 = std::array::from_fn(|_| rng.range(-4.0, 4.0));
        let axis = rng.below(3) as usize;
        p[axis] = f64::from(rng.below(8)) - 4.0;
        let at = |offset: f64| {
            let mut q = p;
            q[axis] += offset;
            exact(q, 3)
        };
        assert!((at(1e-9) - at(-1e-9)).abs() < 1e-8);
        let right = (at(2.0 * h) - at(h)) / h;
        let left = (at(-h) - at(-2.0 * h)) / h;
        // The second derivative is bounded, and the slopes are taken 3 h apart.
        assert!((right - left).abs() < 20.0 * 3.0 * h, "{left} {right}");
        // And the single-precision one follows.
        for offset in [-1e-3, -1e-6, 0.0, 1e-6, 1e-3] {
            let mut q = p;
            q[axis] += offset;
            let q = single(q);
            assert!((f64::from(perlin(q, 3)) - exact(double(q), 3)).abs() < 1e-6);
        }
    }
}

#[test]
fn seeds_and_octaves_differ() {
    let mut rng = Rng::new(4);
    let mut n_equal = 0;
    let (mut mean, mut square) = (0.0, 0.0);
    let n = 100_000;
    for _ in 0..n {
        let p = rng.in_cube(100.0);
        n_equal += u32::from((perlin(p, 0) - perlin(p, 1)).abs() < 1e-6);
        mean += f64::from(perlin(p, 0));
        square += f64::from(perlin(p, 0)).powi(2);
    }
    assert!(n_equal < 20);
    // Without bias, and neither flat nor wild.
    assert!((mean / f64::from(n)).abs() < 0.005);
    let deviation = (square / f64::from(n)).sqrt();
    assert!((0.15..0.3).contains(&deviation), "{deviation}");
}

fn exact_turbulence(p: D3, octaves: u32, seed: u32) -> f64 {
    (0..octaves)
        .map(|i| exact(scaled(p, 2.0_f64.powi(i as i32)), seed) / 2.0_f64.powi(i as i32))
        .sum::<f64>()
        .abs()
}

fn noise(pattern: u32, scale: f32) -> Noise {
    Noise {
        low: Color::BLACK,
        scale,
        high: Color::WHITE,
        pattern,
        octaves: 7,
        seed: 5,
        _pad: [0; 2],
    }
}

#[test]
fn patterns_are_their_formulas() {
    let mut rng = Rng::new(5);
    for _ in 0..50_000 {
        let p = rng.in_cube(8.0);
        let octaves = rng.below(7) + 1;
        let sum = f64::from(turbulence(p, octaves, 9));
        assert!((sum - exact_turbulence(double(p), octaves, 9)).abs() < 4e-6);
        let scale = rng.log_range(0.5, 4.0) as f32;
        // The scaled point is rounded before anything else.
        let q = double(p * scale);
        for (pattern, expected) in [
            (PATTERN_NOISE, 0.5 * (1.0 + exact(q, 5))),
            (PATTERN_TURBULENCE, exact_turbulence(q, 7, 5)),
            (
                PATTERN_MARBLE,
                0.5 * (1.0
                    + (f64::from(scale) * f64::from(p.z)
                        + 10.0 * exact_turbulence(double(p), 7, 5))
                    .sin()),
            ),
        ] {
            let color = noise(pattern, scale).evaluate(p);
            assert!(
                (f64::from(color.r) - expected).abs() < 3e-5,
                "{pattern}: {color:?} {expected}"
            );
            assert!(color.r == color.g && color.g == color.b);
        }
    }
}

#[test]
fn patterns_blend_two_colours() {
    let mut rng = Rng::new(6);
    let (low, high) = (Color::new(0.1, 0.5, 1.0), Color::new(0.9, 0.5, 0.0));
    for _ in 0..10_000 {
        let p = rng.in_cube(10.0);
        let t = noise(PATTERN_MARBLE, 4.0).evaluate(p).r;
        let blend = Noise { low, high, ..noise(PATTERN_MARBLE, 4.0) }.evaluate(p);
        assert_eq!(blend, Color::lerp(t, low, high));
    }
}

/// Colours stay colours at any place that a scene may have, at any scale.
#[test]
fn patterns_are_bounded_everywhere() {
    let mut rng = Rng::new(7);
    for _ in 0..200_000 {
        let size = rng.log_range(1.0, 1e12);
        let p: Vec3 = rng.in_cube(size);
        let scale = rng.log_range(1e-3, 1e12) as f32;
        for pattern in [PATTERN_NOISE, PATTERN_TURBULENCE, PATTERN_MARBLE] {
            let noise = Noise { octaves: 16, ..noise(pattern, scale) };
            let x = noise.evaluate(p).r;
            assert!((-1e-6..2.0).contains(&x), "{x}: pattern {pattern}, {p:?}, scale {scale}");
        }
    }
}
