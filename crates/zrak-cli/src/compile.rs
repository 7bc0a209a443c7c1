//! `zrak compile`: a scene as a file that is mapped into memory and rendered at once.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde::Serialize;
use zrak::scene::compiled::EXTENSION;

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::overrides::Overrides;
use crate::terminal;
use crate::text::duration;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak compile crown.pbrt -o crown.zscene     read, built and checked once...
  zrak render crown.zscene --spp 1000         ...and rendered at once ever after

A compiled scene is for the version of zrak that made it. Change the scene, and compile it again.";

/// Options of `zrak compile`.
#[derive(Args, Debug)]
pub(crate) struct CompileArgs {
    /// Built-in scene (see `zrak scenes`) or path of a scene file
    scene: PathBuf,
    /// File to write, which has to end in .zscene
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Print one line of JSON about what was written on stdout
    #[arg(long)]
    json: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    load: crate::load::LoadArgs,
    #[command(flatten)]
    overrides: Overrides,
}

/// The line of JSON.
#[derive(Serialize)]
struct Json<'a> {
    scene: &'a str,
    output: String,
    /// Size of the file.
    bytes: u64,
    /// Bytes of each array that is not empty.
    arrays: serde_json::Map<String, serde_json::Value>,
    /// From the start of the process until the scene was built, in seconds.
    build_s: f64,
    write_s: f64,
    /// From the start of the process, in seconds.
    total_s: f64,
    version: &'a str,
}

/// Lowers the scene and writes it.
pub(crate) fn run(args: &CompileArgs, start: Instant) -> Result<Exit, Failure> {
    let path = &args.output;
    if path.extension().is_none_or(|extension| extension != EXTENSION) {
        let message = format!(
            "invalid value for '--output': the name of a compiled scene has to end in \
             .{EXTENSION}, and '{}' does not",
            path.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    zrak::image::check_replaceable(path).map_err(|error| Failure::file(&error))?;
    let mut scene = args.load.load(&args.scene, args.quiet)?.into_scene();
    args.overrides.apply(&mut scene.desc)?;
    let compiled = scene.compile()?;
    let build_s = start.elapsed().as_secs_f64();
    compiled.write_file(path).map_err(|error| Failure::file(&error))?;
    let total_s = start.elapsed().as_secs_f64();
    let bytes = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    if args.json {
        let sizes = compiled.arena().sizes();
        let arrays = sizes.into_iter().filter(|(_, size)| *size > 0);
        terminal::print_json(&Json {
            scene: &scene.desc.name,
            output: path.display().to_string(),
            bytes,
            arrays: arrays.map(|(name, size)| (name.to_owned(), size.into())).collect(),
            build_s,
            write_s: total_s - build_s,
            total_s,
            version: zrak::VERSION,
        })?;
    } else if !args.quiet {
        let megabytes = bytes as f64 / 1e6;
        let took = duration(total_s);
        terminal::note(&format!("wrote {} ({megabytes:.1} MB) in {took}", path.display()));
    }
    Ok(Exit::Success)
}
