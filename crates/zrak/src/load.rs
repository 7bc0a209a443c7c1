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
    /// The file it came from; `None` for a built-in scene.
    pub source: Option<Source>,
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

/// Loads a scene: from a file, if the argument ends in `.toml`, has a path separator in it or is
/// the name of a file; otherwise the built-in scene of this name, which goes before a file of
/// the same name.
///
/// # Errors
/// If the file is not a scene that can be rendered, or there is no built-in scene of this name.
pub fn load_scene(name_or_path: impl AsRef<OsStr>) -> Result<Scene, Error> {
    let path = Path::new(name_or_path.as_ref());
    if let Some(builtin) = path.to_str().and_then(builtin::find) {
        let desc = (builtin.build)();
        return Ok(Scene { desc, base_dir: PathBuf::new(), source: None });
    }
    if is_path(path) {
        let file::LoadedScene { desc, base_dir, source } = file::read(path)?;
        return Ok(Scene { desc, base_dir, source: Some(source) });
    }
    let name = path.to_string_lossy();
    let guess = match builtin::suggest(&name) {
        Some(near) => format!("; did you mean '{near}'?"),
        None => String::from(";"),
    };
    let message = format!(
        "there is no built-in scene '{name}'{guess} run `zrak scenes` for a list, or give the path \
         of a .toml file"
    );
    Err(Error::new(ErrorKind::UnknownScene, message))
}

/// Whether it can only mean a file.
fn is_path(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
        || text.contains(std::path::is_separator)
        || path.is_file()
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
