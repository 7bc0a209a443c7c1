//! Binary trees by the surface area heuristic.
//!
//! MacDonald and Booth, *Heuristics for ray tracing using space subdivision*, 1990: a ray that meets
//! a box meets a part of it with probability about the ratio of their areas, so the best split has the
//! smallest sum of area times number of primitives. Small sets are swept exactly, large ones with
//! bins (Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, 2007).

use zrak_core::accel::MAX_DEPTH;
use zrak_core::math::{Bounds, Vec3};

/// Sets of up to this many primitives are swept exactly.
const SWEEP_LIMIT: usize = 4096;
/// Bins for larger ones.
const N_BINS: usize = 32;

/// Node of a [`BinaryTree`].
#[derive(Clone, Copy, Debug)]
pub enum BinaryNode {
    /// Two nodes, by index.
    Inner([u32; 2]),
    /// A primitive, by index.
    Leaf(u32),
}

/// Tree with one primitive in a leaf.
#[derive(Clone, Debug, Default)]
pub struct BinaryTree {
    /// Nodes with their bounds; the first is the root, and children come after their parents.
    pub nodes: Vec<(Bounds, BinaryNode)>,
}

/// A set of primitives to be split, and the slot of the node that it becomes.
struct Task {
    node: usize,
    first: usize,
    last: usize,
    depth: usize,
}

/// Builds a tree over primitives with these bounds, at most [`MAX_DEPTH`] deep.
#[must_use]
pub fn build(bounds: &[Bounds]) -> BinaryTree {
    let mut tree = BinaryTree::default();
    if bounds.is_empty() {
        return tree;
    }
    let mut order: Vec<u32> = (0..bounds.len() as u32).collect();
    let mut scratch = Scratch::default();
    let unset = (Bounds::EMPTY, BinaryNode::Leaf(0));
    tree.nodes.reserve(2 * bounds.len());
    tree.nodes.push(unset);
    let mut tasks = vec![Task { node: 0, first: 0, last: bounds.len(), depth: 1 }];
    while let Some(Task { node, first, last, depth }) = tasks.pop() {
        let set = &mut order[first..last];
        let total = union_of(bounds, set);
        if let [prim] = *set {
            tree.nodes[node] = (total, BinaryNode::Leaf(prim));
            continue;
        }
        // Halving needs so many more levels; split for quality only while there are enough left.
        let levels_if_halved = (set.len() as f64).log2().ceil() as usize + 1;
        let n_left = if depth + levels_if_halved >= MAX_DEPTH {
            halve(bounds, set)
        } else if set.len() <= SWEEP_LIMIT {
            sweep(bounds, set, &mut scratch)
        } else {
            split_by_bins(bounds, set).unwrap_or_else(|| halve(bounds, set))
        };
        let left = tree.nodes.len();
        tree.nodes.extend([unset, unset]);
        tree.nodes[node] = (total, BinaryNode::Inner([left as u32, left as u32 + 1]));
        tasks.push(Task { node: left + 1, first: first + n_left, last, depth: depth + 1 });
        tasks.push(Task { node: left, first, last: first + n_left, depth: depth + 1 });
    }
    tree
}

fn union_of(bounds: &[Bounds], set: &[u32]) -> Bounds {
    set.iter().fold(Bounds::EMPTY, |all, &i| all.union(bounds[i as usize]))
}

fn component(v: Vec3, axis: usize) -> f32 {
    v.to_array()[axis]
}

/// Twice the centre: what primitives are ordered by.
fn center(bounds: &[Bounds], prim: u32, axis: usize) -> f32 {
    let b = &bounds[prim as usize];
    component(b.lo, axis) + component(b.hi, axis)
}

fn sort_by_center(bounds: &[Bounds], set: &mut [u32], axis: usize) {
    set.sort_unstable_by(|&a, &b| {
        center(bounds, a, axis).total_cmp(&center(bounds, b, axis)).then(a.cmp(&b))
    });
}

/// Splits in the middle of the order along the longest axis.
fn halve(bounds: &[Bounds], set: &mut [u32]) -> usize {
    let total = union_of(bounds, set);
    let size = (total.hi - total.lo).to_array();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
    sort_by_center(bounds, set, axis);
    set.len() / 2
}

/// Buffers of [`sweep`], kept between calls.
#[derive(Default)]
struct Scratch {
    best_order: Vec<u32>,
    right_area: Vec<f32>,
}

/// Tries every split of the order along every axis; leaves the set in the best order.
fn sweep(bounds: &[Bounds], set: &mut [u32], scratch: &mut Scratch) -> usize {
    let n = set.len();
    let mut best = (f32::INFINITY, n / 2);
    for axis in 0..3 {
        sort_by_center(bounds, set, axis);
        scratch.right_area.clear();
        scratch.right_area.resize(n, 0.0);
        let mut right = Bounds::EMPTY;
        for i in (1..n).rev() {
            right = right.union(bounds[set[i] as usize]);
            scratch.right_area[i] = right.half_area();
        }
        let mut left = Bounds::EMPTY;
        let mut improved = false;
        for i in 1..n {
            left = left.union(bounds[set[i - 1] as usize]);
            let cost = left.half_area() * i as f32 + scratch.right_area[i] * (n - i) as f32;
            if cost < best.0 {
                best = (cost, i);
                improved = true;
            }
        }
        if improved || axis == 0 {
            scratch.best_order.clear();
            scratch.best_order.extend_from_slice(set);
        }
    }
    set.copy_from_slice(&scratch.best_order);
    best.1
}

/// Splits between bins of centres; none if all centres coincide.
fn split_by_bins(bounds: &[Bounds], set: &mut [u32]) -> Option<usize> {
    let mut lo = [f32::INFINITY; 3];
    let mut hi = [f32::NEG_INFINITY; 3];
    for &i in set.iter() {
        for axis in 0..3 {
            let c = center(bounds, i, axis);
            lo[axis] = lo[axis].min(c);
            hi[axis] = hi[axis].max(c);
        }
    }
    let scale = |axis: usize| N_BINS as f32 / (hi[axis] - lo[axis]);
    let bin_of = |i: u32, axis: usize| {
        (((center(bounds, i, axis) - lo[axis]) * scale(axis)) as usize).min(N_BINS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| hi[axis] > lo[axis] && scale(axis).is_finite()) {
        let mut bins = [(Bounds::EMPTY, 0_usize); N_BINS];
        for &i in set.iter() {
            let bin = &mut bins[bin_of(i, axis)];
            bin.0 = bin.0.union(bounds[i as usize]);
            bin.1 += 1;
        }
        let mut right = [(0.0_f32, 0_usize); N_BINS];
        let mut all = (Bounds::EMPTY, 0);
        for i in (1..N_BINS).rev() {
            all = (all.0.union(bins[i].0), all.1 + bins[i].1);
            right[i] = (all.0.half_area(), all.1);
        }
        let mut left = (Bounds::EMPTY, 0);
        for i in 1..N_BINS {
            left = (left.0.union(bins[i - 1].0), left.1 + bins[i - 1].1);
            if left.1 == 0 || right[i].1 == 0 {
                continue;
            }
            let cost = left.0.half_area() * left.1 as f32 + right[i].0 * right[i].1 as f32;
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, i));
            }
        }
    }
    let (_, axis, split) = best?;
    // Partition in place.
    let mut n_left = 0;
    for i in 0..set.len() {
        if bin_of(set[i], axis) < split {
            set.swap(i, n_left);
            n_left += 1;
        }
    }
    Some(n_left)
}
