//! Building a small tree exactly: every split of the order of centres along every axis is tried.
//!
//! The three orders are sorted once and then kept by stable partition, as in Wald and Havran, *On
//! building fast kd-Trees for Ray Tracing*, 2006.

use zrak_core::accel::Node;

use crate::binary::fits;
use crate::record::{Child, Planes, Record, node_of};

/// The most primitives that can be swept: indices have 16 bits.
pub(crate) const MAX_SWEPT: usize = 4096;

/// Memory that is used again for tree after tree.
#[derive(Default)]
pub(crate) struct Sweeper {
    /// Indices of records in the order of their centres along each axis.
    orders: [Vec<u16>; 3],
    ranks: Vec<((u32, u32), u16)>,
    /// Half of the area of all from here on, in the order that is being swept.
    right_area: Vec<f32>,
    is_left: Vec<bool>,
    right: Vec<u16>,
}

/// Where a node goes.
pub(crate) struct Place<'a> {
    /// It and all below it.
    pub(crate) nodes: &'a mut [Node<2>],
    /// Its index.
    pub(crate) index: u32,
    /// Its depth; the root's is 1.
    pub(crate) depth: usize,
}

impl Place<'_> {
    /// The places of the two children, if they are nodes.
    pub(crate) fn split(&mut self, n_left: usize) -> [Place<'_>; 2] {
        let (left, right) = self.nodes[1..].split_at_mut(n_left - 1);
        let depth = self.depth + 1;
        let index = self.index;
        [
            Place { nodes: left, index: index + 1, depth },
            Place { nodes: right, index: index + n_left as u32, depth },
        ]
    }
}

impl Sweeper {
    /// Builds the tree over two records or more; gives its box.
    pub(crate) fn build(&mut self, records: &[Record], place: Place) -> Planes {
        debug_assert!((2..=MAX_SWEPT).contains(&records.len()));
        if let [a, b] = records {
            return leaf_pair(a, b, place);
        }
        for (axis, order) in self.orders.iter_mut().enumerate() {
            self.ranks.clear();
            self.ranks.extend(records.iter().zip(0..).map(|(record, i)| (record.rank(axis), i)));
            self.ranks.sort_unstable();
            order.clear();
            order.extend(self.ranks.iter().map(|&(_, i)| i));
        }
        self.right_area.resize(records.len(), 0.0);
        self.is_left.resize(records.len(), false);
        self.subtree(records, 0, records.len(), place)
    }

    /// Builds the tree over the records in this range of the orders.
    fn subtree(
        &mut self,
        records: &[Record],
        first: usize,
        last: usize,
        mut place: Place,
    ) -> Planes {
        let n = last - first;
        let record = |i: u16| &records[usize::from(i)];
        if n == 2 {
            let [a, b] = [first, first + 1].map(|i| record(self.orders[0][i]));
            return leaf_pair(a, b, place);
        }
        let (axis, n_left) = self.best_split(records, first, last, place.depth);
        self.partition(axis, first, first + n_left, last);
        let [left, right] = place.split(n_left);
        let middle = first + n_left;
        let mut child = |first: usize, last: usize, place: Place| {
            if last - first == 1 {
                Child::Leaf(record(self.orders[0][first]))
            } else {
                let index = place.index;
                Child::Inner(index, self.subtree(records, first, last, place))
            }
        };
        let children = [child(first, middle, left), child(middle, last, right)];
        let (node, planes) = node_of(children);
        place.nodes[0] = node;
        planes
    }

    /// Axis and number of records on the left with the smallest sum of area times number; the middle
    /// of the longest axis if there is none that fits.
    fn best_split(
        &mut self,
        records: &[Record],
        first: usize,
        last: usize,
        depth: usize,
    ) -> (usize, usize) {
        let n = last - first;
        let mut best = None;
        let mut best_cost = f32::INFINITY;
        let mut whole_cost = f32::INFINITY;
        for axis in 0..3 {
            let order = &self.orders[axis][first..last];
            let right_area = &mut self.right_area[..n];
            let mut all = Planes::EMPTY;
            for (&i, area) in order.iter().zip(right_area.iter_mut()).rev() {
                all.union(&records[usize::from(i)].planes());
                *area = all.half_area();
            }
            whole_cost = right_area[0] * n as f32;
            let mut all = Planes::EMPTY;
            for i in 1..n {
                all.union(&records[usize::from(order[i - 1])].planes());
                let cost = all.half_area() * i as f32 + right_area[i] * (n - i) as f32;
                if cost < best_cost {
                    best_cost = cost;
                    best = Some((axis, i));
                }
            }
        }
        // Where boxes all but coincide, no split gains anything, and halving makes the tree flat.
        let gains = best_cost < whole_cost * (1.0 - 1.0 / 65536.0);
        best.filter(|&(_, n_left)| gains && fits(depth, n, n_left)).unwrap_or_else(|| {
            let mut centers = Planes::EMPTY;
            for &i in &self.orders[0][first..last] {
                centers.union(&records[usize::from(i)].center_planes());
            }
            (centers.longest_axis(), n / 2)
        })
    }

    /// Brings the records on the left of a split of one order to the front of the other two.
    fn partition(&mut self, axis: usize, first: usize, middle: usize, last: usize) {
        for i in first..last {
            self.is_left[usize::from(self.orders[axis][i])] = i < middle;
        }
        for other in (0..3).filter(|&other| other != axis) {
            let order = &mut self.orders[other][first..last];
            self.right.resize(order.len(), 0);
            let (mut n_left, mut n_right) = (0, 0);
            for i in 0..order.len() {
                let index = order[i];
                let is_left = self.is_left[usize::from(index)];
                order[n_left] = index;
                self.right[n_right] = index;
                n_left += usize::from(is_left);
                n_right += usize::from(!is_left);
            }
            order[n_left..].copy_from_slice(&self.right[..n_right]);
        }
    }
}

/// A node with two leaves.
fn leaf_pair(a: &Record, b: &Record, place: Place) -> Planes {
    let (a, b) = if a.prim.0 < b.prim.0 { (a, b) } else { (b, a) };
    let (node, planes) = node_of([Child::Leaf(a), Child::Leaf(b)]);
    place.nodes[0] = node;
    planes
}
