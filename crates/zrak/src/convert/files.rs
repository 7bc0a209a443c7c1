//! The files that a scene refers to, and those beside a scene that is written.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use zrak_scene::desc::{BackgroundDesc, MeshDesc, SceneDesc, TextureDesc};
use zrak_scene::lower::{Assets, EMBEDDED, resolve};
use zrak_scene::validate::{KeyPath, Problem};

use crate::{Error, ErrorKind, Scene};

/// Calls `change` with the path of every picture of a scene, and where it is.
pub(super) fn for_each_picture<E>(
    desc: &mut SceneDesc,
    mut change: impl FnMut(&mut String, &dyn Fn() -> KeyPath) -> Result<(), E>,
) -> Result<(), E> {
    for (name, texture) in &mut desc.textures {
        if let TextureDesc::Image { path, .. } = texture {
            change(path, &|| KeyPath::default().join("textures").join(name.as_str()).join("path"))?;
        }
    }
    if let BackgroundDesc::Image { path, .. } = &mut desc.background {
        change(path, &|| KeyPath::default().join("background").join("path"))?;
    }
    Ok(())
}

/// Calls `change` with the path of every mesh file of a scene, and where it is.
pub(super) fn for_each_mesh_file<E>(
    desc: &mut SceneDesc,
    mut change: impl FnMut(&mut String, &dyn Fn() -> KeyPath) -> Result<(), E>,
) -> Result<(), E> {
    for (name, mesh) in &mut desc.meshes {
        if let MeshDesc::File { path } = mesh {
            change(path, &|| KeyPath::default().join("meshes").join(name.as_str()).join("path"))?;
        }
    }
    Ok(())
}

/// Whether a picture's path is that of a file.
pub(super) fn is_file(path: &str) -> bool {
    Assets::builtin_name(path).is_none() && !path.starts_with(EMBEDDED)
}

impl Scene {
    /// Path of a file that the scene refers to at `key`, if it may be read.
    pub(super) fn file(&self, path: &str, key: &dyn Fn() -> KeyPath) -> Result<PathBuf, Error> {
        resolve(path, &self.lower_options()).map_err(|error| {
            self.error(vec![Problem { path: key(), message: error.to_string(), help: None }])
        })
    }
}

/// The files beside a scene that is being written.
pub(super) struct Beside {
    /// The scene's folder.
    folder: PathBuf,
    /// Name of the folder in it that they are in.
    name: String,
    /// Names that are taken, in lower case: not all file systems tell cases apart.
    taken: BTreeSet<String>,
    has_folder: bool,
    pub(super) files: Vec<PathBuf>,
}

impl Beside {
    pub(super) fn new(output: &Path) -> Self {
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        Self {
            folder: output.parent().unwrap_or(Path::new("")).to_owned(),
            name: format!("{}.files", plain(&stem)),
            taken: BTreeSet::new(),
            has_folder: false,
            files: Vec::new(),
        }
    }

    /// Writes a file under a name like `wanted`; gives its path as the scene has to say it.
    pub(super) fn write(&mut self, wanted: &str, bytes: &[u8]) -> Result<String, Error> {
        let folder = self.folder.join(&self.name);
        if !self.has_folder {
            std::fs::create_dir_all(&folder).map_err(|error| {
                let message = format!("cannot make the folder '{}': {error}", folder.display());
                Error::new(ErrorKind::Image, message)
            })?;
            self.has_folder = true;
        }
        let name = self.unique(wanted);
        let path = folder.join(&name);
        zrak_image::replace_file(&path, bytes)?;
        self.files.push(path);
        Ok(format!("{}/{name}", self.name))
    }

    /// Forgets what was written: the scene itself could not be.
    pub(super) fn remove(&self) {
        // Nothing can be done about what cannot be removed, and there is an error to tell already.
        for file in &self.files {
            let _ = std::fs::remove_file(file);
        }
        let _ = std::fs::remove_dir(self.folder.join(&self.name));
    }

    fn unique(&mut self, wanted: &str) -> String {
        let wanted = plain(wanted);
        let (stem, extension) = match wanted.split_once('.') {
            Some((stem, extension)) => (stem, format!(".{extension}")),
            None => (wanted.as_str(), String::new()),
        };
        let numbered = (2..).map(|i| format!("{stem}-{i}{extension}"));
        let mut names = std::iter::once(wanted.clone()).chain(numbered);
        // There are more numbers than names that can be taken.
        let name =
            names.find(|name| !self.taken.contains(&name.to_lowercase())).unwrap_or(wanted.clone());
        self.taken.insert(name.to_lowercase());
        name
    }
}

/// A name as the name of a file, on every system.
fn plain(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    let name: String = name.chars().map(|c| if is_plain(c) { c } else { '-' }).collect();
    let name = name.trim_matches(['.', '-']);
    // The end has the extension.
    let n_before = name.chars().count().saturating_sub(80);
    let name: String = name.chars().skip(n_before).collect();
    if name.is_empty() { "file".to_owned() } else { name }
}
