//! The check of trees in pieces against one that looks at all nodes in turn.

use std::sync::OnceLock;

use proptest::prelude::*;
use zrak_accel::Trees;
use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::math::{Bounds, Vec3, lowbias32, unit_f32, vec3};
use zrak_core::media::VACUUM;
use zrak_core::scene::{Globals, MaterialKind, MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{Instance, NO_MOTION, Sphere};

use crate::arena::{SceneArena, SceneArrays};

/// Whether these are trees, the first node's and those of `roots`, over primitives that are there.
fn are_trees<const N: usize>(nodes: &[Node<N>], roots: &[u32], arrays: &SceneArrays) -> bool {
    let mut depths = vec![None; nodes.len()];
    depths[0] = Some((1, false));
    for &root in roots {
        if root == 0 || root as usize >= nodes.len() {
            return false;
        }
        depths[root as usize] = Some((1, true));
    }
    for (i, node) in nodes.iter().enumerate() {
        let Some((depth, is_placed)) = depths[i] else { return false };
        if depth > MAX_DEPTH {
            return false;
        }
        for child in node.children.into_iter().filter(|&child| child != PrimRef::NONE) {
            let c = child.index() as usize;
            let is_good = match child.kind() {
                Some(PrimKind::Node) => c > i && c < nodes.len() && depths[c].is_none(),
                Some(PrimKind::Sphere) => c < arrays.spheres.len(),
                Some(PrimKind::Instance) => c < arrays.instances.len() && !is_placed,
                _ => false,
            };
            if !is_good {
                return false;
            }
            if child.is_node() {
                depths[c] = Some((depth + 1, is_placed));
            }
        }
    }
    true
}

/// Trees of many pieces: three that are placed some times each, and the world's.
fn forest() -> &'static SceneArrays {
    static FOREST: OnceLock<SceneArrays> = OnceLock::new();
    FOREST.get_or_init(|| {
        let mut arrays = SceneArrays::default();
        arrays.lambertians.push(bytemuck::Zeroable::zeroed());
        let material = MaterialRef::new(MaterialKind::Lambertian, 0);
        let mut spheres = |n: u32| -> Vec<(PrimRef, Bounds)> {
            let first = arrays.spheres.len() as u32;
            (first..first + n)
                .map(|i| {
                    let [x, y, z] = [0, 1, 2].map(|k| unit_f32(lowbias32(3 * i + k)));
                    let (center, radius) = (vec3(x, y, z), 0.01);
                    arrays.spheres.push(Sphere {
                        center,
                        radius,
                        material,
                        flags: 0,
                        _pad: [0; 2],
                    });
                    let r = Vec3::splat(radius);
                    (PrimRef::new(PrimKind::Sphere, i), Bounds { lo: center - r, hi: center + r })
                })
                .collect()
        };
        let sets = [6000, 1, 5000].map(&mut spheres);
        let mut world = spheres(10_000);
        let mut trees = Trees::new();
        for set in sets {
            let [root2, root8] = trees.append(set);
            for _ in 0..3 {
                let i = arrays.instances.len() as u32;
                let mut instance: Instance = bytemuck::Zeroable::zeroed();
                (instance.root2, instance.root8, instance.motion) = (root2, root8, NO_MOTION);
                arrays.instances.push(instance);
                let bounds = Bounds { lo: Vec3::ZERO, hi: Vec3::splat(1.0) };
                world.push((PrimRef::new(PrimKind::Instance, i), bounds));
            }
        }
        trees.set_root(world);
        (arrays.nodes2, arrays.nodes8) = (trees.nodes2, trees.nodes8);
        arrays
    })
}

fn globals() -> Globals {
    Globals { camera_medium: VACUUM, ..bytemuck::Zeroable::zeroed() }
}

fn is_packed(arrays: &SceneArrays) -> bool {
    SceneArena::pack(globals(), arrays.clone()).is_ok()
}

fn roots(arrays: &SceneArrays) -> [Vec<u32>; 2] {
    let of = |root: fn(&Instance) -> u32| arrays.instances.iter().map(root).collect();
    [of(|i| i.root2), of(|i| i.root8)]
}

/// The nodes of some trees level by level, and where the roots are then.
fn by_levels<const N: usize>(nodes: &[Node<N>], roots: &mut [u32]) -> Vec<Node<N>> {
    let mut order = vec![0];
    let mut distinct = roots.to_vec();
    distinct.dedup();
    order.extend(distinct);
    let mut i = 0;
    while i < order.len() {
        let children = nodes[order[i] as usize].children;
        order.extend(children.into_iter().filter(|child| child.is_node()).map(PrimRef::index));
        i += 1;
    }
    let mut places = vec![0; nodes.len()];
    for (place, &node) in order.iter().enumerate() {
        places[node as usize] = place as u32;
    }
    for root in roots {
        *root = places[*root as usize];
    }
    let moved = |&node: &u32| {
        let mut node = nodes[node as usize];
        for child in node.children.iter_mut().filter(|child| child.is_node()) {
            *child = PrimRef::new(PrimKind::Node, places[child.index() as usize]);
        }
        node
    };
    order.iter().map(moved).collect()
}

