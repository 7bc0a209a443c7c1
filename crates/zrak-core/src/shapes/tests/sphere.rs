//! Spheres, standing and moving, against the quadratic in `f64`.

use std::f64::consts::PI;

use super::super::{Convex, MovingSphere, NEEDS_UV, Shape, Sphere};
use super::{check_interaction, reach};
use crate::math::{Vec3, vec3};
use crate::ray::Ray;
use crate::testing::{
    ANY_MATERIAL, Rng, add, cross, dot, double, length, scaled, single, sub, unit,
};

pub(super) fn sphere(center: Vec3, radius: f32) -> Sphere {
    Sphere { center, radius, material: ANY_MATERIAL, flags: NEEDS_UV, _pad: [0; 2] }
}

/// Distances to both crossings of the line, by the quadratic in `f64`, with half of the difference.
struct Exact {
    middle: f64,
    half: f64,
    /// Distance of the line from the centre.
    distance: f64,
}

fn exact(s: &Sphere, ray: &Ray) -> Exact {
    let (oc, d) = (sub(double(s.center), double(ray.o)), double(ray.d));
    let a = dot(d, d);
    let middle = dot(oc, d) / a;
    let distance = length(sub(oc, scaled(d, middle)));
    let r = f64::from(s.radius);
    Exact { middle, half: ((r * r - distance * distance).max(0.0) / a).sqrt(), distance }
}

/// A random sphere and a ray that passes its centre at 0 to 1.2 radii, often almost at 1.
fn random(rng: &mut Rng) -> (Sphere, Ray) {
    let radius = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { radius * rng.log_range(0.1, 1e3) };
    let s = sphere(rng.in_cube(away), radius as f32);
    let d = rng.direction();
    let side = unit(cross(double(d), double(rng.direction())));
    let miss = match rng.below(3) {
        0 => rng.range(0.0, 1.2),
        1 => 1.0 - rng.log_range(1e-9, 0.1),
        _ => 1.0 + rng.log_range(1e-9, 0.1),
    };
    let back = match rng.below(3) {
        0 => rng.range(-1.5, 1.5),
        1 => rng.log_range(1.5, 1e4),
        _ => -rng.log_range(1.5, 1e4),
    };
    let offset = add(scaled(side, miss * radius), scaled(double(d), -back * radius));
    (s, Ray { o: single(add(double(s.center), offset)), d, time: 0.0 })
}

#[test]
fn crossings_are_those_of_the_quadratic() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses) = (0, 0);
    for _ in 0..400_000 {
        let (s, ray) = random(&mut rng);
        let r = f64::from(s.radius);
        let e = exact(&s, &ray);
        let oc = length(sub(double(s.center), double(ray.o)));
        // Error of the position relative to the centre: a few roundings of the largest number in play.
        let far = oc + r + length(double(s.center)) + length(double(ray.o));
        let error = 1e-6 * far;
        // An error across the ray moves the crossing by this much along it.
        let along = |half: f64| error + (2.0 * r * error / (half + (r * error).sqrt()));
        let is_ahead = |t: f64| t > along(e.half);
        let inside = oc < r - error;
        let outside = oc > r + error;
        match s.intersect(&ray) {
            Some(t) => {
                n_hits += 1;
                let t = f64::from(t);
                assert!(t > 0.0 || !outside, "{t}");
                assert!(e.distance < r + error, "hit at {} radii", e.distance / r);
                let nearest = (t - (e.middle - e.half)).abs().min((t - (e.middle + e.half)).abs());
                assert!(nearest < along(e.half), "{t}: off by {nearest:e}, r = {r}, far = {far}");
                if outside {
                    assert!((t - (e.middle - e.half)).abs() < along(e.half));
                }
                if inside {
                    assert!((t - (e.middle + e.half)).abs() < along(e.half));
                }
                // Rays pass the bounds of what they hit.
                let inv = ray.d.map(crate::math::reciprocal_or_huge);
                let slab = s.bounds([0.0; 2]).slab(ray.o, inv);
                assert!(slab.is_some(), "{s:?} {ray:?}");

                let i = s.interaction(&ray, t as f32);
                check_interaction(&i);
                let from_center = sub(double(i.p), double(s.center));
                let n = unit(from_center);
                let off = (length(from_center) - r).abs();
                assert!(off <= reach(i.p_error, n), "{off:e} off, {:?}", i.p_error);
                assert!(off <= 1e-6 * (r + length(double(s.center))));
                // The point may slide along the surface, by as much as the ray is uncertain.
                let on_ray = add(double(ray.o), scaled(double(ray.d), t));
                assert!(length(sub(double(i.p), on_ray)) < 2.0 * along(e.half));
            }
            None => {
                n_misses += 1;
                let misses = e.distance > r - error;
                let behind = outside && !is_ahead(e.middle - e.half);
                assert!(misses || behind || (!inside && !outside), "{s:?} {ray:?}");
            }
        }
    }
    assert!(n_hits > 100_000 && n_misses > 50_000, "{n_hits} hits, {n_misses} misses");
}

