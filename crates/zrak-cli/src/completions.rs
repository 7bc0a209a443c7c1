//! `zrak completions`: a script that completes `zrak` in a shell.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::args::Cli;
use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::terminal;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak completions bash > ~/.local/share/bash-completion/completions/zrak
  zrak completions zsh > ~/.zfunc/_zrak
  zrak completions fish > ~/.config/fish/completions/zrak.fish";

/// Options of `zrak completions`.
#[derive(Args, Debug)]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Prints the script.
pub(crate) fn run(args: &CompletionsArgs) -> Result<Exit, Failure> {
    // To memory first: the generator panics when it cannot write.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "zrak", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Success)
}
