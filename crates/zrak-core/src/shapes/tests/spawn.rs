//! Rays that leave a surface do not meet it again by rounding: at scales from 1e-3 to 1e5, near the
//! origin and far from it, in every direction.

use super::super::{Convex, Shape, Sphere, surface_interaction};
use super::boxes::{box3, random_box};
use super::instance::{affine, inverse, random_map};
use super::quad::random_quad;
use super::sphere::sphere;
use super::triangle::random_triangle;
use crate::interaction::SurfaceInteraction;
use crate::math::Vec3;
use crate::ray::Ray;
use crate::scene::PrimKind;
use crate::testing::{
    D3, Rng, TestScene, add, cross, dot, double, hit_of, prim, scaled, single, sub, unit,
};

/// Direction to the side of `n` that `side` says, often almost along the surface.
pub(super) fn leaving(rng: &mut Rng, n: Vec3, side: f64) -> Vec3 {
    let n = scaled(double(n), side);
    loop {
        let w = match rng.below(4) {
            0 => n,
            1 | 2 => double(rng.direction()),
            // Grazing.
            _ => {
                let along = unit(cross(n, double(rng.direction())));
                unit(add(along, scaled(n, rng.log_range(1e-7, 0.1))))
            }
        };
        let w = single(w);
        // The sign that the renderer sees.
        if crate::math::dot(w, single(n)) > 0.0 {
            return w;
        }
    }
}

/// A ray towards a random point of a shape of this size, from nearby or from far.
fn ray_at(rng: &mut Rng, aim: D3, size: f64) -> Ray {
    let d = double(rng.direction());
    let back = rng.log_range(0.5, 1e3) * size;
    Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 }
}

/// A sphere from 1e-3 to 1e5, up to a thousand radii from the origin, and a point that a ray hits; none
/// if the ray misses.
fn point_on_a_sphere(rng: &mut Rng) -> Option<(Sphere, SurfaceInteraction)> {
    let radius = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { radius * rng.log_range(0.1, 1e3) };
    let s = sphere(rng.in_cube(away), radius as f32);
    let aim = add(double(s.center), double(rng.in_cube(radius)));
    let ray = ray_at(rng, aim, radius);
    let t = s.intersect(&ray)?;
    Some((s, s.interaction(&ray, t)))
}

#[test]
fn outside_of_a_sphere() {
    let mut rng = Rng::new(1);
    let mut n_cases = 0;
    while n_cases < 300_000 {
        let Some((s, i)) = point_on_a_sphere(&mut rng) else { continue };
        n_cases += 1;
        let out = i.spawn(leaving(&mut rng, i.n, 1.0), 0.0);
        assert_eq!(s.intersect(&out), None, "{s:?} {i:?} {out:?}");
        assert_eq!(s.interval(&out), None);
    }
}

#[test]
fn inside_of_a_sphere() {
    let mut rng = Rng::new(2);
    let mut n_cases = 0;
    while n_cases < 300_000 {
        let Some((s, i)) = point_on_a_sphere(&mut rng) else { continue };
        n_cases += 1;
        let into = i.spawn(leaving(&mut rng, i.n, -1.0), 0.0);
        // The other end of the chord, never this one.
        let chord = -2.0 * f64::from(s.radius) * dot(double(into.d), double(i.n));
        let t = s.intersect(&into);
        assert!(t.is_some(), "lost inside: {s:?} {i:?} {into:?}");
        let t = f64::from(t.unwrap());
        assert!(t >= 0.9 * chord, "{t:e} of {chord:e}: {s:?} {i:?} {into:?}");
    }
}

#[test]
fn both_sides_of_a_box() {
    let mut rng = Rng::new(3);
    let mut n_cases = 0;
    while n_cases < 300_000 {
        let b = if rng.chance(0.1) {
            // With faces through the origin, where coordinates have no error.
            box3(Vec3::splat(-1.0), Vec3::ZERO)
        } else {
            random_box(&mut rng)
        };
        let size = f64::from((b.hi - b.lo).max_component());
        let (lo, hi) = (double(b.lo), double(b.hi));
        let aim: D3 = std::array::from_fn(|i| lo[i] + (hi[i] - lo[i]) * rng.range(0.0, 1.0));
        let ray = ray_at(&mut rng, aim, size);
        let Some(t) = b.intersect(&ray) else { continue };
        let i = b.interaction(&ray, t);
        n_cases += 1;
        let out = i.spawn(leaving(&mut rng, i.n, 1.0), 0.0);
        assert_eq!(b.intersect(&out), None, "{b:?} {i:?} {out:?}");
        assert_eq!(b.interval(&out), None);
        let into = i.spawn(leaving(&mut rng, i.n, -1.0), 0.0);
        // Straight through, it meets another face: the point there differs.
        if let Some(t) = b.intersect(&into) {
            let there = b.interaction(&into, t);
            assert_ne!(there.n, i.n, "{b:?} {i:?} {into:?}");
        } else {
            // Only at an edge.
            let on_edge = (0..3)
                .filter(|&a| {
                    let (p, e) = (double(i.p)[a], 4.0 * double(i.p_error)[a] + 1e-30);
                    (p - lo[a]).abs() <= e || (p - hi[a]).abs() <= e
                })
                .count();
            assert!(on_edge >= 2, "{b:?} {i:?} {into:?}");
        }
    }
}

