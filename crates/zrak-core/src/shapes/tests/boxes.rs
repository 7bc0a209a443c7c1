//! Boxes against slabs in `f64`.

use super::super::{Box3, Convex, Shape};
use super::check_interaction;
use crate::math::{Vec3, vec3};
use crate::ray::Ray;
use crate::testing::{ANY_MATERIAL, D3, Rng, add, cross, double, scaled, single};

pub(super) fn box3(lo: Vec3, hi: Vec3) -> Box3 {
    Box3 { lo, material: ANY_MATERIAL, hi, _pad: 0 }
}

pub(super) fn random_box(rng: &mut Rng) -> Box3 {
    let size = rng.log_range(1e-3, 1e5);
    let away = if rng.chance(0.3) { 0.0 } else { size * rng.log_range(0.1, 1e3) };
    let lo = rng.in_cube(away);
    let sides: D3 = std::array::from_fn(|_| size * rng.log_range(0.01, 1.0));
    box3(lo, single(add(double(lo), sides)))
}

/// Interval of the line inside, and the axes of its ends.
fn exact(b: &Box3, ray: &Ray) -> ([f64; 2], [usize; 2]) {
    let (lo, hi, o, d) = (double(b.lo), double(b.hi), double(ray.o), double(ray.d));
    let (mut t, mut axes) = ([f64::NEG_INFINITY, f64::INFINITY], [0, 0]);
    for axis in 0..3 {
        let (a, b) = ((lo[axis] - o[axis]) / d[axis], (hi[axis] - o[axis]) / d[axis]);
        let (a, b) = if d[axis] == 0.0 {
            let inside = lo[axis] < o[axis] && o[axis] < hi[axis];
            if inside { (f64::NEG_INFINITY, f64::INFINITY) } else { (1.0, -1.0) }
        } else {
            (a.min(b), a.max(b))
        };
        if a > t[0] {
            (t[0], axes[0]) = (a, axis);
        }
        if b < t[1] {
            (t[1], axes[1]) = (b, axis);
        }
    }
    (t, axes)
}

fn random(rng: &mut Rng) -> (Box3, Ray) {
    let b = random_box(rng);
    let size = f64::from((b.hi - b.lo).max_component());
    let aim: D3 = {
        let (lo, hi) = (double(b.lo), double(b.hi));
        std::array::from_fn(|i| lo[i] + (hi[i] - lo[i]) * rng.range(-0.2, 1.2))
    };
    let d = rng.direction();
    let back = if rng.chance(0.3) { rng.range(-0.5, 0.5) } else { rng.log_range(0.5, 1e4) };
    (b, Ray { o: single(add(aim, scaled(double(d), -back * size))), d, time: 0.0 })
}

#[test]
fn crossings_are_those_of_the_slabs() {
    let mut rng = Rng::new(1);
    let mut n_hits = 0;
    for _ in 0..400_000 {
        let (b, ray) = random(&mut rng);
        let ([enter, leave], _) = exact(&b, &ray);
        // Parameters have three roundings each, and the origin counts as exact.
        let close = |t: f32, exact: f64| (f64::from(t) - exact).abs() <= 4e-7 * exact.abs();
        let surely_hits = enter <= leave - 4e-7 * (enter.abs() + leave.abs()) && leave > 0.0;
        let in_a_face = (0..3).any(|a| {
            let o = ray.o.to_array()[a];
            ray.d.to_array()[a] == 0.0 && (o == b.lo.to_array()[a] || o == b.hi.to_array()[a])
        });
        // Which may hit or miss.
        if in_a_face {
            continue;
        }
        match b.intersect(&ray) {
            Some(t) => {
                n_hits += 1;
                assert!(t > 0.0);
                assert!(close(t, if enter > 0.0 { enter } else { leave }), "{t} {enter} {leave}");
                let i = b.interaction(&ray, t);
                check_interaction(&i);
                // The point is on the face that the normal belongs to, exactly.
                let (p, n) = (i.p.to_array(), i.n.to_array());
                let (lo, hi) = (b.lo.to_array(), b.hi.to_array());
                let axis = (0..3).find(|&a| n[a] != 0.0).unwrap();
                assert!(n.iter().map(|x| x.abs()).sum::<f32>() == 1.0);
                assert_eq!(p[axis], if n[axis] > 0.0 { hi[axis] } else { lo[axis] });
                assert!((0..3).all(|a| (lo[a]..=hi[a]).contains(&p[a])), "{i:?}");
                // From outside the normal points against the ray, from inside along it.
                let along = n[axis] * ray.d.to_array()[axis];
                assert!(if enter > 0.0 { along < 0.0 } else { along > 0.0 });
                assert!(i.uv.iter().all(|x| (0.0..=1.0).contains(x)));
            }
            None => assert!(!surely_hits, "{b:?} {ray:?}"),
        }
        match b.interval(&ray) {
            Some([start, end]) => {
                assert!(start >= 0.0 && end >= start);
                assert!(close(start, enter.max(0.0)) || (enter < 0.0 && start == 0.0));
                assert!(close(end, leave));
            }
            None => assert!(!surely_hits),
        }
    }
    assert!(n_hits > 150_000, "{n_hits}");
}

