//! Bilinear patches against the roots of their equations in `f64`.

use super::super::patch::hit_patch;
use super::super::{MeshPatch, MeshTriangle};
use super::spawn::leaving;
use super::{check_interaction, reach};
use crate::accel::{Accel, BruteForce};
use crate::accessor::Array;
use crate::math::{Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimKind, PrimRef};
use crate::shapes::{Mesh, primitive_bounds, surface_interaction};
use crate::testing::{
    ANY_MATERIAL, D3, Rng, TestScene, add, cross, dot, double, hit_of, length, prim, ray_to,
    scaled, single, sub, unit,
};

/// Where a line meets a patch, or the surface that it is a part of.
#[derive(Clone, Copy, Debug)]
struct Root {
    t: f64,
    u: f64,
    v: f64,
    /// Sine of the angle between line and surface.
    sin: f64,
}

fn point([p00, p10, p01, p11]: [D3; 4], u: f64, v: f64) -> D3 {
    let mix = |a: D3, b: D3, t: f64| add(scaled(a, 1.0 - t), scaled(b, t));
    mix(mix(p00, p10, u), mix(p01, p11, u), v)
}

fn partials([p00, p10, p01, p11]: [D3; 4], u: f64, v: f64) -> [D3; 2] {
    let mix = |a: D3, b: D3, t: f64| add(scaled(a, 1.0 - t), scaled(b, t));
    [mix(sub(p10, p00), sub(p11, p01), v), mix(sub(p01, p00), sub(p11, p10), u)]
}

/// All roots: the line and the straight line at u lie in a plane if a triple product vanishes, which is
/// quadratic in u; three values of it give its coefficients.
fn roots(p: [D3; 4], o: D3, d: D3) -> Vec<Root> {
    let f = |u: f64| {
        let (a, b) = (point(p, u, 0.0), point(p, u, 1.0));
        dot(cross(sub(a, o), sub(b, a)), d)
    };
    let (f0, fh, f1) = (f(0.0), f(0.5), f(1.0));
    let (a, b, c) = (2.0 * f0 - 4.0 * fh + 2.0 * f1, 4.0 * fh - 3.0 * f0 - f1, f0);
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let mut all = Vec::new();
    for mut u in [q / a, c / q] {
        if !u.is_finite() || u.abs() > 1e3 {
            continue;
        }
        // The point of the straight line at u that is nearest to the ray's line, then Newton.
        let (a, b) = (point(p, u, 0.0), point(p, u, 1.0));
        let n = cross(d, cross(sub(b, a), d));
        let mut v = dot(sub(o, a), n) / dot(sub(b, a), n);
        let mut t = dot(sub(point(p, u, v), o), d);
        for _ in 0..4 {
            let r = sub(add(o, scaled(d, t)), point(p, u, v));
            let [su, sv] = partials(p, u, v);
            // r = su du + sv dv - d dt.
            let det = dot(su, cross(sv, d));
            u += dot(r, cross(sv, d)) / det;
            v += dot(su, cross(r, d)) / det;
            t -= dot(su, cross(sv, r)) / det;
        }
        let [su, sv] = partials(p, u, v);
        let n = cross(su, sv);
        if t.is_finite() {
            all.push(Root { t, u, v, sin: (dot(n, d) / length(n)).abs() });
        }
    }
    all
}

/// Corners of a patch: a parallelogram bent by up to `bend` of its size.
fn random_corners(rng: &mut Rng) -> ([Vec3; 4], f64) {
    let size = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 300.0) };
    let corner = double(rng.in_cube(away));
    let bend = if rng.chance(0.2) { 1e-3 } else { rng.range(0.0, 0.6) };
    let (u, v) = loop {
        let u = scaled(double(rng.direction()), size);
        let v = scaled(double(rng.direction()), size * rng.log_range(0.1, 1.0));
        if length(cross(u, v)) > 0.2 * length(u) * length(v) {
            break (u, v);
        }
    };
    let mut shake = |p: D3| single(add(p, scaled(double(rng.direction()), bend * size * 0.3)));
    let corners = [corner, add(corner, u), add(corner, v), add(corner, add(u, v))].map(&mut shake);
    (corners, size)
}

