//! The one error type of this crate.
//!
//! Its text is a whole sentence: the path, the cause in the words of the system or the decoder,
//! and what to do. The cause is therefore part of the text and not a [`source`], which would
//! print it twice in a chain.
//!
//! [`source`]: std::error::Error::source

use std::fmt::Display;
use std::path::Path;

/// What went wrong, for callers that decide by it (such as an exit code).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The system refused to read or write: missing file, no permission, full disk.
    Io,
    /// The path names a folder or a device where a file is needed.
    NotAFile,
    /// The name's extension, or the content, is of no format that this crate knows.
    UnknownFormat,
    /// A known format holds something that this crate does not read, such as deep EXR data.
    Unsupported,
    /// The file is truncated or damaged.
    Damaged,
    /// The picture is larger than the caller's limits.
    TooLarge,
    /// A texel is negative, infinite or not a number.
    BadTexel,
    /// Two pictures of different sizes cannot be compared.
    SizeMismatch,
    /// A picture's pixel count is not its width times its height, is zero, or does not fit the
    /// format; or a chart has nothing that can be drawn.
    InvalidInput,
}

/// Why a picture could not be read, written or compared.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Error {
    kind: ErrorKind,
    message: String,
}

impl Error {
    /// An error whose text is `message`, for crates that write their own kinds of picture.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// What went wrong.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The system failed to `action` ("write", "read") `path`.
    pub(crate) fn io(action: &str, path: &Path, cause: &std::io::Error, advice: &str) -> Self {
        let path = path.display();
        Self::new(ErrorKind::Io, format!("cannot {action} '{path}': {cause}; {advice}"))
    }
}

/// A fault found in a file's content, before its path is known.
///
/// Codecs work on bytes and return this; [`Fault::at`] makes the sentence.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) kind: ErrorKind,
    pub(crate) cause: String,
    /// Bytes that the texels would take, if they are too many.
    pub(crate) n_bytes: Option<u64>,
}

impl Fault {
    pub(crate) fn new(kind: ErrorKind, cause: impl Display) -> Self {
        // Causes come from several decoders; they are put in the middle of a sentence.
        Self { kind, cause: cause.to_string().trim_end_matches('.').to_owned(), n_bytes: None }
    }

    pub(crate) fn too_many_bytes(width: u64, height: u64, n_bytes: u64, limit: u64) -> Self {
        let cause =
            format!("its {width}x{height} texels take {n_bytes} bytes and the limit is {limit}");
        Self { n_bytes: Some(n_bytes), ..Self::new(ErrorKind::TooLarge, cause) }
    }

    pub(crate) fn damaged(cause: impl Display) -> Self {
        Self::new(ErrorKind::Damaged, cause)
    }

    pub(crate) fn unsupported(cause: impl Display) -> Self {
        Self::new(ErrorKind::Unsupported, cause)
    }

    /// The error for the file at `path`.
    pub(crate) fn at(self, path: &Path) -> Error {
        let advice = match self.kind {
            ErrorKind::Damaged => "; the file is damaged or incomplete: copy or export it again",
            ErrorKind::UnknownFormat => "; convert it to PNG, JPEG, HDR, EXR or PFM",
            ErrorKind::Unsupported => "; export it again in a plainer form, such as RGB PNG or EXR",
            ErrorKind::TooLarge => "; scale the image down",
            ErrorKind::BadTexel => "; repair the image: texels must be finite and not negative",
            _ => "",
        };
        Error::new(self.kind, format!("cannot read '{}': {}{advice}", path.display(), self.cause))
    }
}
