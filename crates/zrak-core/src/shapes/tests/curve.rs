//! Curves against densely sampled axes in `f64`.

use super::super::{CURVE_CYLINDER, CURVE_FLAT, CURVE_RIBBON, Curve, Ribbon};
use super::check_interaction;
use super::spawn::leaving;
use crate::interaction::SurfaceInteraction;
use crate::math::{Vec3, reciprocal_or_huge};
use crate::ray::Ray;
use crate::scene::{PrimKind, PrimRef};
use crate::shapes::{primitive_bounds, surface_interaction};
use crate::testing::{
    ANY_MATERIAL, D3, Rng, TestScene, add, cross, dot, double, hit_of, length, prim, scaled,
    single, sub, unit,
};

const PRIM: PrimRef = prim(PrimKind::Curve, 0);

fn mix(a: D3, b: D3, t: f64) -> D3 {
    add(scaled(a, 1.0 - t), scaled(b, t))
}

fn blossom([a, b, c, d]: [D3; 4], [x, y, z]: [f64; 3]) -> D3 {
    let (ab, bc, cd) = (mix(a, b, x), mix(b, c, x), mix(c, d, x));
    mix(mix(ab, bc, y), mix(bc, cd, y), z)
}

fn axis(p: [D3; 4], u: f64) -> D3 {
    blossom(p, [u; 3])
}

fn tangent([a, b, c, d]: [D3; 4], u: f64) -> D3 {
    let q = [sub(b, a), sub(c, b), sub(d, c)];
    scaled(mix(mix(q[0], q[1], u), mix(q[1], q[2], u), u), 3.0)
}

/// A curve and all that it is made of.
#[derive(Clone, Copy, Debug)]
struct Case {
    curve: Curve,
    ribbon: Ribbon,
    size: f64,
}

fn halvings(p: [D3; 4], width: f64) -> u32 {
    let bend = |a: D3, b: D3, c: D3| length(add(sub(a, scaled(b, 2.0)), c));
    let most = bend(p[0], p[1], p[2]).max(bend(p[1], p[2], p[3]));
    let depth = (1.414 * 6.0 * most / (8.0 * 0.05 * width)).log2() / 2.0;
    (depth.ceil().max(0.0) as u32).min(10)
}

fn random_case(rng: &mut Rng, form: u32, is_straight: bool) -> Case {
    let size = rng.log_range(1e-2, 1e4);
    let away = if rng.chance(0.5) { 0.0 } else { size * rng.log_range(0.1, 30.0) };
    let start = double(rng.in_cube(away));
    let chord = scaled(double(rng.direction()), size);
    let mut points = [0.0, 1.0, 2.0, 3.0].map(|k| add(start, scaled(chord, k / 3.0)));
    if !is_straight {
        for p in &mut points[1..3] {
            *p = add(*p, double(rng.in_cube(0.4 * size)));
        }
    }
    let points = points.map(single);
    let width = size * rng.log_range(0.003, 0.05);
    let widths = if is_straight || rng.chance(0.3) {
        [width as f32; 2]
    } else {
        [width as f32, (width * rng.unit()) as f32]
    };
    // Across the chord, at one end and turned at the other.
    let start = unit(cross(chord, double(rng.direction())));
    let end = unit(add(start, scaled(unit(cross(chord, start)), rng.range(-1.0, 1.0))));
    let (start, end) = if is_straight { (start, start) } else { (start, end) };
    let angle = dot(start, end).clamp(-1.0, 1.0).acos();
    let inv_sin = if angle.sin() < 1e-3 { 0.0 } else { 1.0 / angle.sin() };
    let ribbon = Ribbon {
        start: single(start),
        angle: angle as f32,
        end: single(end),
        inv_sin: inv_sin as f32,
    };
    let curve = Curve {
        points,
        widths,
        u: [0.0, 1.0],
        material: ANY_MATERIAL,
        form,
        ribbon: 0,
        n_halvings: halvings(points.map(double), width).max(if form == CURVE_RIBBON {
            2
        } else {
            0
        }),
    };
    Case { curve, ribbon, size }
}

