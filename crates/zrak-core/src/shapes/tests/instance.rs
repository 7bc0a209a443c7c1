//! Shapes under affine maps.

use super::super::{primitive_bounds, surface_interaction};
use super::boxes::box3;
use super::check_interaction;
use super::sphere::sphere;
use crate::math::{Affine, Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::scene::PrimKind;
use crate::testing::{
    D3, Rng, TestScene, add, cross, dot, double, hit_of, length, prim, scaled, single, sub, unit,
};

/// Rows of a 3x4 matrix.
pub(super) type Map = [[f64; 4]; 3];

pub(super) fn affine(m: Map) -> Affine {
    Affine { rows: m.map(|row| row.map(|x| x as f32)) }
}

pub(super) fn apply(m: &Map, p: D3, w: f64) -> D3 {
    m.map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3] * w)
}

pub(super) fn inverse(m: &Map) -> Map {
    let row = |i: usize| [m[i][0], m[i][1], m[i][2]];
    let (a, b, c) = (row(0), row(1), row(2));
    // Columns of the inverse.
    let det = dot(a, cross(b, c));
    let columns = [cross(b, c), cross(c, a), cross(a, b)].map(|v| scaled(v, 1.0 / det));
    let t = [m[0][3], m[1][3], m[2][3]];
    std::array::from_fn(|i| {
        let r: [f64; 3] = std::array::from_fn(|j| columns[j][i]);
        [r[0], r[1], r[2], -dot(r, t)]
    })
}

/// A turn with scales along the turned axes, maybe mirrored, and a shift.
pub(super) fn random_map(rng: &mut Rng, size: f64, away: f64) -> Map {
    let x = double(rng.direction());
    let y = unit(cross(x, double(rng.direction())));
    let z = cross(x, y);
    let mut scales: D3 = std::array::from_fn(|_| size * rng.log_range(0.2, 1.0));
    if rng.chance(0.3) {
        scales[0] = -scales[0];
    }
    // A second turn, so that the scales shear.
    let p = double(rng.direction());
    let q = unit(cross(p, double(rng.direction())));
    let axes = [p, q, cross(p, q)];
    let shift = double(rng.in_cube(away));
    std::array::from_fn(|i| {
        let entry = |j: usize| (0..3).map(|k| [x, y, z][k][i] * scales[k] * axes[k][j]).sum();
        [entry(0), entry(1), entry(2), shift[i]]
    })
}

#[test]
fn interactions_lie_on_the_mapped_surface() {
    let mut rng = Rng::new(1);
    let mut n_hits = 0;
    for round in 0..60_000 {
        let mut scene = TestScene::default();
        let size = rng.log_range(1e-3, 1e4);
        let away = size * rng.log_range(0.1, 100.0);
        let map = random_map(&mut rng, size, away);
        let back = inverse(&map);
        let is_sphere = round % 2 == 0;
        let target = if is_sphere {
            scene.spheres.push(sphere(Vec3::ZERO, 1.0));
            prim(PrimKind::Sphere, 0)
        } else {
            scene.boxes.push(box3(Vec3::splat(-1.0), Vec3::splat(1.0)));
            prim(PrimKind::Box, 0)
        };
        let handle = scene.place(target, affine(map), affine(back));
        let view = scene.view();
        let bounds = primitive_bounds(&view, handle, [0.0; 2]);
        for _ in 0..4 {
            let aim = apply(&map, double(rng.in_cube(1.2)), 1.0);
            let d = rng.direction();
            let far = rng.log_range(1.0, 100.0) * size;
            let ray = Ray { o: single(sub(aim, scaled(double(d), far))), d, time: 0.0 };
            let Some(hit) = hit_of(&view, handle, &ray) else { continue };
            n_hits += 1;
            assert!(bounds.slab(ray.o, ray.d.map(reciprocal_or_huge)).is_some());
            let i = surface_interaction(&view, &hit, &ray);
            check_interaction(&i);
            // The true normal, by the inverse transposed; and the true surface, in object space.
            let local = apply(&back, double(i.p), 1.0);
            let object_n = if is_sphere {
                unit(local)
            } else {
                let axis =
                    (0..3).max_by(|&a, &b| local[a].abs().total_cmp(&local[b].abs())).unwrap();
                let mut n = [0.0; 3];
                n[axis] = local[axis].signum();
                n
            };
            let n = unit(std::array::from_fn(|j| (0..3).map(|k| back[k][j] * object_n[k]).sum()));
            let height = if is_sphere { length(local) - 1.0 } else { dot(object_n, local) - 1.0 };
            // From object to world along the normal: divided by the length of the gradient.
            let gradient: D3 =
                std::array::from_fn(|j| (0..3).map(|k| back[k][j] * object_n[k]).sum());
            let off = (height / length(gradient)).abs();
            let reach = super::reach(i.p_error, n);
            assert!(off <= reach * 1.001, "{off:e} {reach:e}");
            let near_edge = !is_sphere && {
                let mut sorted = local.map(f64::abs);
                sorted.sort_by(f64::total_cmp);
                sorted[1] > 0.999
            };
            if !near_edge {
                assert!(dot(double(i.n), n) > 1.0 - 1e-4, "{:?} {n:?}", i.n);
            }
            // And near the ray.
            let on_ray = add(double(ray.o), scaled(double(ray.d), f64::from(hit.t)));
            let distance = length(sub(double(i.p), on_ray));
            assert!(
                distance < 2e-3 * size,
                "{distance:e}, size {size:e}, far {far:e}, away {away:e}"
            );
        }
    }
    assert!(n_hits > 100_000, "{n_hits}");
}

#[test]
fn the_identity_changes_no_hit() {
    let mut rng = Rng::new(2);
    let mut scene = TestScene::default();
    scene.spheres.push(sphere(Vec3::ZERO, 1.0));
    let bare = prim(PrimKind::Sphere, 0);
    let handle = scene.place(bare, Affine::IDENTITY, Affine::IDENTITY);
    let view = scene.view();
    for _ in 0..100_000 {
        let ray = Ray { o: rng.in_cube(2.0), d: rng.direction(), time: 0.0 };
        let t = |prim| hit_of(&view, prim, &ray).map(|hit| hit.t);
        assert_eq!(t(handle), t(bare));
    }
}
