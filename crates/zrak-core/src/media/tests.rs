//! Media: lengths of free flights, and where events may be.

mod homogeneous;

use super::{ConstantMedium, NO_PLACEMENT};
use crate::accel::{Accel, BruteForce};
use crate::accessor::Array;
use crate::materials::Isotropic;
use crate::math::{Affine, Color, Vec3, vec3};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{MaterialKind, MaterialRef, PrimKind, PrimRef, SceneView};
use crate::shapes::{Box3, Placement, Shape, Sphere, boundary_interval};
use crate::testing::{
    ANY_MATERIAL, D3, Rng, TestScene, add, double, kolmogorov, length, prim, scaled, single, solid,
    sub,
};

fn sphere(center: Vec3, radius: f32) -> Sphere {
    Sphere { center, radius, material: ANY_MATERIAL, flags: 0, _pad: [0; 2] }
}

fn box3(lo: Vec3, hi: Vec3) -> Box3 {
    Box3 { lo, material: ANY_MATERIAL, hi, _pad: 0 }
}

fn medium(boundary: PrimRef, density: f64) -> ConstantMedium {
    ConstantMedium {
        boundary,
        material: MaterialRef::new(MaterialKind::Isotropic, 0),
        neg_mean_free_path: (-1.0 / density) as f32,
        placement: NO_PLACEMENT,
    }
}

/// First event of a ray in the media of a scene, in samples of one pixel.
fn events(view: &SceneView, ray: &Ray, n_media: usize, n: u32, bounce: u32) -> Vec<f64> {
    let prims: Vec<_> = (0..n_media).map(|i| prim(PrimKind::Medium, i)).collect();
    let all = BruteForce { prims: Array::new(&prims) };
    (0..n)
        .filter_map(|i| {
            let mut sampler = Sampler::new(5, i % 64, 9, i / 64);
            (0..bounce).for_each(|_| sampler.next_bounce());
            all.closest_hit(view, ray, &sampler, f32::INFINITY).map(|hit| f64::from(hit.t))
        })
        .collect()
}

/// Checks that distances from `start` on are exponential up to `end`, and that as many rays get
/// through as should.
fn check_exponential(mut distances: Vec<f64>, n: u32, density: f64, start: f64, end: f64) {
    let stopped = 1.0 - (-density * (end - start)).exp();
    let expected = f64::from(n) * stopped;
    let sigma = (expected * (1.0 - stopped)).sqrt();
    let off = (distances.len() as f64 - expected).abs();
    assert!(off < 4.0 * sigma + 1.0, "{} events, {expected} expected", distances.len());
    let cdf = |t: f64| (1.0 - (-density * (t - start)).exp()) / stopped;
    let statistic = kolmogorov(&mut distances, cdf);
    assert!(statistic < 2.2, "Kolmogorov's statistic is {statistic}");
}

#[test]
fn free_flights_are_exponential() {
    let n = 100_000;
    for (density, bounce) in [(0.2, 0), (1.0, 1), (5.0, 17)] {
        let mut scene = TestScene::default();
        scene.spheres.push(sphere(Vec3::ZERO, 2.0));
        scene.media.push(medium(prim(PrimKind::Sphere, 0), density));
        let view = scene.view();
        let d = vec3(0.6, 0.0, 0.8);
        // From the middle, and from outside.
        let inside = Ray { o: Vec3::ZERO, d, time: 0.0 };
        check_exponential(events(&view, &inside, 1, n, bounce), n, density, 0.0, 2.0);
        let outside = Ray { o: d * -7.0, d, time: 0.0 };
        check_exponential(events(&view, &outside, 1, n, bounce), n, density, 5.0, 9.0);
    }
}

#[test]
fn overlapping_media_add_up() {
    let n = 100_000;
    let mut scene = TestScene::default();
    scene.spheres.push(sphere(Vec3::ZERO, 3.0));
    scene.boxes.push(box3(Vec3::splat(-3.0), Vec3::splat(3.0)));
    scene.media.push(medium(prim(PrimKind::Sphere, 0), 0.2));
    scene.media.push(medium(prim(PrimKind::Box, 0), 0.3));
    scene.media.push(medium(prim(PrimKind::Sphere, 0), 0.1));
    let view = scene.view();
    let ray = Ray { o: Vec3::ZERO, d: vec3(1.0, 0.0, 0.0), time: 0.0 };
    check_exponential(events(&view, &ray, 3, n, 0), n, 0.6, 0.0, 3.0);
}