/// How much the lines across turn along half of the width. Where that is much, several of them meet, and
/// a ray passes them all at once.
fn tightness(case: &Case, d: D3, u: f64) -> f64 {
    let h = 1e-4;
    let turn = scaled(sub(across(case, d, u + h), across(case, d, u - h)), 0.5 / h);
    let [w0, w1] = case.curve.widths.map(f64::from);
    0.5 * w0.max(w1) * length(turn) / length(tangent(case.curve.points.map(double), u))
}

fn scene_of(case: &Case) -> TestScene {
    let mut scene = TestScene::default();
    scene.curves.push(case.curve);
    scene.ribbons.push(case.ribbon);
    scene
}

/// Where a ray passes the axis at u: how far from it across, as a share of half of the width, and how
/// deep.
#[derive(Clone, Copy, Debug)]
struct Pass {
    u: f64,
    t: f64,
    side: f64,
}

/// Direction of the line across at u, for rays along `d`.
fn across(case: &Case, d: D3, u: f64) -> D3 {
    let n = if case.curve.form == CURVE_RIBBON {
        let (a, b) = (double(case.ribbon.start), double(case.ribbon.end));
        let angle = f64::from(case.ribbon.angle);
        if angle.sin() < 1e-3 {
            mix(a, b, u)
        } else {
            let weight = |s: f64| (s * angle).sin() / angle.sin();
            add(scaled(a, weight(1.0 - u)), scaled(b, weight(u)))
        }
    } else {
        scaled(d, -1.0)
    };
    unit(cross(tangent(case.curve.points.map(double), u), n))
}

/// All passes: changes of sign of the ray's side of the line across, found by `n` steps, then by halving.
fn passes(case: &Case, ray: &Ray, n: u32) -> Vec<Pass> {
    let p = case.curve.points.map(double);
    let (o, d) = (double(ray.o), double(ray.d));
    let across = |u: f64| across(case, d, u);
    let beside = |u: f64| dot(cross(sub(axis(p, u), o), across(u)), d);
    let mut found = Vec::new();
    for i in 0..n {
        let (mut lo, mut hi) = (f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n));
        let (at_lo, at_hi) = (beside(lo), beside(hi));
        if at_lo * at_hi > 0.0 {
            continue;
        }
        for _ in 0..50 {
            let middle = 0.5 * (lo + hi);
            if beside(middle) * at_lo > 0.0 {
                lo = middle;
            } else {
                hi = middle;
            }
        }
        let u = 0.5 * (lo + hi);
        // The point of the line across that the ray meets.
        let (c, b) = (sub(axis(p, u), o), across(u));
        let flat = |v: D3| sub(v, scaled(d, dot(v, d)));
        let (c2, b2) = (flat(c), flat(b));
        let s = -dot(c2, b2) / dot(b2, b2);
        let [w0, w1] = case.curve.widths.map(f64::from);
        let radius = 0.5 * (w0 + (w1 - w0) * u);
        found.push(Pass { u, t: dot(add(c, scaled(b, s)), d), side: s / radius });
    }
    found
}

fn ray_at(rng: &mut Rng, case: &Case) -> Ray {
    let p = case.curve.points.map(double);
    let width = f64::from(case.curve.widths[0]);
    let aim = add(axis(p, rng.range(-0.05, 1.05)), double(rng.in_cube(width)));
    let d = double(rng.direction());
    let back = rng.log_range(0.3, 30.0) * case.size;
    Ray { o: single(sub(aim, scaled(d, back))), d: single(d), time: 0.0 }
}

