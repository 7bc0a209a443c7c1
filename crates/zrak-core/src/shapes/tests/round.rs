//! Disks and cylinders against `f64`: where they are hit, and what is there.

use super::super::{Cylinder, Disk, Shape};
use super::{check_interaction, reach};
use crate::math::{Vec3, vec3};
use crate::ray::Ray;
use crate::testing::{
    ANY_MATERIAL, D3, Rng, add, cross, dot, double, length, scaled, single, sub, unit,
};

/// A disk under an affine map, as the host makes it.
fn disk(center: D3, u: D3, v: D3, inner: f64, phi_max: f64) -> Disk {
    let across = cross(u, v);
    let (area, n) = (length(across), unit(across));
    Disk {
        center: single(center),
        material: ANY_MATERIAL,
        normal: single(n),
        inner: inner as f32,
        x_axis: single(scaled(cross(v, n), 1.0 / area)),
        phi_max: phi_max as f32,
        y_axis: single(scaled(cross(n, u), 1.0 / area)),
        _pad0: 0,
        u: single(u),
        _pad1: 0,
        v: single(v),
        _pad2: 0,
    }
}

/// The angle from 0 to a turn.
fn angle(y: f64, x: f64) -> f64 {
    y.atan2(x).rem_euclid(std::f64::consts::TAU)
}

/// Coordinates and their derivatives, from what a shape says is at its points: `point_of` gives the
/// point at (u, v).
fn check_coordinates(
    shape: &impl Shape,
    ray: &Ray,
    t: f32,
    size: f64,
    point_of: impl Fn(f64, f64) -> D3,
) {
    let s = shape.interaction(ray, t);
    check_interaction(&s);
    let (u, v) = (f64::from(s.uv[0]), f64::from(s.uv[1]));
    assert!((-1e-5..=1.00001).contains(&u) && (-1e-5..=1.00001).contains(&v), "{s:?}");
    let off = length(sub(point_of(u, v), double(s.p)));
    assert!(off < 1e-5 * (size + length(double(s.p))), "{off}: {s:?}");
    const STEP: f64 = 1e-4;
    let du = scaled(sub(point_of(u + STEP, v), point_of(u - STEP, v)), 0.5 / STEP);
    let dv = scaled(sub(point_of(u, v + STEP), point_of(u, v - STEP)), 0.5 / STEP);
    for (got, exact) in [(s.dpdu, du), (s.dpdv, dv)] {
        let off = length(sub(double(got), exact));
        assert!(off < 2e-3 * length(exact) + 1e-4 * size, "{got:?} {exact:?}");
    }
    // Within its error of the surface.
    let far = reach(s.p_error, double(s.n));
    let off = dot(sub(double(s.p), point_of(u, v)), double(s.n)).abs();
    assert!(far > 0.0 && off < far + 1e-6 * size, "{off} {far}");
}

#[test]
fn disks_are_hit_where_they_are() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses) = (0, 0);
    for case in 0..60_000 {
        let size = rng.log_range(1e-2, 1e3);
        let away = size * rng.range(0.0, 10.0);
        let center = double(rng.in_cube(away));
        let u = scaled(double(rng.direction()), size);
        let v = scaled(double(rng.direction()), size * rng.range(0.3, 1.0));
        if length(cross(u, v)) < 0.2 * length(u) * length(v) {
            continue;
        }
        let inner = if case % 2 == 0 { 0.0 } else { rng.range(0.1, 0.8) };
        let phi_max = if case % 3 == 0 { rng.range(0.5, 6.0) } else { std::f64::consts::TAU };
        let shape = disk(center, u, v, inner, phi_max);
        let (x, y) = (rng.range(-1.3, 1.3), rng.range(-1.3, 1.3));
        let (r, phi) = (x.hypot(y), angle(y, x));
        let aim = add(center, add(scaled(u, x), scaled(v, y)));
        let d = double(rng.direction());
        if dot(d, unit(cross(u, v))).abs() < 0.05 {
            continue;
        }
        let away = size * rng.range(0.5, 20.0);
        let ray = Ray { o: single(sub(aim, scaled(d, away))), d: single(d), time: 0.0 };
        // How near to its rims what is hit is, as shares of its size.
        let rims = [(r - 1.0).abs(), if inner > 0.0 { (r - inner).abs() } else { 1.0 }];
        let sides = [phi, (phi - phi_max).abs(), std::f64::consts::TAU - phi].map(|a| a * r);
        let is_ring = phi_max > 6.1;
        let near = rims.into_iter().chain(if is_ring { [1.0; 3] } else { sides });
        if near.fold(1.0, f64::min) < 2e-3 {
            continue;
        }
        let is_on = r < 1.0 && r > inner && (is_ring || phi < phi_max);
        let hit = shape.intersect(&ray);
        assert_eq!(hit.is_some(), is_on, "{shape:?} {ray:?} {r} {phi}");
        match hit {
            None => n_misses += 1,
            Some(t) => {
                n_hits += 1;
                assert!((f64::from(t) - away).abs() < 2e-4 * (away + size + length(center)));
                if r < 0.02 || phi * r < 0.01 || (std::f64::consts::TAU - phi) * r < 0.01 {
                    continue;
                }
                check_coordinates(&shape, &ray, t, size, |s, t| {
                    let (phi, r) = (s * phi_max, 1.0 - t * (1.0 - inner));
                    let (sin, cos) = phi.sin_cos();
                    add(center, add(scaled(u, r * cos), scaled(v, r * sin)))
                });
                let back = Ray { d: -ray.d, ..ray };
                assert_eq!(shape.intersect(&back), None);
            }
        }
    }
    assert!(n_hits > 5000 && n_misses > 5000, "{n_hits} {n_misses}");
}

