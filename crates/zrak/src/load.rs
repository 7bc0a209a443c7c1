//! Scenes by name or from a file.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use zrak_scene::arena::SceneArena;
use zrak_scene::builtin;
use zrak_scene::desc::SceneDesc;
use zrak_scene::file::{self, Source};
use zrak_scene::lower::{LowerOptions, lower};

use crate::{Error, ErrorKind};

/// A scene without problems, and where it came from.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The scene; free to be changed before it is lowered.
    pub desc: SceneDesc,
    /// Folder that the paths of its images start from.
    pub base_dir: PathBuf,
    /// The scene file it came from; `None` for a built-in scene and for other formats.
    pub source: Option<Source>,
    /// What was not read as it stands in a file of another format.
    pub warnings: Vec<String>,
}

/// What may be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadOptions {
    /// Whether files outside of the scene's folder may be read.
    pub allow_external: bool,
    /// Most bytes of all files of a scene together, once they are unpacked.
    pub max_bytes: u64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { allow_external: false, max_bytes: 16 << 30 }
    }
}

impl Scene {
    /// Reads its images, builds its tree and lays everything out for rendering.
    ///
    /// # Errors
    /// If an image cannot be read, or the description was changed to one that has problems. They
    /// are shown at their places in the file, if there is one.
    pub fn lower(&self) -> Result<Arc<SceneArena>, Error> {
        let options = LowerOptions::new(&self.base_dir);
        lower(&self.desc, &options).map(Arc::new).map_err(|problems| match &self.source {
            Some(source) => source.error(problems).into(),
            None => {
                let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
                Error::new(ErrorKind::Scene, lines.join("\n"))
            }
        })
    }
}

/// Loads a scene: from a file, if the argument ends in `.toml`, `.pbrt` or `.obj`, has a path separator in it or
/// is the name of a file; otherwise the built-in scene of this name, which goes before a file of
/// the same name.
///
/// # Errors
/// If the file is not a scene that can be rendered, or there is no built-in scene of this name.
pub fn load_scene(name_or_path: impl AsRef<OsStr>) -> Result<Scene, Error> {
    load_scene_with(name_or_path, &LoadOptions::default())
}

/// [`load_scene`] with other limits.
///
/// # Errors
/// As for [`load_scene`].
pub fn load_scene_with(
    name_or_path: impl AsRef<OsStr>,
    options: &LoadOptions,
) -> Result<Scene, Error> {
    let path = Path::new(name_or_path.as_ref());
    if let Some(builtin) = path.to_str().and_then(builtin::find) {
        let desc = (builtin.build)();
        let (base_dir, warnings) = (PathBuf::new(), Vec::new());
        return Ok(Scene { desc, base_dir, source: None, warnings });
    }
    if has_extension(path, "pbrt") {
        let LoadOptions { allow_external, max_bytes } = *options;
        let options = zrak_pbrt::ImportOptions { allow_external, max_bytes };
        let imported = zrak_pbrt::import(path, &options)?;
        return Ok(Scene {
            desc: imported.desc,
            base_dir: imported.base_dir,
            source: None,
            warnings: imported.warnings.iter().map(ToString::to_string).collect(),
        });
    }
    if has_extension(path, "obj") {
        let LoadOptions { allow_external, max_bytes } = *options;
        let options = zrak_obj::ImportOptions { allow_external, max_bytes, ..Default::default() };
        let imported = zrak_obj::import(path, &options)?;
        return Ok(Scene {
            desc: imported.desc,
            base_dir: imported.base_dir,
            source: None,
            warnings: imported.warnings.iter().map(ToString::to_string).collect(),
        });
    }
    if is_path(path) {
        let file::LoadedScene { desc, base_dir, source } = file::read(path)?;
        return Ok(Scene { desc, base_dir, source: Some(source), warnings: Vec::new() });
    }
    let name = path.to_string_lossy();
    let guess = match builtin::suggest(&name) {
        Some(near) => format!("; did you mean '{near}'?"),
        None => String::from(";"),
    };
    let message = format!(
        "there is no built-in scene '{name}'{guess} run `zrak scenes` for a list, or give the path \
         of a .toml, .pbrt or .obj file"
    );
    Err(Error::new(ErrorKind::UnknownScene, message))
}

/// Whether it can only mean a file.
fn is_path(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    has_extension(path, "toml") || text.contains(std::path::is_separator) || path.is_file()
}

/// Whether a file's name ends so, or so and in `.gz`.
fn has_extension(path: &Path, wanted: &str) -> bool {
    let is = |path: &Path, wanted: &str| {
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
    };
    is(path, wanted)
        || (is(path, "gz") && path.file_stem().is_some_and(|s| is(Path::new(s), wanted)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_name_and_by_path() {
        assert_eq!(load_scene("final").unwrap().desc.name, "final");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let desc = load_scene("quads").unwrap().desc;
        std::fs::write(&path, file::write_string(&desc)).unwrap();
        let scene = load_scene(&path).unwrap();
        assert_eq!((scene.desc, scene.base_dir), (desc, folder.path().to_owned()));
        assert!(scene.source.is_some());
    }

    #[test]
    fn what_is_not_there_is_explained() {
        for (name, kind, words) in [
            ("fianl", ErrorKind::UnknownScene, "did you mean 'final'? run `zrak scenes`"),
            ("zzz", ErrorKind::UnknownScene, "'zzz'; run `zrak scenes`"),
            ("none.toml", ErrorKind::Scene, "there is no such scene file"),
            ("no/such/folder", ErrorKind::Scene, "there is no such scene file"),
        ] {
            let error = load_scene(name).unwrap_err();
            assert_eq!(error.kind(), kind, "{name}");
            assert!(error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn a_missing_image_is_shown_in_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("globe.toml");
        let text = file::write_string(&load_scene("earth").unwrap().desc);
        std::fs::write(&path, text.replace("builtin:earth.png", "none.png")).unwrap();
        let Err(error) = load_scene(&path).unwrap().lower() else { panic!("it has no image") };
        assert_eq!(error.kind(), ErrorKind::Scene);
        assert!(error.scene().unwrap().line_column().is_some());
        assert!(error.to_string().contains("none.png"), "{error}");
    }
}
