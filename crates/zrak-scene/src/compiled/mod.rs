//! Compiled scenes: the arena in a file, ready to render.
//!
//! A compiled scene is what lowering made of a scene: nothing is parsed, decoded or built when it is
//! opened. The file is mapped into memory and checked in one pass over all of it: the checksum, which
//! finds damage, and every handle (`arena/check.rs`), because whoever can write a file can also write
//! its checksum. See `header` for how it is laid out.
//!
//! Of the scene's description it keeps the name, the camera and how it is sampled, which may be changed;
//! everything else is in the arena alone. It is made for the zrak that wrote it: another one whose
//! records look different says so, and the scene has to be compiled again.

mod checksum;
mod header;

#[cfg(test)]
mod tests;

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;
use std::sync::Arc;

use zrak_core::scene::Globals;

use crate::arena::{SceneArena, Storage, map};
use crate::desc::{CameraDesc, SceneDesc};
use crate::error::{SceneError, SceneErrorKind};
use crate::lower;
use crate::validate::{KeyPath, Problem, validate};

use checksum::Checksum;
use header::Header;

#[doc(hidden)]
pub use header::sign;

/// How the names of compiled scenes end.
pub const EXTENSION: &str = "zscene";

/// A scene that is ready to render, and what of its description can still be changed.
#[derive(Clone)]
pub struct CompiledScene {
    desc: SceneDesc,
    arena: SceneArena,
}

impl CompiledScene {
    /// The scene that `desc` was lowered to.
    #[must_use]
    pub fn new(desc: &SceneDesc, arena: SceneArena) -> Self {
        Self { desc: kept(desc), arena }
    }

