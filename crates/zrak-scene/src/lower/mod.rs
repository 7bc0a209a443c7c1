//! From a valid description to the arena.
//!
//! All computation is in `f64` with correctly rounded operations or the `libm` crate's functions,
//! and rounded to `f32` once, so an arena is the same on every machine.

mod assets;
mod budget;
mod camera;
mod curves;
mod environment;
mod lights;
mod meshes;
mod objects;
mod patches;
mod sky;
mod surfaces;
mod textures;
mod transform;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use zrak_accel::{BuildOptions, Trees};
use zrak_core::math::Bounds;
use zrak_core::scene::{Background, Globals, PrimKind, PrimRef};
use zrak_core::shapes::primitive_bounds;

use crate::arena::{SceneArena, SceneArrays};
use crate::desc::{BackgroundDesc, SceneDesc, Triple};
use crate::progress::{LoadProgress, LoadStage};
use crate::validate::{KeyPath, Problem};
use budget::Budget;

pub use assets::{Assets, EMBEDDED, MissingTextures, resolve, stays_inside};
pub use transform::Transform;

/// Where the files are that a scene refers to, which may be read, and how large they may be.
#[derive(Clone, Debug)]
pub struct LowerOptions {
    /// Folder that relative paths start from.
    pub base_dir: PathBuf,
    /// Limits of each image.
    pub image_limits: zrak_image::Limits,
    /// Most bytes of all meshes and images that are read, and of the arena that is made of them.
    pub max_bytes: u64,
    /// Whether files outside of the folder may be read.
    pub allow_external: bool,
    /// Pictures inside the scene's file: the path `embedded:NAME` means entry `NAME`.
    pub embedded: Embedded,
    /// What becomes of textures whose image cannot be read.
    pub missing_textures: MissingTextures,
    /// Is told how far the lowering is.
    pub progress: LoadProgress,
}

/// Pictures in memory, by name.
pub type Embedded = BTreeMap<String, Arc<[u8]>>;

/// [`LowerOptions::max_bytes`], unless it is changed: 16 GiB.
pub const MAX_BYTES: u64 = 16 << 30;

impl LowerOptions {
    /// Options for a scene whose paths are relative to `base_dir`.
    #[must_use]
    pub fn new(base_dir: impl AsRef<Path>) -> Self {
        Self {
            base_dir: base_dir.as_ref().to_owned(),
            image_limits: zrak_image::Limits::default(),
            max_bytes: MAX_BYTES,
            allow_external: false,
            embedded: Embedded::default(),
            missing_textures: MissingTextures::default(),
            progress: LoadProgress::default(),
        }
    }
}

/// What a description was lowered to.
#[derive(Clone)]
pub struct Lowered {
    /// The arena.
    pub arena: SceneArena,
    /// What had to be left out or replaced.
    pub warnings: Vec<Problem>,
    /// The images that are in the arena.
    pub images: Vec<LoadedImage>,
}

/// An image in an arena.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadedImage {
    /// Its path in the description.
    pub path: String,
    /// Where its texels begin, as [`zrak_core::textures::ImageTexture`] says it.
    pub first_word: u32,
}

/// Builds the arena of a description.
///
/// # Errors
/// The problems that [`crate::validate::validate`] finds, or those of the files it refers to.
pub fn lower(desc: &SceneDesc, options: &LowerOptions) -> Result<SceneArena, Vec<Problem>> {
    lower_with_warnings(desc, options).map(|lowered| lowered.arena)
}

/// [`lower`], and what there is to say about it.
///
/// # Errors
/// As for [`lower`].
pub fn lower_with_warnings(
    desc: &SceneDesc,
    options: &LowerOptions,
) -> Result<Lowered, Vec<Problem>> {
    let problems = crate::validate::validate(desc);
    if !problems.is_empty() {
        return Err(problems);
    }
    let progress = &options.progress;
    let budget = Budget::new(options.max_bytes);
    let mut warnings = Vec::new();
    let mut arrays = SceneArrays::default();
    let mut textures = textures::Textures::new(desc);
    let materials = surfaces::lower(desc, &mut textures, &mut arrays);
    lights::lower(desc, &mut arrays);
    environment::lower(&desc.background, &mut textures, &mut arrays);
    let images = textures.read_images(options, &budget, &mut arrays, &mut warnings)?;
    progress.begin(LoadStage::Objects, desc.meshes.len() as u64);
    let mut meshes = meshes::Meshes::new(desc, options, &budget);
    meshes.read_files();
    let objects = objects::lower(desc, &materials, &mut meshes, &mut arrays)?;
    drop(meshes);
    let globals = globals(desc);
    let whole = |message: String| Problem { path: KeyPath::default(), message, help: None };
    let n_bytes = arrays.n_bytes() as u64 + objects.n_tree_bytes(arrays.instances.len());
    if n_bytes > options.max_bytes {
        let help = Some(budget::HELP.to_owned());
        return Err(vec![Problem { help, ..whole(budget.exceeded()) }]);
    }
    build(objects, globals, &mut arrays, progress).map_err(|message| vec![whole(message)])?;
    progress.begin(LoadStage::Packing, 0);
    match SceneArena::pack(globals, arrays) {
        Ok(arena) => Ok(Lowered { arena, warnings, images }),
        Err(corrupt) => Err(vec![whole(corrupt.to_string())]),
    }
}

