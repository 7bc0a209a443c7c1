//! zrak's own scene files. Nothing is lost: the scene that is read back renders the same picture.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use zrak_mesh::{TriangleMesh, ply};
use zrak_scene::desc::{MeshDesc, SceneDesc};
use zrak_scene::file::write_string;
use zrak_scene::lower::EMBEDDED;

use super::Converted;
use super::files::{self, Beside};
use crate::{Error, ErrorKind, Scene};

/// Meshes of so many triangles are written as numbers into the scene's file, which is easier to read.
const INLINE_MAX: usize = 32;

/// A scene as the text of a scene file that is to lie in `folder`, and what is lost: meshes are written
/// out as numbers, and files are not copied.
///
/// # Errors
/// The scene refers to files that may not be read.
pub fn to_toml(scene: &Scene, folder: &Path) -> Result<(String, Vec<String>), Error> {
    super::has_description(scene)?;
    let mut desc = scene.desc.clone();
    let mut warnings = Vec::new();
    if !is_same_folder(folder, &scene.base_dir) {
        let mut n_outside = 0;
        let mut make_absolute = |path: &mut String, key: &dyn Fn() -> _| -> Result<(), Error> {
            if files::is_file(path) {
                let file = scene.file(path, key)?;
                // A path that is not text cannot be written to a scene file.
                if let Some(text) = file.canonicalize().ok().as_deref().and_then(Path::to_str) {
                    *path = text.to_owned();
                }
                n_outside += 1;
            }
            Ok(())
        };
        files::for_each_picture(&mut desc, &mut make_absolute)?;
        files::for_each_mesh_file(&mut desc, &mut make_absolute)?;
        if n_outside > 0 {
            let message = format!(
                "{n_outside} files are outside of the folder of the new scene: rendering it needs \
                 --allow-external"
            );
            warnings.push(message);
        }
    }
    let mut n_embedded = 0;
    files::for_each_picture(&mut desc, |path, _| {
        n_embedded += usize::from(path.starts_with(EMBEDDED));
        Ok::<_, Error>(())
    })?;
    if n_embedded > 0 {
        warnings
            .push(format!("{n_embedded} textures are of pictures inside the file, and are lost"));
    }
    let has_more = |mesh: &MeshDesc| matches!(mesh, MeshDesc::Loaded(mesh) if !fits_inline(mesh));
    let n_meshes = desc.meshes.values().filter(|mesh| has_more(mesh)).count();
    if n_meshes > 0 {
        warnings.push(format!("{n_meshes} meshes lose their tangents or groups"));
    }
    Ok((write_string(&desc), warnings))
}

/// Writes a scene file, and beside it what it refers to.
pub(super) fn write(scene: &Scene, output: &Path) -> Result<Converted, Error> {
    let mut beside = Beside::new(output);
    let written = collect(scene, output, &mut beside).and_then(|desc| {
        let text = write_string(&desc);
        Ok(zrak_image::replace_file(output, text.as_bytes())?)
    });
    if let Err(error) = written {
        beside.remove();
        return Err(error);
    }
    let mut files = beside.files;
    files.push(output.to_owned());
    Ok(Converted { files, warnings: Vec::new() })
}

/// The scene with everything that it refers to in place.
fn collect(scene: &Scene, output: &Path, beside: &mut Beside) -> Result<SceneDesc, Error> {
    let mut desc = scene.desc.clone();
    let folder = output.parent().unwrap_or(Path::new(""));
    let stays = is_same_folder(folder, &scene.base_dir);
    // What was copied, by its path before.
    let mut copies: BTreeMap<String, String> = BTreeMap::new();
    let mut copy = |path: &mut String, key: &dyn Fn() -> _| -> Result<(), Error> {
        if let Some(copied) = copies.get(path) {
            path.clone_from(copied);
            return Ok(());
        }
        let copied = if let Some(name) = path.strip_prefix(EMBEDDED) {
            // A picture that is not there is an error when it is read.
            let Some(bytes) = scene.embedded.get(name) else { return Ok(()) };
            beside.write(name, bytes)?
        } else if files::is_file(path) && !stays {
            let file = scene.file(path, key)?;
            let limits = zrak_image::Limits {
                max_bytes: scene.options.max_bytes,
                ..zrak_image::Limits::default()
            };
            let bytes = zrak_image::read_image_file(&file, &limits).map_err(|error| {
                // It is the scene that is at fault.
                Error::new(ErrorKind::Scene, error.to_string())
            })?;
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            beside.write(&name, &bytes)?
        } else {
            return Ok(());
        };
        copies.insert(std::mem::replace(path, copied.clone()), copied);
        Ok(())
    };
    files::for_each_picture(&mut desc, &mut copy)?;
    files::for_each_mesh_file(&mut desc, &mut copy)?;
    for (name, mesh) in &mut desc.meshes {
        if let MeshDesc::Loaded(loaded) = mesh
            && (loaded.triangles.len() > INLINE_MAX || !fits_inline(loaded))
        {
            let path = beside.write(&format!("{name}.ply"), &ply_bytes(loaded)?)?;
            *mesh = MeshDesc::File { path };
        }
    }
    Ok(desc)
}

/// Whether numbers in a scene file say everything about a mesh.
fn fits_inline(mesh: &Arc<TriangleMesh>) -> bool {
    mesh.tangents.is_empty() && mesh.face_groups.is_empty()
}

fn ply_bytes(mesh: &TriangleMesh) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    // Memory takes everything.
    ply::write(&mut bytes, mesh)
        .map_err(|error| Error::new(ErrorKind::Image, error.to_string()))?;
    Ok(bytes)
}

/// Whether two folders are the same; empty is the current one.
fn is_same_folder(a: &Path, b: &Path) -> bool {
    let real = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().ok()
    };
    real(a).is_some_and(|a| real(b) == Some(a))
}
