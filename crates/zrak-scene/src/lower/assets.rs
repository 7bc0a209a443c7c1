//! Images that scenes refer to.

use std::path::{Component, Path, PathBuf};

use zrak_image::{Error, ErrorKind, TextureImage, decode_texture, read_texture};

use super::LowerOptions;

/// What the paths of pictures inside zrak start with.
const BUILTIN: &str = "builtin:";
/// What the paths of pictures inside the scene's own file start with.
const EMBEDDED: &str = "embedded:";

/// The pictures inside zrak.
pub struct Assets;

impl Assets {
    /// Names and contents.
    const ALL: &'static [(&'static str, &'static [u8])] = &[
        ("earth.png", include_bytes!("../../../../assets/earth.png")),
        ("gradient.pfm", include_bytes!("../../../../assets/gradient.pfm")),
    ];

    /// Name of the built-in picture that `path` means, if it means one.
    #[must_use]
    pub fn builtin_name(path: &str) -> Option<&str> {
        path.strip_prefix(BUILTIN)
    }

    /// Names of all built-in pictures.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.iter().map(|(name, _)| *name)
    }
}

/// What becomes of a texture whose image cannot be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MissingTextures {
    /// The scene is refused.
    #[default]
    Error,
    /// Mid grey stands for it, with a warning.
    Warn,
}

/// Reads the image at `path`: relative to the scene's folder, built in, or embedded in the scene's file.
pub(super) fn read(path: &str, options: &LowerOptions) -> Result<TextureImage, Error> {
    let limits = &options.image_limits;
    if let Some(name) = Assets::builtin_name(path) {
        return match Assets::ALL.iter().find(|(known, _)| *known == name) {
            Some((_, bytes)) => decode_texture(bytes, Path::new(path), limits),
            None => {
                let known: Vec<_> = Assets::names().collect();
                let known = known.join(", ");
                let message = format!("there is no built-in picture '{name}'; there is: {known}");
                Err(Error::new(ErrorKind::Io, message))
            }
        };
    }
    if let Some(name) = path.strip_prefix(EMBEDDED) {
        return match options.embedded.get(name) {
            Some(bytes) => decode_texture(bytes, Path::new(path), limits),
            None => {
                let message = format!(
                    "there is no picture '{name}' in the scene's file; save the picture as a file"
                );
                Err(Error::new(ErrorKind::Io, message))
            }
        };
    }
    read_texture(&resolve(path, options)?, limits)
}

/// Path of a file that a scene names, if it may be read.
pub(super) fn resolve(path: &str, options: &LowerOptions) -> Result<PathBuf, Error> {
    let base = if options.base_dir.as_os_str().is_empty() {
        Path::new(".")
    } else {
        options.base_dir.as_path()
    };
    let full = base.join(path);
    if options.allow_external || stays_inside(base, Path::new(path)) {
        return Ok(full);
    }
    let message = format!(
        "'{path}' is outside of the scene's folder; move the file there, or allow files from \
         elsewhere with --allow-external"
    );
    Err(Error::new(ErrorKind::Io, message))
}

/// Whether a relative path leads to something in the folder, links followed.
#[must_use]
pub fn stays_inside(base: &Path, relative: &Path) -> bool {
    let mut depth = 0_i32;
    for part in relative.components() {
        match part {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir => depth -= 1,
            Component::RootDir | Component::Prefix(_) => return false,
        }
        if depth < 0 {
            return false;
        }
    }
    // What cannot be resolved does not exist, and reading it will say so.
    match (base.join(relative).canonicalize(), base.canonicalize()) {
        (Ok(real), Ok(base)) => real.starts_with(base),
        _ => true,
    }
}
