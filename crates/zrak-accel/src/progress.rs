//! Telling the caller how far a build is.

use std::sync::atomic::{AtomicUsize, Ordering};

/// How to build.
#[derive(Clone, Copy, Default)]
pub struct BuildOptions<'a> {
    /// Called from time to time with the share of this tree that is built, from any of the threads
    /// that build it; shares may come slightly out of order. At most some 200 calls.
    pub progress: Option<&'a (dyn Fn(f32) + Sync)>,
}

/// Calls for a tree.
const N_STEPS: u64 = 200;

/// Counts the units of work that are done.
pub(crate) struct Progress<'a> {
    callback: Option<&'a (dyn Fn(f32) + Sync)>,
    n_total: u64,
    n_done: AtomicUsize,
}

impl<'a> Progress<'a> {
    pub(crate) fn new(options: &BuildOptions<'a>, n_total: usize) -> Self {
        Self { callback: options.progress, n_total: n_total as u64, n_done: AtomicUsize::new(0) }
    }

    /// Counts some more units, and calls back if that makes a step.
    pub(crate) fn add(&self, n: usize) {
        let Some(callback) = self.callback else { return };
        let before = self.n_done.fetch_add(n, Ordering::Relaxed) as u64;
        let now = before + n as u64;
        if before * N_STEPS / self.n_total != now * N_STEPS / self.n_total {
            callback(now as f32 / self.n_total as f32);
        }
    }
}
