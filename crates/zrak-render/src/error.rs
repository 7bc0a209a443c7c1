//! Why a backend could not render.

/// What sort of failure it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BackendErrorKind {
    /// There is no such device, or no driver for it.
    Unavailable,
    /// An option that the backend cannot take.
    InvalidOption,
    /// The scene or the film does not fit the memory.
    OutOfMemory,
    /// The device failed on the way, or was lost.
    Failed,
}

/// A backend could not start or go on.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct BackendError {
    kind: BackendErrorKind,
    message: String,
}

impl BackendError {
    /// An error whose text is `message`.
    pub fn new(kind: BackendErrorKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// What sort of failure it is.
    #[must_use]
    pub fn kind(&self) -> BackendErrorKind {
        self.kind
    }
}
