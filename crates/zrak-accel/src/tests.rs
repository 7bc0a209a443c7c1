//! Trees hold every primitive once, in boxes that hold it, and are never too deep.

use std::collections::HashMap;

use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::math::{Bounds, Vec3, vec3};
use zrak_core::scene::{PrimKind, PrimRef};

use proptest::prelude::*;

use crate::build_trees;

mod layout;
mod quality;

fn prims(bounds: Vec<Bounds>) -> Vec<(PrimRef, Bounds)> {
    let handle = |i: usize| PrimRef::new(PrimKind::Sphere, i as u32);
    bounds.into_iter().enumerate().map(|(i, bounds)| (handle(i), bounds)).collect()
}

fn child_bounds<const N: usize>(node: &Node<N>, i: usize) -> Bounds {
    let corner = |planes: &[[f32; N]; 3]| vec3(planes[0][i], planes[1][i], planes[2][i]);
    Bounds { lo: corner(&node.lo), hi: corner(&node.hi) }
}

/// Walks the tree with this root and checks what is promised of it; returns its depth and the number
/// of its nodes.
fn check_tree<const N: usize>(
    nodes: &[Node<N>],
    root: u32,
    prims: &[(PrimRef, Bounds)],
) -> (usize, usize) {
    let mut bounds_of: HashMap<PrimRef, Bounds> = prims.iter().copied().collect();
    let mut n_visited = 0;
    let mut depth_max = 0;
    // Node, its depth, and the box that its parent keeps of it.
    let mut stack = vec![(root as usize, 1_usize, None::<Bounds>)];
    while let Some((index, depth, outer)) = stack.pop() {
        n_visited += 1;
        depth_max = depth_max.max(depth);
        let node = &nodes[index];
        let mut all = Bounds::EMPTY;
        for (i, child) in node.children.iter().enumerate() {
            let bounds = child_bounds(node, i);
            if *child == PrimRef::NONE {
                // No primitive may hide behind an empty slot, and no ray from nearby meets it.
                assert!(bounds == child_bounds(&Node::<N>::EMPTY, i));
                continue;
            }
            all = all.union(bounds);
            if child.is_node() {
                let child = child.index() as usize;
                assert!(child > index, "children come after their parents");
                stack.push((child, depth + 1, Some(bounds)));
            } else {
                let own = bounds_of.remove(child);
                assert_eq!(
                    own,
                    Some(bounds),
                    "a leaf's box is its primitive's, and it has one leaf"
                );
            }
        }
        if let Some(outer) = outer {
            assert_eq!(outer, all, "a box is the union of those below");
        }
    }
    assert!(bounds_of.is_empty(), "a primitive is missing");
    assert!(depth_max <= MAX_DEPTH, "{depth_max}");
    (depth_max, n_visited)
}

/// Depths of both trees.
fn check(bounds: Vec<Bounds>) -> [usize; 2] {
    let prims = prims(bounds);
    let trees = build_trees(&prims);
    let n = prims.len();
    assert_eq!(trees.nodes2.len(), n.saturating_sub(1).max(1));
    let (depth2, n2) = check_tree(&trees.nodes2, 0, &prims);
    let (depth8, n8) = check_tree(&trees.nodes8, 0, &prims);
    assert_eq!([n2, n8], [trees.nodes2.len(), trees.nodes8.len()], "all nodes are in the tree");
    [depth2, depth8]
}

fn at(p: Vec3, r: f32) -> Bounds {
    Bounds { lo: p - Vec3::splat(r), hi: p + Vec3::splat(r) }
}

/// Numbers in [0, 1), by a hash of the index.
fn unit(i: u32, k: u32) -> f32 {
    let h = zrak_core::math::lowbias32(i.wrapping_mul(3).wrapping_add(k).wrapping_add(77));
    zrak_core::math::unit_f32(h)
}

#[test]
fn few_and_none() {
    assert_eq!(check(vec![]), [1, 1]);
    assert_eq!(check(vec![at(Vec3::ZERO, 1.0)]), [1, 1]);
    for n in 2..40 {
        check((0..n).map(|i| at(vec3(i as f32, 0.0, 0.0), 0.4)).collect());
    }
    // Eight fit one wide node.
    let eight = (0..8).map(|i| at(vec3(i as f32, 0.0, 0.0), 0.4)).collect();
    assert_eq!(check(eight)[1], 1);
}

