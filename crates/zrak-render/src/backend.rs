//! The interface of a backend.
//!
//! # To add a backend
//! 1. Make a crate with a type that implements [`Backend`]. It must call
//!    [`zrak_core::integrators::render_pixel`], or the stages that it is made of, and add up
//!    [`zrak_core::film::PixelSum`]s: then its pictures are the same bytes as everybody's.
//! 2. Add it to the facade's choice of backends (crate `zrak`, `backends.rs`).
//! 3. Let `zrak selftest` compare it with the processor.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::{BackendError, Film, SampleRange};

/// What a backend runs on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackendInfo {
    /// `cpu`, `cuda`, ...
    pub name: &'static str,
    /// The device, in words.
    pub device: String,
}

/// Where the time went, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Bringing the kernels to the device, including the driver's compilation.
    pub compile_s: f64,
    /// Bringing the scene to the device.
    pub upload_s: f64,
    /// Tracing.
    pub render_s: f64,
    /// Bringing the film back.
    pub download_s: f64,
}

impl Times {
    /// Sum of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            compile_s: self.compile_s + other.compile_s,
            upload_s: self.upload_s + other.upload_s,
            render_s: self.render_s + other.render_s,
            download_s: self.download_s + other.download_s,
        }
    }
}

/// How a running render is watched and stopped, from any thread.
#[derive(Debug, Default)]
pub struct Control {
    stop: AtomicBool,
    n_samples: AtomicU64,
}

impl Control {
    /// Asks the render to stop soon.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Counts samples (of single pixels) that were rendered.
    pub fn count_samples(&self, n: u64) {
        self.n_samples.fetch_add(n, Ordering::Relaxed);
    }

    /// Samples (of single pixels) rendered so far, including those of unfinished passes.
    #[must_use]
    pub fn n_samples(&self) -> u64 {
        self.n_samples.load(Ordering::Relaxed)
    }
}

/// Something that renders one scene.
pub trait Backend {
    /// What it runs on.
    fn info(&self) -> BackendInfo;

    /// Adds samples to a film, of all pixels of its region: as many of `samples`, from the first
    /// on, as it sees fit to do in one go (a fraction of a second to a few), at least one. Returns how
    /// many. If it is stopped or fails before all pixels have the same number, the film is
    /// spoilt and the result is 0 or an error.
    ///
    /// # Errors
    /// If the device fails.
    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError>;

    /// Where the time went so far.
    fn times(&self) -> Times;

    /// Parts of it that failed and were done without since, in their own words.
    fn failures(&self) -> Vec<String> {
        Vec::new()
    }
}
