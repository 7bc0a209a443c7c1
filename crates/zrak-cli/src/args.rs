//! The command line, from which the help, the completions and the man pages are made.

use std::fmt;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use zrak::{BackendChoice, RenderOptions, Tree};

use crate::{
    bench, compare, compile, completions, convert, devices, exit_codes, info, man, render, scenes,
    selftest,
};

/// A physically based path tracer: the same picture, to the last bit, on processor and GPU
#[derive(Parser, Debug)]
#[command(
    name = "zrak",
    version,
    max_term_width = 100,
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = format!("{EXAMPLES}\n\n{}", exit_codes::HELP),
)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  zrak scenes                           what there is to render
  zrak render final                     to final.png
  zrak render model.glb -o a.exr        a glTF file to an OpenEXR picture
  zrak convert cover -o cover.toml      a scene file to start from
  zrak info scene.pbrt                  what is in a scene, and the memory it takes
  zrak selftest                         is every picture the same everywhere?";

/// The subcommands.
#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    /// Render a scene to picture files
    #[command(visible_alias = "r", after_help = render::EXAMPLES)]
    Render(render::RenderArgs),
    /// List the built-in scenes
    Scenes(scenes::ScenesArgs),
    /// Write a scene as a file that renders at once
    #[command(after_help = compile::EXAMPLES)]
    Compile(compile::CompileArgs),
    /// Write a scene as a file of another format
    #[command(visible_alias = "export", after_help = convert::EXAMPLES)]
    Convert(convert::ConvertArgs),
    /// Say what is in a scene, and the memory that it takes
    #[command(after_help = info::EXAMPLES)]
    Info(info::InfoArgs),
    /// List what can be rendered on
    Devices(devices::DevicesArgs),
    /// Say how two pictures differ
    #[command(after_help = compare::EXAMPLES)]
    Compare(compare::CompareArgs),
    /// Check that all backends render the same pictures
    #[command(after_help = selftest::EXAMPLES)]
    Selftest(selftest::SelftestArgs),
    /// Measure total times over resolutions, backends and block shapes
    #[command(after_help = bench::EXAMPLES)]
    Bench(bench::BenchArgs),
    /// Print completions for a shell
    #[command(after_help = completions::EXAMPLES)]
    Completions(completions::CompletionsArgs),
    /// Write the man pages, or print them
    #[command(after_help = man::EXAMPLES)]
    Man(man::ManArgs),
}

/// What to render on.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Backend (never changes the picture)")]
pub(crate) struct BackendArgs {
    /// What to render on
    #[arg(long, short = 'b', value_name = "NAME", default_value = "auto")]
    pub(crate) backend: BackendName,
    /// Threads of the processor [default: all cores]
    #[arg(long, short = 'j', value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Numbers of the CUDA devices with commas between them, or `all` (see `zrak devices`)
    #[arg(long, value_name = "N", default_value_t = zrak::Devices::one(0))]
    pub(crate) device: zrak::Devices,
    /// Threads of a CUDA block along x and y
    #[arg(long, value_name = "WxH", default_value_t = Block::default())]
    pub(crate) block: Block,
    /// How the processor finds the closest hit
    #[arg(long, value_name = "NAME", default_value = "wide", hide_short_help = true)]
    pub(crate) tree: TreeName,
}

impl BackendArgs {
    /// The options of the renderer.
    pub(crate) fn options(&self) -> RenderOptions {
        RenderOptions {
            backend: self.backend.into(),
            threads: self.threads,
            tree: self.tree.into(),
            devices: self.device,
            block: self.block.0,
        }
    }
}

/// [`BackendChoice`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BackendName {
    /// The GPU if it can be had, otherwise the processor
    Auto,
    /// The processor
    Cpu,
    /// NVIDIA GPUs, or an error
    Cuda,
    /// NVIDIA GPUs and the processor together, or an error
    Hybrid,
}

impl From<BackendName> for BackendChoice {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Self::Auto,
            BackendName::Cpu => Self::Cpu,
            BackendName::Cuda => Self::Cuda,
            BackendName::Hybrid => Self::Hybrid,
        }
    }
}

/// [`Tree`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TreeName {
    /// Eight-wide tree, with vector instructions
    Wide,
    /// Binary tree, as on the GPU
    Binary,
    /// Every primitive is tested
    BruteForce,
}

impl From<TreeName> for Tree {
    fn from(name: TreeName) -> Self {
        match name {
            TreeName::Wide => Self::Wide,
            TreeName::Binary => Self::Binary,
            TreeName::BruteForce => Self::BruteForce,
        }
    }
}

/// A number of threads; 0 is refused here, as `--threads 0`.
fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(0) => Err("there has to be at least 1 thread".to_owned()),
        Ok(n) => Ok(n),
        Err(error) => Err(error.to_string()),
    }
}

/// Two numbers with an x between them, both at least 1.
pub(crate) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once('x').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
    match parsed {
        Some(size) if size[0] > 0 && size[1] > 0 => Ok(size),
        Some(_) => Err("both numbers have to be at least 1".to_owned()),
        None => Err("two numbers with an x between them are needed, such as 16x16".to_owned()),
    }
}

/// A shape of blocks that CUDA can take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Block(pub(crate) [u32; 2]);

impl Default for Block {
    fn default() -> Self {
        Self(RenderOptions::default().block)
    }
}

impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.0;
        write!(f, "{x}x{y}")
    }
}

impl FromStr for Block {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let [x, y] = parse_size(text)?;
        let n_threads = u64::from(x) * u64::from(y);
        if n_threads > 1024 {
            return Err(format!("a block has at most 1024 threads, and {x} x {y} = {n_threads}"));
        }
        Ok(Self([x, y]))
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn defaults_are_those_of_the_renderer() {
        let Command::Render(args) = Cli::parse_from(["zrak", "render", "final"]).command else {
            panic!("that is a render")
        };
        assert_eq!(args.backend.options(), RenderOptions::default());
    }

    #[test]
    fn blocks_are_what_cuda_can_take() {
        for (text, block) in [("16x16", Some([16, 16])), ("32x4", Some([32, 4]))] {
            assert_eq!(text.parse().ok(), block.map(Block));
        }
        for text in ["", "16", "0x4", "x", "33x32", "-1x2", "4x4x4", "65536x65536"] {
            assert!(text.parse::<Block>().is_err(), "{text}");
        }
    }
}