#[test]
fn all_in_one_place() {
    for n in [2, 9, 100, 5000] {
        let depths = check(vec![at(vec3(3.0, -1.0, 2.0), 0.5); n]);
        // Halved all the way.
        assert_eq!(depths[0], (n - 1).ilog2() as usize + 1);
        // The same centre, with other sizes.
        check((0..n).map(|i| at(Vec3::ZERO, 1.0 + i as f32)).collect());
        // Flat, and points.
        check(vec![Bounds::of_points(Vec3::ZERO, Vec3::ZERO); n]);
        check((0..n).map(|i| at(vec3(i as f32, 0.0, 0.0), 0.0)).collect());
    }
}

#[test]
fn sizes_that_grow_exponentially() {
    // The best split takes one primitive off at a time: the depth must be stopped.
    for ratio in [1.01_f32, 1.1, 1.5, 2.0, 4.0] {
        let n = ((1e30_f32).ln() / ratio.ln()).min(5000.0) as i32;
        let bounds: Vec<Bounds> = (0..n)
            .map(|i| {
                let x = 1e-10 * ratio.powi(i);
                Bounds { lo: vec3(x, 0.0, 0.0), hi: vec3(x * 1.001, x * 0.001, x * 0.001) }
            })
            .collect();
        check(bounds);
        let nested = (0..n).map(|i| at(Vec3::ZERO, 1e-10 * ratio.powi(i))).collect();
        check(nested);
    }
}

#[test]
fn a_hundred_thousand() {
    let n = 100_000;
    let scattered = (0..n)
        .map(|i| at(vec3(unit(i, 0), unit(i, 1), unit(i, 2)) * 100.0, 0.1 * unit(i, 3)))
        .collect();
    let [depth2, depth8] = check(scattered);
    assert!(depth2 < 40 && depth8 < 20, "{depth2} {depth8}");
    check((0..n).map(|i| at(vec3(i as f32, 0.0, 0.0), 0.5)).collect());
    // Two heaps far apart, and many in one place.
    check(
        (0..n)
            .map(|i| at(vec3(if i % 2 == 0 { 0.0 } else { 1e9 }, unit(i / 10, 0), 0.0), 1e-3))
            .collect(),
    );
}

#[test]
fn infinite_boxes() {
    let (inf, max) = (f32::INFINITY, f32::MAX);
    let extremes = [
        [-inf, inf],
        [0.0, inf],
        [-inf, 0.0],
        [-max, max],
        [max, max],
        [-max, -max],
        [max, inf],
        [0.0, 0.0],
        [-0.0, 0.0],
        [1e-45, 1e-44],
    ];
    let side = |i: u32| extremes[i as usize % extremes.len()];
    let odd = |i: u32| {
        let [x, y, z] = [side(i), side(i / 10), side(i / 100)];
        Bounds { lo: vec3(x[0], y[0], z[0]), hi: vec3(x[1], y[1], z[1]) }
    };
    // Alone, and among boxes of usual size, in sets that are swept, binned, and binned in parallel.
    for n in [1000, 5000, 70_000] {
        check((0..1000).map(odd).collect());
        let usual = |i: u32| at(vec3(unit(i, 0), unit(i, 1), unit(i, 2)), 0.01);
        let bounds = (0..n).map(|i| if i % 7 == 0 { odd(i) } else { usual(i) }).collect();
        check(bounds);
        let one = (0..n).map(|i| if i == n / 2 { odd(0) } else { usual(i) }).collect();
        check(one);
    }
}

#[test]
fn huge_and_tiny_coordinates() {
    let n = 6000;
    let spread = |i: u32| {
        let e = |k| {
            10.0_f32.powf(unit(i, k) * 30.0 - 15.0) * if unit(i, k + 3) < 0.5 { -1.0 } else { 1.0 }
        };
        at(vec3(e(0), e(1), e(2)), e(6).abs())
    };
    check((0..n).map(spread).collect());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_boxes(boxes in prop::collection::vec(
        ([-8_i32..8, -8..8, -8..8], [0_i32..4, 0..4, 0..4], -3_i32..4), 0..300,
    )) {
        let bounds = boxes.into_iter().map(|(lo, size, exponent)| {
            let scale = 4.0_f32.powi(exponent);
            let lo = Vec3::from_array(lo.map(|x| x as f32)) * scale;
            Bounds { lo, hi: lo + Vec3::from_array(size.map(|x| x as f32)) * scale }
        });
        check(bounds.collect());
    }

    /// More primitives than are swept exactly, so that bins are used too.
    #[test]
    fn many_boxes(seed in any::<u32>(), n in 4000_u32..9000, spread in 0.0_f32..2.0) {
        let bounds = (0..n).map(|i| {
            let h = |k| unit(i.wrapping_add(seed), k);
            at(vec3(h(0), h(1) * spread, 0.0), h(2) * 0.01)
        });
        check(bounds.collect());
    }
}