#[test]
fn hits_are_where_the_axis_is_passed() {
    let mut rng = Rng::new(1);
    let (mut n_hits, mut n_misses, mut n_unclear) = ([0; 3], 0, 0);
    for _ in 0..60_000 {
        let form = rng.below(3);
        let case = random_case(&mut rng, form, false);
        let ray = ray_at(&mut rng, &case);
        let real = passes(&case, &ray, 400);
        let far = length(double(ray.o)) + length(double(case.curve.points[0])) + case.size;
        // Rounding, as a share of the width where the ray passes.
        let [w0, w1] = case.curve.widths.map(f64::from);
        let blur = |r: &Pass| 1e-5 * far / (w0 + (w1 - w0) * r.u) + 0.02;
        let is_sure = |r: &&Pass| r.side.abs() < 1.0 - blur(r) && r.u > 0.01 && r.u < 0.99;
        let is_unclear = |r: &Pass| (r.side.abs() - 1.0).abs() < blur(r) || r.t < 0.1 * case.size;
        // Where the ray runs almost along the axis or in the plane of a ribbon, passes are ill-defined.
        let p = case.curve.points.map(double);
        let is_skew = |r: &Pass| {
            let tangent = unit(tangent(p, r.u));
            length(cross(tangent, double(ray.d))) < 0.3
                || tightness(&case, double(ray.d), r.u) > 0.2
        };
        // So is one that passes next to an end.
        let is_at_end = |u: f64| {
            let c = sub(axis(p, u), double(ray.o));
            let along = dot(c, unit(tangent(p, u)))
                - dot(c, double(ray.d)) * dot(double(ray.d), unit(tangent(p, u)));
            form != CURVE_RIBBON && along.abs() < 1e-5 * far
        };
        let at_end = is_at_end(0.0) || is_at_end(1.0);
        if at_end || real.iter().any(|r| is_unclear(r) || is_skew(r)) {
            n_unclear += 1;
            continue;
        }
        let scene = scene_of(&case);
        let view = scene.view();
        match case.curve.intersect(&view, &ray) {
            Some(t) => {
                n_hits[form as usize] += 1;
                let t64 = f64::from(t);
                let near = |r: &&Pass| (r.t - t64).abs() < 0.02 * w0 + 4e-5 * far;
                let middle = |a: &&Pass, b: &&Pass| a.side.abs().total_cmp(&b.side.abs());
                let Some(pass) = real.iter().filter(near).min_by(middle) else {
                    panic!("{t} is not among {real:?}: {case:?} {ray:?}")
                };
                assert!(pass.side.abs() < 1.0 + blur(pass), "{pass:?} {case:?} {ray:?}");
                let slab = primitive_bounds(&view, PRIM, [0.0; 2])
                    .slab(ray.o, ray.d.map(reciprocal_or_huge));
                assert!(slab.is_some(), "{case:?} {ray:?}");
                let Some(hit) = hit_of(&view, PRIM, &ray) else { panic!("{case:?} {ray:?}") };
                let i = surface_interaction(&view, &hit, &ray);
                check_interaction(&i);
                assert!(
                    (f64::from(i.uv[0]) - pass.u).abs() < 0.02,
                    "{i:?} {pass:?} {case:?} {ray:?}"
                );
                let side = f64::from(i.uv[1]) * 2.0 - 1.0;
                assert!((side - pass.side).abs() < 3.0 * blur(pass), "{i:?} {pass:?} {case:?}");
                if form != CURVE_RIBBON {
                    assert!(i.is_front(ray.d), "{i:?} {ray:?}");
                }
                let tilt = dot(double(i.n), unit(tangent(p, pass.u)));
                assert!(form == CURVE_RIBBON || tilt.abs() < 0.05, "{tilt}: {i:?} {case:?}");
            }
            None => {
                n_misses += 1;
                let missed = real.iter().find(is_sure);
                assert!(missed.is_none(), "{missed:?} {case:?} {ray:?}");
            }
        }
    }
    assert!(
        n_hits.iter().all(|&n| n > 2_000) && n_misses > 5_000,
        "{n_hits:?} {n_misses} {n_unclear}"
    );
}

/// A straight thread of even width is convex: rays that leave it never meet it again.
#[test]
fn rays_leave_straight_curves() {
    let mut rng = Rng::new(2);
    let mut n_cases = [0; 3];
    while n_cases.iter().sum::<u32>() < 150_000 {
        let form = rng.below(3);
        let case = random_case(&mut rng, form, true);
        let ray = ray_at(&mut rng, &case);
        let scene = scene_of(&case);
        let view = scene.view();
        let Some(hit) = hit_of(&view, PRIM, &ray) else { continue };
        let i = surface_interaction(&view, &hit, &ray);
        n_cases[form as usize] += 1;
        for side in [1.0, -1.0] {
            let away = i.spawn(leaving(&mut rng, i.n, side), 0.0);
            assert_eq!(case.curve.intersect(&view, &away), None, "{case:?} {i:?} {away:?}");
        }
    }
    assert!(n_cases.iter().all(|&n| n > 10_000), "{n_cases:?}");
}

