//! Trees of both widths in the arrays that the renderer reads.

use std::borrow::Cow;

use rayon::prelude::*;
use zrak_core::accel::Node;
use zrak_core::math::Bounds;
use zrak_core::scene::PrimRef;

use crate::binary;
use crate::progress::{BuildOptions, Progress};
use crate::record::Record;
use crate::wide::widen;

/// Any number of trees, each of them in both widths, over the same primitives.
///
/// Links are indices into the whole arrays, and a child comes after its parent. Node 0 is the root of
/// the main tree; it is there from the start and has no children until [`set_root`](Self::set_root), so
/// that what instances of the main tree refer to can be built first:
///
/// ```
/// # use zrak_accel::Trees;
/// # use zrak_core::{math::{Bounds, vec3}, scene::{PrimKind, PrimRef}};
/// # let bounds = Bounds::of_points(vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
/// # let (prototype, world) = (vec![(PrimRef::new(PrimKind::Sphere, 0), bounds)], vec![]);
/// let mut trees = Trees::new();
/// let [root2, root8] = trees.append(prototype);
/// trees.set_root(world);
/// # assert_eq!([root2, root8], [1, 1]);
/// ```
///
/// Each tree is at most [`MAX_DEPTH`](zrak_core::accel::MAX_DEPTH) nodes deep, and is the same whatever
/// the number of threads and the order of the primitives. A tree without primitives is one node without
/// children.
///
/// Methods that add a tree panic if there is no room for its nodes; see
/// [`has_room_for`](Self::has_room_for).
#[derive(Clone, Debug)]
pub struct Trees {
    /// Binary trees.
    pub nodes2: Vec<Node<2>>,
    /// Eight-wide trees.
    pub nodes8: Vec<Node<8>>,
}

impl Default for Trees {
    fn default() -> Self {
        Self::new()
    }
}

/// The most nodes: handles have 28 bits for an index.
const MAX_NODES: usize = 1 << 28;

/// Builds one tree over primitives with their bounds. Without primitives, the root has no children.
#[must_use]
pub fn build_trees(prims: &[(PrimRef, Bounds)]) -> Trees {
    build_trees_with(prims, &BuildOptions::default())
}

/// [`build_trees`] with options. An owned list is freed early.
#[must_use]
pub fn build_trees_with<'p>(
    prims: impl Into<Cow<'p, [(PrimRef, Bounds)]>>,
    options: &BuildOptions,
) -> Trees {
    let mut trees = Trees::new();
    trees.set_root_with(prims, options);
    trees
}

impl Trees {
    /// The root of the main tree, without children yet.
    #[must_use]
    pub fn new() -> Self {
        Self { nodes2: vec![Node::EMPTY], nodes8: vec![Node::EMPTY] }
    }

    /// Whether handles can tell the nodes apart if a tree over so many primitives is added. It has one
    /// binary node less than primitives, and fewer wide ones.
    #[must_use]
    pub fn has_room_for(&self, n_prims: usize) -> bool {
        n_prims.saturating_sub(1).max(1) <= MAX_NODES - self.nodes2.len()
    }

    /// Adds a tree over primitives with their bounds; gives the indices of its roots in the nodes of
    /// both widths.
    pub fn append<'p>(&mut self, prims: impl Into<Cow<'p, [(PrimRef, Bounds)]>>) -> [u32; 2] {
        self.append_with(prims, &BuildOptions::default())
    }

    /// [`append`](Self::append) with options.
    pub fn append_with<'p>(
        &mut self,
        prims: impl Into<Cow<'p, [(PrimRef, Bounds)]>>,
        options: &BuildOptions,
    ) -> [u32; 2] {
        let roots = [self.nodes2.len() as u32, self.nodes8.len() as u32];
        self.build_at(roots, prims.into(), options);
        roots
    }

    /// Adds a tree over primitives with their bounds whose roots replace the first nodes. To be called
    /// once.
    pub fn set_root<'p>(&mut self, prims: impl Into<Cow<'p, [(PrimRef, Bounds)]>>) {
        self.set_root_with(prims, &BuildOptions::default());
    }

    /// [`set_root`](Self::set_root) with options.
    pub fn set_root_with<'p>(
        &mut self,
        prims: impl Into<Cow<'p, [(PrimRef, Bounds)]>>,
        options: &BuildOptions,
    ) {
        // The tree is built over the last node, which then gets its place back from the root.
        let last = [self.nodes2.len() as u32 - 1, self.nodes8.len() as u32 - 1];
        let [last2, last8] = last.map(|i| i as usize);
        let displaced = (self.nodes2[last2], self.nodes8[last8]);
        self.build_at(last, prims.into(), options);
        let roots = (self.nodes2[last2], self.nodes8[last8]);
        (self.nodes2[last2], self.nodes8[last8]) = displaced;
        (self.nodes2[0], self.nodes8[0]) = roots;
    }

    /// Builds a tree whose roots have these indices, behind all other nodes.
    fn build_at(
        &mut self,
        [root2, root8]: [u32; 2],
        prims: Cow<[(PrimRef, Bounds)]>,
        options: &BuildOptions,
    ) {
        assert!(self.has_room_for(prims.len()), "more than 2^28 nodes");
        let records: Vec<Record> = prims.par_iter().map(Record::new).collect();
        drop(prims);
        let n = records.len();
        let first = root2 as usize;
        self.nodes2.truncate(first);
        self.nodes2.par_extend(rayon::iter::repeat_n(Node::EMPTY, n.saturating_sub(1).max(1)));
        if let [] | [_] = records[..] {
            self.nodes2[first] = records.first().map_or(Node::EMPTY, Record::alone);
            self.nodes8.truncate(root8 as usize);
            self.nodes8.push(records.first().map_or(Node::EMPTY, Record::alone));
            return;
        }
        // Binary nodes, choice of the wide ones, and writing these.
        let progress = Progress::new(options, 3 * n);
        let nodes = &mut self.nodes2[first..];
        binary::build(records, nodes, root2, &progress);
        widen(nodes, root2, &mut self.nodes8, root8, &progress);
    }
}
