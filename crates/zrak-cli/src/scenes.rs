//! `zrak scenes`: the built-in scenes.

use clap::Args;
use serde::Serialize;

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::terminal;
use crate::text::{Align, table};

/// Options of `zrak scenes`.
#[derive(Args, Debug)]
pub(crate) struct ScenesArgs {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Scene {
    name: &'static str,
    width: u32,
    height: u32,
    spp: u32,
    summary: &'static str,
}

/// Prints the list.
pub(crate) fn run(args: &ScenesArgs) -> Result<Exit, Failure> {
    let describe = |builtin: &zrak::scene::builtin::Builtin| {
        let desc = (builtin.build)();
        Scene {
            name: builtin.name,
            width: desc.camera.width,
            height: desc.camera.height,
            spp: desc.render.samples_per_pixel,
            summary: builtin.summary,
        }
    };
    let scenes: Vec<Scene> = zrak::scene::builtin::all().iter().map(describe).collect();
    if args.json {
        terminal::print_json(&scenes)?;
        return Ok(Exit::Success);
    }
    let title = ["name", "size", "spp", "summary"].map(str::to_owned).to_vec();
    let row = |scene: &Scene| {
        let size = format!("{}x{}", scene.width, scene.height);
        vec![scene.name.to_owned(), size, scene.spp.to_string(), scene.summary.to_owned()]
    };
    let rows: Vec<_> = std::iter::once(title).chain(scenes.iter().map(row)).collect();
    terminal::print(&table(&[Align::Left, Align::Right, Align::Right, Align::Left], &rows))?;
    Ok(Exit::Success)
}
