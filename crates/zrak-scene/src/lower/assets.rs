//! Images that scenes refer to.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use zrak_image::{Error, ErrorKind};

use super::LowerOptions;

/// What the paths of pictures inside zrak start with.
const BUILTIN: &str = "builtin:";
/// What the paths of pictures inside the scene's own file start with; the rest is their name.
pub const EMBEDDED: &str = "embedded:";

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

    /// The file of a built-in picture.
    #[must_use]
    pub fn bytes(name: &str) -> Option<&'static [u8]> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, bytes)| *bytes)
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

/// The bytes of the image at `path`: relative to the scene's folder, built in, or embedded in the scene's
/// file; and the path that errors call it.
pub(super) fn read<'a>(
    path: &str,
    options: &'a LowerOptions,
) -> Result<(Cow<'a, [u8]>, PathBuf), Error> {
    if let Some(name) = Assets::builtin_name(path) {
        return match Assets::bytes(name) {
            Some(bytes) => Ok((Cow::Borrowed(bytes), PathBuf::from(path))),
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
            Some(bytes) => Ok((Cow::Borrowed(&**bytes), PathBuf::from(path))),
            None => {
                let message = format!(
                    "there is no picture '{name}' in the scene's file; save the picture as a file"
                );
                Err(Error::new(ErrorKind::Io, message))
            }
        };
    }
    let path = resolve(path, options)?;
    let bytes = zrak_image::read_image_file(&path, &options.image_limits)?;
    Ok((Cow::Owned(bytes), path))
}

/// Path of a file that a scene names, if it may be read.
///
/// # Errors
/// It is outside of the scene's folder, and that is not allowed.
pub fn resolve(path: &str, options: &LowerOptions) -> Result<PathBuf, Error> {
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
