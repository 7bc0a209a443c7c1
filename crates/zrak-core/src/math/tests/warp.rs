//! Warps against their densities.

use crate::math::{
    equal_area_sphere_to_square, equal_area_square_to_sphere, square_to_uniform_disk,
    square_to_uniform_sphere, vec3,
};
use crate::testing::{ChiSquared, Rng, double, length};

const N: u32 = 2_000_000;

/// Bin of an angle, of `n` around the circle.
fn sector(y: f64, x: f64, n: usize) -> usize {
    let turns = y.atan2(x) / std::f64::consts::TAU + 0.5;
    ((turns * n as f64) as usize).min(n - 1)
}

#[test]
fn sphere_is_uniform() {
    let mut rng = Rng::new(1);
    let (n_z, n_phi) = (40, 40);
    let mut counts = vec![0_u64; n_z * n_phi];
    for _ in 0..N {
        let v = square_to_uniform_sphere(rng.unit_f32(), rng.unit_f32());
        let d = double(v);
        assert!((length(d) - 1.0).abs() < 5e-7, "{}", length(d));
        // Equal areas: z and the angle around it are uniform.
        let band = (((d[2] + 1.0) * 0.5 * n_z as f64) as usize).min(n_z - 1);
        counts[band * n_phi + sector(d[1], d[0], n_phi)] += 1;
    }
    ChiSquared { n_tests: 2 }.check_uniform("sphere", &counts);
}

#[test]
fn disk_is_uniform() {
    let mut rng = Rng::new(2);
    let (n_r, n_phi) = (40, 40);
    let mut counts = vec![0_u64; n_r * n_phi];
    for _ in 0..N {
        let (x, y) = square_to_uniform_disk(rng.unit_f32(), rng.unit_f32());
        let (x, y) = (f64::from(x), f64::from(y));
        let r2 = x * x + y * y;
        assert!(r2 < 1.000_001);
        let ring = ((r2 * n_r as f64) as usize).min(n_r - 1);
        counts[ring * n_phi + sector(y, x, n_phi)] += 1;
    }
    ChiSquared { n_tests: 2 }.check_uniform("disk", &counts);
}

#[test]
fn corners_of_the_square_are_mapped_to_points() {
    let last = 1.0 - 2.0_f32.powi(-24);
    for u in [0.0, 0.5, last] {
        for v in [0.0, 0.25, 0.5, last] {
            let d = double(square_to_uniform_sphere(u, v));
            assert!((length(d) - 1.0).abs() < 5e-7);
            let (x, y) = square_to_uniform_disk(u, v);
            assert!(x * x + y * y <= 1.000_000_2);
        }
    }
    assert_eq!(square_to_uniform_sphere(0.0, 0.3).z, 1.0);
}

#[test]
fn the_equal_area_map_can_be_undone() {
    let mut rng = Rng::new(12);
    for _ in 0..100_000 {
        let (x, y) = (rng.range(0.0, 1.0) as f32, rng.range(0.0, 1.0) as f32);
        let (u, v) = equal_area_sphere_to_square(equal_area_square_to_sphere(x, y));
        assert!((u - x).abs() < 1e-3 && (v - y).abs() < 1e-3, "({x}, {y}) became ({u}, {v})");
    }
    // Away from where the square root has no slope.
    for (d, at) in [
        (vec3(0.0, 0.0, 1.0), (0.5, 0.5)),
        (vec3(1.0, 0.0, 0.0), (1.0, 0.5)),
        (vec3(0.0, 1.0, 0.0), (0.5, 1.0)),
        (vec3(-1.0, 0.0, 0.0), (0.0, 0.5)),
    ] {
        assert_eq!(equal_area_sphere_to_square(d), at);
    }
}
