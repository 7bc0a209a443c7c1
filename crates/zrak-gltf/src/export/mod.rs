//! From a scene description to a binary glTF file.
//!
//! Every object becomes a node in the world; objects of one mesh share it. Shapes without triangles are
//! tessellated. What glTF cannot say is left out or approximated, with a warning.

mod file;
mod geometry;
mod lights;
mod materials;
mod objects;
mod principled;
mod shapes;
mod textures;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde_json::json;
use zrak_scene::desc::{BackgroundDesc, SceneDesc};

use crate::container;
use crate::error::{Error, ErrorKind, Warning, Warnings};
use file::GltfFile;
use objects::Objects;

/// Pictures in memory: what [`crate::Imported::assets`] holds.
pub type Assets = BTreeMap<String, Arc<[u8]>>;

/// What an export reads from and adds to.
struct Export<'a> {
    desc: &'a SceneDesc,
    base_dir: &'a Path,
    assets: &'a Assets,
    file: GltfFile,
    warnings: Warnings,
}

/// Writes a scene as a .glb file, whole or not at all. Paths in it are relative to `base_dir`;
/// `embedded:NAME` means entry `NAME` of `assets`.
///
/// # Errors
/// The file cannot be written, the scene refers to what it does not have, or it is too large for the
/// format's 4 GiB.
pub fn write_glb(
    desc: &SceneDesc,
    base_dir: &Path,
    assets: &Assets,
    path: &Path,
) -> Result<Vec<Warning>, Error> {
    let (bytes, warnings) =
        to_glb(desc, base_dir, assets).map_err(|e| e.in_file(path.display()))?;
    zrak_image::replace_file(path, &bytes).map_err(|e| Error::new(ErrorKind::Io, "", e, ""))?;
    Ok(warnings)
}

/// The bytes of a scene as a .glb file. See [`write_glb`].
///
/// # Errors
/// The scene refers to what it does not have, or it is too large for the format's 4 GiB.
pub fn to_glb(
    desc: &SceneDesc,
    base_dir: &Path,
    assets: &Assets,
) -> Result<(Vec<u8>, Vec<Warning>), Error> {
    let file = GltfFile::new();
    let mut export = Export { desc, base_dir, assets, file, warnings: Warnings::default() };
    // First, for of many warnings only so many are shown.
    if desc.background != BackgroundDesc::default() {
        let message = "glTF has no backgrounds: the scene's is left out";
        export.warnings.note("background", message);
    }
    let mut nodes = Vec::new();
    nodes.push(lights::camera(&mut export));
    nodes.extend(lights::lights(&mut export));
    Objects::write(&mut export, &mut nodes)?;
    let mut scene = json!({"nodes": nodes});
    if !desc.name.is_empty() {
        scene["name"] = json!(desc.name);
    }
    export.file.push("scenes", scene);
    let (json, bin) = export.file.finish();
    let bytes = container::join(&json, &bin).ok_or_else(|| {
        let message = "the scene needs more than the 4 GiB that a binary glTF file can have";
        Error::new(ErrorKind::TooLarge, "", message, "split the scene")
    })?;
    Ok((bytes, export.warnings.into_list()))
}