/// Asserts that a ray spawned to either side of a flat shape does not hit it.
fn check_flat(rng: &mut Rng, shape: &impl Shape, i: &SurfaceInteraction) {
    for side in [1.0, -1.0] {
        let away = i.spawn(leaving(rng, i.n, side), 0.0);
        assert_eq!(shape.intersect(&away), None, "{i:?} {away:?}");
    }
}

#[test]
fn both_sides_of_a_quad() {
    let mut rng = Rng::new(4);
    let mut n_cases = 0;
    while n_cases < 200_000 {
        let q = random_quad(&mut rng);
        let aim = add(
            double(q.corner),
            add(scaled(double(q.u), rng.unit()), scaled(double(q.v), rng.unit())),
        );
        let size = f64::from(q.u.length() + q.v.length());
        let ray = ray_at(&mut rng, aim, size);
        let Some(t) = q.intersect(&ray) else { continue };
        n_cases += 1;
        check_flat(&mut rng, &q, &q.interaction(&ray, t));
    }
}

#[test]
fn both_sides_of_a_triangle() {
    let mut rng = Rng::new(5);
    let mut n_cases = 0;
    while n_cases < 200_000 {
        let tri = random_triangle(&mut rng);
        let [a, b, c] = tri.vertices.map(double);
        let (u, v) = (rng.unit(), rng.unit());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let aim = add(a, add(scaled(sub(b, a), u), scaled(sub(c, a), v)));
        let size = crate::testing::length(sub(b, a)) + crate::testing::length(sub(c, a));
        let ray = ray_at(&mut rng, aim, size);
        let Some(t) = tri.intersect(&ray) else { continue };
        n_cases += 1;
        check_flat(&mut rng, &tri, &tri.interaction(&ray, t));
    }
}

#[test]
fn both_sides_of_an_instance() {
    let mut rng = Rng::new(6);
    let mut n_cases = 0;
    while n_cases < 200_000 {
        let mut scene = TestScene::default();
        let size = rng.log_range(1e-3, 1e5);
        let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 300.0) };
        let map = random_map(&mut rng, size, away);
        let is_sphere = rng.chance(0.5);
        let target = if is_sphere {
            scene.spheres.push(sphere(Vec3::ZERO, 1.0));
            prim(PrimKind::Sphere, 0)
        } else {
            scene.boxes.push(box3(Vec3::splat(-1.0), Vec3::splat(1.0)));
            prim(PrimKind::Box, 0)
        };
        let handle = scene.place(target, affine(map), affine(inverse(&map)));
        let view = scene.view();
        let hit = |ray: &Ray| hit_of(&view, handle, ray);
        let aim = super::instance::apply(&map, double(rng.in_cube(1.0)), 1.0);
        let ray = ray_at(&mut rng, aim, size);
        let Some(first) = hit(&ray) else { continue };
        let i = surface_interaction(&view, &first, &ray);
        n_cases += 1;
        let out = i.spawn(leaving(&mut rng, i.n, 1.0), 0.0);
        assert_eq!(hit(&out), None, "{map:?} {i:?} {out:?}");
        let w = leaving(&mut rng, i.n, -1.0);
        let cos = -dot(double(w), double(i.n));
        let into = i.spawn(w, 0.0);
        match hit(&into) {
            Some(second) => {
                let t = second.t;
                if !is_sphere {
                    let there = surface_interaction(&view, &second, &into);
                    assert!(dot(double(there.n), double(i.n)) < 0.9999, "{map:?} {i:?} {into:?}");
                } else if cos > 0.01 {
                    // The shortest chord of the flattest ellipsoid is long.
                    assert!(f64::from(t) > 1e-3 * cos * size, "{t} {cos} {size}");
                }
            }
            None => assert!(!is_sphere, "lost inside: {map:?} {i:?} {into:?}"),
        }
    }
}
