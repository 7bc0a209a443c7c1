//! How the process ends, for scripts.

use std::process::ExitCode;

/// The exit codes of every subcommand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    /// All is well.
    Success = 0,
    /// The pictures differ.
    Different = 1,
    /// The command line makes no sense; clap's own code for that, too.
    Usage = 2,
    /// The scene cannot be read, or cannot be rendered.
    Scene = 3,
    /// A picture or another file cannot be read or written.
    File = 4,
    /// The backend cannot start or go on.
    Backend = 5,
    /// Ctrl-C: 128 and the number of the signal, as shells have it.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// The table in `zrak --help`.
pub(crate) const HELP: &str = "\
Exit codes:
  0    success
  1    pictures differ (compare, selftest)
  2    the command line is wrong
  3    the scene, or an image that it refers to, cannot be read or rendered
  4    a picture or another file cannot be read or written
  5    the backend or its device is missing, out of memory or failed
  130  interrupted; `render` writes the finished passes first";
