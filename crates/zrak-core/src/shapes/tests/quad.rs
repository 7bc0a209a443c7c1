//! Parallelograms against plane and coordinates in `f64`.

use super::super::{Quad, Shape};
use super::{check_interaction, reach};
use crate::math::reciprocal_or_huge;
use crate::ray::Ray;
use crate::testing::{D3, Rng, add, cross, dot, double, length, quad, scaled, single, sub, unit};

pub(super) fn random_quad(rng: &mut Rng) -> Quad {
    let size = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 1e3) };
    loop {
        let u = scaled(double(rng.direction()), size);
        let v = scaled(double(rng.direction()), size * rng.log_range(0.01, 1.0));
        if length(cross(u, v)) > 0.1 * length(u) * length(v) {
            return quad(rng.in_cube(away), single(u), single(v));
        }
    }
}

fn point(q: &Quad, alpha: f64, beta: f64) -> D3 {
    add(double(q.corner), add(scaled(double(q.u), alpha), scaled(double(q.v), beta)))
}

#[test]
fn hits_are_where_the_plane_is_crossed() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses) = (0, 0);
    for _ in 0..400_000 {
        let q = random_quad(&mut rng);
        let size = length(double(q.u)) + length(double(q.v));
        let (alpha, beta) = (rng.range(-0.3, 1.3), rng.range(-0.3, 1.3));
        let aim = point(&q, alpha, beta);
        let d = double(rng.direction());
        let n = unit(cross(double(q.u), double(q.v)));
        let cos = dot(d, n);
        let back = rng.log_range(1e-2, 1e2) * size;
        let ray = Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 };
        // Where it really crosses the plane.
        let (o, d) = (double(ray.o), double(ray.d));
        let t = dot(n, sub(double(q.corner), o)) / dot(n, d);
        let at = sub(add(o, scaled(d, t)), double(q.corner));
        let area = length(cross(double(q.u), double(q.v)));
        let alpha = dot(cross(double(q.v), n), at) / area;
        let beta = dot(cross(n, double(q.u)), at) / area;
        // Error of the crossing: roundings of coordinates, stretched by the slope.
        let error = 1e-6 * (length(o) + length(double(q.corner)) + back + size) / cos.abs();
        let height = area / length(double(q.u)).max(length(double(q.v)));
        let overlap = f64::from(q.alpha_overlap.max(q.beta_overlap));
        let margin = error / height + overlap + 1e-6;
        let inside = |m: f64| (m..=1.0 - m).contains(&alpha) && (m..=1.0 - m).contains(&beta);
        match q.intersect(&ray) {
            Some(hit) => {
                n_hits += 1;
                assert!(hit > 0.0);
                assert!((f64::from(hit) - t).abs() < error, "{hit} {t} {error:e}");
                assert!(inside(-margin), "{alpha} {beta} {margin:e}");
                let slab = q.bounds([0.0; 2]).slab(ray.o, ray.d.map(reciprocal_or_huge));
                assert!(slab.is_some(), "{q:?} {ray:?}");
                let i = q.interaction(&ray, hit);
                check_interaction(&i);
                let off = dot(n, sub(double(i.p), double(q.corner))).abs();
                assert!(off <= reach(i.p_error, n), "{off:e} {:?}", i.p_error);
                assert!(dot(double(i.n), n) > 1.0 - 1e-6, "the normal is u x v");
                let [a, b] = i.uv.map(f64::from);
                assert!((0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b));
                let moved = margin + 2.0 * overlap;
                assert!((a - alpha).abs() < moved && (b - beta).abs() < moved);
                assert!(
                    length(sub(double(i.p), point(&q, a, b)))
                        < 1e-6 * (size + length(double(q.corner)))
                );
            }
            None => {
                n_misses += 1;
                assert!(!inside(margin) || t <= error, "{alpha} {beta}, {t}");
            }
        }
    }
    assert!(n_hits > 100_000 && n_misses > 100_000, "{n_hits} {n_misses}");
}

#[test]
fn rays_in_the_plane_and_behind_miss() {
    let mut rng = Rng::new(2);
    let q = quad(single([0.0; 3]), single([1.0, 0.0, 0.0]), single([0.0, 1.0, 0.0]));
    for _ in 0..10_000 {
        let d = unit([rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), 0.0]);
        let o = single([rng.range(-1.0, 2.0), rng.range(-1.0, 2.0), 0.0]);
        assert_eq!(q.intersect(&Ray { o, d: single(d), time: 0.0 }), None);
        let above = single([0.5, 0.5, rng.log_range(1e-6, 1e6)]);
        let up = single(unit([rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), rng.range(0.01, 1.0)]));
        assert_eq!(q.intersect(&Ray { o: above, d: up, time: 0.0 }), None);
    }
}
