//! Checks that trees are some: each node but a root has one parent, which comes before it, and none is
//! too deep. The world's root is the first; the others are those of instances, in whose trees no
//! instance and no medium is.
//!
//! A piece of the nodes is checked on its own: it falls into parts of trees whose roots, its *tops*,
//! have their parent in an earlier piece, or none. In the end the links that cross from piece to piece
//! must lead to the tops, to each once. Trees are laid out depth first, so few links do; others would
//! only take longer.

use std::sync::Mutex;

use rayon::prelude::*;
use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::accessor::Array;
use zrak_core::scene::{PrimKind, PrimRef, SceneView};
use zrak_core::shapes::Instance;

use super::{BATCH, Check, Corrupt, n_prims, require};
use crate::arena::PIECE_SIZE;

pub(super) struct TreeChecker<'a, const N: usize> {
    name: &'static str,
    nodes: Array<'a, Node<N>>,
    /// Number of primitives of each kind, by the number of the kind.
    n_prims: [u32; 16],
    /// Roots of the trees that instances place, in order, each once.
    placed_roots: Vec<u32>,
    /// What was found in the pieces, with their numbers.
    parts: Mutex<Vec<(usize, Parts)>>,
}

/// The parts of trees in a piece.
#[derive(Default)]
struct Parts {
    tops: Vec<Top>,
    links: Vec<Link>,
}

/// The root of a part of a tree.
struct Top {
    node: u32,
    /// Levels of nodes of the part.
    depth: u8,
    /// Whether there is something in it that must not be placed.
    is_of_world: bool,
}

/// A link to a node of a later piece.
struct Link {
    child: u32,
    /// Number of the part's top in its piece.
    top: u32,
    /// Level of the child, counted from the top's, which is 1.
    depth: u8,
}

/// Bit for each kind of primitive that must not be placed.
const OF_WORLD: u32 = 1 << PrimKind::Instance as u32 | 1 << PrimKind::Medium as u32;

/// Level of a node that nothing was found to lead to.
const UNKNOWN: u8 = 0;

impl<'a, const N: usize> TreeChecker<'a, N> {
    const PIECE: usize = PIECE_SIZE / size_of::<Node<N>>();

    pub(super) fn new(
        name: &'static str,
        scene: &SceneView<'a>,
        nodes: Array<'a, Node<N>>,
        root: impl Fn(&Instance) -> u32 + Sync,
    ) -> Result<Self, Corrupt> {
        require(!nodes.is_empty(), || format!("{name} has no root"))?;
        let instances = &scene.instances;
        let roots = (0..instances.len()).into_par_iter().with_min_len(BATCH);
        let mut placed_roots: Vec<u32> = roots.map(|i| root(&instances.get(i))).collect();
        // Many instances of few trees: most are the same as the one before.
        placed_roots.dedup();
        placed_roots.par_sort_unstable();
        placed_roots.dedup();
        let wrong = |root: &&u32| **root == 0 || **root >= nodes.len();
        if let Some(root) = placed_roots.iter().find(wrong) {
            return Err(Corrupt::new(format!("an instance of node {root} of {name}")));
        }
        let n_prims = std::array::from_fn(|kind| n_prims(scene, kind as u32));
        Ok(Self { name, nodes, n_prims, placed_roots, parts: Mutex::default() })
    }

