//! What the builder moves about: a primitive with its box, in 32 bytes.

use zrak_core::accel::Node;
use zrak_core::math::Bounds;
use zrak_core::scene::{PrimKind, PrimRef};

/// A box as its smallest and its negated largest coordinates, so that the union of two boxes is one
/// minimum for each number; two more numbers make it two vector registers.
///
/// Minima of the same numbers in any order differ in the signs of zeros alone, and those are removed
/// before they are stored: so unions may be taken in any order, by any number of threads.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Planes([f32; 8]);

impl Planes {
    /// The union with it is the other box.
    pub(crate) const EMPTY: Self = Self([f32::INFINITY; 8]);

    #[inline(always)]
    pub(crate) fn union(&mut self, other: &Self) {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = if b < *a { b } else { *a };
        }
    }

    /// Smallest and largest coordinate.
    #[inline(always)]
    pub(crate) fn interval(&self, axis: usize) -> [f32; 2] {
        [self.0[axis], -self.0[axis + 3]]
    }

    /// Half of the surface area. Not of an empty box.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| -(self.0[axis] + self.0[axis + 3]));
        x * y + y * z + z * x
    }

    /// The axis along which the box is longest.
    pub(crate) fn longest_axis(&self) -> usize {
        let size = [0, 1, 2].map(|axis| -(self.0[axis] + self.0[axis + 3]));
        let longer = |a: usize, b: usize| if size[b] > size[a] { b } else { a };
        longer(longer(0, 1), 2)
    }
}

/// A primitive with its box.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Record {
    planes: [f32; 6],
    pub(crate) prim: PrimRef,
    _pad: u32,
}

impl Record {
    pub(crate) fn new(&(prim, bounds): &(PrimRef, Bounds)) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.lo.to_array(), bounds.hi.to_array());
        Self { planes: [a, b, c, -d, -e, -f], prim, _pad: 0 }
    }

    /// The root of a tree over this primitive alone.
    pub(crate) fn alone<const N: usize>(&self) -> Node<N> {
        let mut node = Node::EMPTY;
        node.children[0] = self.prim;
        for axis in 0..3 {
            [node.lo[axis][0], node.hi[axis][0]] = self.planes().interval(axis);
        }
        node
    }

    #[inline(always)]
    pub(crate) fn planes(&self) -> Planes {
        let [a, b, c, d, e, f] = self.planes;
        Planes([a, b, c, d, e, f, 0.0, 0.0])
    }

    /// Twice the centre: what primitives are ordered by. Not a number if the box is infinite to
    /// both sides.
    #[inline(always)]
    pub(crate) fn center(&self, axis: usize) -> f32 {
        self.planes[axis] - self.planes[axis + 3]
    }

    /// The centre as a box of its own.
    #[inline(always)]
    pub(crate) fn center_planes(&self) -> Planes {
        let [x, y, z] = [0, 1, 2].map(|axis| self.center(axis));
        Planes([x, y, z, -x, -y, -z, 0.0, 0.0])
    }

    /// Integers in the order of centres, then of handles: no two primitives are equal.
    #[inline(always)]
    pub(crate) fn rank(&self, axis: usize) -> (u32, u32) {
        let center = self.center(axis);
        // The sign of a NaN is the platform's, and that of a zero has no meaning.
        let center = if center.is_nan() { 0.0 } else { center + 0.0 };
        let bits = center.to_bits();
        let ordered = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
        (ordered, self.prim.0)
    }
}

/// Child of a node: a primitive, or a node by its index.
#[derive(Clone, Copy)]
pub(crate) enum Child<'a> {
    /// Keeps the primitive's bounds as they are.
    Leaf(&'a Record),
    /// Node with the union of what it holds.
    Inner(u32, Planes),
}

impl Child<'_> {
    #[inline(always)]
    pub(crate) fn planes(&self) -> Planes {
        match self {
            Child::Leaf(record) => record.planes(),
            Child::Inner(_, planes) => *planes,
        }
    }
}

/// The node with these children; gives the union of their boxes too.
#[inline(always)]
pub(crate) fn node_of(children: [Child; 2]) -> (Node<2>, Planes) {
    let mut node = Node::EMPTY;
    let mut all = Planes::EMPTY;
    for (slot, child) in children.into_iter().enumerate() {
        let planes = child.planes();
        all.union(&planes);
        let zero = match child {
            Child::Leaf(record) => {
                node.children[slot] = record.prim;
                // Adding it changes nothing.
                -0.0
            }
            Child::Inner(index, _) => {
                node.children[slot] = PrimRef::new(PrimKind::Node, index);
                // Adding it makes a positive zero of a negative one.
                0.0
            }
        };
        for axis in 0..3 {
            let [lo, hi] = planes.interval(axis);
            node.lo[axis][slot] = lo + zero;
            node.hi[axis][slot] = hi + zero;
        }
    }
    (node, all)
}
