//! Text on stdout and stderr, which may be a terminal, a file, a pipe or closed.
//!
//! `println!` and `eprintln!` panic when nobody reads any more; these do not.

use std::io::{ErrorKind, IsTerminal, Write, stderr, stdout};

use crate::exit_codes::Exit;
use crate::failure::Failure;

/// Writes a result to stdout. A reader that left, such as `head`, has seen enough.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new(Exit::File, format!("cannot write to the standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a value to stdout as one line of JSON.
pub(crate) fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    match serde_json::to_string(value) {
        Ok(json) => print(&(json + "\n")),
        Err(error) => Err(Failure::new(Exit::File, format!("cannot write JSON: {error}"))),
    }
}

/// Writes a line for a person to stderr, if anybody reads it.
pub(crate) fn note(line: &str) {
    let mut err = stderr().lock();
    let _ = writeln!(err, "{line}");
}

/// Whether stderr shows colours.
pub(crate) fn has_colours() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    stderr().is_terminal() && !refused
}

/// `text` in the colour of errors, where stderr has colours.
pub(crate) fn bold_red(text: &str) -> String {
    if has_colours() { format!("\x1b[1;31m{text}\x1b[0m") } else { text.to_owned() }
}