    /// Opens a compiled scene. The file is mapped into memory where the system can do that, and must not
    /// be changed in place as long as there is a copy of the scene; it may be replaced or deleted.
    ///
    /// # Errors
    /// If it cannot be read, was written by a zrak with other records, is damaged, or leads astray.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let origin = path.display().to_string();
        let io_error = |error: io::Error| {
            let message = match error.kind() {
                io::ErrorKind::NotFound => "there is no such file".to_owned(),
                _ => format!("cannot read the compiled scene: {error}"),
            };
            SceneError::file(SceneErrorKind::Io, &origin, message, None)
        };
        let metadata = std::fs::metadata(path).map_err(io_error)?;
        if !metadata.is_file() {
            let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
            let message = format!("this is {what}, not a compiled scene");
            return Err(SceneError::file(SceneErrorKind::Io, &origin, message, None));
        }
        let mut file = File::open(path).map_err(io_error)?;
        // Not even the beginning is there; and nothing at all cannot be mapped.
        if metadata.len() < Header::SIZE as u64 {
            let mut start = Vec::new();
            file.take(Header::SIZE as u64).read_to_end(&mut start).map_err(io_error)?;
            return Self::parse(&start, &origin);
        }
        match map(&file) {
            Ok(map) => {
                let map = Arc::new(map);
                let storage = |start| Storage::mapped(Arc::clone(&map), start);
                Self::read(&map, &origin, storage)
            }
            // Some file systems cannot map files.
            Err(_) => {
                let mut bytes = Vec::new();
                file.read_to_end(&mut bytes).map_err(io_error)?;
                Self::parse(&bytes, &origin)
            }
        }
    }

    /// A compiled scene from the bytes of its file, which are copied; `origin` is what errors call it.
    ///
    /// # Errors
    /// As for [`CompiledScene::open`].
    pub fn parse(bytes: &[u8], origin: &str) -> Result<Self, SceneError> {
        Self::read(bytes, origin, |start| Storage::copy_of(&bytes[start..]))
    }

    fn read(
        bytes: &[u8],
        origin: &str,
        storage: impl FnOnce(usize) -> Storage,
    ) -> Result<Self, SceneError> {
        let (header, start) = Header::read(bytes, origin)?;
        let desc = crate::file::parse(&header.text, origin)?;
        if desc != kept(&desc) {
            return Err(damaged(origin, "it describes more than a compiled scene can"));
        }
        let globals = Globals {
            background: header.background,
            camera_medium: header.camera_medium,
            ..lower::globals(&desc)
        };
        let storage = storage(start);
        let checksum = Checksum::new(&header.lens);
        let arena = SceneArena::from_storage(globals, &header.lens, storage, &|i, piece| {
            checksum.add(i, piece);
        });
        // Damage is the likely reason of a handle that leads astray: look for it first.
        let sum = match &arena {
            Ok(_) => checksum.finish(),
            Err(_) => checksum::of_arena(&header.lens, &bytes[start..]),
        };
        if sum != header.arena_checksum {
            return Err(damaged(origin, "its bytes are not the ones that were written"));
        }
        let arena = arena.map_err(|corrupt| damaged(origin, &corrupt.to_string()))?;
        Ok(Self { desc, arena })
    }

    /// Writes the file's content.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        out.write_all(&Header::bytes(&self.desc, &self.arena))?;
        out.write_all(self.arena.bytes())
    }

    /// Writes a file, replacing what was there whole or not at all.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_file(&self, path: impl AsRef<Path>) -> Result<(), zrak_image::Error> {
        zrak_image::replace_file_with(path.as_ref(), |file| self.write(file))
    }

    /// What is known of the scene's description: name, camera and sampling. It has no objects.
    #[must_use]
    pub const fn desc(&self) -> &SceneDesc {
        &self.desc
    }

    /// The scene as it was compiled.
    #[must_use]
    pub const fn arena(&self) -> &SceneArena {
        &self.arena
    }

    /// The scene as seen and sampled by `desc`, which may differ from [`CompiledScene::desc`] in its
    /// name, its camera except for the shutter, and its sampling.
    ///
    /// # Errors
    /// The problems of the description, or that it is one of another scene.
    pub fn arena_for(&self, desc: &SceneDesc) -> Result<SceneArena, Vec<Problem>> {
        let problems = validate(desc);
        if !problems.is_empty() {
            return Err(problems);
        }
        let CameraDesc { shutter_open_s, shutter_close_s, medium, .. } = desc.camera.clone();
        let own = self.desc.clone();
        let camera = CameraDesc { shutter_open_s, shutter_close_s, medium, ..own.camera };
        let SceneDesc { name, description, render, .. } = own;
        let fixed = SceneDesc { name, description, render, camera, ..desc.clone() };
        if fixed != self.desc {
            let message = "of a compiled scene, only the name, the camera but for its shutter, and the \
                 sampling can be changed";
            return Err(vec![Problem {
                path: KeyPath::default(),
                message: message.to_owned(),
                help: Some("change the scene that it was made of, and compile it again".to_owned()),
            }]);
        }
        Ok(self.arena.with_globals(lower::globals(desc)))
    }
}

impl fmt::Debug for CompiledScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CompiledScene")
            .field("name", &self.desc.name)
            .field("bytes", &self.arena.bytes().len())
            .field("is_mapped", &self.arena.is_mapped())
            .finish()
    }
}

/// What a compiled scene keeps of a description. The medium of the camera is one of the arena's.
fn kept(desc: &SceneDesc) -> SceneDesc {
    SceneDesc {
        name: desc.name.clone(),
        description: desc.description.clone(),
        camera: CameraDesc { medium: None, ..desc.camera.clone() },
        render: desc.render.clone(),
        ..SceneDesc::default()
    }
}

/// An error about what must not be in a file.
fn damaged(origin: &str, what: &str) -> SceneError {
    let message = format!("the compiled scene is damaged: {what}");
    let help = "copy it again, or compile the scene again with `zrak compile`";
    SceneError::file(SceneErrorKind::Damaged, origin, message, Some(help))
}
