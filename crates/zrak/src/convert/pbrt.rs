//! Scenes for pbrt-v4, which can say other things than zrak's: what is lost, the exporter's warnings say.

use std::path::Path;

use zrak_pbrt::{ExportOptions, export_to};
use zrak_scene::error::{SceneError, SceneErrorKind};

use super::Converted;
use super::files::{self, Beside};
use crate::{Error, Scene};

/// Writes a `.pbrt` file, and beside it what it refers to.
pub(super) fn write(scene: &Scene, output: &Path) -> Result<Converted, Error> {
    // The exporter reads files without asking whether it may.
    let mut desc = scene.desc.clone();
    files::for_each_picture(&mut desc, |path, key| match files::is_file(path) {
        true => scene.file(path, key).map(drop),
        false => Ok(()),
    })?;
    files::for_each_mesh_file(&mut desc, |path, key| scene.file(path, key).map(drop))?;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let options = ExportOptions {
        picture: format!("{stem}.exr"),
        max_bytes: scene.options.max_bytes,
        ..ExportOptions::default()
    };
    let mut beside = Beside::new(output);
    // Why a file could not be written; the exporter only gets to know that it could not.
    let mut failed = None;
    let exported =
        export_to(&scene.desc, &scene.base_dir, &scene.embedded, &options, &mut |name, bytes| {
            beside.write(name, bytes).map_err(|error| {
                let message = error.to_string();
                failed = Some(error);
                SceneError::file(SceneErrorKind::Io, name, message, None)
            })
        });
    let written = match (exported, failed) {
        (_, Some(error)) => Err(error),
        (Err(error), None) => Err(Error::from(error)),
        (Ok((text, warnings)), None) => zrak_image::replace_file(output, text.as_bytes())
            .map(|()| warnings)
            .map_err(Error::from),
    };
    match written {
        Ok(warnings) => {
            let mut files = beside.files;
            files.push(output.to_owned());
            Ok(Converted { files, warnings })
        }
        Err(error) => {
            beside.remove();
            Err(error)
        }
    }
}
