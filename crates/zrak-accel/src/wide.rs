//! From binary to wide trees: which binary nodes become nodes of the wide tree is chosen so that a
//! random ray visits as few as possible.
//!
//! Ylitie, Karras and Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs*, 2017, section 3.2: let C(b, i) be the least area of the wide nodes in a forest of at most i
//! wide trees that holds what is below the binary node b. A leaf needs none. An inner node either is
//! one wide node, whose eight slots its two children share, or gives i slots to its children:
//!
//! C(b, 1) = area(b) + min over k of C(left, k) + C(right, 8 - k)
//! C(b, i) = min(C(b, i - 1), min over k of C(left, k) + C(right, i - k))
//!
//! Boxes of leaves are met anyway, and do not count.

use rayon::prelude::*;
use zrak_core::accel::Node;
use zrak_core::math::{Bounds, vec3};
use zrak_core::scene::{PrimKind, PrimRef};

use crate::progress::Progress;

const WIDTH: usize = 8;
/// Subtrees with more primitives than this are the work of several threads.
const TASK_LIMIT: usize = 4096;

/// C(b, 1) to C(b, 7).
type Costs = [f32; WIDTH - 1];
const LEAF: Costs = [0.0; WIDTH - 1];

/// For every number of slots from 2 to 8, how many the left child gets, in three bits; none if one
/// slot less is as good.
#[derive(Clone, Copy, Default)]
struct Choice(u32);

impl Choice {
    #[inline(always)]
    fn n_left(self, n_slots: usize) -> usize {
        (self.0 >> (3 * (n_slots - 2)) & 7) as usize
    }

    #[inline(always)]
    fn set(&mut self, n_slots: usize, n_left: usize) {
        self.0 |= (n_left as u32) << (3 * (n_slots - 2));
    }
}

/// Part of the binary tree: a node, by its place among the nodes of this tree, and the number of
/// primitives below.
#[derive(Clone, Copy)]
struct Subtree {
    node: usize,
    n: usize,
}

/// A binary tree, and which of its nodes become wide ones.
struct Tree<'a> {
    /// All binary nodes of this tree, depth first.
    nodes: &'a [Node<2>],
    /// Index of the first one: links are offset by it.
    base: u32,
    choices: Vec<Choice>,
}

fn bounds_of(node: &Node<2>, slot: usize) -> Bounds {
    let corner = |planes: &[[f32; 2]; 3]| vec3(planes[0][slot], planes[1][slot], planes[2][slot]);
    Bounds { lo: corner(&node.lo), hi: corner(&node.hi) }
}

/// Area of what is below a node, never zero, so that of worthless nodes fewer are better.
fn area_of(node: &Node<2>) -> f32 {
    let area = bounds_of(node, 0).union(bounds_of(node, 1)).half_area();
    if area > f32::MIN_POSITIVE { area } else { f32::MIN_POSITIVE }
}

/// The two children of a node.
fn split_of(nodes: &[Node<2>], base: u32, subtree: Subtree) -> [Subtree; 2] {
    let Subtree { node, n } = subtree;
    let right = nodes[node].children[1];
    // Nodes are laid out depth first, and a tree has one node less than primitives.
    let n_left = if right.is_node() { (right.index() - base) as usize - node } else { n - 1 };
    [Subtree { node: node + 1, n: n_left }, Subtree { node: node + n_left, n: n - n_left }]
}

/// The cheapest choice for a node and what it costs.
#[inline(always)]
fn choose(area: f32, left: &Costs, right: &Costs) -> (Choice, Costs) {
    let mut choice = Choice::default();
    let mut costs = LEAF;
    let mut best = (f32::INFINITY, WIDTH / 2);
    for k in 1..WIDTH {
        let cost = left[k - 1] + right[WIDTH - 1 - k];
        if cost < best.0 {
            best = (cost, k);
        }
    }
    choice.set(WIDTH, best.1);
    costs[0] = area + best.0;
    for n_slots in 2..WIDTH {
        let mut best = (costs[n_slots - 2], 0);
        for k in 1..n_slots {
            let cost = left[k - 1] + right[n_slots - 1 - k];
            if cost < best.0 {
                best = (cost, k);
            }
        }
        choice.set(n_slots, best.1);
        costs[n_slots - 1] = best.0;
    }
    (choice, costs)
}

/// Chooses for all nodes of a subtree.
fn plan(nodes: &[Node<2>], base: u32, subtree: Subtree, choices: &mut [Choice]) -> Costs {
    let Subtree { node, n } = subtree;
    if n == 1 {
        return LEAF;
    }
    let [left, right] = split_of(nodes, base, subtree);
    let (here, below) = choices.split_at_mut(1);
    if n > TASK_LIMIT {
        let (left_choices, right_choices) = below.split_at_mut(left.n - 1);
        let (left, right) = rayon::join(
            || plan(nodes, base, left, left_choices),
            || plan(nodes, base, right, right_choices),
        );
        let (choice, costs) = choose(area_of(&nodes[node]), &left, &right);
        here[0] = choice;
        return costs;
    }
    // Children come after their parents: backwards, they are done first.
    let mut costs = vec![LEAF; n - 1];
    for i in (0..n - 1).rev() {
        let source = &nodes[node + i];
        let of = |child: PrimRef| {
            if child.is_node() { costs[(child.index() - base) as usize - node] } else { LEAF }
        };
        let (left, right) = (of(source.children[0]), of(source.children[1]));
        let (choice, cost) = choose(area_of(source), &left, &right);
        choices[i] = choice;
        costs[i] = cost;
    }
    costs[0]
}

/// A child of a wide node: the box is in a slot of a binary node.
#[derive(Clone, Copy)]
struct Slot {
    parent: usize,
    slot: usize,
    subtree: Subtree,
}

