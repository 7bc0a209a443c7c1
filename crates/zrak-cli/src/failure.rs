//! Why a subcommand could not do its work: one message on stderr and an exit code.

use std::error::Error;
use std::fmt::Write;

use crate::exit_codes::Exit;
use crate::terminal;

/// A message for the user and how the process ends.
#[derive(Debug)]
pub(crate) struct Failure {
    exit: Exit,
    /// Whole text, several lines if need be.
    text: String,
}

impl Failure {
    /// A failure whose message is one sentence.
    pub(crate) fn new(exit: Exit, message: impl AsRef<str>) -> Self {
        let text = format!("{} {}", terminal::bold_red("error:"), message.as_ref());
        Self { exit, text }
    }

    /// A failure to write a file.
    pub(crate) fn file(error: &zrak::image::Error) -> Self {
        Self::new(Exit::File, chain(error))
    }

    /// Says what happened, and how to end.
    pub(crate) fn report(self) -> Exit {
        terminal::note(&self.text);
        self.exit
    }
}

impl From<zrak::Error> for Failure {
    fn from(error: zrak::Error) -> Self {
        let exit = match error.kind() {
            zrak::ErrorKind::UnknownScene | zrak::ErrorKind::Scene => Exit::Scene,
            zrak::ErrorKind::Image => Exit::File,
            zrak::ErrorKind::InvalidOption => Exit::Usage,
            _ => Exit::Backend,
        };
        match error.scene() {
            // It has its own layout, with the place in the file.
            Some(scene) if terminal::has_colours() => Self { exit, text: scene.styled() },
            Some(scene) => Self { exit, text: scene.to_string() },
            None => Self::new(exit, chain(&error)),
        }
    }
}

/// A message and those of its causes that it does not already have in it.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let message = error.to_string();
        if !text.contains(&message) {
            let _ = write!(text, ": {message}");
        }
        cause = error.source();
    }
    text
}
