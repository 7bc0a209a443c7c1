//! Scenes as files of other formats.

mod files;
mod glb;
mod pbrt;
#[cfg(test)]
mod tests;
mod toml;

use std::path::{Path, PathBuf};

use crate::{Error, ErrorKind, Scene};

pub use toml::to_toml;

/// A format that scenes can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneFormat {
    /// zrak's own scene file, `.toml`.
    Toml,
    /// Binary glTF 2.0, `.glb`.
    Glb,
    /// A scene for pbrt-v4, `.pbrt`.
    Pbrt,
}

impl SceneFormat {
    const ALL: [(Self, &'static str); 3] =
        [(Self::Toml, "toml"), (Self::Glb, "glb"), (Self::Pbrt, "pbrt")];

    /// The format that a file's extension names.
    ///
    /// # Errors
    /// There is no such format.
    pub fn of_path(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        let found = Self::ALL.iter().find(|(_, name)| extension.eq_ignore_ascii_case(name));
        found.map(|(format, _)| *format).ok_or_else(|| {
            let [first @ .., last] = Self::ALL.map(|(_, name)| format!(".{name}"));
            let message = format!(
                "'{}' names no format that scenes are written in; use {} or {last}",
                path.display(),
                first.join(", ")
            );
            Error::new(ErrorKind::InvalidOption, message)
        })
    }
}

/// What a conversion did.
#[derive(Clone, Debug, Default)]
pub struct Converted {
    /// The files that were written, the scene's own last.
    pub files: Vec<PathBuf>,
    /// What of the scene the format cannot say.
    pub warnings: Vec<String>,
}

/// Writes a scene as a file of the format that its extension names. Files that it refers to are kept
/// beside it, in a folder of its name with `.files` at the end, unless they are in its folder already.
/// Every file is replaced whole or not at all, the scene's own last.
///
/// # Errors
/// The scene refers to files that cannot be read, or may not be; a file cannot be written.
pub fn convert(scene: &Scene, output: &Path) -> Result<Converted, Error> {
    has_description(scene)?;
    match SceneFormat::of_path(output)? {
        SceneFormat::Toml => toml::write(scene, output),
        SceneFormat::Glb => glb::write(scene, output),
        SceneFormat::Pbrt => pbrt::write(scene, output),
    }
}

/// Compiled scenes have no description of their objects that could be written.
fn has_description(scene: &Scene) -> Result<(), Error> {
    if scene.compiled.is_none() {
        return Ok(());
    }
    let message = "a compiled scene cannot be converted, for it has no description of its objects; \
                   convert the scene that it was made of";
    Err(Error::new(ErrorKind::Scene, message))
}