/// A scene of one patch.
fn scene_of(corners: [Vec3; 4]) -> TestScene {
    let mut scene = TestScene { positions: corners.to_vec(), ..TestScene::default() };
    scene.meshes.push(Mesh { material: ANY_MATERIAL, ..bytemuck::Zeroable::zeroed() });
    scene.mesh_patches.push(MeshPatch { vertices: [0, 1, 2, 3], mesh: 0, flip: 0, _pad: [0; 2] });
    scene
}

#[test]
fn hits_are_roots_of_the_equations() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses, mut n_second, mut n_touches) = (0, 0, 0, 0);
    for _ in 0..300_000 {
        let (corners, size) = random_corners(&mut rng);
        let p = corners.map(double);
        let aim = point(p, rng.range(-0.3, 1.3), rng.range(-0.3, 1.3));
        let d = double(rng.direction());
        let back = rng.log_range(1e-2, 1e2) * size;
        let ray = Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 };
        let real = roots(p, double(ray.o), double(ray.d));
        // Near an outline, rounding decides.
        if real.iter().any(|r| r.sin < 0.02) {
            continue;
        }
        let far = length(double(ray.o)) + length(p[0]) + back + size;
        let error = |r: &Root| 3e-6 * far / r.sin;
        let [su, sv] = partials(p, 0.5, 0.5);
        let thin = length(cross(su, sv)) / length(su).max(length(sv));
        if thin < 0.1 * size {
            continue;
        }
        let margin = |r: &Root| 8.0 * error(r) / thin + 1e-6;
        let depth = |r: &Root| r.u.min(1.0 - r.u).min(r.v).min(1.0 - r.v);
        let scene = scene_of(corners);
        let view = scene.view();
        match hit_patch(corners, &ray) {
            Some(hit) => {
                n_hits += 1;
                let t = f64::from(hit.t);
                let off = |r: &&Root| {
                    (r.u - f64::from(hit.uv[0])).abs() + (r.v - f64::from(hit.uv[1])).abs()
                };
                let root = real.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
                let Some(root) = root.filter(|r| (r.t - t).abs() < error(r)) else {
                    // It may touch the outline, next to which there is no root.
                    let there = add(double(ray.o), scaled(double(ray.d), t));
                    let [u, v] = hit.uv.map(f64::from);
                    let off = length(sub(there, point(p, u, v)));
                    assert!(off < 1e-6 * far, "{t} is not among {real:?}: {corners:?} {ray:?}");
                    n_touches += 1;
                    continue;
                };
                assert!(depth(root) > -margin(root), "{root:?} {hit:?}");
                let skipped = real
                    .iter()
                    .any(|r| r.t > error(r) && r.t < root.t - error(r) && depth(r) > margin(r));
                assert!(!skipped, "{real:?} {hit:?} {corners:?} {ray:?}");
                n_second += u32::from(real.iter().any(|r| r.t < root.t && r.t > 0.0));
                let prim = prim(PrimKind::MeshPatch, 0);
                let slab = primitive_bounds(&view, prim, [0.0; 2])
                    .slab(ray.o, ray.d.map(reciprocal_or_huge));
                if depth(root) > 0.0 {
                    assert!(slab.is_some(), "{corners:?} {ray:?}");
                }
                let Some(first) = hit_of(&view, prim, &ray) else { continue };
                let i = surface_interaction(&view, &first, &ray);
                check_interaction(&i);
                let [u, v] = i.uv.map(f64::from);
                assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
                assert!((u - root.u).abs() < 2.0 * margin(root) + 1e-5, "{i:?} {root:?}");
                assert!((v - root.v).abs() < 2.0 * margin(root) + 1e-5, "{i:?} {root:?}");
                let [su, sv] = partials(p, u, v);
                let n = unit(cross(su, sv));
                assert!(dot(double(i.n), n) > 1.0 - 1e-6, "{i:?} {n:?}");
                // The point is on the patch to within its error.
                let off = sub(double(i.p), point(p, u, v));
                assert!(dot(off, n).abs() <= reach(i.p_error, n), "{off:?} {i:?}");
                assert!(length(sub(double(i.dpdu), su)) < 1e-5 * length(su) + 1e-6 * far);
                assert!(length(sub(double(i.dpdv), sv)) < 1e-5 * length(sv) + 1e-6 * far);
            }
            None => {
                n_misses += 1;
                let missed = real.iter().any(|r| depth(r) > margin(r) && r.t > error(r));
                assert!(!missed, "{real:?} {corners:?} {ray:?}");
            }
        }
    }
    assert!(n_touches * 1000 < n_hits, "{n_touches} {n_hits}");
    assert!(
        n_hits > 70_000 && n_misses > 50_000 && n_second > 500,
        "{n_hits} {n_misses} {n_second}"
    );
}

