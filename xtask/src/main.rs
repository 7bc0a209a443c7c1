//! Chores of the repository, run as `cargo xtask COMMAND`.

mod kernels;

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};

/// Chores of the zrak repository.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compile the GPU kernels to PTX, or check the committed ones.
    Kernels(kernels::Options),
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Kernels(options) => kernels::run(&repository(), &options),
    }
}

/// Root of the repository.
fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new(".")).to_owned()
}
