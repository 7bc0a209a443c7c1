//! `zrak bench`: total times from start to finish on one thread, on all, and on the GPU.
//!
//! Each run starts from nothing: it builds the scene, brings it to the backend, renders it and
//! brings the film back. Only the writing of a picture is left out.

mod charts;
mod files;
mod measure;
mod tables;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;
use zrak::{BackendChoice, RenderOptions};

use crate::args::{Block, parse_size};
use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::{interrupt, machine, terminal, text};
use measure::Results;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak bench                                              the final scene, 100x100 to 1000x1000
  zrak bench --resolutions 200x200,400x400 --runs 5       medians of five runs
  zrak bench --out results                                with bench.csv, bench.json and charts
  zrak bench cover --backends cpu,cuda --max-time 600     larger points, without one thread

The first run on a GPU includes the driver's compilation, which it keeps for later ones.";

/// Options of `zrak bench`.
#[derive(Args, Debug)]
pub(crate) struct BenchArgs {
    /// Built-in scene or path of a .toml file
    #[arg(default_value = "final")]
    scene: PathBuf,
    /// Sizes of the picture
    #[arg(
        long, value_name = "WxH,...", value_delimiter = ',', value_parser = parse_size,
        default_value = "100x100,200x200,300x300,400x400,500x500,600x600,700x700,800x800,900x900,1000x1000"
    )]
    resolutions: Vec<[u32; 2]>,
    /// Samples per pixel
    #[arg(long, short = 's', value_name = "N", default_value_t = 10)]
    spp: u32,
    /// Runs of each point, of which the median counts
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// What to measure: one thread, all threads, the GPU
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_value = "cpu1,cpu,cuda")]
    backends: Vec<BenchBackend>,
    /// Shapes of CUDA blocks to try at the largest size; the other points have the default shape
    #[arg(
        long,
        value_name = "WxH,...",
        value_delimiter = ',',
        default_value = "4x4,8x8,16x16,20x20,32x4"
    )]
    blocks: Vec<Block>,
    /// Number of the CUDA device
    #[arg(long, value_name = "N", default_value_t = 0)]
    device: u32,
    /// Leave out points of which one run would take longer, judged by the one before
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    max_time: f64,
    /// Folder for bench.csv, bench.json and the charts, made if need be
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one line of JSON instead of tables
    #[arg(long)]
    json: bool,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum BenchBackend {
    /// The processor on one thread
    Cpu1,
    /// The processor on all threads
    Cpu,
    /// An NVIDIA GPU
    Cuda,
}

impl BenchBackend {
    const fn name(self) -> &'static str {
        match self {
            Self::Cpu1 => "cpu1",
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
        }
    }

    /// Name for people.
    fn title(self) -> String {
        match self {
            Self::Cpu1 => "CPU, 1 thread".to_owned(),
            Self::Cpu => format!("CPU, {}", text::count(zrak::n_threads(None), "thread")),
            Self::Cuda => "GPU".to_owned(),
        }
    }

    fn options(self, device: u32, Block(block): Block) -> RenderOptions {
        let cpu = RenderOptions { backend: BackendChoice::Cpu, ..RenderOptions::default() };
        match self {
            Self::Cpu1 => RenderOptions { threads: Some(1), ..cpu },
            Self::Cpu => cpu,
            Self::Cuda => RenderOptions {
                backend: BackendChoice::Cuda,
                devices: zrak::Devices::one(device),
                block,
                ..cpu
            },
        }
    }
}

/// Where and how it was measured.
#[derive(Serialize)]
struct Setup {
    version: &'static str,
    date: String,
    command: Vec<String>,
    cpu: String,
    threads: usize,
    instruction_set: String,
    gpu: Option<String>,
    scene: String,
    spp: u32,
    max_depth: u32,
    seed: u64,
    runs: u32,
}

/// Measures, and reports what was measured also when it is interrupted or a device fails.
pub(crate) fn run(args: &BenchArgs) -> Result<Exit, Failure> {
    let control = interrupt::install();
    let scene = checked_scene(args)?;
    let gpu = gpu_name(args);
    let backends = available(args, &gpu)?;
    if let Some(dir) = &args.out {
        prepare(dir)?;
    }
    let setup = Setup {
        version: zrak::VERSION,
        date: machine::now_utc(),
        command: std::env::args_os().map(|arg| arg.to_string_lossy().into_owned()).collect(),
        cpu: machine::cpu_model(),
        threads: zrak::n_threads(None),
        instruction_set: zrak::cpu_instruction_set().to_owned(),
        gpu: gpu.ok(),
        scene: scene.desc.name,
        spp: args.spp,
        max_depth: scene.desc.render.max_depth,
        seed: scene.desc.render.seed,
        runs: args.runs,
    };

    let results = measure::measure(args, &backends, &control);
    if args.json {
        terminal::print(&(files::json(&setup, &results) + "\n"))?;
    } else {
        terminal::print(&tables::tables(&setup, &backends, &results))?;
    }
    if let (Some(dir), false) = (&args.out, results.points.is_empty()) {
        files::write(dir, &setup, &results).map_err(|error| Failure::file(&error))?;
        charts::write(dir, &setup, &backends, &results).map_err(|error| Failure::file(&error))?;
    }
    finish(results, control.is_stopped())
}

fn finish(results: Results, was_interrupted: bool) -> Result<Exit, Failure> {
    if was_interrupted {
        terminal::note("interrupted: the points that were finished are reported");
        return Ok(Exit::Interrupted);
    }
    results.failure.map_or(Ok(Exit::Success), Err)
}

/// The scene, if it can be rendered at every size.
fn checked_scene(args: &BenchArgs) -> Result<zrak::Scene, Failure> {
    let scene = zrak::load_scene(&args.scene)?;
    for &[width, height] in &args.resolutions {
        measure::overrides(args, [width, height]).apply(&mut scene.clone().desc)?;
    }
    Ok(scene)
}

/// Name of the GPU, or why there is none.
fn gpu_name(args: &BenchArgs) -> Result<String, String> {
    let devices = zrak::cuda::devices().map_err(|error| error.to_string())?;
    let found = devices.into_iter().find(|device| device.ordinal == args.device);
    found.map(|device| device.name).ok_or(format!("there is no CUDA device {}", args.device))
}

/// The backends that were asked for and are there.
fn available(args: &BenchArgs, gpu: &Result<String, String>) -> Result<Vec<BenchBackend>, Failure> {
    let mut backends = args.backends.clone();
    let Err(reason) = gpu else { return Ok(backends) };
    if backends.contains(&BenchBackend::Cuda) {
        backends.retain(|backend| *backend != BenchBackend::Cuda);
        if backends.is_empty() {
            return Err(Failure::new(Exit::Backend, reason));
        }
        terminal::note(&format!("cuda is left out: {reason}"));
    }
    Ok(backends)
}

/// Makes the folder and makes sure that it takes files, before anything is measured.
fn prepare(dir: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(dir).map_err(|error| {
        Failure::new(Exit::File, format!("cannot make the folder '{}': {error}", dir.display()))
    })?;
    zrak::image::check_writable(&dir.join("time.png")).map_err(|error| Failure::file(&error))
}
