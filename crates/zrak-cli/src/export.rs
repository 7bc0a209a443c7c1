//! `zrak export`: a scene as a scene file, to start from or to archive.

use std::path::{Path, PathBuf};

use clap::Args;
use zrak::Scene;
use zrak::scene::desc::{BackgroundDesc, MeshDesc, TextureDesc};
use zrak::scene::lower::Assets;

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::overrides::Overrides;
use crate::terminal;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak export cover -o cover.toml           a built-in scene, to be changed
  zrak export box.pbrt -o box.toml          a scene for pbrt-v4 as one for zrak
  zrak export final --spp 1000 | less       as it would be rendered, to the standard output";

/// Options of `zrak export`.
#[derive(Args, Debug)]
pub(crate) struct ExportArgs {
    /// Built-in scene (see `zrak scenes`) or path of a scene file (not a compiled one)
    scene: PathBuf,
    /// File to write; `-` is the standard output
    #[arg(long, short, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    load: crate::args::LoadArgs,
    #[command(flatten)]
    overrides: Overrides,
}

/// Writes the scene.
pub(crate) fn run(args: &ExportArgs) -> Result<Exit, Failure> {
    let mut scene = args.load.load(&args.scene, false)?;
    if scene.compiled.is_some() {
        let message = "a compiled scene cannot be exported, for it has no description of its \
                       objects; export the scene that it was made of";
        return Err(Failure::new(Exit::Scene, message));
    }
    args.overrides.apply(&mut scene.desc)?;
    let is_stdout = args.output.as_os_str() == "-";
    keep_images(&mut scene, (!is_stdout).then_some(&args.output));
    let text = zrak::scene::file::write_string(&scene.desc);
    if is_stdout {
        terminal::print(&text)?;
    } else {
        let written = zrak::image::replace_file(&args.output, text.as_bytes());
        written.map_err(|error| Failure::file(&error))?;
    }
    Ok(Exit::Success)
}

/// Makes relative paths of images and meshes absolute, unless the new file lies where the old one did.
fn keep_images(scene: &mut Scene, output: Option<&PathBuf>) {
    if scene.source.is_none() && scene.base_dir.as_os_str().is_empty() {
        return;
    }
    let Ok(base_dir) = folder(&scene.base_dir).canonicalize() else { return };
    let new_dir = output.and_then(|path| folder(path.parent()?).canonicalize().ok());
    if new_dir.as_ref() == Some(&base_dir) {
        return;
    }
    for texture in scene.desc.textures.values_mut() {
        if let TextureDesc::Image { path, .. } = texture
            && Assets::builtin_name(path).is_none()
            // A path that is not text cannot be written to a scene file.
            && let Some(absolute) = base_dir.join(&*path).to_str()
        {
            *path = absolute.to_owned();
        }
    }
    for mesh in scene.desc.meshes.values_mut() {
        if let MeshDesc::File { path } = mesh
            && let Some(absolute) = base_dir.join(&*path).to_str()
        {
            *path = absolute.to_owned();
        }
    }
    if let BackgroundDesc::Image { path, .. } = &mut scene.desc.background
        && let Some(absolute) = base_dir.join(&*path).to_str()
    {
        *path = absolute.to_owned();
    }
}

/// `path`, or the current folder if it is empty.
fn folder(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}
