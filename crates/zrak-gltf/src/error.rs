//! What can be wrong with a glTF file, and what of it is only worth a word.

use std::collections::BTreeSet;
use std::fmt::{self, Display};

/// What sort of error it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A file could not be read or written.
    Io,
    /// The file is neither glTF 2.0 nor its binary form.
    NotGltf,
    /// The text is not JSON, or its JSON has another shape than glTF's.
    Syntax,
    /// The file contradicts itself or the specification.
    Invalid,
    /// The file needs something that zrak does not have.
    Unsupported,
    /// The file asks for more memory than [`crate::Limits`] allow.
    TooLarge,
}

/// A glTF file could not be read or written. Its text is a sentence that names the file, the place in
/// its JSON, the cause and what to do.
#[derive(Clone, PartialEq, Eq)]
pub struct Error(Box<Inner>);

#[derive(Clone, PartialEq, Eq)]
struct Inner {
    kind: ErrorKind,
    file: String,
    location: String,
    message: String,
    help: String,
}

impl Error {
    pub(crate) fn new(
        kind: ErrorKind,
        location: impl Display,
        message: impl Display,
        help: impl Display,
    ) -> Self {
        Self(Box::new(Inner {
            kind,
            file: String::new(),
            location: location.to_string(),
            message: message.to_string(),
            help: help.to_string(),
        }))
    }

    /// The file contradicts itself; only its maker can mend that.
    pub(crate) fn invalid(location: impl Display, message: impl Display) -> Self {
        let help = "the file is damaged or was written by a faulty exporter: export it again";
        Self::new(ErrorKind::Invalid, location, message, help)
    }

    pub(crate) fn in_file(mut self, file: impl Display) -> Self {
        self.0.file = file.to_string();
        self
    }

    /// What sort of error it is.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The place in the JSON, such as `meshes[3].primitives[0].indices`; empty for the whole file.
    #[must_use]
    pub fn location(&self) -> &str {
        &self.0.location
    }

    /// The cause, without file, place and advice.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.0.message
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Inner { file, location, message, help, .. } = &*self.0;
        for part in [file, location] {
            if !part.is_empty() {
                write!(f, "{part}: ")?;
            }
        }
        f.write_str(message)?;
        if help.is_empty() { Ok(()) } else { write!(f, "; {help}") }
    }
}

// `unwrap` and a test's `Result` show an error by `Debug`: let them show something to read.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Error ({:?}): {self}", self.0.kind)
    }
}

impl std::error::Error for Error {}

/// Something that was read or written otherwise than it was meant, or not at all.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Warning {
    /// The place in the JSON or in the scene.
    pub location: String,
    /// What it is.
    pub message: String,
}

impl Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { location, message } = self;
        if location.is_empty() { f.write_str(message) } else { write!(f, "{location}: {message}") }
    }
}

/// More warnings than this are counted, not kept.
const KEPT_MAX: usize = 200;

/// Warnings, each once.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    list: Vec<Warning>,
    seen: BTreeSet<Warning>,
    n_left_out: usize,
}

impl Warnings {
    pub(crate) fn note(&mut self, location: impl Display, message: impl Display) {
        if self.list.len() >= KEPT_MAX {
            self.n_left_out += 1;
            return;
        }
        let warning = Warning { location: location.to_string(), message: message.to_string() };
        if self.seen.insert(warning.clone()) {
            self.list.push(warning);
        }
    }

    pub(crate) fn into_list(mut self) -> Vec<Warning> {
        if self.n_left_out > 0 {
            let message = format!("{} more warnings are not shown", self.n_left_out);
            self.list.push(Warning { location: String::new(), message });
        }
        self.list
    }
}
