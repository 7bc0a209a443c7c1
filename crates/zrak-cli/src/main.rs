//! The `zrak` command: a file per subcommand, and what they share.

mod args;
mod exit_codes;
mod failure;

mod bench;
mod compare;
mod compile;
mod completions;
mod convert;
mod devices;
mod info;
mod man;
mod render;
mod scenes;
mod selftest;

mod interrupt;
mod load;
mod loading;
mod machine;
mod overrides;
mod progress;
mod terminal;
mod text;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;

use args::{Cli, Command};

fn main() -> ExitCode {
    let start = Instant::now();
    let result = match Cli::parse().command {
        Command::Render(args) => render::run(&args, start),
        Command::Scenes(args) => scenes::run(&args),
        Command::Compile(args) => compile::run(&args, start),
        Command::Convert(args) => convert::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Devices(args) => devices::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Selftest(args) => selftest::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    };
    match result {
        Ok(exit) => exit.into(),
        Err(failure) => failure.report().into(),
    }
}