#[test]
fn intervals_are_what_lies_inside() {
    let mut rng = Rng::new(2);
    for _ in 0..200_000 {
        let (s, ray) = random(&mut rng);
        let e = exact(&s, &ray);
        let r = f64::from(s.radius);
        let far = length(sub(double(s.center), double(ray.o)))
            + r
            + length(double(s.center))
            + length(double(ray.o));
        let error = 1e-6 * far;
        let along = error + (2.0 * r * error / (e.half + (r * error).sqrt()));
        if let Some([start, end]) = s.interval(&ray) {
            let (start, end) = (f64::from(start), f64::from(end));
            assert!(start >= 0.0);
            assert!((start - (e.middle - e.half).max(0.0)).abs() < along);
            assert!((end - (e.middle + e.half)).abs() < along);
            let center = double(ray.o);
            let p = single(add(center, scaled(double(ray.d), rng.range(start, end.max(start)))));
            let p_error = rng.in_cube(1e-3 * r).abs();
            if s.surely_contains(p, p_error, 0.0) {
                let to_p = sub(double(p), double(s.center)).map(f64::abs);
                assert!(length(add(to_p, double(p_error))) < r);
            }
        }
    }
}

#[test]
fn grazing_and_tangent_rays_have_finite_hits() {
    let s = sphere(Vec3::ZERO, 1.0);
    for (y, hits) in [(0.999_999_9, true), (1.0, true), (1.000_001, false)] {
        let ray = Ray { o: vec3(-5.0, y, 0.0), d: vec3(1.0, 0.0, 0.0), time: 0.0 };
        let t = s.intersect(&ray);
        assert_eq!(t.is_some(), hits, "{y}");
        assert!(t.is_none_or(|t| (t - 5.0).abs() < 1e-3));
    }
    // From the centre, and from far away.
    let from_center = Ray { o: Vec3::ZERO, d: vec3(0.0, 0.0, 1.0), time: 0.0 };
    assert_eq!(s.intersect(&from_center), Some(1.0));
    let far = Ray { o: vec3(0.0, 0.0, -1e5), d: vec3(0.0, 0.0, 1.0), time: 0.0 };
    assert_eq!(s.intersect(&far), Some(99_999.0));
    assert_eq!(s.intersect(&Ray { d: vec3(0.0, 0.0, -1.0), ..far }), None);
}

#[test]
fn directions_need_not_be_of_unit_length() {
    let mut rng = Rng::new(3);
    for _ in 0..100_000 {
        let (s, ray) = random(&mut rng);
        // A power of two changes no bit but the exponent.
        let scale = 2.0_f32.powi(rng.below(21) as i32 - 10);
        let scaled = Ray { d: ray.d * scale, ..ray };
        assert_eq!(s.intersect(&scaled).map(|t| t * scale), s.intersect(&ray));
    }
}

#[test]
fn moving_spheres_are_spheres_that_stand_where_they_are() {
    let mut rng = Rng::new(4);
    for _ in 0..100_000 {
        let (still, ray) = random(&mut rng);
        let displacement = rng.in_cube(f64::from(still.radius) * 3.0);
        let moving = MovingSphere {
            center: still.center,
            radius: still.radius,
            displacement,
            material: ANY_MATERIAL,
            flags: NEEDS_UV,
            _pad: [0; 3],
        };
        let ray = Ray { time: rng.unit_f32(), ..ray };
        let at = moving.at(ray.time);
        let exact = add(double(still.center), scaled(double(displacement), f64::from(ray.time)));
        let size = length(exact) + length(double(displacement));
        assert!(length(sub(double(at.center), exact)) <= 2e-7 * size);
        let t = moving.intersect(&ray);
        assert_eq!(t, at.intersect(&ray));
        assert_eq!(moving.interval(&ray), at.interval(&ray));
        if let Some(t) = t {
            assert_eq!(moving.interaction(&ray, t), at.interaction(&ray, t));
            let inv = ray.d.map(crate::math::reciprocal_or_huge);
            assert!(moving.bounds([0.0, 1.0]).slab(ray.o, inv).is_some());
        }
        assert_eq!(moving.intersect(&Ray { time: 0.0, ..ray }), still.intersect(&ray));
        // The bounds hold the sphere at every moment of the shutter, and only then.
        let bounds = moving.bounds([0.25, 0.5]);
        for time in [0.25, 0.3, 0.5] {
            let at = moving.at(time);
            let r = Vec3::splat(at.radius);
            let (lo, hi) = (at.center - r, at.center + r);
            assert!(lo.zip(bounds.lo, |a, b| a - b).to_array().iter().all(|&d| d >= 0.0));
            assert!(bounds.hi.zip(hi, |a, b| a - b).to_array().iter().all(|&d| d >= 0.0));
        }
    }
}

