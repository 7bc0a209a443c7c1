//! A few samples of a scene, by every tree.

use zrak_core::accel::{Accel, BruteForce, Bvh2, Bvh8};
use zrak_core::accessor::Array;
use zrak_core::film::PixelSum;
use zrak_core::integrators::render_pixel;
use zrak_core::interaction::Hit;
use zrak_core::ray::Ray;
use zrak_core::sampler::Sampler;
use zrak_core::scene::{PrimRef, SceneView};
use zrak_scene::arena::SceneArena;
use zrak_scene::desc::{BackgroundDesc, SceneDesc};
use zrak_scene::lower::{Embedded, LowerOptions, MissingTextures, lower};
use zrak_scene::validate::Problem;

/// Pixels to a side.
const SIDE: u32 = 4;
/// Samples of each pixel.
const SAMPLES: u32 = 2;
/// Most path segments: the time that a long path takes is not what is looked for.
const DEPTH_MAX: u32 = 12;
/// Most primitives that brute force is tried with.
const BRUTE_MAX: usize = 64;

/// Lowers a scene, with a small picture and short paths. It finds the files `embedded:small.pfm` and
/// `embedded:small.png` and no others.
pub fn lower_small(desc: &SceneDesc) -> Result<SceneArena, Vec<Problem>> {
    let mut desc = desc.clone();
    desc.camera.width = SIDE;
    desc.camera.height = SIDE;
    desc.render.max_depth = desc.render.max_depth.min(DEPTH_MAX);
    // Skies of any kind are computed, which takes as long as a hundred scenes without one: some are enough.
    if matches!(desc.background, BackgroundDesc::Sky { .. }) && hash(&format!("{desc:?}")) % 64 != 0
    {
        desc.background = BackgroundDesc::Constant { color: [0.5, 0.7, 1.0] };
    }
    let mut options = LowerOptions::new("/no/such/folder");
    options.missing_textures = MissingTextures::Warn;
    options.image_limits.max_bytes = 4 << 20;
    options.max_bytes = 16 << 20;
    options.embedded = Embedded::from([
        ("small.pfm".to_owned(), include_bytes!("../seeds/image/small.pfm")[..].into()),
        ("small.png".to_owned(), include_bytes!("../seeds/image/rgba8.png")[..].into()),
    ]);
    lower(&desc, &options)
}

/// FNV-1a.
fn hash(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193))
}

/// Renders the samples of an arena whose trees may hold boxes of any size, so that they need not agree.
pub fn render(arena: &SceneArena) {
    let view = arena.view();
    picture(&view, Tree::Wide(Bvh8 { nodes: view.nodes8 }));
    picture(&view, Tree::Binary(Bvh2 { nodes: view.nodes2 }));
}

/// Renders the samples with both trees and, if there is little in the scene, without one.
///
/// # Panics
/// If the pictures are not the same.
pub fn render_and_compare(arena: &SceneArena) {
    let view = arena.view();
    let wide = picture(&view, Tree::Wide(Bvh8 { nodes: view.nodes8 }));
    let binary = picture(&view, Tree::Binary(Bvh2 { nodes: view.nodes2 }));
    assert_eq!(wide, binary, "the trees disagree");
    let prims = world(&view);
    if prims.len() <= BRUTE_MAX {
        let brute = picture(&view, Tree::None(BruteForce { prims: Array::new(&prims) }));
        assert_eq!(wide, brute, "the tree hides or adds a hit");
    }
}

fn picture(view: &SceneView, tree: Tree) -> Vec<PixelSum> {
    let pixels = (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE));
    pixels.map(|(x, y)| render_pixel(view, tree, x, y, 0, SAMPLES)).collect()
}

/// The primitives of the world, instances among them.
fn world(view: &SceneView) -> Vec<PrimRef> {
    let (mut prims, mut stack) = (Vec::new(), vec![0]);
    while let Some(node) = stack.pop()
        && prims.len() <= BRUTE_MAX
    {
        for child in view.nodes2.get(node).children {
            if child.is_node() {
                stack.push(child.index());
            } else if child != PrimRef::NONE {
                prims.push(child);
            }
        }
    }
    prims
}

/// A tree that is chosen at run time, so that the integrator is compiled once.
#[derive(Clone, Copy)]
enum Tree<'a> {
    Wide(Bvh8<'a>),
    Binary(Bvh2<'a>),
    None(BruteForce<'a>),
}

impl Accel for Tree<'_> {
    #[inline(never)]
    fn closest_hit(
        &self,
        scene: &SceneView,
        ray: &Ray,
        sampler: &Sampler,
        t_max: f32,
    ) -> Option<Hit> {
        match self {
            Self::Wide(tree) => tree.closest_hit(scene, ray, sampler, t_max),
            Self::Binary(tree) => tree.closest_hit(scene, ray, sampler, t_max),
            Self::None(list) => list.closest_hit(scene, ray, sampler, t_max),
        }
    }
}
