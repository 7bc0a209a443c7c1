//! How much memory a scene may still take.

use std::sync::atomic::{AtomicU64, Ordering};

/// The most bytes of what is made of a scene's files. It is spent before memory is taken.
pub(super) struct Budget {
    total: u64,
    left: AtomicU64,
}

impl Budget {
    pub(super) fn new(total: u64) -> Self {
        Self { total, left: AtomicU64::new(total) }
    }

    pub(super) fn left(&self) -> u64 {
        self.left.load(Ordering::Relaxed)
    }

    /// Spends bytes; the error is a message.
    pub(super) fn spend(&self, n_bytes: u64) -> Result<(), String> {
        let spent = self
            .left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(n_bytes));
        spent.map(drop).map_err(|_| self.exceeded())
    }

    pub(super) fn exceeded(&self) -> String {
        let limit = self.total;
        format!("the scene takes more memory than the limit of {limit} bytes")
    }
}

/// What to do about it.
pub(super) const HELP: &str = "if the scene is meant to be so large, raise the limit (--max-bytes)";
