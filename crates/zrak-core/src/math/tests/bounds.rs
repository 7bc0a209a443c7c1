//! Boxes and the slab test.

use proptest::prelude::*;

use crate::math::{Bounds, SLAB_SLACK, Slab, Vec3, reciprocal_or_huge, vec3};
use crate::testing::{D3, Rng, add, double, length, scaled, single, sub, unit};

/// Coordinates of every size, with many equal ones.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (-10_i32..10).prop_map(|x| x as f32),
        4 => -1.0_f32..1.0,
        1 => -1e6_f32..1e6,
        1 => -1e-6_f32..1e-6,
        1 => -1e12_f32..1e12,
        1 => prop_oneof![Just(0.0_f32), Just(-0.0), Just(1e-38), Just(-1e-30), Just(1.0)],
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

fn direction() -> impl Strategy<Value = Vec3> {
    let component = prop_oneof![
        6 => -1.0_f32..1.0,
        1 => Just(0.0_f32),
        1 => Just(-0.0_f32),
        1 => Just(1.0_f32),
        1 => Just(-1.0_f32),
        1 => -1e-20_f32..1e-20,
        1 => -1e-30_f32..1e-30,
    ];
    [component.clone(), component.clone(), component].prop_map(Vec3::from_array)
}

fn slab(bounds: &Bounds, o: Vec3, d: Vec3) -> Option<Slab> {
    bounds.slab(o, d.map(reciprocal_or_huge))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The promise on which all culling rests: with `==` on numbers, without any tolerance.
    #[test]
    fn what_passes_a_box_passes_every_box_around_it(
        a in point(), b in point(), more in point(), other in point(), o in point(), d in direction(),
        on_face in 0..12_u32,
    ) {
        let inner = Bounds::of_points(a, b);
        let outer = inner.union(Bounds::of_points(more, other));
        // Half of the origins lie on a face of one of them.
        let mut o = o.to_array();
        let faces = [inner.lo, inner.hi, outer.lo, outer.hi];
        if on_face < 6 {
            let axis = on_face as usize % 3;
            o[axis] = faces[on_face as usize % 4].to_array()[axis];
        }
        let o = Vec3::from_array(o);
        if let Some(s) = slab(&inner, o, d) {
            let big = slab(&outer, o, d);
            prop_assert!(big.is_some(), "{inner:?} passed, {outer:?} not");
            let big = big.unwrap();
            prop_assert!(big.t_enter <= s.t_enter && big.t_leave >= s.t_leave, "{big:?} {s:?}");
            prop_assert!(s.t_enter >= 0.0);
        }
    }

    /// A ray aimed at a point of a box never misses it.
    #[test]
    fn a_ray_at_a_point_inside_passes(
        a in point(), b in point(), way in direction(), far in 0.001_f64..2.0,
        s in [0.0_f64..=1.0, 0.0..=1.0, 0.0..=1.0],
    ) {
        let bounds = Bounds::of_points(a, b).padded(0.0);
        let (lo, hi) = (double(Bounds::of_points(a, b).lo), double(Bounds::of_points(a, b).hi));
        let p: D3 = std::array::from_fn(|i| lo[i] + (hi[i] - lo[i]) * s[i]);
        // Directions are rounded, so a ray only comes as near to its aim as that is far away.
        let size = bounds.hi.abs().max_component().max(bounds.lo.abs().max_component());
        let way = double(way);
        prop_assume!(length(way) > 1e-3);
        let o = single(add(p, scaled(unit(way), -far * f64::from(size))));
        let to = sub(p, double(o));
        prop_assume!(length(to) > 0.0);
        let d = single(unit(to));
        prop_assert!(slab(&bounds, o, d).is_some());
    }
}

#[test]
fn the_interval_is_that_of_the_reals() {
    let mut rng = Rng::new(1);
    for _ in 0..300_000 {
        let (p, q) = (rng.in_cube(2.0), rng.in_cube(2.0));
        let bounds = Bounds::of_points(p, q);
        let (o, d) = (rng.in_cube(4.0), rng.direction());
        let (lo, hi) = (double(bounds.lo), double(bounds.hi));
        let (o64, d64) = (double(o), double(d));
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            if d64[axis] == 0.0 {
                if o64[axis] < lo[axis] || o64[axis] > hi[axis] {
                    leave = -1.0;
                }
                continue;
            }
            let a = (lo[axis] - o64[axis]) / d64[axis];
            let b = (hi[axis] - o64[axis]) / d64[axis];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        match slab(&bounds, o, d) {
            Some(s) => {
                assert!(enter <= leave * (1.0 + 2e-6) + 1e-9, "{enter} {leave} {s:?}");
                assert!((f64::from(s.t_enter) - enter).abs() <= 1e-6 * enter);
                let slack = f64::from(SLAB_SLACK);
                assert!((f64::from(s.t_leave) / slack - leave).abs() <= 1e-6 * leave.abs());
                assert!(f64::from(s.t_leave) >= leave, "the far end is conservative");
            }
            None => assert!(enter > leave, "missed: {enter} {leave}"),
        }
    }
}

#[test]
fn unions_and_sizes() {
    let b = Bounds::of_points(vec3(1.0, 5.0, -1.0), vec3(0.0, 7.0, 2.0));
    assert_eq!(b.union(Bounds::EMPTY), b);
    assert_eq!((b.lo, b.hi), (vec3(0.0, 5.0, -1.0), vec3(1.0, 7.0, 2.0)));
    assert_eq!(b.center(), vec3(0.5, 6.0, 0.5));
    assert_eq!(b.half_area(), 2.0 + 6.0 + 3.0);
    assert_eq!(Bounds::EMPTY.half_area(), 0.0);
}

#[test]
fn padding_gives_flat_boxes_a_volume() {
    for at in [0.5_f32, 1.0, -3.0, 1e5, -1e-3] {
        let flat =
            Bounds::of_points(vec3(-1.0, at, -1.0) * at.abs(), vec3(1.0, at, 1.0) * at.abs());
        let padded = flat.padded(0.0);
        assert!(padded.lo.y < flat.lo.y && padded.hi.y > flat.hi.y);
        let p = add(double(padded.hi), scaled(double(padded.lo), -1.0));
        assert!(p.iter().all(|&side| side > 0.0));
    }
}
