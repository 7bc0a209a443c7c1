//! The one error of the facade: what its parts say, and what can be saved.

use std::fmt;

use zrak_render::{BackendError, BackendErrorKind};
use zrak_scene::error::SceneError;

use crate::RenderOutput;

/// What sort of error it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// There is no built-in scene of this name.
    UnknownScene,
    /// The scene cannot be read, or cannot be rendered.
    Scene,
    /// A picture cannot be read or written.
    Image,
    /// An option that the backend cannot take.
    InvalidOption,
    /// The scene or the film does not fit the memory.
    OutOfMemory,
    /// There is no such device, or it failed.
    Backend,
}

/// A scene could not be loaded, rendered or written.
///
/// `Display` gives the message of the part that failed; that of a [`SceneError`] has several
/// lines and starts with `error:`.
pub struct Error(Box<Inner>);

struct Inner {
    kind: ErrorKind,
    cause: Cause,
    finished: Option<RenderOutput>,
}

enum Cause {
    Message(String),
    Scene(SceneError),
    Gltf(zrak_gltf::Error),
    Backend(BackendError),
    Image(zrak_image::Error),
}

impl Error {
    fn from_cause(kind: ErrorKind, cause: Cause) -> Self {
        Self(Box::new(Inner { kind, cause, finished: None }))
    }

    pub(crate) fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self::from_cause(kind, Cause::Message(message.into()))
    }

    pub(crate) fn with_finished(mut self, finished: RenderOutput) -> Self {
        self.0.finished = Some(finished);
        self
    }

    /// What sort of error it is.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// What is wrong with the scene, if it comes from a file.
    #[must_use]
    pub fn scene(&self) -> Option<&SceneError> {
        match &self.0.cause {
            Cause::Scene(error) => Some(error),
            _ => None,
        }
    }

    /// The passes that were finished before the device failed.
    #[must_use]
    pub fn finished(&self) -> Option<&RenderOutput> {
        self.0.finished.as_ref()
    }
}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::from_cause(ErrorKind::Scene, Cause::Scene(error))
    }
}

impl From<zrak_gltf::Error> for Error {
    fn from(error: zrak_gltf::Error) -> Self {
        Self::from_cause(ErrorKind::Scene, Cause::Gltf(error))
    }
}

impl From<zrak_image::Error> for Error {
    fn from(error: zrak_image::Error) -> Self {
        Self::from_cause(ErrorKind::Image, Cause::Image(error))
    }
}

impl From<BackendError> for Error {
    fn from(error: BackendError) -> Self {
        let kind = match error.kind() {
            BackendErrorKind::InvalidOption => ErrorKind::InvalidOption,
            BackendErrorKind::OutOfMemory => ErrorKind::OutOfMemory,
            _ => ErrorKind::Backend,
        };
        Self::from_cause(kind, Cause::Backend(error))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.cause {
            Cause::Message(message) => f.write_str(message),
            Cause::Scene(error) => error.fmt(f),
            Cause::Gltf(error) => error.fmt(f),
            Cause::Backend(error) => error.fmt(f),
            Cause::Image(error) => error.fmt(f),
        }
    }
}

// `unwrap` and a test's `Result` show an error by `Debug`: let them show something to read.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Error ({:?}): {self}", self.0.kind)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        // The cause's text is this error's text, so the chain goes on behind the cause.
        match &self.0.cause {
            Cause::Message(_) => None,
            Cause::Scene(error) => error.source(),
            Cause::Gltf(error) => error.source(),
            Cause::Backend(error) => error.source(),
            Cause::Image(error) => error.source(),
        }
    }
}
