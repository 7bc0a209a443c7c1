//! Bounding volume hierarchies of any width, with one primitive in a leaf.
//!
//! A node holds the boxes of its children, so that one visit tests all of them: two at a time
//! suit the GPU's 16-byte loads, eight the processor's vector registers. A leaf's box is exactly the
//! bounds of its primitive: the test that the definition of a hit asks for is the one that the tree
//! makes anyway.

use super::{Accel, found, keep_closer, no_hit};
use crate::accessor::{Array, Stack, StackMemory};
use crate::interaction::{Hit, NO_INSTANCE};
use crate::math::{SLAB_SLACK, Vec3, max, min, reciprocal_or_huge};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimKind, PrimRef, SceneView};

/// Node of a tree with up to `N` children: structure of arrays, by axis and child.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Node<const N: usize> {
    /// Smallest coordinates of the children's boxes.
    pub lo: [[f32; N]; 3],
    /// Largest coordinates of the children's boxes.
    pub hi: [[f32; N]; 3],
    /// The children; [`PrimRef::NONE`] in slots without one, with an empty box.
    pub children: [PrimRef; N],
    /// Nothing; keeps the size a power of two.
    pub _pad: [u32; N],
}

const _: () = assert!(size_of::<Node<2>>() == 64);
const _: () = assert!(size_of::<Node<8>>() == 256);

impl<const N: usize> Node<N> {
    /// Node without children. Their boxes lie at infinity in one octant; a ray that runs there and
    /// has hit nothing visits them in vain, for there is no primitive in them.
    pub const EMPTY: Self = Self {
        lo: [[f32::INFINITY; N], [f32::NEG_INFINITY; N], [f32::INFINITY; N]],
        hi: [[f32::INFINITY; N], [f32::NEG_INFINITY; N], [f32::INFINITY; N]],
        children: [PrimRef::NONE; N],
        _pad: [0; N],
    };
}

/// Most nodes on the way from the root of a tree to a leaf, of any width. A visit leaves at most
/// N - 1 children behind, which bounds the traversal's stack.
pub const MAX_DEPTH: usize = 48;

/// Binary tree with the stack that it needs.
pub type Bvh2<'a> = Bvh<'a, 2, { 2 * MAX_DEPTH }>;
/// Eight-wide tree with the stack that it needs.
pub type Bvh8<'a> = Bvh<'a, 8, { 14 * MAX_DEPTH }>;

/// A tree with up to `N` children to a node and a stack of `S` entries; node 0 is its root.
#[derive(Clone, Copy)]
pub struct Bvh<'a, const N: usize, const S: usize> {
    /// All nodes.
    pub nodes: Array<'a, Node<N>>,
}

/// A child to visit, and where the ray enters its box.
type Entry = (f32, PrimRef);

impl<const N: usize, const S: usize> Accel for Bvh<'_, N, S> {
    #[inline(always)]
    fn closest_hit(
        &self,
        scene: &SceneView,
        ray: &Ray,
        sampler: &Sampler,
        t_max: f32,
    ) -> Option<Hit> {
        let has_instances = scene.kinds.has_prim(PrimKind::Instance);
        // The space that the traversal is in: the world, or that of an instance, whose entries lie on
        // top of the stack's first `base`.
        let mut space = Space::world(ray);
        let mut memory = StackMemory::<Entry, S>::new();
        let mut stack = Stack::new(&mut memory);
        let mut best = no_hit(t_max);
        let mut current: Option<Entry> = Some((0.0, PrimRef(0)));
        // Loops have a single exit each: see `render_pixel` about what compilers do otherwise.
        while let Some(entry) = current {
            // Go down to a leaf, the nearest child first.
            let mut leaf = Some(entry);
            while let Some((_, link)) = leaf
                && link.is_node()
            {
                let node = self.nodes.get(link.index());
                let mut enter = [0.0; N];
                let mut leave = [0.0; N];
                for i in 0..N {
                    let (o, inv_d) = (space.ray.o, space.inv_d);
                    let x0 = (node.lo[0][i] - o.x) * inv_d.x;
                    let x1 = (node.hi[0][i] - o.x) * inv_d.x;
                    let y0 = (node.lo[1][i] - o.y) * inv_d.y;
                    let y1 = (node.hi[1][i] - o.y) * inv_d.y;
                    let z0 = (node.lo[2][i] - o.z) * inv_d.z;
                    let z1 = (node.hi[2][i] - o.z) * inv_d.z;
                    let near = max(min(z0, z1), space.t_floor);
                    enter[i] = max(max(min(x0, x1), min(y0, y1)), near);
                    // The slack keeps the test conservative; beyond the closest hit nothing counts.
                    leave[i] =
                        min(min(max(x0, x1), min(max(y0, y1), max(z0, z1))) * SLAB_SLACK, best.t);
                }
                leaf = next_child(&node, &enter, &leave, &mut stack);
                if leaf.is_none() {
                    leaf = pop(&mut stack, space.base, best.t);
                }
            }
            current = None;
            if let Some((t_enter, prim)) = leaf {
                if has_instances && prim.kind() == Some(PrimKind::Instance) {
                    let instance = scene.instances.get(prim.index());
                    let local = instance.placement_at(scene, ray.time).object_ray(ray);
                    space = Space {
                        inv_d: local.d.map(reciprocal_or_huge),
                        ray: local,
                        t_floor: t_enter,
                        instance: prim.index(),
                        base: stack.len(),
                    };
                    let root = if N == 2 { instance.root2 } else { instance.root8 };
                    current = Some((t_enter, PrimRef(root)));
                } else {
                    let placed = (prim, space.instance);
                    keep_closer(&mut best, scene, placed, &space.ray, sampler, t_enter);
                    current = pop(&mut stack, space.base, best.t);
                }
            }
            if has_instances && current.is_none() && space.instance != NO_INSTANCE {
                // Done with the instance.
                space = Space::world(ray);
                current = pop(&mut stack, 0, best.t);
            }
        }
        found(best)
    }
}

