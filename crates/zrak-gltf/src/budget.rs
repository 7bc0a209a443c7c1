//! How much memory a file has asked for.

use std::cell::Cell;
use std::fmt::Display;

use crate::error::{Error, ErrorKind};

/// What is left of [`crate::Limits::max_bytes`]. It is spent before memory is taken, and also bounds
/// the time that a small file can cost by asking for the same numbers again and again.
#[derive(Debug)]
pub(crate) struct Budget {
    total: u64,
    left: Cell<u64>,
}

impl Budget {
    pub(crate) fn new(total: u64) -> Self {
        Self { total, left: Cell::new(total) }
    }

    pub(crate) fn left(&self) -> u64 {
        self.left.get()
    }

    /// Spends `count` times `size` bytes.
    pub(crate) fn spend(&self, location: impl Display, count: u64, size: u64) -> Result<(), Error> {
        let rest = count.checked_mul(size).and_then(|n| self.left.get().checked_sub(n));
        match rest {
            Some(rest) => {
                self.left.set(rest);
                Ok(())
            }
            None => Err(self.exceeded(location)),
        }
    }

    pub(crate) fn exceeded(&self, location: impl Display) -> Error {
        let mib = self.total >> 20;
        let message = format!("the file asks for more than the {mib} MiB of memory it may have");
        let help = "split the scene, or allow more (--max-bytes)";
        Error::new(ErrorKind::TooLarge, location, message, help)
    }
}