/// From bent ones, they meet it again only farther away.
#[test]
fn rays_leave_bent_curves() {
    let mut rng = Rng::new(3);
    let (mut n_cases, mut n_again) = (0, 0);
    while n_cases < 50_000 {
        let form = rng.below(3);
        let mut case = random_case(&mut rng, form, false);
        case.curve.widths[1] = case.curve.widths[0];
        let ray = ray_at(&mut rng, &case);
        let scene = scene_of(&case);
        let view = scene.view();
        let Some(hit) = hit_of(&view, PRIM, &ray) else { continue };
        let i = surface_interaction(&view, &hit, &ray);
        n_cases += 1;
        for side in [1.0, -1.0] {
            let w = leaving(&mut rng, i.n, side);
            let away = i.spawn(w, 0.0);
            let Some(t) = case.curve.intersect(&view, &away) else { continue };
            n_again += 1;
            // Along a ribbon, rounding decides what it touches.
            let next =
                hit_of(&view, PRIM, &away).map(|hit| surface_interaction(&view, &hit, &away));
            if form == CURVE_RIBBON
                && next.is_none_or(|next| {
                    let at = |i: &SurfaceInteraction| {
                        tightness(&case, double(away.d), f64::from(i.uv[0]))
                    };
                    crate::math::dot(next.n, away.d).abs() < 1e-2 || at(&next).max(at(&i)) > 0.2
                })
            {
                continue;
            }
            // To meet it where it bends by r, a ray must go along it, or far.
            let real = passes(&case, &away, 20_000);
            let t = f64::from(t);
            let width = f64::from(case.curve.widths[0]);
            let is_real = real.iter().any(|r| {
                r.t > 0.0 && (r.t - t).abs() < 0.4 * width + 0.1 * t && r.side.abs() < 1.05
            });
            assert!(is_real, "{t} {real:?} {case:?} {i:?} {away:?}");
        }
    }
    assert!(n_again * 5 < n_cases, "{n_again} of {n_cases}");
}

/// Rays at the ends at which parts of a curve meet do not slip through.
#[test]
fn parts_leave_no_gaps() {
    let mut rng = Rng::new(4);
    for _ in 0..30_000 {
        let form = rng.below(3);
        let whole = random_case(&mut rng, form, false);
        let p = whole.curve.points.map(double);
        let n = 4;
        let mut scene = TestScene::default();
        scene.ribbons.push(whole.ribbon);
        for k in 0..n {
            let (a, b) = (f64::from(k) / f64::from(n), f64::from(k + 1) / f64::from(n));
            let at = |u: f64| {
                let [w0, w1] = whole.curve.widths.map(f64::from);
                (w0 + (w1 - w0) * u) as f32
            };
            scene.curves.push(Curve {
                points: [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|u| single(blossom(p, u))),
                widths: [at(a), at(b)],
                u: [a as f32, b as f32],
                ..whole.curve
            });
        }
        let view = scene.view();
        for _ in 0..10 {
            let u = f64::from(1 + rng.below(n - 1)) / f64::from(n);
            let d = double(rng.direction());
            let c = axis(p, u);
            if tightness(&whole, d, u) > 0.2 {
                continue;
            }
            let tangent = unit(tangent(p, u));
            if length(cross(tangent, d)) < 0.3 {
                continue;
            }
            let n = if form == CURVE_RIBBON {
                let (a, b) = (double(whole.ribbon.start), double(whole.ribbon.end));
                unit(mix(a, b, u))
            } else {
                d
            };
            let b = unit(cross(tangent, n));
            if dot(cross(tangent, b), d).abs() < 0.3 {
                continue;
            }
            let [w0, w1] = whole.curve.widths.map(f64::from);
            let aim = add(c, scaled(b, rng.range(-0.4, 0.4) * (w0 + (w1 - w0) * u)));
            let o = single(sub(aim, scaled(d, 3.0 * whole.size)));
            let ray = Ray { o, d: single(d), time: 0.0 };
            let hit = (0..4).any(|k| hit_of(&view, prim(PrimKind::Curve, k), &ray).is_some());
            assert!(hit, "a gap at {u}: {whole:?} {ray:?}");
        }
    }
}