#[test]
fn cylinders_are_hit_where_they_are() {
    let mut rng = Rng::new(2);
    let (mut n_hits, mut n_second, mut n_misses) = (0, 0, 0);
    for case in 0..60_000 {
        let radius = rng.log_range(1e-2, 1e3);
        let (z_min, z_max) = (-radius * rng.range(0.2, 3.0), radius * rng.range(0.2, 3.0));
        let phi_max = if case % 2 == 0 { std::f64::consts::TAU } else { rng.range(0.5, 6.0) };
        let shape = Cylinder {
            radius: radius as f32,
            z_min: z_min as f32,
            z_max: z_max as f32,
            phi_max: phi_max as f32,
            material: ANY_MATERIAL,
            _pad: [0; 3],
        };
        let o = rng.in_cube(3.0 * radius);
        // At the middle of it, more or less.
        let aim = double(rng.in_cube(1.2 * radius));
        let ray = Ray { o, d: single(unit(sub(aim, double(o)))), time: 0.0 };
        let d = ray.d;
        let (o, d) = (double(o), double(d));
        let a = d[0] * d[0] + d[1] * d[1];
        let b = o[0] * d[0] + o[1] * d[1];
        let c = o[0] * o[0] + o[1] * o[1] - radius * radius;
        let discriminant = b * b - a * c;
        if discriminant.abs() < 1e-3 * a * radius * radius || c.abs() < 1e-3 * radius * radius {
            continue;
        }
        // Roots ahead that are on it; unsure ones spoil the case.
        let mut expected = None;
        let mut is_unsure = false;
        if discriminant > 0.0 {
            for sign in [-1.0, 1.0] {
                let t = (-b + sign * discriminant.sqrt()) / a;
                let p = add(o, scaled(d, t));
                let phi = angle(p[1], p[0]);
                let margins = [(p[2] - z_min).abs() / radius, (p[2] - z_max).abs() / radius];
                let sides = if phi_max > 6.1 {
                    [1.0; 3]
                } else {
                    [phi, (phi - phi_max).abs(), std::f64::consts::TAU - phi]
                };
                let near = margins.into_iter().chain(sides).fold(t.abs() / radius, f64::min);
                is_unsure |= near < 2e-3;
                let is_on =
                    t > 0.0 && (z_min..z_max).contains(&p[2]) && (phi_max > 6.1 || phi < phi_max);
                if is_on && expected.is_none() {
                    expected = Some((t, phi));
                    n_second += u32::from(sign > 0.0 && c > 0.0);
                }
            }
        }
        if is_unsure {
            continue;
        }
        let hit = shape.intersect(&ray);
        assert_eq!(hit.is_some(), expected.is_some(), "{shape:?} {ray:?} {expected:?}");
        let (Some(t), Some((exact, phi))) = (hit, expected) else {
            n_misses += 1;
            continue;
        };
        n_hits += 1;
        assert!((f64::from(t) - exact).abs() < 1e-3 * (exact + radius), "{t} {exact}");
        if !(0.01..std::f64::consts::TAU - 0.01).contains(&phi) {
            continue;
        }
        check_coordinates(&shape, &ray, t, radius, |s, t| {
            let (sin, cos) = (s * phi_max).sin_cos();
            [radius * cos, radius * sin, z_min + t * (z_max - z_min)]
        });
        let n: Vec3 = shape.interaction(&ray, t).n;
        let p = ray.at(t);
        assert!(n.z == 0.0 && dot(double(n), double(vec3(p.x, p.y, 0.0))) > 0.0);
    }
    assert!(n_hits > 5000 && n_second > 500 && n_misses > 5000, "{n_hits} {n_second} {n_misses}");
}
