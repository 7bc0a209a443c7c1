//! Where nodes lie: several trees in one array, and the same ones however they are built.

use std::sync::Mutex;

use super::*;
use crate::{BuildOptions, Trees, build_trees_with};

/// Boxes of which some share a centre, and some a plane at one of the two zeros.
fn mixed(n: u32, seed: u32) -> Vec<(PrimRef, Bounds)> {
    let bounds = |i: u32| {
        let [x, y, z] = [0, 1, 2].map(|k| unit(i.wrapping_add(seed), k));
        match i % 4 {
            0 => at(vec3(0.5, 0.5, 0.25), 0.2 * x),
            1 => Bounds { lo: vec3(-0.0, y, z), hi: vec3(x, y + 0.1, z + 0.1) },
            2 => Bounds { lo: vec3(0.0, y, z - 1.0), hi: vec3(x, y + 0.1, -0.0) },
            _ => at(vec3(x, y, z), 0.01),
        }
    };
    prims((0..n).map(bounds).collect())
}

fn bytes(trees: &Trees) -> [Vec<u8>; 2] {
    [bytemuck::cast_slice(&trees.nodes2).to_vec(), bytemuck::cast_slice(&trees.nodes8).to_vec()]
}

#[test]
fn trees_follow_one_another_and_the_main_root_comes_first() {
    let sizes = [3, 0, 1, 2, 100, 5000, 1, 70_000];
    let sets: Vec<_> = sizes.iter().zip(0..).map(|(&n, seed)| mixed(n, seed)).collect();
    for main in [0, 1, 2, 50, 5000] {
        let main = mixed(main, 99);
        let mut trees = Trees::new();
        let roots: Vec<[u32; 2]> = sets.iter().map(|set| trees.append(set)).collect();
        trees.set_root(&main);
        let mut n_nodes = [0; 2];
        for (root, prims) in roots.iter().chain(&[[0, 0]]).zip(sets.iter().chain([&main])) {
            n_nodes[0] += check_tree(&trees.nodes2, root[0], prims).1;
            n_nodes[1] += check_tree(&trees.nodes8, root[1], prims).1;
        }
        assert_eq!(n_nodes, [trees.nodes2.len(), trees.nodes8.len()], "no node is left over");
    }
}

#[test]
fn a_tree_does_not_depend_on_threads_or_order() {
    for n in [100, 5000, 200_000] {
        let prims = mixed(n, 7);
        let one = build_trees(&prims);
        let expected = bytes(&one);
        for n_threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build();
            let trees = pool.expect("threads can be started").install(|| build_trees(&prims));
            assert!(bytes(&trees) == expected, "{n} primitives on {n_threads} threads");
        }
        let mut shuffled = prims;
        shuffled.sort_by_key(|(prim, _)| zrak_core::math::lowbias32(prim.0));
        assert!(bytes(&build_trees(&shuffled)) == expected, "{n} primitives in another order");
    }
}

#[test]
fn zeros_of_inner_boxes_are_positive() {
    let trees = build_trees(&mixed(5000, 3));
    for node in &trees.nodes2 {
        for slot in (0..2).filter(|&slot| node.children[slot].is_node()) {
            let planes = node.lo.iter().chain(&node.hi).map(|plane| plane[slot]);
            assert!(planes.into_iter().all(|x| x.to_bits() != (-0.0_f32).to_bits()));
        }
    }
}

#[test]
fn progress_is_told_and_ends_at_one() {
    for n in [2, 100, 5000, 100_000] {
        let shares = Mutex::new(Vec::new());
        let tell = |share: f32| shares.lock().expect("no test panics here").push(share);
        let options = BuildOptions { progress: Some(&tell) };
        let prims = mixed(n, 1);
        let told = build_trees_with(&prims, &options);
        assert!(bytes(&told) == bytes(&build_trees(&prims)), "telling changes nothing");
        let mut shares = shares.into_inner().expect("no test panics here");
        shares.sort_by(f32::total_cmp);
        assert!((1..=201).contains(&shares.len()), "{}", shares.len());
        assert!(shares[0] > 0.0 && shares[shares.len() - 1] == 1.0, "{shares:?}");
        if n == 100_000 {
            assert!(shares.len() > 20 && shares[0] < 0.2, "{shares:?}");
        }
    }
}

#[test]
fn there_is_room_for_as_many_nodes_as_handles_can_tell_apart() {
    let max = 1 << 28;
    let mut trees = Trees::new();
    for (n, expected) in [(0, true), (max, true), (max + 1, false), (usize::MAX, false)] {
        assert_eq!(trees.has_room_for(n), expected, "{n}");
    }
    trees.append(mixed(11, 0));
    assert!(trees.has_room_for(max - 10) && !trees.has_room_for(max - 9));
}