/// The children of a wide node.
#[derive(Clone, Copy)]
struct Slots {
    slots: [Option<Slot>; WIDTH],
    n: usize,
}

impl Tree<'_> {
    /// The children that the wide node in place of a binary one has.
    fn children(&self, subtree: Subtree) -> Slots {
        let mut slots = Slots { slots: [None; WIDTH], n: 0 };
        self.expand(subtree, WIDTH, &mut slots);
        slots
    }

    /// Gives the children of a node their share of some slots.
    fn expand(&self, subtree: Subtree, n_slots: usize, slots: &mut Slots) {
        let n_left = self.choices[subtree.node].n_left(n_slots);
        let shares = [n_left, n_slots - n_left];
        let children = split_of(self.nodes, self.base, subtree);
        for (slot, (child, share)) in children.into_iter().zip(shares).enumerate() {
            let mut share = share;
            if child.n > 1 {
                // Fewer are as good.
                while share > 1 && self.choices[child.node].n_left(share) == 0 {
                    share -= 1;
                }
            }
            if child.n == 1 || share == 1 {
                slots.slots[slots.n] = Some(Slot { parent: subtree.node, slot, subtree: child });
                slots.n += 1;
            } else {
                self.expand(child, share, slots);
            }
        }
    }

    /// Number of wide nodes in place of a subtree.
    fn count(&self, subtree: Subtree) -> usize {
        let mut n = 0;
        let mut stack = vec![subtree];
        while let Some(subtree) = stack.pop() {
            n += 1;
            let inner = self.children(subtree).slots.into_iter().flatten().map(|s| s.subtree);
            stack.extend(inner.filter(|child| child.n > 1));
        }
        n
    }

    /// Writes the wide node in place of a binary one; `link` gives the index of each child that is a
    /// node.
    fn write(&self, subtree: Subtree, mut link: impl FnMut(Subtree) -> u32) -> Node<WIDTH> {
        let mut wide = Node::EMPTY;
        for (i, child) in self.children(subtree).slots.into_iter().flatten().enumerate() {
            let source = &self.nodes[child.parent];
            for axis in 0..3 {
                wide.lo[axis][i] = source.lo[axis][child.slot];
                wide.hi[axis][i] = source.hi[axis][child.slot];
            }
            wide.children[i] = if child.subtree.n == 1 {
                source.children[child.slot]
            } else {
                PrimRef::new(PrimKind::Node, link(child.subtree))
            };
        }
        wide
    }

    /// Writes all wide nodes in place of a subtree, the first of which has this index.
    fn write_all(&self, subtree: Subtree, out: &mut [Node<WIDTH>], index: u32) {
        let mut n = 1;
        let mut stack = vec![(subtree, 0)];
        while let Some((subtree, slot)) = stack.pop() {
            out[slot] = self.write(subtree, |child| {
                stack.push((child, n));
                n += 1;
                index + (n - 1) as u32
            });
        }
    }
}

/// Appends the wide tree in place of a binary one over `n` primitives, at least two. `nodes` are the
/// nodes of the binary tree, whose root has the index `base`. The root of the wide tree gets the index
/// `index`, at which `out` is cut off or continued.
pub(crate) fn widen(
    nodes: &[Node<2>],
    base: u32,
    out: &mut Vec<Node<WIDTH>>,
    index: u32,
    progress: &Progress,
) {
    let n = nodes.len() + 1;
    let root = Subtree { node: 0, n };
    let mut tree = Tree { nodes, base, choices: vec![Choice::default(); nodes.len()] };
    plan(nodes, base, root, &mut tree.choices);
    progress.add(n);
    // The top of the tree is written by one thread, subtrees below it by all.
    let mut top: Vec<Subtree> = Vec::new();
    let mut tasks: Vec<Subtree> = Vec::new();
    let mut add = |subtree: Subtree, top: &mut Vec<Subtree>| {
        if subtree.n > TASK_LIMIT { top.push(subtree) } else { tasks.push(subtree) }
    };
    add(root, &mut top);
    let mut i = 0;
    while i < top.len() {
        for child in tree.children(top[i]).slots.into_iter().flatten() {
            if child.subtree.n > 1 {
                add(child.subtree, &mut top);
            }
        }
        i += 1;
    }
    let counts: Vec<usize> = tasks.par_iter().map(|&subtree| tree.count(subtree)).collect();
    let n_nodes = top.len() + counts.iter().sum::<usize>();
    out.truncate(index as usize);
    out.par_extend(rayon::iter::repeat_n(Node::EMPTY, n_nodes));
    let (out_top, mut rest) = out[index as usize..].split_at_mut(top.len());
    let mut parts = Vec::with_capacity(tasks.len());
    let mut next = index + top.len() as u32;
    for (&subtree, &count) in tasks.iter().zip(&counts) {
        let (part, behind) = rest.split_at_mut(count);
        rest = behind;
        parts.push((subtree, part, next));
        next += count as u32;
    }
    // Children are met in the order in which they were listed.
    let mut next_top = index + 1;
    let mut first_of_tasks = parts.iter().map(|part| part.2);
    for (node, &subtree) in out_top.iter_mut().zip(&top) {
        *node = tree.write(subtree, |child| {
            if child.n > TASK_LIMIT {
                next_top += 1;
                next_top - 1
            } else {
                first_of_tasks.next().unwrap_or_default()
            }
        });
    }
    progress.add(n - tasks.iter().map(|subtree| subtree.n).sum::<usize>());
    parts.into_par_iter().for_each(|(subtree, part, first)| {
        tree.write_all(subtree, part, first);
        progress.add(subtree.n);
    });
}