/// Whether a point is inside a boundary, in `f64`.
type Inside = Box<dyn Fn(D3) -> bool>;

/// A boundary of each kind, of random size and place.
fn random_boundary(rng: &mut Rng, scene: &mut TestScene, kind: u32) -> (PrimRef, D3, f64, Inside) {
    let size = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 1e3) };
    let center = rng.in_cube(away);
    let c = double(center);
    match kind {
        0 => {
            let s = sphere(center, size as f32);
            scene.spheres.push(s);
            let r = f64::from(s.radius);
            let inside = move |p: D3| length(sub(p, c)) < r;
            (prim(PrimKind::Sphere, 0), c, size, Box::new(inside))
        }
        1 => {
            let half = rng.in_cube(size).abs() + Vec3::splat(0.1 * size as f32);
            let b = box3(center - half, center + half);
            scene.boxes.push(b);
            let (lo, hi) = (double(b.lo), double(b.hi));
            let inside = move |p: D3| (0..3).all(|i| lo[i] < p[i] && p[i] < hi[i]);
            (prim(PrimKind::Box, 0), c, size, Box::new(inside))
        }
        _ => {
            // A sphere stretched along the axes.
            scene.spheres.push(sphere(Vec3::ZERO, 1.0));
            let stretch: D3 = std::array::from_fn(|_| size * rng.range(0.3, 1.0));
            let row = |i: usize, s: f64, t: f64| {
                let mut row = [0.0; 4];
                row[i] = s as f32;
                row[3] = t as f32;
                row
            };
            scene.placements.push(Placement {
                world_from_object: Affine { rows: [0, 1, 2].map(|i| row(i, stretch[i], c[i])) },
                object_from_world: Affine {
                    rows: [0, 1, 2].map(|i| row(i, 1.0 / stretch[i], -c[i] / stretch[i])),
                },
            });
            let inside = move |p: D3| {
                let q: D3 = std::array::from_fn(|i| (p[i] - c[i]) / stretch[i]);
                // The matrix itself is rounded.
                length(q) < 1.0 + 1e-6 * (1.0 + length(c) / size)
            };
            (prim(PrimKind::Sphere, 0), c, size, Box::new(inside))
        }
    }
}

/// Wherever an event is, light goes on from a point inside the boundary: it cannot be lost.
#[test]
fn events_are_inside_the_boundary() {
    let mut rng = Rng::new(2);
    let mut n_events = 0;
    while n_events < 300_000 {
        let mut scene = TestScene::default();
        let kind = rng.below(3);
        let (boundary, center, size, inside) = random_boundary(&mut rng, &mut scene, kind);
        // Thin, or so dense that most events are at the rim.
        let density = rng.log_range(0.1, 1e6) / size;
        scene.media.push(medium(boundary, density));
        if !scene.placements.is_empty() {
            scene.media[0].placement = 0;
        }
        scene.isotropics.push(Isotropic { albedo: solid(Color::WHITE) });
        let view = scene.view();
        let placement = scene.media[0].placement(&view);
        for _ in 0..50 {
            let aim = add(center, double(rng.in_cube(size)));
            let d = double(rng.direction());
            let back = if rng.chance(0.5) { rng.range(0.0, 1.0) } else { rng.log_range(1.0, 1e3) };
            let ray = Ray { o: single(sub(aim, scaled(d, back * size))), d: single(d), time: 0.0 };
            let sampler = Sampler::new(0, rng.below(9), rng.below(9), rng.below(1 << 20));
            let prims = [prim(PrimKind::Medium, 0)];
            let all = BruteForce { prims: Array::new(&prims) };
            let Some(hit) = all.closest_hit(&view, &ray, &sampler, f32::INFINITY) else { continue };
            n_events += 1;
            let p = ray.at(hit.t);
            assert!(inside(double(p)), "{p:?}: {ray:?} {hit:?}");
            // From there every ray crosses the boundary ahead, once.
            let next = Ray { o: p, d: rng.direction(), time: 0.0 };
            let interval = boundary_interval(&view, boundary, placement, &next);
            assert!(interval.is_some_and(|[start, end]| start == 0.0 && end > 0.0), "{next:?}");
            if kind == 0 {
                assert!(scene.spheres[0].intersect(&next).is_some());
            }
            if kind == 1 {
                assert!(scene.boxes[0].intersect(&next).is_some());
            }
        }
    }
}

