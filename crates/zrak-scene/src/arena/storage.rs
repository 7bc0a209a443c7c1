//! Where the bytes of an arena are: in memory of its own, or in a file that is mapped.
//!
//! A map shows the file as it is: if another program changes the file in place while it is mapped, the
//! arena may change with it after it was checked, and if it makes the file shorter, reading what is
//! gone ends the process. Nothing can be done against that but not to do it: zrak itself never writes
//! to a file that is there, it replaces it by another one, and a map keeps the old one alive.

#![allow(unsafe_code)]

use std::fs::File;
use std::io;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use memmap2::{Mmap, MmapOptions};

use super::ARENA_ALIGNMENT;

/// Piece of an arena: gives the buffer its alignment.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, align(256))]
pub(crate) struct Chunk([u8; ARENA_ALIGNMENT]);

/// Memory for so many bytes, a multiple of the alignment.
pub(super) fn zeroed(size: usize) -> Vec<Chunk> {
    vec![Chunk::zeroed(); size / ARENA_ALIGNMENT]
}

/// Appends bytes, and zeros up to the next multiple of the alignment.
pub(super) fn append(chunks: &mut Vec<Chunk>, bytes: &[u8]) {
    let (whole, rest) = bytes.as_chunks::<ARENA_ALIGNMENT>();
    chunks.extend(whole.iter().map(|bytes| Chunk(*bytes)));
    if !rest.is_empty() {
        let mut last = Chunk::zeroed();
        last.0[..rest.len()].copy_from_slice(rest);
        chunks.push(last);
    }
}

/// The bytes of an arena, aligned to [`ARENA_ALIGNMENT`]. A copy shares them.
#[derive(Clone)]
pub(crate) enum Storage {
    /// In memory.
    Owned(Arc<Vec<Chunk>>),
    /// In a file, from `start` on.
    Mapped {
        /// The whole file.
        map: Arc<Mmap>,
        /// A multiple of the alignment.
        start: usize,
    },
}

impl Storage {
    /// A copy of bytes, as many as a multiple of the alignment.
    pub(crate) fn copy_of(bytes: &[u8]) -> Self {
        let mut chunks = zeroed(bytes.len());
        bytemuck::cast_slice_mut::<_, u8>(&mut chunks).copy_from_slice(bytes);
        Self::Owned(Arc::new(chunks))
    }

    /// The bytes of a mapped file from a multiple of the alignment on.
    pub(crate) fn mapped(map: Arc<Mmap>, start: usize) -> Self {
        assert!(start <= map.len() && start.is_multiple_of(ARENA_ALIGNMENT));
        Self::Mapped { map, start }
    }

    /// All of them.
    pub(crate) fn bytes(&self) -> &[u8] {
        match self {
            Self::Owned(chunks) => bytemuck::cast_slice(chunks),
            // Maps start at pages, which are larger than the alignment.
            Self::Mapped { map, start } => &map[*start..],
        }
    }
}

/// Maps a whole file into memory, to be read only.
///
/// # Errors
/// If the system or the file system cannot do that.
pub(crate) fn map(file: &File) -> io::Result<Mmap> {
    // SAFETY: the map is private and read-only, so nobody writes through it, and it is only ever read
    // as plain bytes, for which every value is valid. That nobody changes the file itself meanwhile
    // cannot be enforced; it is demanded of users (see this module's head and the guide). Should it
    // happen, the processor's reads stay in bounds, for they are checked.
    unsafe { MmapOptions::new().map_copy_read_only(file) }
}