#[test]
fn trees_may_lie_in_any_order_in_which_parents_come_first() {
    let mut arrays = forest().clone();
    assert!(arrays.nodes2.len() > 20_000 && arrays.nodes8.len() > 3000);
    assert!(is_packed(&arrays));
    let [mut roots2, mut roots8] = roots(&arrays);
    arrays.nodes2 = by_levels(&arrays.nodes2, &mut roots2);
    arrays.nodes8 = by_levels(&arrays.nodes8, &mut roots8);
    for (i, instance) in arrays.instances.iter_mut().enumerate() {
        (instance.root2, instance.root8) = (roots2[i], roots8[i]);
    }
    assert!(is_packed(&arrays));
    // Backwards, it is not.
    arrays.nodes2.reverse();
    assert!(!is_packed(&arrays));
}

/// A child that may or may not be good for a node.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// Any node or primitive.
    To(u8, prop::sample::Index),
    /// The child of another node.
    Copy(prop::sample::Index, u8),
    /// That child, and the other node gets this one.
    Swap(prop::sample::Index, u8),
    /// A root moves here.
    Root(u8),
}

fn apply<const N: usize>(
    nodes: &mut [Node<N>],
    mut set_root: impl FnMut(usize, u32),
    (node, slot, change): (prop::sample::Index, u8, Change),
) {
    let n = nodes.len();
    let (i, slot) = (node.index(n), usize::from(slot) % N);
    match change {
        Change::To(15, _) => nodes[i].children[slot] = PrimRef::NONE,
        Change::To(kind, index) => {
            let kind = u32::from(kind % 8);
            nodes[i].children[slot] = PrimRef(kind << 28 | index.index(n) as u32);
        }
        Change::Copy(from, k) => {
            nodes[i].children[slot] = nodes[from.index(n)].children[usize::from(k) % N];
        }
        Change::Swap(from, k) => {
            let (from, k) = (from.index(n), usize::from(k) % N);
            let other = nodes[from].children[k];
            nodes[from].children[k] = nodes[i].children[slot];
            nodes[i].children[slot] = other;
        }
        Change::Root(k) => set_root(usize::from(k) % 9, i as u32),
    }
}

fn change() -> impl Strategy<Value = Change> {
    let index = any::<prop::sample::Index>;
    prop_oneof![
        (0..16_u8, index()).prop_map(|(kind, i)| Change::To(kind, i)),
        (index(), any::<u8>()).prop_map(|(i, k)| Change::Copy(i, k)),
        (index(), any::<u8>()).prop_map(|(i, k)| Change::Swap(i, k)),
        any::<u8>().prop_map(Change::Root),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn pieces_find_what_is_found_in_turn(
        is_wide in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), change()), 1..4),
    ) {
        let mut arrays = forest().clone();
        let (nodes2, nodes8, instances) =
            (&mut arrays.nodes2, &mut arrays.nodes8, &mut arrays.instances);
        for change in changes {
            if is_wide {
                apply(nodes8, |k, root| instances[k].root8 = root, change);
            } else {
                apply(nodes2, |k, root| instances[k].root2 = root, change);
            }
        }
        let [roots2, roots8] = roots(&arrays);
        let expected = are_trees(&arrays.nodes2, &roots2, &arrays)
            && are_trees(&arrays.nodes8, &roots8, &arrays);
        prop_assert_eq!(is_packed(&arrays), expected);
    }
}

/// Chains of nodes that go on from piece to piece are counted as a whole.
#[test]
fn depth_adds_up_over_pieces() {
    let node = |i: usize| PrimRef::new(PrimKind::Node, i as u32);
    let sphere = PrimRef::new(PrimKind::Sphere, 0);
    // A chain of `n` nodes, one in each 1000, between nodes that hang under a root of their own.
    let chain = |n: usize| {
        const STEP: usize = 1000;
        let mut arrays = forest().clone();
        arrays.nodes2.clear();
        for i in 0..n * STEP {
            let mut node_i = Node::EMPTY;
            node_i.children[0] = sphere;
            if i % STEP == 0 && i / STEP + 1 < n {
                node_i.children[1] = node(i + STEP);
            }
            arrays.nodes2.push(node_i);
        }
        // Every other node is a root.
        let mut instance = arrays.instances[0];
        arrays.instances.clear();
        for i in (0..n * STEP).filter(|i| i % STEP != 0) {
            (instance.root2, instance.root8) = (i as u32, 1);
            arrays.instances.push(instance);
        }
        arrays.nodes8.truncate(1);
        arrays.nodes8[0] = Node::EMPTY;
        arrays.nodes8.push(Node::EMPTY);
        SceneArena::pack(globals(), arrays.clone()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(chain(MAX_DEPTH), Ok(()));
    let error = chain(MAX_DEPTH + 1).unwrap_err();
    assert!(error.contains("too deep"), "{error}");
}
