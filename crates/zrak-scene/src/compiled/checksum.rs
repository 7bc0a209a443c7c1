//! The checksum of an arena: XXH3 of the XXH3 of each piece, so that threads can share the work and the
//! result does not depend on them. It finds damage; it does not prove where a file comes from.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use twox_hash::XxHash3_64;

use crate::arena::{Lens, layout, piece_range, pieces};

/// Hash of bytes.
pub(super) fn hash(bytes: &[u8]) -> u64 {
    XxHash3_64::oneshot(bytes)
}

/// A checksum on the way.
pub(super) struct Checksum(Vec<AtomicU64>);

impl Checksum {
    /// Of an arena with these numbers of records.
    pub(super) fn new(lens: &Lens) -> Self {
        Self(pieces(lens).iter().map(|_| AtomicU64::new(0)).collect())
    }

    /// Takes in piece number `i`.
    pub(super) fn add(&self, i: usize, piece: &[u8]) {
        self.0[i].store(hash(piece), Ordering::Relaxed);
    }

    /// The checksum, once all pieces are in.
    pub(super) fn finish(&self) -> u64 {
        let hashes: Vec<u8> =
            self.0.iter().flat_map(|h| h.load(Ordering::Relaxed).to_le_bytes()).collect();
        hash(&hashes)
    }
}

/// The checksum of the bytes of an arena with these numbers of records; 0 if they are not as many.
pub(super) fn of_arena(lens: &Lens, bytes: &[u8]) -> u64 {
    let Some((spans, _)) = layout(lens).filter(|(_, size)| *size == bytes.len()) else { return 0 };
    let checksum = Checksum::new(lens);
    let pieces = pieces(lens);
    (0..pieces.len())
        .into_par_iter()
        .for_each(|i| checksum.add(i, &bytes[piece_range(&spans, pieces[i])]));
    checksum.finish()
}
