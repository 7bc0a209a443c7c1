//! How good a tree is.

use zrak_core::accel::Node;
use zrak_core::math::{Bounds, vec3};
use zrak_core::scene::PrimRef;

/// The expected number of nodes that a random ray through a tree's box visits, with that of the
/// primitives whose boxes it meets, by the surface area heuristic: the areas of all boxes, divided by
/// that of the root's. 0 if there is no box, or none with an area.
///
/// Node 0 is the root; what instances refer to does not count. See [`sah_cost_of`].
#[must_use]
pub fn sah_cost<const N: usize>(nodes: &[Node<N>]) -> f64 {
    sah_cost_of(nodes, 0)
}

/// [`sah_cost`] of the tree with this root.
#[must_use]
pub fn sah_cost_of<const N: usize>(nodes: &[Node<N>], root: u32) -> f64 {
    let mut root_bounds = Bounds::EMPTY;
    let mut total = 0.0;
    let mut stack = vec![root];
    while let Some(index) = stack.pop() {
        let node = &nodes[index as usize];
        for (i, child) in node.children.iter().enumerate() {
            if *child == PrimRef::NONE {
                continue;
            }
            let corner = |p: &[[f32; N]; 3]| vec3(p[0][i], p[1][i], p[2][i]);
            let bounds = Bounds { lo: corner(&node.lo), hi: corner(&node.hi) };
            total += half_area(bounds);
            if index == root {
                root_bounds = root_bounds.union(bounds);
            }
            if child.is_node() {
                stack.push(child.index());
            }
        }
    }
    let root_area = half_area(root_bounds);
    if root_area > 0.0 { 1.0 + total / root_area } else { 0.0 }
}

/// In double precision: areas of large boxes overflow in single.
fn half_area(bounds: Bounds) -> f64 {
    let (lo, hi) = (bounds.lo.to_array(), bounds.hi.to_array());
    let [x, y, z] = [0, 1, 2].map(|axis| (f64::from(hi[axis]) - f64::from(lo[axis])).max(0.0));
    x * y + y * z + z * x
}
