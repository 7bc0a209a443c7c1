//! Binary trees by the surface area heuristic.
//!
//! MacDonald and Booth, *Heuristics for ray tracing using space subdivision*, 1990: a ray that meets
//! a box meets a part of it with probability about the ratio of their areas, so the best split has the
//! smallest sum of area times number of primitives. Large sets are split between bins (see
//! [`crate::bins`]), small ones exactly (see [`crate::sweep`]).
//!
//! A tree over n primitives has n - 1 nodes. They are laid out depth first, so it is known where a
//! subtree goes before it is built, and threads write to parts of one array.
//!
//! Every decision depends on the set of primitives alone, neither on their order nor on who computes
//! it: unions and counts are exact, and orders are total. So the tree is the same on any number of
//! threads.

use rayon::prelude::*;
use zrak_core::accel::{MAX_DEPTH, Node};

use crate::bins::{self, PARALLEL_LIMIT, center_bounds};
use crate::progress::Progress;
use crate::record::{Child, Planes, Record, node_of};
use crate::sweep::{MAX_SWEPT, Place, Sweeper};

/// Subtrees with more primitives than this are built by tasks of their own.
const TASK_LIMIT: usize = 4096;
/// In trees with more than [`MAX_SWEPT`] primitives, sets of up to this many are swept exactly.
const SWEPT_IN_LARGE: usize = 32;

/// Levels of nodes that a tree over `n` primitives needs: the binary logarithm, rounded up.
fn levels(n: usize) -> usize {
    n.next_power_of_two().trailing_zeros() as usize
}

/// Whether both sides of a split of a node at this depth can still be halved within [`MAX_DEPTH`].
/// Halving itself always fits if the node did.
pub(crate) fn fits(depth: usize, n: usize, n_left: usize) -> bool {
    depth + levels(n_left.max(n - n_left)) <= MAX_DEPTH
}

/// Builds the tree over two records or more, whose root has this index, into `nodes`, one fewer than
/// there are records.
pub(crate) fn build(records: Vec<Record>, nodes: &mut [Node<2>], index: u32, progress: &Progress) {
    let n_swept = if records.len() <= MAX_SWEPT { MAX_SWEPT } else { SWEPT_IN_LARGE };
    build_swept(records, nodes, index, n_swept, progress);
}

/// [`build`], with sets of up to `n_swept` primitives swept exactly.
pub(crate) fn build_swept(
    mut records: Vec<Record>,
    nodes: &mut [Node<2>],
    index: u32,
    n_swept: usize,
    progress: &Progress,
) {
    let is_large = records.len() > PARALLEL_LIMIT;
    let mut copy = if is_large { records.par_iter().copied().collect() } else { Vec::new() };
    let place = Place { nodes, index, depth: 1 };
    Builder { n_swept, progress }.in_tasks(&mut records, &mut copy, place);
}

struct Builder<'a> {
    n_swept: usize,
    progress: &'a Progress<'a>,
}

impl Builder<'_> {
    /// Builds a tree, with tasks for its subtrees. Where several threads partition a set, they move it
    /// to `copy`, which is as large, or empty if there will be none such.
    fn in_tasks(&self, records: &mut [Record], copy: &mut [Record], mut place: Place) -> Planes {
        let n = records.len();
        if n <= TASK_LIMIT {
            let planes = self.alone(records, place, &mut Sweeper::default());
            self.progress.add(n);
            return planes;
        }
        let is_allowed = |n_left| fits(place.depth, n, n_left);
        let centers = center_bounds(records);
        let (records, copy, n_left) = if n > PARALLEL_LIMIT {
            match bins::split_in_parallel(records, copy, &centers, is_allowed) {
                Some(n_left) => (copy, records, n_left),
                None => {
                    let n_left = halve(records, &centers);
                    (records, copy, n_left)
                }
            }
        } else {
            let n_left = bins::split(records, &centers, is_allowed)
                .unwrap_or_else(|| halve(records, &centers));
            (records, copy, n_left)
        };
        let [left_place, right_place] = place.split(n_left);
        let (left, right) = records.split_at_mut(n_left);
        let (left_copy, right_copy) = copy.split_at_mut(n_left.min(copy.len()));
        let (left, right) = rayon::join(
            || self.child(left, left_copy, left_place),
            || self.child(right, right_copy, right_place),
        );
        let (node, planes) = node_of([left, right]);
        place.nodes[0] = node;
        planes
    }

    fn child<'r>(&self, records: &'r mut [Record], copy: &mut [Record], place: Place) -> Child<'r> {
        if records.len() == 1 {
            self.progress.add(1);
            return Child::Leaf(&records[0]);
        }
        Child::Inner(place.index, self.in_tasks(records, copy, place))
    }

    /// Builds a tree on this thread.
    fn alone(&self, records: &mut [Record], mut place: Place, sweeper: &mut Sweeper) -> Planes {
        let n = records.len();
        if n <= self.n_swept {
            return sweeper.build(records, place);
        }
        let centers = center_bounds(records);
        let is_allowed = |n_left| fits(place.depth, n, n_left);
        let n_left =
            bins::split(records, &centers, is_allowed).unwrap_or_else(|| halve(records, &centers));
        let [left_place, right_place] = place.split(n_left);
        let (left, right) = records.split_at_mut(n_left);
        let mut child = |records: &mut [Record], place: Place| {
            (records.len() > 1)
                .then(|| Child::Inner(place.index, self.alone(records, place, sweeper)))
        };
        let left_node = child(left, left_place);
        let right_node = child(right, right_place);
        let (node, planes) = node_of([
            left_node.unwrap_or(Child::Leaf(&left[0])),
            right_node.unwrap_or(Child::Leaf(&right[0])),
        ]);
        place.nodes[0] = node;
        planes
    }
}

/// Moves the first half, by the order along the longest axis of the centres, to the front.
fn halve(records: &mut [Record], centers: &Planes) -> usize {
    let axis = centers.longest_axis();
    let n_left = records.len() / 2;
    records.select_nth_unstable_by_key(n_left, |record| record.rank(axis));
    n_left
}