/// A ray that leaves a patch meets it again only where the patch really bends into its way.
#[test]
fn rays_leave_both_sides() {
    let mut rng = Rng::new(2);
    let (mut n_cases, mut n_again, mut n_touches) = (0, 0, 0);
    while n_cases < 200_000 {
        let (corners, size) = random_corners(&mut rng);
        let p = corners.map(double);
        let aim = point(p, rng.unit(), rng.unit());
        let d = double(rng.direction());
        let o = single(sub(aim, scaled(d, rng.log_range(0.5, 1e3) * size)));
        let scene = scene_of(corners);
        let view = scene.view();
        let prim = prim(PrimKind::MeshPatch, 0);
        let ray = Ray { o, d: single(d), time: 0.0 };
        let Some(hit) = hit_of(&view, prim, &ray) else { continue };
        let i = surface_interaction(&view, &hit, &ray);
        n_cases += 1;
        for side in [1.0, -1.0] {
            let away = i.spawn(leaving(&mut rng, i.n, side), 0.0);
            let Some(again) = hit_patch(corners, &away) else { continue };
            n_again += 1;
            let t = f64::from(again.t);
            let real = roots(p, double(away.o), double(away.d));
            let is_root =
                real.iter().any(|r| r.t > 0.0 && (r.t - t).abs() < 1e-2 * t + 1e-5 * size / r.sin);
            // Touching its outline, the ray may be found to meet it twice, once, or not at all.
            let [u, v] = again.uv.map(f64::from);
            let there = add(double(away.o), scaled(double(away.d), t));
            let is_touch = t > 1e-3 * size && length(sub(there, point(p, u, v))) < 1e-5 * size;
            n_touches += u32::from(!is_root && is_touch);
            assert!(is_root || is_touch, "{t:e} of {real:?}: {corners:?} {i:?} {away:?}");
        }
    }
    assert!(n_again > 1000 && n_touches * 100 < n_again, "{n_again} {n_touches}");
}

/// A ball of bent patches, of which some are cut into two triangles: they share straight edges.
fn ball(
    rng: &mut Rng,
    n: usize,
    size: f64,
    shift: D3,
    with_triangles: bool,
) -> (TestScene, Vec<PrimRef>) {
    let mut scene = TestScene::default();
    scene.meshes.push(Mesh { material: ANY_MATERIAL, ..bytemuck::Zeroable::zeroed() });
    let mut prims = Vec::new();
    let mut index = std::collections::HashMap::new();
    for axis in 0..3 {
        for side in [-1_i64, 1] {
            let mut at = |i: usize, j: usize| {
                let n = n as i64;
                let (a, b) = (2 * i as i64 - n, 2 * j as i64 - n);
                let mut key = [0; 3];
                (key[axis], key[(axis + 1) % 3], key[(axis + 2) % 3]) = (side * n, a, b);
                *index.entry(key).or_insert_with(|| {
                    // On the cube's rims, vertices of different sides are one.
                    let bump = 1.0 + 0.15 * rng.unit();
                    let p = scaled(unit(key.map(|x| x as f64)), size * bump);
                    scene.positions.push(single(add(p, shift)));
                    scene.positions.len() as u32 - 1
                })
            };
            let cells: Vec<[u32; 4]> = (0..n * n)
                .map(|k| (k / n, k % n))
                .map(|(i, j)| [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)])
                .collect();
            for [a, b, c, d] in cells {
                if with_triangles && (a + b + c + d) % 3 == 0 {
                    for vertices in [[a, b, d], [a, d, c]] {
                        scene.mesh_triangles.push(MeshTriangle { vertices, mesh: 0 });
                        prims.push(prim(PrimKind::MeshTriangle, scene.mesh_triangles.len() - 1));
                    }
                    continue;
                }
                // Each in another order.
                let vertices = [[a, b, c, d], [b, d, a, c], [c, a, d, b], [b, a, d, c]]
                    [(a + 2 * b + d) as usize % 4];
                scene.mesh_patches.push(MeshPatch { vertices, mesh: 0, flip: 0, _pad: [0; 2] });
                prims.push(prim(PrimKind::MeshPatch, scene.mesh_patches.len() - 1));
            }
        }
    }
    (scene, prims)
}