/// The space that a traversal is in.
#[derive(Clone, Copy)]
struct Space {
    /// The ray in this space.
    ray: Ray,
    /// One over its direction.
    inv_d: Vec3,
    /// Where it enters the instance; nothing in there counts as closer.
    t_floor: f32,
    /// The instance, or [`NO_INSTANCE`] in the world.
    instance: u32,
    /// Number of entries of the stack that belong to the world.
    base: u32,
}

impl Space {
    #[inline(always)]
    fn world(ray: &Ray) -> Self {
        let inv_d = ray.d.map(reciprocal_or_huge);
        Self { ray: *ray, inv_d, t_floor: 0.0, instance: NO_INSTANCE, base: 0 }
    }
}

/// Takes the next entry above the first `base` that can still hold a closer hit.
#[inline(always)]
fn pop<const S: usize>(stack: &mut Stack<'_, Entry, S>, base: u32, t_best: f32) -> Option<Entry> {
    let mut entry = stack.pop_above(base);
    // An equally close one with a smaller handle would count, so those are kept.
    while let Some((t_enter, _)) = entry
        && t_enter > t_best
    {
        entry = stack.pop_above(base);
    }
    entry
}

/// The nearest child that the ray meets; the others go on the stack, the farthest first.
#[inline(always)]
fn next_child<const N: usize, const S: usize>(
    node: &Node<N>,
    enter: &[f32; N],
    leave: &[f32; N],
    stack: &mut Stack<'_, Entry, S>,
) -> Option<Entry> {
    if N == 2 {
        let first = (enter[0], node.children[0]);
        let second = (enter[1], node.children[1]);
        return match (enter[0] <= leave[0], enter[1] <= leave[1]) {
            (true, true) => {
                let (near, far) =
                    if second.0 < first.0 { (second, first) } else { (first, second) };
                stack.push(far);
                Some(near)
            }
            (true, false) => Some(first),
            (false, true) => Some(second),
            (false, false) => None,
        };
    }
    let mut mask = 0_u32;
    for i in 0..N {
        mask |= u32::from(enter[i] <= leave[i]) << i;
    }
    if mask == 0 {
        return None;
    }
    let take = |mask: &mut u32| {
        let i = mask.trailing_zeros() as usize % N;
        *mask &= *mask - 1;
        (enter[i], node.children[i])
    };
    let first = take(&mut mask);
    if mask == 0 {
        return Some(first);
    }
    let second = take(&mut mask);
    let (mut near, far) = if second.0 < first.0 { (second, first) } else { (first, second) };
    if mask == 0 {
        stack.push(far);
        return Some(near);
    }
    // Three or more: sort by insertion.
    let mut sorted = [near; N];
    sorted[1] = far;
    let mut n = 2;
    while mask != 0 {
        let entry = take(&mut mask);
        let mut k = n;
        while k > 0 && entry.0 < sorted[k - 1].0 {
            sorted[k % N] = sorted[k - 1];
            k -= 1;
        }
        sorted[k % N] = entry;
        n += 1;
    }
    near = sorted[0];
    for entry in sorted[1..n].iter().rev() {
        stack.push(*entry);
    }
    Some(near)
}
