//! Trees are about as good as exact methods make them, and their measure is right.

use super::*;
use crate::binary::build_swept;
use crate::progress::{BuildOptions, Progress};
use crate::record::Record;
use crate::{sah_cost, sah_cost_of};

fn scattered(n: u32, seed: u32) -> Vec<(PrimRef, Bounds)> {
    let p = |i: u32| [0, 1, 2].map(|k| unit(i.wrapping_add(seed), k));
    let size = |i: u32| if i.is_multiple_of(100) { 0.1 } else { 0.01 };
    prims((0..n).map(|i| at(Vec3::from_array(p(i)), size(i) * unit(i, 4))).collect())
}

/// A wavy sheet.
fn sheet(side: u32) -> Vec<(PrimRef, Bounds)> {
    let cell = |i: u32| {
        let (x, z) = ((i % side) as f32, (i / side) as f32);
        at(vec3(x, 0.02 * (x * (side as f32 - x) + z * z * 0.5), z), 0.6)
    };
    prims((0..side * side).map(cell).collect())
}

fn area(b: Bounds) -> f64 {
    f64::from(b.half_area())
}

/// Sum of the areas of the nodes below the root, relative to the root's: what a ray visits beside the
/// primitives.
fn inner_area<const N: usize>(nodes: &[Node<N>]) -> f64 {
    let mut sum = 0.0;
    let mut root = Bounds::EMPTY;
    for (index, node) in nodes.iter().enumerate() {
        for (i, child) in node.children.iter().enumerate().filter(|c| *c.1 != PrimRef::NONE) {
            let bounds = child_bounds(node, i);
            if child.is_node() {
                sum += area(bounds);
            }
            if index == 0 {
                root = root.union(bounds);
            }
        }
    }
    sum / area(root)
}

/// The same of the wide tree whose nodes adopt the children of their largest child until they are full
/// (Wald, Benthin and Boulos, *Getting Rid of Packets*, 2008, section 3.3).
fn inner_area_of_greedy(nodes: &[Node<2>]) -> f64 {
    let mut sum = 0.0;
    let mut stack = vec![0_usize];
    let mut root = Bounds::EMPTY;
    while let Some(index) = stack.pop() {
        let pair = |i: usize| [0, 1].map(|k| (child_bounds(&nodes[i], k), nodes[i].children[k]));
        let mut children = pair(index).to_vec();
        if index == 0 {
            root = children[0].0.union(children[1].0);
        }
        while children.len() < 8 {
            let inner = (0..children.len()).filter(|&i| children[i].1.is_node());
            let largest =
                inner.max_by(|&a, &b| area(children[a].0).total_cmp(&area(children[b].0)));
            let Some(i) = largest else { break };
            let below = children.swap_remove(i).1;
            children.extend(pair(below.index() as usize));
        }
        for (bounds, child) in children.into_iter().filter(|c| c.1.is_node()) {
            sum += area(bounds);
            stack.push(child.index() as usize);
        }
    }
    sum / area(root)
}

#[test]
fn the_measure_of_a_known_tree() {
    let unit_cube = |x: f32| Bounds { lo: vec3(x, 0.0, 0.0), hi: vec3(x + 1.0, 1.0, 1.0) };
    // None; one that fills the root; two of half-area 3 in a root of 1 x 1 x 4, whose half-area is 9.
    for (xs, expected) in [(vec![], 0.0), (vec![5.0], 2.0), (vec![0.0, 3.0], 1.0 + 2.0 * 3.0 / 9.0)]
    {
        let trees = build_trees(&prims(xs.iter().map(|&x| unit_cube(x)).collect()));
        assert_eq!([sah_cost(&trees.nodes2), sah_cost(&trees.nodes8)], [expected; 2]);
    }
    // Three: the pair at 0 and 1 has 1 x 1 x 2, half-area 5, the root 1 x 1 x 11, half-area 23.
    let three = prims([0.0, 10.0, 1.0].map(unit_cube).to_vec());
    let mut trees = build_trees(&scattered(100, 1));
    let [root2, root8] = trees.append(&three);
    let leaves = 3.0 * 3.0 / 23.0;
    assert_eq!(sah_cost_of(&trees.nodes2, root2), 1.0 + (leaves + 5.0 / 23.0));
    assert!((sah_cost_of(&trees.nodes8, root8) - (1.0 + leaves)).abs() < 1e-12);
}

#[test]
fn bins_are_nearly_as_good_as_the_exact_sweep() {
    for prims in [scattered(4000, 5), sheet(60)] {
        let [exact, binned] = [4096, 32].map(|n_swept| {
            let records: Vec<Record> = prims.iter().map(Record::new).collect();
            let mut nodes = vec![Node::EMPTY; prims.len() - 1];
            let progress = Progress::new(&BuildOptions::default(), prims.len());
            build_swept(records, &mut nodes, 0, n_swept, &progress);
            check_tree(&nodes, 0, &prims);
            sah_cost(&nodes)
        });
        assert!(binned < 1.02 * exact, "{binned} {exact}");
    }
}

#[test]
fn wide_nodes_are_chosen_better_than_greedily() {
    let mut saved = 0.0;
    for n in 9..200 {
        let trees = build_trees(&scattered(n, 1000 * n));
        let (chosen, greedy) = (inner_area(&trees.nodes8), inner_area_of_greedy(&trees.nodes2));
        assert!(chosen <= greedy * (1.0 + 1e-5), "{n}: {chosen} {greedy}");
        saved += 1.0 - chosen / greedy;
    }
    assert!(saved > 0.0);
    for prims in [scattered(10_000, 5), sheet(100)] {
        let trees = build_trees(&prims);
        let (chosen, greedy) = (inner_area(&trees.nodes8), inner_area_of_greedy(&trees.nodes2));
        assert!(chosen < 0.98 * greedy, "{chosen} {greedy}");
    }
}
