//! What can be wrong with a mesh.

use std::fmt;
use std::ops::Range;

/// Why a mesh cannot be used: what is wrong, where, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    file: String,
    place: Option<Box<Place>>,
    message: String,
}

/// A part of a line of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Counted from 1.
    pub line: usize,
    /// What is in the line, cut where it gets long.
    pub text: String,
    /// The part that matters, in bytes of `text`.
    pub span: Range<usize>,
}

/// A longer line, in bytes, is cut.
const LINE_MAX: usize = 4096;

impl Error {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { file: String::new(), place: None, message: message.into() }
    }

    /// An error that shows a part of a line.
    pub(crate) fn at(
        line: usize,
        bytes: &[u8],
        span: Range<usize>,
        message: impl Into<String>,
    ) -> Self {
        let part = |range: Range<usize>| {
            let end = range.end.min(bytes.len()).min(LINE_MAX);
            String::from_utf8_lossy(&bytes[range.start.min(end)..end])
        };
        // What is not UTF-8 is replaced by something of another length.
        let before = part(0..span.start).into_owned();
        let marked = part(span.clone());
        let start = before.len();
        let end = start + marked.len();
        let text = before + &marked + &part(span.end.max(span.start)..bytes.len());
        let place = Some(Box::new(Place { line, text, span: start..end }));
        Self { file: String::new(), place, message: message.into() }
    }

    /// The same, in this file.
    #[must_use]
    pub fn in_file(mut self, file: impl fmt::Display) -> Self {
        self.file = file.to_string();
        self
    }

    /// What is wrong, without its place.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The place, in files that are text.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        self.place.as_deref()
    }
}

impl Place {
    /// The column, in characters counted from 1.
    #[must_use]
    pub fn column(&self) -> usize {
        self.text.get(..self.span.start).map_or(0, |before| before.chars().count()) + 1
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.file.is_empty() {
            write!(f, "{}: ", self.file)?;
        }
        if let Some(place) = &self.place {
            write!(f, "line {}, column {}: ", place.line, place.column())?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}
