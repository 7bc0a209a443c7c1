//! Binary glTF, which says less than a scene can: what is lost, the exporter's warnings say.

use std::path::Path;

use zrak_scene::lower::{Assets, EMBEDDED};

use super::{Converted, files};
use crate::{Error, Scene};

/// Writes a `.glb` file with everything in it.
pub(super) fn write(scene: &Scene, output: &Path) -> Result<Converted, Error> {
    let mut desc = scene.desc.clone();
    let mut pictures = scene.embedded.clone();
    files::for_each_picture(&mut desc, |path, key| -> Result<(), Error> {
        if let Some(name) = Assets::builtin_name(path) {
            // zrak's own pictures go into the file like any other.
            if let Some(bytes) = Assets::bytes(name) {
                pictures.insert(format!("builtin:{name}"), bytes.into());
                *path = format!("{EMBEDDED}builtin:{name}");
            }
        } else if files::is_file(path) {
            // The exporter reads files without asking whether it may.
            scene.file(path, key)?;
        }
        Ok(())
    })?;
    files::for_each_mesh_file(&mut desc, |path, key| scene.file(path, key).map(drop))?;
    let (bytes, warnings) = zrak_gltf::to_glb(&desc, &scene.base_dir, &pictures)?;
    zrak_image::replace_file(output, &bytes)?;
    let warnings = warnings.iter().map(ToString::to_string).collect();
    Ok(Converted { files: vec![output.to_owned()], warnings })
}
