//! `zrak info`: what is in a scene, and the memory that it takes.

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use zrak::scene::arena::stats::{ArenaStats, Count, ImageStats, MemoryUse, PrimitiveCount};
use zrak::{LoadedImage, SceneArena};

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::load::LoadArgs;
use crate::terminal;
use crate::text::{self, Align, table};

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak info final                      a table
  zrak info model.glb --json | jq .bounds";

/// Options of `zrak info`.
#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Built-in scene (see `zrak scenes`) or path of a .toml, .pbrt, .gltf or .glb file
    scene: PathBuf,
    /// Print one line of JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    load: LoadArgs,
}

/// What is said.
#[derive(Serialize)]
struct Info<'a> {
    scene: &'a str,
    camera: Camera,
    bounds: Option<[[f32; 3]; 2]>,
    primitives: Primitives<'a>,
    vertices: u64,
    prototypes: u64,
    instances: u64,
    moving_instances: u64,
    media: &'a [Count],
    materials: &'a [Count],
    lights: &'a [Count],
    textures: &'a [Count],
    images: Vec<Image<'a>>,
    memory: &'a [MemoryUse],
    memory_bytes: u64,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Camera {
    width: u32,
    height: u32,
    projection: &'static str,
    position: [f32; 3],
    /// Unit vector.
    direction: [f32; 3],
}

#[derive(Serialize)]
struct Primitives<'a> {
    unique: u64,
    placed: u64,
    kinds: &'a [PrimitiveCount],
}

#[derive(Serialize)]
struct Image<'a> {
    /// None if the scene does not say it.
    path: Option<&'a str>,
    #[serde(flatten)]
    stats: &'a ImageStats,
}

/// Loads the scene, as for a render, and says what is in it.
pub(crate) fn run(args: &InfoArgs) -> Result<Exit, Failure> {
    // In the line of JSON, warnings are inside.
    let loaded = args.load.load(&args.scene, args.json)?;
    let (scene, lowered) = loaded.lower()?;
    let stats = ArenaStats::of(&lowered.arena);
    let warnings: Vec<String> = scene.warnings.iter().chain(&lowered.warnings).cloned().collect();
    let info = Info {
        scene: &scene.desc.name,
        camera: camera(&lowered.arena),
        bounds: stats.bounds,
        primitives: Primitives {
            unique: stats.n_unique(),
            placed: stats.n_placed(),
            kinds: &stats.primitives,
        },
        vertices: stats.vertices,
        prototypes: stats.prototypes,
        instances: stats.instances,
        moving_instances: stats.moving_instances,
        media: &stats.media,
        materials: &stats.materials,
        lights: &stats.lights,
        textures: &stats.textures,
        images: images(&stats.images, &lowered.images),
        memory: &stats.memory,
        memory_bytes: stats.bytes,
        warnings: &warnings,
    };
    if args.json {
        terminal::print_json(&info)?;
    } else {
        terminal::print(&describe(&info))?;
    }
    Ok(Exit::Success)
}

fn camera(arena: &SceneArena) -> Camera {
    let camera = &arena.globals().camera;
    Camera {
        width: camera.width,
        height: camera.height,
        projection: match camera.projection {
            zrak::core::camera::PROJECTION_PERSPECTIVE => "perspective",
            zrak::core::camera::PROJECTION_ORTHOGRAPHIC => "orthographic",
            zrak::core::camera::PROJECTION_EQUIRECTANGULAR => "equirectangular",
            _ => "equal-area",
        },
        position: [camera.origin.x, camera.origin.y, camera.origin.z],
        direction: [camera.forward.x, camera.forward.y, camera.forward.z],
    }
}

/// The images of the arena, with their paths.
fn images<'a>(stats: &'a [ImageStats], loaded: &'a [LoadedImage]) -> Vec<Image<'a>> {
    let paths: BTreeMap<u32, &str> =
        loaded.iter().map(|image| (image.first_word, image.path.as_str())).collect();
    let image =
        |stats: &'a ImageStats| Image { path: paths.get(&stats.first_word).copied(), stats };
    stats.iter().map(image).collect()
}

/// The table.
fn describe(info: &Info) -> String {
    let mut rows: Vec<[String; 2]> = vec![["scene".into(), clean(info.scene)]];
    let triple = |v: [f32; 3]| format!("({}, {}, {})", v[0], v[1], v[2]);
    let Camera { width, height, projection, position, direction } = &info.camera;
    rows.push([
        "camera".into(),
        format!(
            "{width}x{height}, {projection}, at {} towards {}",
            triple(*position),
            triple(*direction)
        ),
    ]);
    let bounds = info.bounds.map_or("nothing to be seen".to_owned(), |[lo, hi]| {
        format!("{} to {}", triple(lo), triple(hi))
    });
    rows.push(["bounds".into(), bounds]);
    let both = |unique: u64, placed: u64| match unique == placed {
        true => text::grouped(unique),
        false => {
            format!("{}, placed {} times in all", text::grouped(unique), text::grouped(placed))
        }
    };
    let Primitives { unique, placed, kinds } = &info.primitives;
    rows.push(["primitives".into(), both(*unique, *placed)]);
    for PrimitiveCount { kind, unique, placed } in *kinds {
        rows.push([format!("  {kind}"), both(*unique, *placed)]);
    }
    if info.vertices > 0 {
        rows.push(["vertices".into(), text::grouped(info.vertices)]);
    }
    if info.instances > 0 {
        let moving = match info.moving_instances {
            0 => String::new(),
            n => format!(", {} of them moving", text::grouped(n)),
        };
        let [n, of] = [info.instances, info.prototypes].map(text::grouped);
        rows.push(["instances".into(), format!("{n} of {of} prototypes{moving}")]);
    }
    for (name, counts) in [
        ("materials", info.materials),
        ("media", info.media),
        ("lights", info.lights),
        ("textures", info.textures),
    ] {
        if !counts.is_empty() {
            let counts = counts.iter().map(|c| format!("{} {}", text::grouped(c.count), c.kind));
            rows.push([name.into(), counts.collect::<Vec<_>>().join(", ")]);
        }
    }
    if !info.images.is_empty() {
        rows.push(["images".into(), text::grouped(info.images.len() as u64)]);
    }
    for Image { path, stats } in info.images.iter().take(IMAGES_MAX) {
        let levels = if stats.levels > 1 { ", with levels of detail" } else { "" };
        let (width, height, format) = (stats.width, stats.height, stats.format);
        rows.push([
            format!("  {}", path.map_or("(made by zrak)".to_owned(), clean)),
            format!("{width}x{height}, {format}{levels}, {}", text::bytes(stats.bytes)),
        ]);
    }
    if info.images.len() > IMAGES_MAX {
        let n_more = (info.images.len() - IMAGES_MAX) as u64;
        rows.push(["  ...".into(), format!("{} more", text::grouped(n_more))]);
    }
    rows.push(["memory".into(), text::bytes(info.memory_bytes)]);
    for MemoryUse { kind, bytes } in info.memory {
        rows.push([format!("  {kind}"), text::bytes(*bytes)]);
    }
    let rows: Vec<Vec<String>> = rows.into_iter().map(Vec::from).collect();
    table(&[Align::Left, Align::Left], &rows)
}

/// More images than this are counted, not shown.
const IMAGES_MAX: usize = 40;

/// A text from a file, which could disturb a terminal.
fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}