    /// Checks a piece of the nodes.
    #[inline(never)]
    pub(super) fn check_piece(&self, index: usize) -> Check {
        let first = (index * Self::PIECE) as u32;
        let end = self.nodes.len().min(first.saturating_add(Self::PIECE as u32));
        // Level of each node in its part, and number of its top.
        let mut known = vec![(UNKNOWN, 0_u16); (end - first) as usize];
        let known = known.as_mut_slice();
        let mut parts = Parts::default();
        for i in first..end {
            let place = (i - first) as usize;
            if known[place].0 == UNKNOWN {
                known[place] = (1, parts.tops.len() as u16);
                parts.tops.push(Top { node: i, depth: 1, is_of_world: false });
            }
            let (depth, top) = known[place];
            let below = (depth + 1, top);
            let mut kinds = 0_u32;
            for child in self.nodes.get(i).children {
                let (kind, c) = (child.0 >> 28, child.index());
                kinds |= 1 << kind;
                if !child.is_node() {
                    if c >= self.n_prims[kind as usize] && child != PrimRef::NONE {
                        return Err(self.wrong_child(i, child));
                    }
                    continue;
                }
                let is_new = if c >= end {
                    parts.links.push(Link { child: c, top: u32::from(top), depth: below.0 });
                    c < self.nodes.len()
                } else if c > i {
                    std::mem::replace(&mut known[(c - first) as usize], below).0 == UNKNOWN
                } else {
                    false
                };
                if !is_new {
                    return Err(self.wrong_child(i, child));
                }
            }
            let part = &mut parts.tops[top as usize];
            part.depth = part.depth.max(depth);
            part.is_of_world |= kinds & OF_WORLD != 0;
            // Nodes are kind 0.
            if kinds & 1 != 0 && usize::from(depth) >= MAX_DEPTH {
                return Err(self.too_deep());
            }
        }
        // A root has no parent.
        let from = self.placed_roots.partition_point(|&root| root < first);
        for &root in self.placed_roots[from..].iter().take_while(|&&root| root < end) {
            require(known[(root - first) as usize].0 == 1, || self.second_parent(root))?;
        }
        let mut all = self.parts.lock().map_err(|_| Corrupt::new("a check failed"))?;
        all.push((index, parts));
        Ok(())
    }

    // Apart from the loop, whose numbers would have to be in memory for it.
    #[cold]
    #[inline(never)]
    fn wrong_child(&self, parent: u32, child: PrimRef) -> Corrupt {
        let (name, c) = (self.name, child.index());
        Corrupt::new(if child.is_node() {
            format!("node {parent} of {name} has node {c} as a child")
        } else {
            format!("no primitive {:#x}", child.0)
        })
    }

    #[cold]
    #[inline(never)]
    fn too_deep(&self) -> Corrupt {
        Corrupt::new(format!("{} is too deep", self.name))
    }

    fn second_parent(&self, node: u32) -> String {
        format!("a second node of {} has node {node} as a child", self.name)
    }

    /// Checks how the pieces hang together, once each of them was checked.
    pub(super) fn finish(self) -> Check {
        let mut parts = self.parts.into_inner().map_err(|_| Corrupt::new("a check failed"))?;
        let (name, placed_roots) = (self.name, self.placed_roots);
        parts.sort_unstable_by_key(|(index, _)| *index);
        let (mut tops, mut links) = (Vec::new(), Vec::new());
        for (_, mut piece) in parts {
            let first = tops.len() as u32;
            links.extend(piece.links.drain(..).map(|l| Link { top: first + l.top, ..l }));
            tops.append(&mut piece.tops);
        }
        links.par_sort_unstable_by_key(|link| link.child);
        let (mut links, mut roots) =
            (links.into_iter().peekable(), placed_roots.into_iter().peekable());
        // Levels above each part, and whether it is of a tree that instances place.
        let mut above: Vec<(u8, bool)> = Vec::with_capacity(tops.len());
        for Top { node, depth, is_of_world } in tops {
            let second = |node: u32| format!("a second node of {name} has node {node} as a child");
            if let Some(link) = links.next_if(|link| link.child < node) {
                return Err(Corrupt::new(second(link.child)));
            }
            let link = links.next_if(|link| link.child == node);
            let is_placed_root = roots.next_if(|&root| root == node).is_some();
            let (levels, is_placed) = match link {
                _ if node == 0 || is_placed_root => {
                    require(link.is_none(), || second(node))?;
                    (0, is_placed_root)
                }
                Some(link) => {
                    let (levels, is_placed) = above[link.top as usize];
                    (levels + link.depth - 1, is_placed)
                }
                None => {
                    let message = format!("node {node} of {name} has no parent before it");
                    return Err(Corrupt::new(message));
                }
            };
            require(usize::from(levels) + usize::from(depth) <= MAX_DEPTH, || {
                format!("{name} is too deep")
            })?;
            require(!(is_placed && is_of_world), || {
                format!("an instance or a medium in a tree of {name} that instances place")
            })?;
            above.push((levels, is_placed));
        }
        // What is left leads to nodes that others lead to as well.
        links.next().map_or(Ok(()), |link| {
            Err(Corrupt::new(format!("a second node of {name} has node {} as a child", link.child)))
        })
    }
}
