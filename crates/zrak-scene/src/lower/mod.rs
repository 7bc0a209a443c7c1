//! From a valid description to the arena.
//!
//! All computation is in `f64` with correctly rounded operations or the `libm` crate's functions,
//! and rounded to `f32` once, so an arena is the same on every machine.

mod assets;
mod camera;
mod objects;
mod surfaces;
mod transform;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use zrak_accel::build_trees;
use zrak_core::scene::{Background, Globals};
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
    let prims = objects::lower(desc, &materials, &mut arrays);
    let globals = globals(desc);
    let shutter = [globals.camera.shutter_open_s, globals.camera.shutter_close_s];
    let view = arrays.view(globals);
    let bounded: Vec<_> =
        prims.into_iter().map(|prim| (prim, primitive_bounds(&view, prim, shutter))).collect();
    let trees = build_trees(&bounded);
    arrays.nodes2 = trees.nodes2;
    arrays.nodes8 = trees.nodes8;
    SceneArena::pack(globals, &arrays).map_err(|corrupt| {
        vec![Problem { path: KeyPath::default(), message: corrupt.to_string(), help: None }]
    })
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
        _pad: [0; 3],
    }
}
