//! `zrak man`: the man pages, made of the same definitions as the help.

use std::io;
use std::path::PathBuf;

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;

use crate::args::Cli;
use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::terminal;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak man ~/.local/share/man/man1     zrak.1, zrak-render.1, ...
  zrak man | man -l -                  to read them all";

/// Options of `zrak man`.
#[derive(Args, Debug)]
pub(crate) struct ManArgs {
    /// Folder for all pages, made if need be; without it, they are printed
    dir: Option<PathBuf>,
}

/// Writes or prints the pages.
pub(crate) fn run(args: &ManArgs) -> Result<Exit, Failure> {
    let pages = pages()
        .map_err(|error| Failure::new(Exit::File, format!("cannot make the man pages: {error}")))?;
    let Some(dir) = &args.dir else {
        terminal::print(&pages.into_iter().map(|(_, page)| page).collect::<String>())?;
        return Ok(Exit::Success);
    };
    std::fs::create_dir_all(dir).map_err(|error| {
        Failure::new(Exit::File, format!("cannot make the folder '{}': {error}", dir.display()))
    })?;
    for (name, page) in pages {
        let written = zrak::image::replace_file(&dir.join(name), page.as_bytes());
        written.map_err(|error| Failure::file(&error))?;
    }
    Ok(Exit::Success)
}

/// Name and text of every page.
fn pages() -> io::Result<Vec<(String, String)>> {
    let mut root = Cli::command().disable_help_subcommand(true);
    // Gives the subcommands their whole names, such as zrak-render.
    root.build();
    let page = |command: &Command| {
        let man = Man::new(command.clone()).source(format!("zrak {}", zrak::VERSION));
        let mut text = Vec::new();
        man.render(&mut text)?;
        Ok((man.get_filename(), unfilled_examples(&String::from_utf8_lossy(&text))))
    };
    std::iter::once(&root).chain(root.get_subcommands()).map(page).collect()
}

/// A page whose examples, which are columns of text, are not made into a paragraph.
fn unfilled_examples(page: &str) -> String {
    let Some((before, examples)) = page.split_once(".SH EXTRA\n") else { return page.to_owned() };
    let (examples, after) = examples.split_at(examples.find("\n.SH ").unwrap_or(examples.len()));
    format!("{before}.SH EXAMPLES AND NOTES\n.nf\n{examples}\n.fi{after}")
}
