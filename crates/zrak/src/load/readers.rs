//! The formats that scenes come in.
//!
//! # To add a format
//! Write a reader, and add it with its extensions to [`READERS`].

use std::path::{Path, PathBuf};

use zrak_scene::compiled::{self, CompiledScene};
use zrak_scene::file;
use zrak_scene::lower::Embedded;

use super::{LoadOptions, Scene};
use crate::{Error, ErrorKind};

/// A format that scenes can be read from.
pub(super) struct Reader {
    /// Extensions of its files; each may also be followed by `.gz` if the format allows that.
    pub(super) extensions: &'static [&'static str],
    /// Whether its files have cameras to choose from, and scenes.
    pub(super) has_choice: bool,
    /// Reads a file.
    pub(super) read: fn(&Path, &LoadOptions) -> Result<Scene, Error>,
}

/// All of them.
pub(super) const READERS: [Reader; 5] = [
    Reader { extensions: &["toml"], has_choice: false, read: read_toml },
    Reader { extensions: &["pbrt", "pbrt.gz"], has_choice: false, read: read_pbrt },
    Reader { extensions: &["glb", "gltf"], has_choice: true, read: read_gltf },
    Reader { extensions: &["obj", "obj.gz"], has_choice: false, read: read_obj },
    Reader { extensions: &[compiled::EXTENSION], has_choice: false, read: read_compiled },
];

/// Extensions of files that hold scenes or models, but that nothing here reads.
const UNREAD: [&str; 13] =
    ["3ds", "abc", "blend", "dae", "fbx", "ma", "max", "ply", "stl", "usd", "usda", "usdc", "xml"];

/// The reader for a file of this name.
pub(super) fn of_path(path: &Path) -> Option<&'static Reader> {
    let name = path.file_name()?.to_str()?.to_ascii_lowercase();
    let is_of =
        |extension: &&&str| name.strip_suffix(**extension).is_some_and(|stem| stem.ends_with('.'));
    READERS.iter().find(|reader| reader.extensions.iter().any(|e| is_of(&e)))
}

/// Extensions of all readers, for messages.
pub(super) fn known() -> String {
    let extensions = READERS.iter().map(|reader| format!(".{}", reader.extensions[0]));
    let mut extensions: Vec<_> = extensions.collect();
    extensions.push(".gltf".to_owned());
    let last = extensions.pop().unwrap_or_default();
    format!("{} or {last}", extensions.join(", "))
}

/// A file without an extension that says what it is.
pub(super) fn read_unnamed(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    if let Some(extension) = extension.filter(|e| path.is_file() && UNREAD.contains(&&**e)) {
        let message = format!(
            "cannot read '{}': zrak reads no .{extension} files as scenes; export it as {}",
            path.display(),
            known()
        );
        return Err(Error::new(ErrorKind::Scene, message));
    }
    // Scene files may have any name.
    read_toml(path, options)
}

fn read_toml(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let file::LoadedScene { desc, base_dir, source } = file::read_within(path, options.max_bytes)?;
    options.progress.add(source.text.len() as u64);
    let mut scene = plain(desc, base_dir, path, options);
    scene.source = Some(source);
    Ok(scene)
}

fn read_pbrt(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let LoadOptions { allow_external, max_bytes, .. } = *options;
    let import = zrak_pbrt::ImportOptions { allow_external, max_bytes };
    let imported = zrak_pbrt::import(path, &import)?;
    let mut scene = plain(imported.desc, imported.base_dir, path, options);
    scene.warnings = imported.warnings.iter().map(ToString::to_string).collect();
    Ok(scene)
}

fn read_gltf(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let max_bytes = options.max_bytes;
    let import = zrak_gltf::ImportOptions {
        // An object of JSON takes some hundred bytes.
        limits: zrak_gltf::Limits { max_bytes, max_objects: max_bytes / 1024 },
        allow_external: options.allow_external,
        scene: options.gltf.scene.clone(),
        camera: options.camera.clone(),
        lumens_per_watt: options.gltf.lumens_per_watt,
        cull_back_faces: options.gltf.cull_back_faces,
        progress: options.progress.clone(),
        ..zrak_gltf::ImportOptions::default()
    };
    let imported = zrak_gltf::import(path, &import)?;
    let mut scene = plain(imported.desc, imported.base_dir, path, options);
    scene.embedded = imported.assets;
    let shown = path.display();
    scene.warnings =
        imported.warnings.iter().map(|warning| format!("{shown}: {warning}")).collect();
    Ok(scene)
}

fn read_obj(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let LoadOptions { allow_external, max_bytes, .. } = *options;
    let import = zrak_obj::ImportOptions { allow_external, max_bytes, ..Default::default() };
    let imported = zrak_obj::import(path, &import)?;
    let mut scene = plain(imported.desc, imported.base_dir, path, options);
    scene.warnings = imported.warnings.iter().map(ToString::to_string).collect();
    Ok(scene)
}

fn read_compiled(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let compiled = CompiledScene::open(path)?;
    let mut scene = plain(compiled.desc().clone(), PathBuf::new(), path, options);
    scene.compiled = Some(compiled);
    Ok(scene)
}

/// A scene of a file, without what only some formats have.
fn plain(
    desc: zrak_scene::desc::SceneDesc,
    base_dir: PathBuf,
    path: &Path,
    options: &LoadOptions,
) -> Scene {
    Scene {
        desc,
        base_dir,
        path: Some(path.to_owned()),
        source: None,
        embedded: Embedded::new(),
        warnings: Vec::new(),
        compiled: None,
        options: options.clone(),
    }
}