#[test]
fn surely_inside_is_inside() {
    let mut rng = Rng::new(2);
    let mut n_inside = 0;
    for _ in 0..200_000 {
        let b = random_box(&mut rng);
        let (lo, hi) = (double(b.lo), double(b.hi));
        let p: D3 = std::array::from_fn(|i| lo[i] + (hi[i] - lo[i]) * rng.range(-0.01, 1.01));
        let p = single(p);
        let error = rng.in_cube(f64::from((b.hi - b.lo).max_component()) * 1e-3).abs();
        if b.surely_contains(p, error, 0.0) {
            n_inside += 1;
            let (p, e) = (double(p), double(error));
            assert!((0..3).all(|i| p[i] - e[i] > lo[i] && p[i] + e[i] < hi[i]));
        }
    }
    assert!(n_inside > 50_000);
    // A point of the boundary is not.
    let b = box3(Vec3::ZERO, Vec3::splat(1.0));
    assert!(!b.surely_contains(vec3(0.0, 0.5, 0.5), Vec3::ZERO, 0.0));
    assert!(!b.surely_contains(vec3(0.5, 0.5, 1.0), Vec3::ZERO, 0.0));
}

/// On every face u x v is the outward normal, and both run from 0 to 1.
#[test]
fn texture_coordinates_run_so_that_u_cross_v_points_out() {
    let b = box3(vec3(-1.0, -2.0, -3.0), vec3(1.0, 2.0, 3.0));
    let uv_at = |p: D3, n: D3| {
        let ray = Ray { o: single(add(p, scaled(n, 5.0))), d: single(scaled(n, -1.0)), time: 0.0 };
        let i = b.interaction(&ray, b.intersect(&ray).unwrap());
        assert_eq!(double(i.n), n);
        i.uv
    };
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut n = [0.0; 3];
            n[axis] = side;
            let mut p = [0.3, 0.4, 0.5];
            p[axis] = side * f64::from(b.hi.to_array()[axis]);
            let at = uv_at(p, n);
            // The gradients of u and v on the face, by differences.
            let mut gradients = [[0.0; 3]; 2];
            for i in (0..3).filter(|&i| i != axis) {
                let mut q = p;
                q[i] += 0.25;
                let moved = uv_at(q, n);
                for k in 0..2 {
                    gradients[k][i] = f64::from(moved[k] - at[k]) / 0.25;
                }
            }
            let normal = crate::testing::unit(cross(gradients[0], gradients[1]));
            assert!(crate::testing::dot(normal, n) > 0.999, "axis {axis}, side {side}");
            // From rim to rim they go from 0 to 1.
            for k in 0..2 {
                let i = (0..3).find(|&i| gradients[k][i] != 0.0).unwrap();
                let width = 2.0 * f64::from(b.hi.to_array()[i]);
                assert!((gradients[k][i].abs() * width - 1.0).abs() < 1e-4);
            }
        }
    }
}

#[test]
fn rays_along_the_axes_and_in_the_faces() {
    let b = box3(Vec3::ZERO, Vec3::splat(1.0));
    let ray = |o: [f32; 3], d: [f32; 3]| Ray {
        o: Vec3::from_array(o),
        d: Vec3::from_array(d),
        time: 0.0,
    };
    assert_eq!(b.intersect(&ray([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0])), Some(1.0));
    assert_eq!(b.intersect(&ray([-1.0, 0.5, 0.5], [1.0, -0.0, -0.0])), Some(1.0));
    assert_eq!(b.intersect(&ray([0.5, 0.5, 0.5], [0.0, -1.0, 0.0])), Some(0.5));
    assert_eq!(b.intersect(&ray([2.0, 0.5, 0.5], [1.0, 0.0, 0.0])), None);
    assert_eq!(b.intersect(&ray([-1.0, 1.5, 0.5], [1.0, 0.0, 0.0])), None);
    // From a face outwards: nothing; inwards: the other side.
    assert_eq!(b.intersect(&ray([1.0, 0.5, 0.5], [1.0, 0.0, 0.0])), None);
    assert_eq!(b.intersect(&ray([1.0, 0.5, 0.5], [-1.0, 0.0, 0.0])), Some(1.0));
}
