//! zrak, a physically based path tracer: one source, one image, nothing to install.
//!
//! This is the crate to depend on. A scene is loaded by name or from a file, lowered to an
//! arena, and rendered on the GPU if there is one, or else on the processor; the picture is the
//! same to the last bit wherever it is rendered.
//!
//! ```
//! use zrak::{Control, RenderOptions, Transfer};
//!
//! # fn main() -> Result<(), zrak::Error> {
//! # let folder = tempfile::tempdir().unwrap();
//! # std::env::set_current_dir(folder.path()).unwrap();
//! let mut scene = zrak::load_scene("cornell-box")?;
//! scene.desc.camera.width = 60;
//! scene.desc.camera.height = 60;
//!
//! let options = RenderOptions::default();
//! let mut notices = |line: &str| eprintln!("{line}");
//! let output = zrak::render(scene.lower()?, 4, &options, &Control::default(), &mut notices)?;
//!
//! let metadata = output.metadata(&scene.desc);
//! let picture = output.film.to_picture();
//! zrak::image::write("cornell.png".as_ref(), &picture, Some(&metadata), Transfer::Srgb)?;
//! # assert!(std::path::Path::new("cornell.png").is_file());
//! # Ok(())
//! # }
//! ```
//!
//! The other crates are here as modules: [`scene`] to build a scene in code, [`image`] to read,
//! write and compare pictures, [`backend`] to write a backend, [`cpu`] and [`cuda`] for the
//! backends there are, and [`core`] for what computes every sample.

mod backends;
mod convert;
mod error;
mod load;
mod memory;
mod render;

pub use zrak_core as core;
pub use zrak_cpu as cpu;
pub use zrak_cuda as cuda;
pub use zrak_image as image;
pub use zrak_render as backend;
pub use zrak_scene as scene;

pub use zrak_cpu::Tree;
pub use zrak_image::{Metadata, Picture, Transfer};
pub use zrak_render::{BackendInfo, Control, Film, Times};
pub use zrak_scene::arena::SceneArena;
pub use zrak_scene::desc::SceneDesc;
pub use zrak_scene::lower::{LoadedImage, MissingTextures};
pub use zrak_scene::progress::{LoadProgress, LoadStage};

pub use backends::{
    BackendChoice, Devices, RenderOptions, UnknownBackend, cpu_instruction_set, n_threads,
};
pub use convert::{Converted, SceneFormat, convert, to_toml};
pub use error::{Error, ErrorKind};
pub use load::{GltfOptions, LoadOptions, LoweredScene, Scene, load_scene, load_scene_with};
pub use render::{RenderOutput, render};

/// The version of zrak.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