#[test]
fn cylinders_have_round_normals_and_flat_curves_face_the_ray() {
    let thread = |form| Curve {
        points: [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0].map(|y| single([0.0, y, 0.0])),
        widths: [0.2; 2],
        u: [0.0, 1.0],
        material: ANY_MATERIAL,
        form,
        ribbon: 0,
        n_halvings: 0,
    };
    for (form, x) in [(CURVE_FLAT, 0.05), (CURVE_CYLINDER, 0.05), (CURVE_CYLINDER, -0.08)] {
        let scene = TestScene { curves: vec![thread(form)], ..TestScene::default() };
        let view = scene.view();
        let d = single([0.0, 0.0, -1.0]);
        let ray = Ray { o: single([x, 0.1, 5.0]), d, time: 0.0 };
        let hit = hit_of(&view, PRIM, &ray).unwrap();
        let i = surface_interaction(&view, &hit, &ray);
        let nx = if form == CURVE_CYLINDER { x / 0.1 } else { 0.0 };
        let expected = single([nx, 0.0, (1.0 - nx * nx).sqrt()]);
        assert!((i.n - expected).length() < 1e-5, "{i:?} {expected:?}");
        assert!((hit.t - 5.0).abs() < 1e-5);
        // u runs along it, and v x u is the normal of the flat one.
        assert!((f64::from(i.uv[0]) - 0.55).abs() < 1e-5, "{i:?}");
        assert!((i.dpdu - single([0.0, 2.0, 0.0])).length() < 0.2, "{i:?}");
        let front = crate::math::cross(i.dpdv, i.dpdu);
        assert!(front.z > 0.0 && (i.dpdv.length() - 0.2).abs() < 1e-5, "{i:?}");
        assert!((0.1 * (2.0 * i.uv[1] - 1.0) * i.dpdv.x.signum() - x as f32).abs() < 1e-5);
        // Beside it there is nothing.
        let beside = Ray { o: single([0.101, 0.1, 5.0]), d, time: 0.0 };
        assert!(hit_of(&view, PRIM, &beside).is_none());
        let above = Ray { o: single([0.0, 1.01, 5.0]), d, time: 0.0 };
        assert!(hit_of(&view, PRIM, &above).is_none());
    }
}

/// Nothing hostile: no width, no length, all points in one place, seen along the axis.
#[test]
fn degenerate_curves_give_no_nonsense() {
    let mut rng = Rng::new(5);
    for _ in 0..50_000 {
        let mut case = random_case(&mut rng, 0, false);
        case.curve.form = rng.below(3);
        let c = &mut case.curve;
        match rng.below(5) {
            0 => c.points = [c.points[0]; 4],
            1 => c.widths = [0.0; 2],
            2 => (c.points[1], c.points[2]) = (c.points[0], c.points[3]),
            3 => c.points[3] = c.points[0],
            _ => (case.ribbon.start, case.ribbon.end) = (Vec3::ZERO, Vec3::ZERO),
        }
        c.n_halvings = rng.below(11);
        let scene = scene_of(&case);
        let view = scene.view();
        let mut ray = ray_at(&mut rng, &case);
        if rng.chance(0.3) {
            let chord = double(case.curve.points[3] - case.curve.points[0]);
            if length(chord) > 0.0 {
                ray.o = single(sub(double(case.curve.points[0]), chord));
                ray.d = single(unit(chord));
            }
        }
        if let Some(hit) = hit_of(&view, PRIM, &ray) {
            assert!(hit.t >= 0.0 && hit.t.is_finite());
            let i = surface_interaction(&view, &hit, &ray);
            check_interaction(&i);
            assert!(i.p.to_array().iter().all(|x| x.is_finite()));
        }
    }
}
