//! From a valid description to the arena.
//!
//! All computation is in `f64` with correctly rounded operations or the `libm` crate's functions,
//! and rounded to `f32` once, so an arena is the same on every machine.

mod assets;
mod camera;
mod lights;
mod meshes;
mod objects;
mod surfaces;
mod transform;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use zrak_accel::Trees;
use zrak_core::accel::Node;
use zrak_core::math::Bounds;
use zrak_core::scene::{Background, Globals, PrimKind, PrimRef};
use zrak_core::shapes::primitive_bounds;

use crate::arena::{SceneArena, SceneArrays};
use crate::desc::{BackgroundDesc, SceneDesc, Triple};
use crate::validate::{KeyPath, Problem};

pub use assets::Assets;
pub use transform::Transform;

/// Where the files are that a scene refers to, and how large they may be.
#[derive(Clone, Debug)]
pub struct LowerOptions {
    /// Folder that relative paths start from.
    pub base_dir: PathBuf,
    /// Limits of images.
    pub image_limits: zrak_image::Limits,
}

impl LowerOptions {
    /// Options for a scene whose paths are relative to `base_dir`.
    #[must_use]
    pub fn new(base_dir: impl AsRef<Path>) -> Self {
        Self { base_dir: base_dir.as_ref().to_owned(), image_limits: zrak_image::Limits::default() }
    }
}

/// Builds the arena of a description.
///
/// # Errors
/// The problems that [`crate::validate::validate`] finds, or those of the files it refers to.
pub fn lower(desc: &SceneDesc, options: &LowerOptions) -> Result<SceneArena, Vec<Problem>> {
    let problems = crate::validate::validate(desc);
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut arrays = SceneArrays::default();
    let materials = surfaces::lower(desc, options, &mut arrays)?;
    lights::lower(desc, &mut arrays);
    let mut meshes = meshes::Meshes::new(desc, options);
    let objects = objects::lower(desc, &materials, &mut meshes, &mut arrays)?;
    drop(meshes);
    let globals = globals(desc);
    build(objects, globals, &mut arrays);
    SceneArena::pack(globals, &arrays).map_err(|corrupt| {
        vec![Problem { path: KeyPath::default(), message: corrupt.to_string(), help: None }]
    })
}

/// Builds the trees: first those that instances place, then that of the world, whose boxes hold them.
fn build(objects: objects::LoweredObjects, globals: Globals, arrays: &mut SceneArrays) {
    let shutter = [globals.camera.shutter_open_s, globals.camera.shutter_close_s];
    let bounded = |arrays: &SceneArrays, prims: Vec<PrimRef>| -> Vec<(PrimRef, Bounds)> {
        let view = arrays.view(globals);
        prims.into_iter().map(|prim| (prim, primitive_bounds(&view, prim, shutter))).collect()
    };
    // The world's root comes first.
    let mut trees = Trees { nodes2: vec![Node::EMPTY], nodes8: vec![Node::EMPTY] };
    let roots: Vec<[u32; 2]> =
        objects.sets.into_iter().map(|prims| trees.append(&bounded(arrays, prims))).collect();
    for (instance, &set) in arrays.instances.iter_mut().zip(&objects.set_of_instance) {
        [instance.root2, instance.root8] = roots[set as usize];
    }
    arrays.nodes2 = std::mem::take(&mut trees.nodes2);
    let mut prims = objects.world;
    prims.extend((0..arrays.instances.len()).map(|i| PrimRef::new(PrimKind::Instance, i as u32)));
    let world = bounded(arrays, prims);
    trees.nodes2 = std::mem::take(&mut arrays.nodes2);
    trees.set_root(&world);
    arrays.nodes2 = trees.nodes2;
    arrays.nodes8 = trees.nodes8;
}

fn globals(desc: &SceneDesc) -> Globals {
    let color = |c: Triple| zrak_core::math::Color::from_array(c.map(|x| x as f32));
    let background = match &desc.background {
        BackgroundDesc::Constant { color: c } => Background { bottom: color(*c), top: color(*c) },
        BackgroundDesc::Gradient { bottom, top } => {
            Background { bottom: color(*bottom), top: color(*top) }
        }
        _ => Background { bottom: color([0.0; 3]), top: color([0.0; 3]) },
    };
    Globals {
        camera: camera::lower(&desc.camera),
        background,
        max_depth: desc.render.max_depth,
        seed_lo: desc.render.seed as u32,
        seed_hi: (desc.render.seed >> 32) as u32,
        camera_medium: surfaces::medium_index(desc, desc.camera.medium.as_deref()),
        _pad: [0; 2],
    }
}
