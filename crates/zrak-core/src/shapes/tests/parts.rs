//! Parts of spheres, cylinders and disks against closed forms in `f64`.

use core::f64::consts::TAU;

use super::super::{Cylinder, Disk, PartialSphere, Shape};
use super::check_interaction;
use super::spawn::leaving;
use crate::interaction::SurfaceInteraction;
use crate::math::{Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::testing::{
    ANY_MATERIAL, D3, Rng, add, cross, dot, double, length, scaled, single, sub, unit,
};

/// A shape, and what is known about it by closed forms.
struct Case<S> {
    shape: S,
    size: f64,
    /// All parameters at which a line crosses the surface that the shape is a part of.
    crossings: fn(&S, D3, D3) -> Vec<f64>,
    /// Whether a point of the surface is in the part: how far inside of its limits, as a share of the
    /// size, below 0 outside.
    depth: fn(&S, D3) -> f64,
    /// (u, v) of a point.
    uv: fn(&S, D3) -> [f64; 2],
    /// The outward normal.
    normal: fn(&S, D3) -> D3,
    /// The point at (u, v).
    point: fn(&S, [f64; 2]) -> D3,
}

fn angle(p: D3) -> f64 {
    p[1].atan2(p[0]).rem_euclid(TAU)
}

/// How far an angle is inside of [0, `phi_max`], times the distance from the axis.
fn angular_depth(p: D3, phi_max: f32) -> f64 {
    if f64::from(phi_max) >= TAU - 1e-6 {
        return f64::INFINITY;
    }
    let arm = (p[0] * p[0] + p[1] * p[1]).sqrt();
    let phi = angle(p);
    let inside = phi.min(f64::from(phi_max) - phi);
    // Beyond the start, angles are almost a turn.
    inside.max(-(TAU - phi).min(phi - f64::from(phi_max)).abs()) * arm
}

fn roots(a: f64, half_b: f64, c: f64) -> Vec<f64> {
    let discriminant = half_b * half_b - a * c;
    if discriminant < 0.0 || a == 0.0 {
        return Vec::new();
    }
    let s = discriminant.sqrt();
    vec![(-half_b - s) / a, (-half_b + s) / a]
}

fn part_of_a_turn(rng: &mut Rng) -> f64 {
    if rng.chance(0.3) { TAU } else { rng.range(0.1, TAU) }
}

fn partial_sphere(rng: &mut Rng) -> Case<PartialSphere> {
    let r = rng.log_range(1e-3, 1e5);
    let mut z = [rng.range(-1.0, 1.0), rng.range(-1.0, 1.0)];
    z.sort_by(f64::total_cmp);
    let cut = [rng.chance(0.7), rng.chance(0.7)];
    let [low, high] = [if cut[0] { z[0] } else { -1.0 }, if cut[1] { z[1] } else { 1.0 }];
    let theta_low = low.acos();
    let shape = PartialSphere {
        radius: r as f32,
        z_min: if cut[0] { (low * r) as f32 } else { (-2.0 * r) as f32 },
        z_max: if cut[1] { (high * r) as f32 } else { (2.0 * r) as f32 },
        phi_max: part_of_a_turn(rng) as f32,
        theta_low: theta_low as f32,
        theta_span: (high.acos() - theta_low) as f32,
        material: ANY_MATERIAL,
        _pad: 0,
    };
    Case {
        shape,
        size: r,
        crossings: |s, o, d| {
            let r = f64::from(s.radius);
            roots(dot(d, d), dot(o, d), dot(o, o) - r * r)
        },
        depth: |s, p| {
            let z = (p[2] - f64::from(s.z_min)).min(f64::from(s.z_max) - p[2]);
            z.min(angular_depth(p, s.phi_max)) / f64::from(s.radius)
        },
        uv: |s, p| {
            let theta = (p[2] / f64::from(s.radius)).clamp(-1.0, 1.0).acos();
            let v = (theta - f64::from(s.theta_low)) / f64::from(s.theta_span);
            [angle(p) / f64::from(s.phi_max), v]
        },
        normal: |_, p| unit(p),
        point: |s, [u, v]| {
            let (phi, r) = (u * f64::from(s.phi_max), f64::from(s.radius));
            let theta = f64::from(s.theta_low) + v * f64::from(s.theta_span);
            [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()].map(|x| x * r)
        },
    }
}

fn cylinder(rng: &mut Rng) -> Case<Cylinder> {
    let r = rng.log_range(1e-3, 1e5);
    let z_min = r * rng.range(-3.0, 1.0);
    let shape = Cylinder {
        radius: r as f32,
        z_min: z_min as f32,
        z_max: (z_min + r * rng.range(0.1, 3.0)) as f32,
        phi_max: part_of_a_turn(rng) as f32,
        material: ANY_MATERIAL,
        _pad: [0; 3],
    };
    Case {
        shape,
        size: r,
        crossings: |s, o, d| {
            let r = f64::from(s.radius);
            let flat = |v: D3| [v[0], v[1], 0.0];
            let (o, d) = (flat(o), flat(d));
            roots(dot(d, d), dot(o, d), dot(o, o) - r * r)
        },
        depth: |s, p| {
            let z = (p[2] - f64::from(s.z_min)).min(f64::from(s.z_max) - p[2]);
            z.min(angular_depth(p, s.phi_max)) / f64::from(s.radius)
        },
        uv: |s, p| {
            let height = f64::from(s.z_max) - f64::from(s.z_min);
            [angle(p) / f64::from(s.phi_max), (p[2] - f64::from(s.z_min)) / height]
        },
        normal: |_, p| unit([p[0], p[1], 0.0]),
        point: |s, [u, v]| {
            let (phi, r) = (u * f64::from(s.phi_max), f64::from(s.radius));
            let height = f64::from(s.z_max) - f64::from(s.z_min);
            [r * phi.cos(), r * phi.sin(), f64::from(s.z_min) + v * height]
        },
    }
}

/// Disks of radius r at z = 0.
fn disk(rng: &mut Rng) -> Case<Disk> {
    let r = rng.log_range(1e-3, 1e5);
    let axis = |x: f64, y: f64| single([x, y, 0.0]);
    let shape = Disk {
        center: Vec3::ZERO,
        normal: single([0.0, 0.0, 1.0]),
        inner: if rng.chance(0.3) { 0.0 } else { rng.range(0.0, 0.9) as f32 },
        x_axis: axis(1.0 / r, 0.0),
        y_axis: axis(0.0, 1.0 / r),
        u: axis(r, 0.0),
        v: axis(0.0, r),
        phi_max: part_of_a_turn(rng) as f32,
        material: ANY_MATERIAL,
        ..bytemuck::Zeroable::zeroed()
    };
    Case {
        shape,
        size: r,
        crossings: |_, o, d| if d[2] == 0.0 { Vec::new() } else { vec![-o[2] / d[2]] },
        depth: |s, p| {
            let r = f64::from(s.u.x);
            let arm = length([p[0], p[1], 0.0]);
            let ring = (r - arm).min(if s.inner == 0.0 { r } else { arm - r * f64::from(s.inner) });
            ring.min(angular_depth(p, s.phi_max)) / r
        },
        uv: |s, p| {
            let arm = length([p[0], p[1], 0.0]) / f64::from(s.u.x);
            [angle(p) / f64::from(s.phi_max), (1.0 - arm) / (1.0 - f64::from(s.inner))]
        },
        normal: |_, _| [0.0, 0.0, 1.0],
        point: |s, [u, v]| {
            let phi = u * f64::from(s.phi_max);
            let arm = f64::from(s.u.x) * (1.0 - v * (1.0 - f64::from(s.inner)));
            [arm * phi.cos(), arm * phi.sin(), 0.0]
        },
    }
}

/// Hits, misses, texture coordinates, derivatives, errors, and rays that leave.
fn check<S: Shape + std::fmt::Debug>(seed: u64, make: fn(&mut Rng) -> Case<S>) {
    let mut rng = Rng::new(seed);
    let (mut n_hits, mut n_misses) = (0, 0);
    for _ in 0..200_000 {
        let Case { shape, size, crossings, depth, uv, normal, point } = make(&mut rng);
        let aim = double(rng.in_cube(1.3 * size));
        let d = double(rng.direction());
        let back = if rng.chance(0.3) { 0.2 } else { rng.log_range(0.5, 100.0) } * size;
        let ray = Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 };
        let (o, d) = (double(ray.o), double(ray.d));
        let at = |t: f64| add(o, scaled(d, t));
        let cos = |t: f64| dot(normal(&shape, at(t)), d).abs().max(1e-9);
        // What rounding moves a crossing by, as a parameter and along the surface.
        let error = |t: f64| 4e-6 * (length(o) + size) / cos(t);
        let real: Vec<f64> = crossings(&shape, o, d);
        if real.iter().any(|&t| cos(t) < 0.01 || t.abs() < 2.0 * error(t)) {
            continue;
        }
        let surely = |t: f64| depth(&shape, at(t)) > error(t) / size;
        let maybe = |t: f64| depth(&shape, at(t)) > -error(t) / size;
        match shape.intersect(&ray) {
            Some(t) => {
                n_hits += 1;
                let t64 = f64::from(t);
                let near = |r: &&f64| (**r - t64).abs() < error(**r);
                let Some(&t_real) = real.iter().find(near) else {
                    panic!("{t} is not among {real:?}: {shape:?} {ray:?}")
                };
                assert!(maybe(t_real), "outside: {shape:?} {ray:?}");
                let skipped = real.iter().any(|&r| r > 0.0 && r < t_real && surely(r));
                assert!(!skipped, "the nearer of {real:?} was missed: {shape:?} {ray:?}");
                let slab = shape.bounds([0.0; 2]).slab(ray.o, ray.d.map(reciprocal_or_huge));
                assert!(slab.is_some(), "{shape:?} {ray:?}");
                let i = shape.interaction(&ray, t);
                check_interaction(&i);
                let p = double(i.p);
                assert!(length(sub(p, at(t_real))) < 2.0 * error(t_real));
                let n = normal(&shape, p);
                assert!(dot(double(i.n), n) > 1.0 - 1e-6);
                let arm = length([p[0], p[1], 0.0]);
                if arm > 1e-3 * size && depth(&shape, p) > 1e-3 {
                    check_parameters(&shape, &i, size, arm, uv(&shape, p), point);
                }
                // What is left is exactly on the surface, so rays that leave it do not come back to it.
                for side in [1.0, -1.0] {
                    let away = i.spawn(leaving(&mut rng, i.n, side), 0.0);
                    if let Some(t) = shape.intersect(&away) {
                        // The other side of something round.
                        let there = add(double(away.o), scaled(double(away.d), f64::from(t)));
                        let sink = -dot(double(away.d), double(i.n));
                        assert!(side < 0.0 && sink > 0.0, "{shape:?} {i:?} {away:?}");
                        let chord = length(sub(there, p));
                        assert!(chord > sink * size, "{chord:e}: {shape:?} {i:?} {away:?}");
                    }
                }
            }
            None => {
                n_misses += 1;
                let missed = real.iter().any(|&r| r > 0.0 && surely(r));
                assert!(!missed, "{real:?}: {shape:?} {ray:?}");
            }
        }
    }
    assert!(n_hits > 20_000 && n_misses > 20_000, "{n_hits} {n_misses}");
}