/// A medium whose boundary lies in a wall: no event behind the wall.
#[test]
fn no_event_lies_behind_a_wall_that_the_boundary_touches() {
    let mut rng = Rng::new(3);
    let mut scene = TestScene::default();
    scene.boxes.push(box3(vec3(-1.0, 0.0, -1.0), vec3(1.0, 2.0, 1.0)));
    scene.quads.push(crate::testing::quad(
        vec3(-20.0, 0.0, -20.0),
        vec3(0.0, 0.0, 40.0),
        vec3(40.0, 0.0, 0.0),
    ));
    scene.media.push(medium(prim(PrimKind::Box, 0), 1.0));
    let view = scene.view();
    let prims = [prim(PrimKind::Medium, 0), prim(PrimKind::Quad, 0)];
    let all = BruteForce { prims: Array::new(&prims) };
    for i in 0..200_000 {
        let o = vec3(rng.range(-0.9, 0.9) as f32, rng.range(0.01, 3.0) as f32, 0.3);
        let mut d = rng.direction();
        d.y = -d.y.abs();
        if d.y > -0.2 {
            continue;
        }
        let ray = Ray { o, d, time: 0.0 };
        let hit = all
            .closest_hit(&view, &ray, &Sampler::new(0, 0, 0, i), f32::INFINITY)
            .expect("the wall");
        if hit.prim.kind() == Some(PrimKind::Medium) {
            assert!(ray.at(hit.t).y > 0.0);
        } else {
            assert!(ray.at(hit.t).y.abs() < 1e-5);
        }
    }
}

/// However short its free paths, a medium stops light: no event is lost at its rim.
#[test]
fn dense_media_are_opaque() {
    let mut rng = Rng::new(4);
    let mut n_rays = 0;
    while n_rays < 200_000 {
        let mut scene = TestScene::default();
        let kind = rng.below(3);
        let (boundary, center, size, inside) = random_boundary(&mut rng, &mut scene, kind);
        // From a mean free path of a hundredth of the size to less than rounding.
        let density = rng.log_range(3e2, 1e9) / size;
        scene.media.push(medium(boundary, density));
        if !scene.placements.is_empty() {
            scene.media[0].placement = 0;
        }
        let view = scene.view();
        let placement = scene.media[0].placement(&view);
        for _ in 0..50 {
            // Straight at the middle half of it.
            let aim = add(center, double(rng.in_cube(0.05 * size)));
            let d = double(rng.direction());
            let back = rng.log_range(1e-3, 1e2);
            let ray = Ray { o: single(sub(aim, scaled(d, back * size))), d: single(d), time: 0.0 };
            let sampler = Sampler::new(1, rng.below(9), rng.below(9), rng.below(1 << 20));
            let prims = [prim(PrimKind::Medium, 0)];
            let hit = BruteForce { prims: Array::new(&prims) }.closest_hit(
                &view,
                &ray,
                &sampler,
                f32::INFINITY,
            );
            n_rays += 1;
            let hit = hit.unwrap_or_else(|| panic!("light gets through: {density:e} {ray:?}"));
            assert!(inside(double(ray.at(hit.t))));
            // And near where it entered.
            let [start, end] = boundary_interval(&view, boundary, placement, &ray).unwrap();
            let depth = f64::from(hit.t - start);
            let rounding = 2e-5 * (f64::from(end) + length(double(ray.o)));
            assert!(depth < 18.0 / density + rounding, "{depth:e} {density:e} {rounding:e}");
        }
    }
}
