//! Closed surfaces have no holes: rays at edges, at corners and everywhere else never slip through,
//! from inside or outside.

use super::super::{Triangle, primitive_bounds};
use super::triangle::triangle;
use crate::accel::{Accel, BruteForce};
use crate::accessor::Array;
use crate::math::{Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::PrimKind;
use crate::shapes::intersect_primitive;
use crate::testing::{
    D3, Rng, TestScene, add, cross, double, prim, quad, ray_to, scaled, single, sub, unit,
};

/// Corners, and triangles by three of them.
type Mesh = (Vec<D3>, Vec<[usize; 3]>);

fn tetrahedron() -> Mesh {
    let corners = vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    (corners, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

fn cube() -> Mesh {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|b| b as f64 * 2.0 - 1.0);
    let sides =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

/// The icosahedron, with each side cut in four `n` times and pushed to the unit sphere.
fn icosphere(n: u32) -> Mesh {
    let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-g, g] {
            corners.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(unit));
        }
    }
    let near = |a: D3, b: D3| crate::testing::length(sub(a, b)) < 1.1;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let (p, q, r) = (corners[a], corners[b], corners[c]);
                if near(p, q) && near(q, r) && near(r, p) {
                    let out = crate::testing::dot(cross(sub(q, p), sub(r, p)), p) > 0.0;
                    triangles.push(if out { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..n {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |i: usize, j: usize| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    corners.push(unit(add(corners[i], corners[j])));
                    corners.len() - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    (corners, triangles)
}

/// The mesh under a scale and a shift, its corners rounded to `f32`.
fn placed((corners, triangles): &Mesh, size: f64, shift: D3) -> (Vec<Vec3>, Vec<Triangle>) {
    let corners: Vec<Vec3> = corners.iter().map(|&p| single(add(scaled(p, size), shift))).collect();
    let triangles = triangles.iter().map(|t| triangle(t.map(|i| corners[i]))).collect();
    (corners, triangles)
}

/// A point that rays are aimed at: a corner, on an edge, or anywhere on the surface.
fn target(rng: &mut Rng, triangles: &[Triangle]) -> Vec3 {
    let [a, b, c] = triangles[rng.below(triangles.len() as u32) as usize].vertices.map(double);
    match rng.below(3) {
        0 => single(a),
        1 => single(add(a, scaled(sub(b, a), rng.unit()))),
        _ => {
            let (u, v) = (rng.unit(), rng.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            single(add(a, add(scaled(sub(b, a), u), scaled(sub(c, a), v))))
        }
    }
}

#[test]
fn triangle_meshes_have_no_holes() {
    let sampler = Sampler::new(0, 0, 0, 0);
    let mut rng = Rng::new(1);
    for (mesh, inner) in [(tetrahedron(), 0.2), (cube(), 0.7), (icosphere(2), 0.7)] {
        for size in [1e-3, 1.0, 1e5] {
            for away in [0.0, 1.0, 1000.0] {
                let shift = double(rng.in_cube(away * size));
                let (_, triangles) = placed(&mesh, size, shift);
                let scene = TestScene { triangles, ..TestScene::default() };
                let view = scene.view();
                let prims: Vec<_> =
                    (0..scene.triangles.len()).map(|i| prim(PrimKind::Triangle, i)).collect();
                let bounds: Vec<_> =
                    prims.iter().map(|&p| primitive_bounds(&view, p, [0.0; 2])).collect();
                for _ in 0..5_000 {
                    let o = add(double(rng.in_cube(inner * 0.5 * size)), shift);
                    let ray = ray_to(single(o), target(&mut rng, &scene.triangles));
                    let inv_d = ray.d.map(reciprocal_or_huge);
                    let hit = prims.iter().zip(&bounds).any(|(&p, b)| {
                        b.slab(ray.o, inv_d).is_some_and(|slab| {
                            intersect_primitive(&view, p, &ray, &sampler, slab.t_enter).is_some()
                        })
                    });
                    assert!(hit, "a hole: size {size}, away {away}, {ray:?}");
                }
            }
        }
    }
}

/// From outside, a ray at the middle of the mesh cannot pass; aimed at the middle of edges and at
/// corners on its way.
#[test]
fn triangle_meshes_are_closed_from_outside() {
    let mut rng = Rng::new(2);
    let sampler = Sampler::new(0, 0, 0, 0);
    for mesh in [tetrahedron(), cube(), icosphere(1)] {
        for size in [1e-3, 1.0, 1e5] {
            let (_, triangles) = placed(&mesh, size, [0.0; 3]);
            let scene = TestScene { triangles, ..TestScene::default() };
            let view = scene.view();
            let prims: Vec<_> =
                (0..scene.triangles.len()).map(|i| prim(PrimKind::Triangle, i)).collect();
            let all = BruteForce { prims: Array::new(&prims) };
            for _ in 0..10_000 {
                // Through the target and on into the middle.
                let aim = double(target(&mut rng, &scene.triangles));
                let middle = scaled(double(rng.in_cube(0.05 * size)), 1.0);
                let way = rng.log_range(1.1, 100.0);
                let o = single(add(middle, scaled(sub(aim, middle), way)));
                let ray = ray_to(o, single(middle));
                assert!(
                    all.closest_hit(&view, &ray, &sampler, f32::INFINITY).is_some(),
                    "{size} {ray:?}"
                );
            }
        }
    }
}

/// A room of six walls, each of `n` x `n` quads, from corner `lo` with side `size`.
fn room(lo: D3, size: f64, n: u32) -> TestScene {
    turned_room(lo, size, n, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
}

/// The same, turned about its corner before it is moved.
fn turned_room(lo: D3, size: f64, n: u32, axes: [D3; 3]) -> TestScene {
    let mut scene = TestScene::default();
    let step = size / f64::from(n);
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            for i in 0..n {
                for j in 0..n {
                    let at = |i: u32, j: u32| {
                        let place = add(
                            scaled(axes[axis], side * size),
                            add(
                                scaled(axes[b], f64::from(i) * step),
                                scaled(axes[c], f64::from(j) * step),
                            ),
                        );
                        // Corners are rounded once, and edges are exact differences of corners.
                        double(single(add(lo, place)))
                    };
                    let corner = at(i, j);
                    let (u, v) = (sub(at(i + 1, j), corner), sub(at(i, j + 1), corner));
                    scene.quads.push(quad(single(corner), single(u), single(v)));
                }
            }
        }
    }
    scene
}

#[test]
fn turned_rooms_do_not_leak() {
    let sampler = Sampler::new(0, 0, 0, 0);
    let mut rng = Rng::new(4);
    for n in [1, 4] {
        for size in [1.0, 555.0] {
            for away in [0.0, 1.0, 30.0, 1000.0] {
                let mut leaks = 0;
                for _ in 0..20 {
                    let lo = double(rng.in_cube(away * size));
                    let x = double(rng.direction());
                    let y = unit(cross(x, double(rng.direction())));
                    let axes = [x, y, cross(x, y)];
                    let scene = turned_room(lo, size, n, axes);
                    let view = scene.view();
                    let prims: Vec<_> =
                        (0..scene.quads.len()).map(|i| prim(PrimKind::Quad, i)).collect();
                    let all = BruteForce { prims: Array::new(&prims) };
                    for _ in 0..5_000 {
                        let inside = |rng: &mut Rng| -> D3 {
                            std::array::from_fn(|_| size * rng.range(0.1, 0.9))
                        };
                        let place = |q: D3| {
                            let moved = add(
                                scaled(axes[0], q[0]),
                                add(scaled(axes[1], q[1]), scaled(axes[2], q[2])),
                            );
                            single(add(lo, moved))
                        };
                        let o = inside(&mut rng);
                        let mut aim = inside(&mut rng);
                        let axis = rng.below(3) as usize;
                        for k in 0..rng.below(4) as usize {
                            let a = (axis + k) % 3;
                            let cells = if k == 0 { 1 } else { n };
                            let cell = rng.below(cells + 1);
                            aim[a] = size * f64::from(cell) / f64::from(cells);
                        }
                        let ray: Ray = ray_to(place(o), place(aim));
                        let hit = all.closest_hit(&view, &ray, &sampler, f32::INFINITY);
                        leaks += u32::from(hit.is_none());
                    }
                }
                assert_eq!(leaks, 0, "n {n}, size {size}, away {away}");
            }
        }
    }
}

#[test]
fn rooms_of_quads_do_not_leak() {
    let sampler = Sampler::new(0, 0, 0, 0);
    let mut rng = Rng::new(3);
    for n in [1, 4] {
        for size in [1e-3, 1.0, 555.0, 1e5] {
            for away in [0.0, 1.0, 30.0, 1000.0] {
                let lo = double(rng.in_cube(away * size));
                let scene = room(lo, size, n);
                let view = scene.view();
                let prims: Vec<_> =
                    (0..scene.quads.len()).map(|i| prim(PrimKind::Quad, i)).collect();
                let all = BruteForce { prims: Array::new(&prims) };
                for _ in 0..10_000 {
                    let inside = |rng: &mut Rng| -> D3 {
                        std::array::from_fn(|i| lo[i] + size * rng.range(0.1, 0.9))
                    };
                    let o = inside(&mut rng);
                    // Anywhere, at an edge between quads, or into a corner.
                    let mut aim = inside(&mut rng);
                    let axis = rng.below(3) as usize;
                    for k in 0..rng.below(4) as usize {
                        let a = (axis + k) % 3;
                        let cells = if k == 0 { 1 } else { n };
                        let cell = rng.below(cells + 1);
                        aim[a] = lo[a] + size * f64::from(cell) / f64::from(cells);
                    }
                    let ray: Ray = ray_to(single(o), single(aim));
                    let hit = all.closest_hit(&view, &ray, &sampler, f32::INFINITY);
                    assert!(hit.is_some(), "a leak: n {n}, size {size}, away {away}, {ray:?}");
                }
            }
        }
    }
}
