//! Triangles against plane and barycentric coordinates in `f64`.

use super::super::{Shape, Triangle};
use super::{check_interaction, reach};
use crate::math::{Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::testing::{
    ANY_MATERIAL, D3, Rng, add, cross, dot, double, length, scaled, single, sub, unit,
};

pub(super) fn triangle(vertices: [Vec3; 3]) -> Triangle {
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    Triangle { vertices, uv, material: ANY_MATERIAL }
}

pub(super) fn random_triangle(rng: &mut Rng) -> Triangle {
    let size = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 1e3) };
    let corner = double(rng.in_cube(away));
    loop {
        let a = scaled(double(rng.direction()), size);
        let b = scaled(double(rng.direction()), size * rng.log_range(0.03, 1.0));
        if length(cross(a, b)) > 0.1 * length(a) * length(b) {
            return triangle([corner, add(corner, a), add(corner, b)].map(single));
        }
    }
}

#[test]
fn hits_are_where_the_plane_is_crossed() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses) = (0, 0);
    for _ in 0..400_000 {
        let tri = random_triangle(&mut rng);
        let [v0, v1, v2] = tri.vertices.map(double);
        let (e1, e2) = (sub(v1, v0), sub(v2, v0));
        let normal = cross(e1, e2);
        let n = unit(normal);
        let size = length(e1) + length(e2);
        let aim = add(v0, add(scaled(e1, rng.range(-0.2, 1.0)), scaled(e2, rng.range(-0.2, 1.0))));
        let d = double(rng.direction());
        let back = rng.log_range(1e-2, 1e2) * size;
        let ray = Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 };
        let (o, d) = (double(ray.o), double(ray.d));
        if dot(n, d).abs() < 1e-6 {
            continue;
        }
        let t = dot(n, sub(v0, o)) / dot(n, d);
        let at: D3 = sub(add(o, scaled(d, t)), v0);
        let b1 = dot(cross(at, e2), normal) / dot(normal, normal);
        let b2 = dot(cross(e1, at), normal) / dot(normal, normal);
        let smallest = b1.min(b2).min(1.0 - b1 - b2);
        let error = 1e-5 * (length(o) + length(v0) + back + size) / dot(n, d).abs();
        let height = length(normal) / length(e1).max(length(e2)).max(length(sub(e1, e2)));
        let margin = error / height;
        match tri.intersect(&ray) {
            Some(hit) => {
                n_hits += 1;
                assert!(hit > 0.0);
                assert!((f64::from(hit) - t).abs() < error, "{hit} {t} {error:e}");
                assert!(smallest > -margin, "{smallest} {margin:e}");
                let slab = tri.bounds([0.0; 2]).slab(ray.o, ray.d.map(reciprocal_or_huge));
                assert!(slab.is_some(), "{tri:?} {ray:?}");
                let i = tri.interaction(&ray, hit);
                check_interaction(&i);
                let off = dot(n, sub(double(i.p), v0)).abs();
                assert!(off <= reach(i.p_error, n), "{off:e} {:?}", i.p_error);
                assert!(dot(double(i.n), n) > 1.0 - 1e-5, "counter-clockwise seen from outside");
                // These texture coordinates are two of the barycentric ones.
                let [u, v] = i.uv.map(f64::from);
                assert!((u - b1).abs() < margin + 4e-6 && (v - b2).abs() < margin + 4e-6);
                assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 + 1e-6);
            }
            None => {
                n_misses += 1;
                assert!(smallest < margin || t < error, "{smallest}, {t}, {error:e}");
            }
        }
    }
    assert!(n_hits > 70_000 && n_misses > 70_000, "{n_hits} {n_misses}");
}

#[test]
fn degenerate_triangles_are_never_hit_with_nonsense() {
    let mut rng = Rng::new(2);
    for _ in 0..100_000 {
        let a = rng.in_cube(1.0);
        let b = rng.in_cube(1.0);
        let needle = triangle([a, b, if rng.chance(0.5) { a } else { (a + b) * 0.5 }]);
        let ray = Ray { o: rng.in_cube(2.0), d: rng.direction(), time: 0.0 };
        if let Some(t) = needle.intersect(&ray) {
            assert!(t > 0.0 && t.is_finite());
        }
    }
}
