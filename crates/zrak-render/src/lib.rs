//! What all backends share: the interface, the film, and the progressive loop.

mod backend;
mod error;
mod film;
mod progressive;
mod region;
mod team;

#[cfg(test)]
mod tests;

pub use backend::{Backend, BackendInfo, Control, Times};
pub use error::{BackendError, BackendErrorKind};
pub use film::Film;
pub use progressive::{Interrupted, Rendered, render};
pub use region::{Region, SampleRange};
pub use team::Team;
