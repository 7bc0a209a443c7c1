//! Wavefront OBJ files and their MTL materials, as scene descriptions.
//!
//! [`import`] makes a mesh of the faces ([`zrak_mesh::obj`]), OpenPBR surfaces of the materials, and a
//! camera and a soft sky, which the format lacks. What it maps exactly, approximately and not at all is in
//! the guide's page on meshes.
//!
//! Files are untrusted: they may not lead out of the scene's folder unless that is allowed, and may not be
//! larger than a limit, unpacked.

mod import;
mod materials;
mod mtl;
mod textures;

use std::path::PathBuf;

use zrak_scene::desc::SceneDesc;

pub use import::import;

/// What a reader may do.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportOptions {
    /// Whether files outside of the scene's folder may be read.
    pub allow_external: bool,
    /// Most bytes of all files together, once they are unpacked, and of the mesh.
    pub max_bytes: u64,
    /// Height of the picture in pixels; its width follows from the camera.
    pub height: u32,
    /// Whether a scene without lights gets a soft sky.
    pub default_light: bool,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self { allow_external: false, max_bytes: 16 << 30, height: 720, default_light: true }
    }
}

/// Something that was not read as it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file.
    pub file: PathBuf,
    /// The line in it, counted from 1; 0 for the whole file.
    pub line: usize,
    /// What became of it.
    pub message: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file.display(), self.message),
            line => write!(f, "{}:{line}: {}", self.file.display(), self.message),
        }
    }
}

/// A scene and what was not read as it stands.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The scene; paths of its images are relative to `base_dir`.
    pub desc: SceneDesc,
    /// The folder of the file.
    pub base_dir: PathBuf,
    /// In the order of the files.
    pub warnings: Vec<Warning>,
}
