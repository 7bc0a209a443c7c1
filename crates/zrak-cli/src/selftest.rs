//! `zrak selftest`: is every picture the same everywhere?
//!
//! The reference is the processor on one thread. All other ways to render the same samples must
//! give the same sums, to the last bit, and must have traced the same rays.

use std::sync::Arc;
use std::time::Instant;

use clap::Args;
use serde::Serialize;
use zrak::scene::builtin::{self, Builtin};
use zrak::{BackendChoice, Control, Film, RenderOptions, SceneArena, Tree};

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::text::count;
use crate::{interrupt, terminal};

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak selftest                     everything there is, the GPU included
  zrak selftest --quick             in a few seconds
  zrak selftest --backend cuda      the GPU against one thread; an error if there is none";

/// Options of `zrak selftest`.
#[derive(Args, Debug)]
pub(crate) struct SelftestArgs {
    /// Fewer and smaller pictures
    #[arg(long)]
    quick: bool,
    /// Test only this one; it has to be there
    #[arg(long, short = 'b', value_name = "NAME")]
    backend: Option<TestedBackend>,
    /// Number of the CUDA device
    #[arg(long, value_name = "N", default_value_t = 0)]
    device: u32,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum TestedBackend {
    /// The processor
    Cpu,
    /// An NVIDIA GPU
    Cuda,
}

/// A picture of a scene. Sizes are odd, too, so that tiles and blocks stick out of the picture.
struct Case {
    size: [u32; 2],
    seed: u64,
    spp: u32,
}

const CASES: [Case; 3] = [
    Case { size: [64, 48], seed: 0, spp: 4 },
    Case { size: [33, 17], seed: 1, spp: 3 },
    Case { size: [128, 128], seed: 0xdead_beef_cafe, spp: 9 },
];
const QUICK_CASES: [Case; 2] = [
    Case { size: [33, 17], seed: 0xdead_beef_cafe, spp: 3 },
    Case { size: [48, 32], seed: 0, spp: 2 },
];

/// Shapes of CUDA blocks: usual ones, no multiple of a warp, and one warp wide.
const BLOCKS: [[u32; 2]; 5] = [[8, 8], [7, 5], [16, 16], [20, 20], [32, 4]];

/// Most intersection tests, roughly, that a brute-force picture is worth.
const BRUTE_FORCE_MAX: u64 = 100_000_000;

/// A way to render that has to give the reference's picture.
struct Variant {
    /// Title of its column.
    column: &'static str,
    /// Options of `zrak render` that choose it.
    replay: String,
    options: RenderOptions,
}

/// What was found about a scene.
#[derive(Serialize)]
struct SceneResult {
    scene: &'static str,
    /// Pictures compared, by column.
    pictures: Vec<(&'static str, u32)>,
    differences: Vec<Difference>,
}

/// A picture that is not the reference's.
#[derive(Serialize)]
struct Difference {
    column: &'static str,
    x: usize,
    y: usize,
    /// Command that renders the picture.
    replay: String,
}

#[derive(Serialize)]
struct Json {
    version: &'static str,
    ok: bool,
    scenes: Vec<SceneResult>,
    cuda_not_tested: Option<String>,
    pictures: u32,
    seconds: f64,
}

/// Tests, and fails with [`Exit::Different`] if anything differs.
pub(crate) fn run(args: &SelftestArgs) -> Result<Exit, Failure> {
    let start = Instant::now();
    let control = interrupt::install();
    let no_cuda = why_no_cuda(args)?;
    let variants = variants(args, no_cuda.is_none());
    let columns = columns(&variants);
    let say = |line: String| if args.json { Ok(()) } else { terminal::print(&(line + "\n")) };

    say(row("scene", columns.iter().map(|column| (*column).to_owned())))?;
    let mut scenes = Vec::new();
    for builtin in builtin::all() {
        let Some(result) = test_scene(builtin, args.quick, &variants, &control)? else {
            terminal::note("interrupted");
            return Ok(Exit::Interrupted);
        };
        say(row(builtin.name, columns.iter().map(|column| cell(&result, column))))?;
        for Difference { column, x, y, replay } in &result.differences {
            say(format!("  {column}: DIFFERENT at pixel ({x}, {y}): run `{replay}`"))?;
        }
        scenes.push(result);
    }

    let n_different: usize = scenes.iter().map(|scene| scene.differences.len()).sum();
    let n_pictures = scenes.iter().flat_map(|scene| &scene.pictures).map(|(_, n)| n).sum();
    let seconds = start.elapsed().as_secs_f64();
    if let Some(reason) = &no_cuda {
        say(format!("cuda: not tested: {reason}"))?;
    }
    let verdict = match n_different {
        0 => "all are the same, to the last bit".to_owned(),
        n => {
            format!("{n} DIFFERENT; one thread renders the reference: `--backend cpu --threads 1`")
        }
    };
    say(format!(
        "{n_pictures} pictures compared with those of one thread in {seconds:.1} s: {verdict}"
    ))?;
    if args.json {
        let ok = n_different == 0;
        let version = zrak::VERSION;
        let cuda_not_tested = no_cuda;
        terminal::print_json(&Json {
            version,
            ok,
            scenes,
            cuda_not_tested,
            pictures: n_pictures,
            seconds,
        })?;
    }
    Ok(if n_different == 0 { Exit::Success } else { Exit::Different })
}

/// Why the GPU is not tested; an error if it was asked for.
fn why_no_cuda(args: &SelftestArgs) -> Result<Option<String>, Failure> {
    if args.backend == Some(TestedBackend::Cpu) {
        return Ok(Some("only the processor was asked for".to_owned()));
    }
    let reason = match zrak::cuda::devices() {
        Ok(found) if found.iter().any(|device| device.ordinal == args.device) => return Ok(None),
        Ok(_) => format!("there is no CUDA device {}", args.device),
        Err(error) => error.to_string(),
    };
    match args.backend {
        Some(_) => Err(Failure::new(Exit::Backend, reason)),
        None => Ok(Some(reason)),
    }
}

fn variants(args: &SelftestArgs, has_cuda: bool) -> Vec<Variant> {
    let mut variants = Vec::new();
    if args.backend != Some(TestedBackend::Cuda) {
        let options = RenderOptions { backend: BackendChoice::Cpu, ..RenderOptions::default() };
        let replay = "--backend cpu";
        let n_threads = zrak::n_threads(None).max(2);
        let threads = RenderOptions { threads: Some(n_threads), ..options };
        let text = format!("{replay} --threads {n_threads}");
        variants.push(Variant { column: "cpu", replay: text, options: threads });
        for (column, name, tree) in [
            ("cpu, binary tree", "binary", Tree::Binary),
            ("cpu, brute force", "brute-force", Tree::BruteForce),
        ] {
            let options = RenderOptions { tree, ..options };
            variants.push(Variant { column, replay: format!("{replay} --tree {name}"), options });
        }
    }
    if has_cuda {
        let n_blocks = if args.quick { 2 } else { BLOCKS.len() };
        for block @ [x, y] in BLOCKS.into_iter().take(n_blocks) {
            let (backend, device) = (BackendChoice::Cuda, args.device);
            let devices = zrak::Devices::one(device);
            let options = RenderOptions { backend, devices, block, ..RenderOptions::default() };
            let replay = format!("--backend cuda --device {device} --block {x}x{y}");
            variants.push(Variant { column: "cuda", replay, options });
        }
        for (column, backend) in
            [("cuda, all", BackendChoice::Cuda), ("hybrid", BackendChoice::Hybrid)]
        {
            let devices = zrak::Devices::ALL;
            let options = RenderOptions { backend, devices, ..RenderOptions::default() };
            let replay = format!("--backend {backend} --device all");
            variants.push(Variant { column, replay, options });
        }
    }
    variants
}

/// The columns of the table, each once.
fn columns(variants: &[Variant]) -> Vec<&'static str> {
    let mut columns: Vec<_> = variants.iter().map(|variant| variant.column).collect();
    columns.dedup();
    columns
}

/// Tests a scene; nothing if that was interrupted.
fn test_scene(
    builtin: &Builtin,
    quick: bool,
    variants: &[Variant],
    control: &Control,
) -> Result<Option<SceneResult>, Failure> {
    let cases: &[Case] = if quick { &QUICK_CASES } else { &CASES };
    let pictures = columns(variants).into_iter().map(|column| (column, 0)).collect();
    let mut result = SceneResult { scene: builtin.name, pictures, differences: Vec::new() };
    for case in cases {
        let mut scene = zrak::load_scene(builtin.name)?;
        [scene.desc.camera.width, scene.desc.camera.height] = case.size;
        scene.desc.render.seed = case.seed;
        let arena = scene.lower()?;
        let one_thread = RenderOptions {
            backend: BackendChoice::Cpu,
            threads: Some(1),
            ..RenderOptions::default()
        };
        let Some(reference) = render(&arena, case, &one_thread, control)? else { return Ok(None) };
        for variant in variants {
            if variant.options.tree == Tree::BruteForce && is_large(&arena, &reference) {
                continue;
            }
            let Some(film) = render(&arena, case, &variant.options, control)? else {
                return Ok(None);
            };
            for (column, n_pictures) in &mut result.pictures {
                *n_pictures += u32::from(*column == variant.column);
            }
            if let Some((x, y)) = first_difference(&reference, &film) {
                let (column, replay) = (variant.column, replay(builtin.name, case, variant));
                result.differences.push(Difference { column, x, y, replay });
            }
        }
    }
    Ok(Some(result))
}

fn render(
    arena: &Arc<SceneArena>,
    case: &Case,
    options: &RenderOptions,
    control: &Control,
) -> Result<Option<Film>, Failure> {
    let output = zrak::render(Arc::clone(arena), case.spp, options, control, &mut |_| {})?;
    Ok((output.n_samples == case.spp).then_some(output.film))
}

/// Whether brute force would take too long for this picture.
fn is_large(arena: &SceneArena, reference: &Film) -> bool {
    // A binary tree has one node less than it has primitives.
    let n_prims = arena.view().nodes2.len() as u64 + 1;
    n_prims * reference.n_rays() > BRUTE_FORCE_MAX
}

/// Column and row of the first pixel whose sums or numbers of rays differ.
fn first_difference(reference: &Film, film: &Film) -> Option<(usize, usize)> {
    let width = reference.region.width as usize;
    let idx = reference.pixels.iter().zip(&film.pixels).position(|(a, b)| a != b)?;
    Some((idx % width, idx / width))
}

fn replay(scene: &str, case: &Case, variant: &Variant) -> String {
    let Case { size: [width, height], seed, spp } = case;
    let options = &variant.replay;
    format!(
        "zrak render {scene} --width {width} --height {height} --spp {spp} --seed {seed} {options} \
         -o different.pfm"
    )
}

fn cell(result: &SceneResult, column: &str) -> String {
    let n_pictures = result.pictures.iter().find(|(name, _)| *name == column).map_or(0, |p| p.1);
    if result.differences.iter().any(|difference| difference.column == column) {
        "DIFFERENT".to_owned()
    } else if n_pictures == 0 {
        "too large".to_owned()
    } else {
        format!("ok ({})", count(n_pictures as usize, "picture"))
    }
}

/// A line of the table, whose widths do not depend on what is still being tested.
fn row(scene: &str, cells: impl Iterator<Item = String>) -> String {
    let cells: String = cells.map(|cell| format!("{cell:<18}")).collect();
    format!("{scene:<20}{cells}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use zrak::backend::Region;
    use zrak::core::math::Color;

    use super::*;

    #[test]
    fn a_difference_in_a_sum_or_a_ray_is_found() {
        let reference = Film::new(Region::whole(5, 4));
        assert_eq!(first_difference(&reference, &reference), None);
        let mut film = reference.clone();
        film.pixels[13].n_rays = 1;
        assert_eq!(first_difference(&reference, &film), Some((3, 2)));
        film.pixels[7].add_sample(Color::new(0.0, 0.0, f32::MIN_POSITIVE), 0);
        assert_eq!(first_difference(&reference, &film), Some((2, 1)));
    }

    #[test]
    fn a_replay_is_a_command_line_that_renders_that_picture() {
        use clap::Parser;
        let quick = SelftestArgs { quick: true, backend: None, device: 3, json: false };
        for variant in variants(&quick, true) {
            let line = replay("final", &CASES[2], &variant);
            let words = line.split(' ').take_while(|word| !word.contains('`'));
            let crate::args::Command::Render(args) =
                crate::args::Cli::try_parse_from(words).unwrap().command
            else {
                panic!("{line} is no render")
            };
            assert_eq!(args.backend.options(), variant.options, "{line}");
        }
    }
}
