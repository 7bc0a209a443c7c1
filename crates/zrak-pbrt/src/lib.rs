//! Scene files of pbrt-v4: read as scene descriptions, and written.
//!
//! The file is read directive by directive, as pbrt does it: each changes the graphics state or adds
//! something that is made of it. What a description cannot say becomes the nearest thing that it can,
//! with one warning; `docs/guide/pbrt.md` says what is exact and what is not. The format is documented at
//! <https://pbrt.org/fileformat-v4>.
//!
//! Files are untrusted: they may not lead out of the scene's folder unless that is allowed, may not
//! include themselves, and may not be larger than a limit, unpacked.
//!
//! # To read something new
//! A shape goes into `shapes.rs`, a material into `materials.rs`, and so on: one function for each
//! directive, with an arm for each type. Parameters that nothing asks for are warned about.

mod camera;
mod color;
mod curves;
mod directives;
mod error;
mod export;
mod facts;
mod given;
mod lens;
mod lexer;
mod lights;
mod materials;
mod maths;
mod media;
mod params;
mod places;
mod reader;
mod references;
mod scopes;
mod settings;
mod shapes;
mod source;
mod spectrum;
mod state;
mod surfaces;
mod textures;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use export::{ExportOptions, Exported, Sink, export, export_to};

use zrak_scene::desc::SceneDesc;
use zrak_scene::error::SceneError;

/// What a reader may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImportOptions {
    /// Whether files outside of the scene's folder may be read.
    pub allow_external: bool,
    /// Most bytes of all files together, once they are unpacked, and of the meshes made of them.
    pub max_bytes: u64,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { allow_external: false, max_bytes: 16 << 30 }
    }
}

/// Something that was not read as it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file.
    pub file: PathBuf,
    /// The line in it, counted from 1.
    pub line: usize,
    /// What became of it.
    pub message: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}: {}", self.file.display(), self.line, self.message)
    }
}

/// A scene and what was not read as it stands.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The scene; paths of its images are relative to `base_dir`.
    pub desc: SceneDesc,
    /// The folder of the file.
    pub base_dir: PathBuf,
    /// What the file wants its picture to be called.
    pub filename: Option<String>,
    /// In the order of the file.
    pub warnings: Vec<Warning>,
}

/// Reads a file.
///
/// # Errors
/// If it, or a file that it includes, cannot be read or is not a pbrt-v4 scene. The error shows the place.
pub fn import(path: &Path, options: &ImportOptions) -> Result<Imported, SceneError> {
    state::Importer::new(path, source::Store::Disk, *options)?.run()
}

/// Reads a scene whose files are in memory, by their paths relative to the scene's folder: those that the
/// scene includes, its spectra and its PLY meshes. Pictures stay paths, as they do in [`import`].
///
/// # Errors
/// As for [`import`]; a file that is not in `files` cannot be read.
pub fn import_from_memory(
    path: &Path,
    files: BTreeMap<PathBuf, Vec<u8>>,
    options: &ImportOptions,
) -> Result<Imported, SceneError> {
    state::Importer::new(path, source::Store::Memory(files), *options)?.run()
}
