//! From binary to wide: a wide node adopts the children of its largest child until it is full.
//!
//! Wald, Benthin and Boulos, *Getting Rid of Packets*, 2008, section 3.3.

use crate::binary::{BinaryNode, BinaryTree};

/// The up to `N` descendants that a wide node in place of `node` has, by index.
pub(crate) fn adopt<const N: usize>(tree: &BinaryTree, node: u32) -> Vec<u32> {
    let mut children = vec![node];
    loop {
        // The inner node with the largest area; a leaf has nothing to adopt.
        let largest = children
            .iter()
            .enumerate()
            .filter_map(|(slot, &child)| match tree.nodes[child as usize] {
                (bounds, BinaryNode::Inner(pair)) => Some((slot, bounds.half_area(), pair)),
                (_, BinaryNode::Leaf(_)) => None,
            })
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match largest {
            Some((slot, _, [left, right])) if children.len() < N => {
                children[slot] = left;
                children.push(right);
            }
            _ => return children,
        }
    }
}
