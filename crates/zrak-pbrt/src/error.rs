//! Errors with a place, until they are shown.

use std::ops::Range;

/// A stretch of a file that was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    /// Index of the file in the list of all that were read.
    pub(crate) file: usize,
    /// Bytes in it.
    pub(crate) bytes: Range<usize>,
}

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) span: Span,
    pub(crate) message: String,
    pub(crate) help: Option<String>,
}

impl Fault {
    pub(crate) fn new(span: &Span, message: impl Into<String>) -> Self {
        Self { span: span.clone(), message: message.into(), help: None }
    }

    /// That there is no such thing, with the one that may be meant or with all.
    pub(crate) fn unknown(span: &Span, what: &str, name: &str, all: &[&str]) -> Self {
        let fault = Self::new(span, format!("unknown {what} \"{name}\""));
        match zrak_scene::suggest::closest(name, all.iter().copied()) {
            Some(near) => fault.help(format!("did you mean \"{near}\"?")),
            None => fault.help(format!("there are {}", all.join(", "))),
        }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

pub(crate) type Result<T> = std::result::Result<T, Fault>;