/// Builds the trees: first those that instances place, then that of the world, whose boxes hold them.
fn build(
    objects: objects::LoweredObjects,
    globals: Globals,
    arrays: &mut SceneArrays,
    progress: &LoadProgress,
) -> Result<(), String> {
    let n_total = objects.sets.iter().map(Vec::len).sum::<usize>()
        + objects.world.len()
        + arrays.instances.len();
    let mut built = Built { progress, n_total, n: 0 };
    progress.begin(LoadStage::Trees, 1000);
    let shutter = [globals.camera.shutter_open_s, globals.camera.shutter_close_s];
    let bounded = |arrays: &SceneArrays, prims: Vec<PrimRef>| -> Vec<(PrimRef, Bounds)> {
        let view = arrays.view(globals);
        prims.into_par_iter().map(|prim| (prim, primitive_bounds(&view, prim, shutter))).collect()
    };
    let room = |trees: &Trees, prims: &[PrimRef]| {
        let message = "the scene has more primitives than trees have nodes for: 2^28";
        if trees.has_room_for(prims.len()) { Ok(()) } else { Err(message.to_owned()) }
    };
    let mut trees = Trees::new();
    let mut roots = Vec::with_capacity(objects.sets.len());
    for prims in objects.sets {
        room(&trees, &prims)?;
        let n = prims.len();
        let tell = |share| built.tell(share, n);
        let build = BuildOptions { progress: Some(&tell) };
        roots.push(trees.append_with(bounded(arrays, prims), &build));
        built.n += n;
    }
    for (instance, &set) in arrays.instances.iter_mut().zip(&objects.set_of_instance) {
        [instance.root2, instance.root8] = roots[set as usize];
    }
    let mut prims = objects.world;
    prims.extend((0..arrays.instances.len()).map(|i| PrimRef::new(PrimKind::Instance, i as u32)));
    room(&trees, &prims)?;
    // The boxes of instances are those of the roots of their trees.
    (arrays.nodes2, arrays.nodes8) = (trees.nodes2, trees.nodes8);
    let world = bounded(arrays, prims);
    trees = Trees {
        nodes2: std::mem::take(&mut arrays.nodes2),
        nodes8: std::mem::take(&mut arrays.nodes8),
    };
    let n = world.len();
    let tell = |share| built.tell(share, n);
    trees.set_root_with(world, &BuildOptions { progress: Some(&tell) });
    (arrays.nodes2, arrays.nodes8) = (trees.nodes2, trees.nodes8);
    Ok(())
}

/// How many primitives are in trees.
struct Built<'a> {
    progress: &'a LoadProgress,
    n_total: usize,
    n: usize,
}

impl Built<'_> {
    /// A share of the tree over the next `n` primitives is built.
    fn tell(&self, share: f32, n: usize) {
        let done = self.n as f64 + f64::from(share) * n as f64;
        self.progress.set((1000.0 * done / self.n_total.max(1) as f64) as u64);
    }
}

/// What there is one of in a scene.
pub(crate) fn globals(desc: &SceneDesc) -> Globals {
    let color = |c: Triple| zrak_core::math::Color::from_array(c.map(|x| x as f32));
    let background = match &desc.background {
        BackgroundDesc::Constant { color: c } => Background { bottom: color(*c), top: color(*c) },
        BackgroundDesc::Gradient { bottom, top } => {
            Background { bottom: color(*bottom), top: color(*top) }
        }
        // The environment's picture is what is seen.
        BackgroundDesc::Image { .. } | BackgroundDesc::Sky { .. } => {
            Background { bottom: color([0.0; 3]), top: color([0.0; 3]) }
        }
    };
    Globals {
        camera: camera::lower(&desc.camera),
        background,
        max_depth: desc.render.max_depth,
        seed_lo: desc.render.seed as u32,
        seed_hi: (desc.render.seed >> 32) as u32,
        camera_medium: surfaces::medium_index(desc, desc.camera.medium.as_deref()),
        rr_depth: desc.render.rr_depth,
        _pad: 0,
    }
}