#[test]
fn texture_coordinates_follow_the_book() {
    let s = sphere(vec3(1.0, 2.0, 3.0), 0.5);
    let at = |d: Vec3| {
        let ray = Ray { o: s.center + d * 2.0, d: -d, time: 0.0 };
        s.interaction(&ray, s.intersect(&ray).unwrap()).uv
    };
    let close = |a: [f32; 2], b: [f32; 2]| {
        assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{a:?} {b:?}");
    };
    // The table of The Next Week, section 4.4.
    close(at(vec3(1.0, 0.0, 0.0)), [0.5, 0.5]);
    close(at(vec3(0.0, 0.0, 1.0)), [0.25, 0.5]);
    close(at(vec3(0.0, 0.0, -1.0)), [0.75, 0.5]);
    assert_eq!(at(vec3(0.0, 1.0, 0.0))[1], 1.0);
    assert_eq!(at(vec3(0.0, -1.0, 0.0))[1], 0.0);
    // Both sides of the seam at -x.
    let tilt = 1e-3_f32;
    let just = |z: f32| at(single(unit([-1.0, 0.0, f64::from(z)])))[0];
    let turns = tilt / std::f32::consts::TAU;
    assert!((just(tilt) - turns).abs() < 1e-5 && (just(-tilt) - 1.0 + turns).abs() < 1e-5);

    let mut rng = Rng::new(5);
    for _ in 0..200_000 {
        let d = rng.direction();
        let [u, v] = at(d);
        assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v), "{u} {v} at {d:?}");
        // Near the poles u means little; compare arcs.
        let [x, y, z] = double(d);
        let phi = (-z).atan2(x) + PI;
        let theta = (-y).clamp(-1.0, 1.0).acos();
        let arc = (f64::from(u) * 2.0 * PI - phi).abs();
        let arc = arc.min(2.0 * PI - arc) * (x * x + z * z).sqrt();
        assert!(arc < 1e-5, "{arc:e} at {d:?}");
        assert!(
            (f64::from(v) * PI - theta).abs() < 1e-5 + 1e-3 * f64::from(u8::from(y.abs() > 0.999))
        );
    }
}

#[test]
fn grazing_rays_come_from_the_side_that_they_come_from() {
    let mut rng = Rng::new(77);
    let mut n_hits = 0;
    for i in 0..400_000 {
        let radius = [1.0, 1e-3, 100.0][i % 3];
        let center = vec3(0.0, -1.01 * radius, 0.3 * radius);
        let sphere = Sphere {
            center,
            radius,
            material: crate::scene::MaterialRef::default(),
            flags: 0,
            _pad: [0; 2],
        };
        // Along tangents, from afar or from next to the point that they touch, to within rounding.
        let n = crate::math::square_to_uniform_sphere(
            rng.range(0.0, 1.0) as f32,
            rng.range(0.0, 1.0) as f32,
        );
        let (s, t) = crate::media::tangents(n);
        let (x, y) =
            crate::math::square_to_uniform_disk(1.0 - f32::EPSILON, rng.range(0.0, 1.0) as f32);
        let d = (s * x + t * y).normalized();
        let touch = center + n * (radius * (1.0 + rng.range(-3e-7, 3e-7) as f32));
        let ray = Ray { o: touch - d * (radius * rng.range(0.001, 3.0) as f32), d, time: 0.0 };
        if let Some(t) = sphere.intersect(&ray) {
            n_hits += 1;
            let oc = center - ray.o;
            let is_outside = crate::math::dot(oc, oc) > radius * radius;
            let surface = sphere.interaction(&ray, t);
            assert_eq!(surface.is_front(d), is_outside, "{sphere:?} {ray:?}");
            assert!((surface.n.length() - 1.0).abs() < 1e-6);
        }
    }
    assert!(n_hits > 100_000, "{n_hits}");
}
