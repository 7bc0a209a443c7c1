//! `zrak convert`: a scene as a file of another format, to start from or to give to another program.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::load::{self, LoadArgs};
use crate::overrides::Overrides;
use crate::terminal;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak convert cover -o cover.toml           a built-in scene, to be changed
  zrak convert box.pbrt -o box.toml          a scene for pbrt-v4 as one for zrak
  zrak convert scene.toml -o scene.glb       for programs that read glTF
  zrak convert model.glb -o model.pbrt       for pbrt-v4
  zrak convert final --spp 1000 | less       as a scene file, to the standard output

Meshes and pictures that a .toml or .pbrt refers to are kept beside it, in FILE.files.";

/// Options of `zrak convert`.
#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// Built-in scene (see `zrak scenes`) or path of a .toml, .pbrt, .gltf or .glb file
    scene: PathBuf,
    /// File to write, .toml, .glb or .pbrt; `-` is a scene file on the standard output
    #[arg(long, short, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    overrides: Overrides,
}

/// Writes the scene.
pub(crate) fn run(args: &ConvertArgs) -> Result<Exit, Failure> {
    let is_stdout = args.output.as_os_str() == "-";
    if !is_stdout {
        // Before a scene is loaded for nothing.
        zrak::SceneFormat::of_path(&args.output)?;
    }
    let mut scene = args.load.load(&args.scene, args.quiet)?.into_scene();
    args.overrides.apply(&mut scene.desc)?;
    let warnings = if is_stdout {
        let (text, warnings) = zrak::to_toml(&scene, Path::new(""))?;
        terminal::print(&text)?;
        warnings
    } else {
        zrak::convert(&scene, &args.output)?.warnings
    };
    if !args.quiet {
        load::warn(&warnings);
    }
    Ok(Exit::Success)
}