/// Texture coordinates, and the derivatives of the point by them.
fn check_parameters<S: std::fmt::Debug>(
    shape: &S,
    i: &SurfaceInteraction,
    size: f64,
    arm: f64,
    [u, v]: [f64; 2],
    point: fn(&S, [f64; 2]) -> D3,
) {
    let error = 1e-4 * size / arm;
    assert!((f64::from(i.uv[0]) - u).abs() < error * 100.0, "u {u}: {shape:?} {i:?}");
    assert!((f64::from(i.uv[1]) - v).abs() < 1e-2, "v {v}: {shape:?} {i:?}");
    let h = 1e-5;
    for (k, d) in [i.dpdu, i.dpdv].into_iter().enumerate() {
        let mut ends = [[u, v]; 2];
        (ends[0][k], ends[1][k]) = (ends[0][k] - h, ends[1][k] + h);
        let [a, b] = ends.map(|uv| point(shape, uv));
        let exact = scaled(sub(b, a), 0.5 / h);
        let off = length(sub(exact, double(d)));
        assert!(off < 1e-3 * length(exact) + 1e-3 * size, "{k}: {exact:?} {shape:?} {i:?}");
    }
    // Outwards is u x v.
    assert!(dot(cross(double(i.dpdu), double(i.dpdv)), double(i.n)) > 0.0, "{shape:?}");
}

#[test]
fn parts_of_spheres_are_where_they_are() {
    check(1, partial_sphere);
}

#[test]
fn parts_of_cylinders_are_where_they_are() {
    check(2, cylinder);
}

#[test]
fn parts_of_disks_are_where_they_are() {
    check(3, disk);
}