#[test]
fn surfaces_of_patches_have_no_holes() {
    let mut rng = Rng::new(3);
    let sampler = Sampler::new(0, 0, 0, 0);
    for n in [1, 3] {
        for size in [1e-3, 1.0, 1e5] {
            for away in [0.0, 1.0, 300.0] {
                for with_triangles in [false, true] {
                    let shift = double(rng.in_cube(away * size));
                    let (scene, prims) = ball(&mut rng, n, size, shift, with_triangles);
                    let view = scene.view();
                    let all = BruteForce { prims: Array::new(&prims) };
                    let corner = |rng: &mut Rng, v: &[u32]| {
                        double(scene.positions[v[rng.below(v.len() as u32) as usize] as usize])
                    };
                    for _ in 0..6_000 {
                        let patch =
                            scene.mesh_patches[rng.below(scene.mesh_patches.len() as u32) as usize];
                        let p = patch.vertices.map(|v| double(scene.positions[v as usize]));
                        // A corner, on an edge, or anywhere.
                        let aim = match rng.below(3) {
                            0 => corner(&mut rng, &patch.vertices),
                            1 if rng.chance(0.5) => point(p, rng.unit(), f64::from(rng.below(2))),
                            1 => point(p, f64::from(rng.below(2)), rng.unit()),
                            _ => point(p, rng.unit(), rng.unit()),
                        };
                        let inside = add(double(rng.in_cube(0.3 * size)), shift);
                        // From inside, and from outside through the same point into the inside.
                        let out = ray_to(single(inside), single(aim));
                        let way = rng.log_range(1.5, 100.0);
                        let o = add(inside, scaled(sub(aim, inside), way));
                        let back = ray_to(single(o), single(inside));
                        for ray in [out, back] {
                            let hit = all.closest_hit(&view, &ray, &sampler, f32::INFINITY);
                            assert!(
                                hit.is_some(),
                                "a hole: n {n}, size {size}, away {away}, {ray:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Patches whose corners coincide, that are flat, or have no area at all.
#[test]
fn degenerate_patches_give_no_nonsense() {
    let mut rng = Rng::new(4);
    let mut n_hits = 0;
    for _ in 0..200_000 {
        let mut c = [(); 4].map(|()| rng.in_cube(1.0));
        match rng.below(6) {
            0 => c[1] = c[0],
            1 => (c[1], c[3]) = (c[0], c[2]),
            2 => (c[1], c[2], c[3]) = (c[0], c[0], c[0]),
            3 => c[3] = c[1] + c[2] - c[0],
            // On a line.
            4 => (c[2], c[3]) = ((c[0] + c[1]) * 0.5, c[1] * 2.0 - c[0]),
            _ => c[3] = c[0],
        }
        let scene = scene_of(c);
        let view = scene.view();
        let ray = ray_to(rng.in_cube(2.0), (c[0] + c[1] + c[2] + c[3]) * 0.25);
        if let Some(hit) = hit_of(&view, prim(PrimKind::MeshPatch, 0), &ray) {
            n_hits += 1;
            assert!(hit.t > 0.0 && hit.t.is_finite());
            let i = surface_interaction(&view, &hit, &ray);
            check_interaction(&i);
            assert!(i.p.to_array().iter().all(|x| x.is_finite()));
        }
    }
    assert!(n_hits > 20_000, "{n_hits}");
}
