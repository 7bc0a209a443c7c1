//! From the builder's tree to the nodes that the renderer reads.

use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::math::Bounds;
use zrak_core::scene::{PrimKind, PrimRef};

use crate::binary::{BinaryNode, BinaryTree, build};
use crate::collapse::adopt;

/// The same primitives in trees of both widths.
#[derive(Clone, Debug)]
pub struct Trees {
    /// Binary tree.
    pub nodes2: Vec<Node<2>>,
    /// Eight-wide tree.
    pub nodes8: Vec<Node<8>>,
}

/// Builds the trees over primitives with their bounds. Without primitives, the root has no children.
#[must_use]
pub fn build_trees(prims: &[(PrimRef, Bounds)]) -> Trees {
    let bounds: Vec<Bounds> = prims.iter().map(|p| p.1).collect();
    let tree = build(&bounds);
    Trees { nodes2: emit(&tree, prims), nodes8: emit(&tree, prims) }
}

impl Trees {
    /// Adds a tree over primitives with their bounds; gives the indices of its roots in the nodes of
    /// both widths.
    pub fn append(&mut self, prims: &[(PrimRef, Bounds)]) -> [u32; 2] {
        let tree = build_trees(prims);
        let roots = [self.nodes2.len() as u32, self.nodes8.len() as u32];
        shift(&mut self.nodes2, tree.nodes2, false);
        shift(&mut self.nodes8, tree.nodes8, false);
        roots
    }

    /// Adds a tree whose roots replace the first nodes.
    pub fn set_root(&mut self, prims: &[(PrimRef, Bounds)]) {
        let tree = build_trees(prims);
        shift(&mut self.nodes2, tree.nodes2, true);
        shift(&mut self.nodes8, tree.nodes8, true);
    }
}

/// Appends the nodes of a tree, or all but the root, which becomes the first node.
fn shift<const N: usize>(nodes: &mut Vec<Node<N>>, tree: Vec<Node<N>>, as_root: bool) {
    let base = nodes.len() as u32 - u32::from(as_root);
    for (i, mut node) in tree.into_iter().enumerate() {
        for child in &mut node.children {
            if *child != PrimRef::NONE && child.is_node() {
                *child = PrimRef::new(PrimKind::Node, child.index() + base);
            }
        }
        if i == 0 && as_root {
            nodes[0] = node;
        } else {
            nodes.push(node);
        }
    }
}

/// Lays out the nodes of a wide tree, depth first.
///
/// # Panics
/// If the tree is deeper than [`MAX_DEPTH`], which [`build`] does not let happen.
fn emit<const N: usize>(tree: &BinaryTree, prims: &[(PrimRef, Bounds)]) -> Vec<Node<N>> {
    let mut nodes = vec![Node::EMPTY];
    if tree.nodes.is_empty() {
        return nodes;
    }
    // (binary node, slot of the wide node that it becomes, depth)
    let mut tasks = vec![(0_u32, 0_usize, 1_usize)];
    while let Some((source, slot, depth)) = tasks.pop() {
        assert!(depth <= MAX_DEPTH, "tree too deep");
        let mut node = Node::<N>::EMPTY;
        for (i, child) in adopt::<N>(tree, source).into_iter().enumerate() {
            let (bounds, kind) = tree.nodes[child as usize];
            for axis in 0..3 {
                node.lo[axis][i] = bounds.lo.to_array()[axis];
                node.hi[axis][i] = bounds.hi.to_array()[axis];
            }
            node.children[i] = match kind {
                BinaryNode::Leaf(prim) => prims[prim as usize].0,
                BinaryNode::Inner(_) => {
                    let index = nodes.len();
                    nodes.push(Node::EMPTY);
                    tasks.push((child, index, depth + 1));
                    PrimRef::new(PrimKind::Node, index as u32)
                }
            };
        }
        nodes[slot] = node;
    }
    nodes
}
