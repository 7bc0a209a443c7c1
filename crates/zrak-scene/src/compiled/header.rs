//! The head of a compiled scene's file.
//!
//! | Bytes | What |
//! |---|---|
//! | 128 | [`Fixed`]: what it is, who wrote it, checksums, background |
//! | 4 each | number of records of each array, in the order of the list |
//! | `text_len` | name, camera and sampling, as a scene file |
//! | | zeros up to a multiple of 4096 |
//! | | the arena, as it is in memory |
//!
//! Numbers are as in memory, too: a file is for machines of one byte order, which are nearly all. Where
//! the arrays lie is not in the file; it follows from their lengths.

use bytemuck::{Pod, Zeroable};
use zrak_core::scene::{Background, Globals};

use super::checksum::{self, hash};
use super::damaged;
use crate::arena::{ARRAY_TYPES, Lens, SceneArena, layout, spans_in_order};
use crate::desc::SceneDesc;
use crate::error::{SceneError, SceneErrorKind};
use crate::file::write_string;

/// The first byte is no text, the last one breaks if line ends are changed on the way.
const MAGIC: [u8; 8] = *b"\x89zscene\n";
const BYTE_ORDER: u32 = 0x0102_0304;
/// To be raised with every change of what stands in the file, or of what a record means, that does not
/// change the list of arrays or the size of a record.
const FORMAT: u32 = 1;
/// The arena starts at a multiple of this: what the pages of most machines have in bytes.
const PAGE: usize = 4096;
/// Longest text in bytes.
const TEXT_MAX: u32 = 16 << 20;

/// The part of a fixed size. Its first three fields are the same in every format.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Fixed {
    magic: [u8; 8],
    byte_order: u32,
    format: u32,
    /// Version of the zrak that wrote it, padded with zeros.
    version: [u8; 24],
    /// [`fingerprint`] of the arena's layout.
    layout: u64,
    /// Size of the file in bytes.
    file_size: u64,
    /// Of everything before the arena, with zero in place of this.
    checksum: u64,
    arena_checksum: u64,
    text_len: u32,
    camera_medium: u32,
    background: Background,
    _pad: [u8; 24],
}

const _: () = assert!(size_of::<Fixed>() == 128);

/// What is read of a head that is as it should be.
pub(super) struct Header {
    pub(super) background: Background,
    pub(super) camera_medium: u32,
    pub(super) arena_checksum: u64,
    pub(super) lens: Lens,
    /// The description as a scene file.
    pub(super) text: String,
}

/// Bytes before the text.
const TEXT_START: usize = size_of::<Fixed>() + size_of::<Lens>();

/// Where the arena starts behind a text of this length.
fn arena_start(text_len: usize) -> usize {
    (TEXT_START + text_len).next_multiple_of(PAGE)
}

/// A number that is another one if records look different: made of the list of arrays and of the version
/// of zrak, since a field may change its meaning and not its size.
fn fingerprint() -> u64 {
    let mut text = format!("{}\n", env!("CARGO_PKG_VERSION"));
    for array in ARRAY_TYPES {
        let record: String = array.record.split_whitespace().collect();
        text += &format!("{} {record} {} {}\n", array.name, array.size, array.alignment);
    }
    hash(text.as_bytes())
}

fn version() -> [u8; 24] {
    let mut version = [0; 24];
    let text = env!("CARGO_PKG_VERSION").as_bytes();
    let n = text.len().min(version.len());
    version[..n].copy_from_slice(&text[..n]);
    version
}

/// Checksum of a head.
fn checksum(head: &[u8]) -> u64 {
    let at = std::mem::offset_of!(Fixed, checksum);
    let mut head = head.to_vec();
    head[at..at + size_of::<u64>()].fill(0);
    hash(&head)
}

impl Header {
    /// The least that a file has.
    pub(super) const SIZE: usize = size_of::<Fixed>();

    /// The head of the file of a scene.
    pub(super) fn bytes(desc: &SceneDesc, arena: &SceneArena) -> Vec<u8> {
        let text = write_string(desc);
        let lens: Lens = spans_in_order(arena.spans()).map(|span| span.len);
        let Globals { background, camera_medium, .. } = *arena.globals();
        let start = arena_start(text.len());
        let mut fixed = Fixed {
            magic: MAGIC,
            byte_order: BYTE_ORDER,
            format: FORMAT,
            version: version(),
            layout: fingerprint(),
            file_size: (start + arena.bytes().len()) as u64,
            checksum: 0,
            arena_checksum: checksum::of_arena(&lens, arena.bytes()),
            text_len: text.len() as u32,
            camera_medium,
            background,
            _pad: [0; 24],
        };
        let mut head = bytemuck::bytes_of(&fixed).to_vec();
        head.extend_from_slice(bytemuck::cast_slice(&lens));
        head.extend_from_slice(text.as_bytes());
        head.resize(start, 0);
        fixed.checksum = checksum(&head);
        head[..size_of::<Fixed>()].copy_from_slice(bytemuck::bytes_of(&fixed));
        head
    }

    /// Reads the head of a file and checks it, except for what the text says. Gives also where the arena
    /// starts.
    pub(super) fn read(bytes: &[u8], origin: &str) -> Result<(Self, usize), SceneError> {
        let other = |message: &str, help: &str| {
            SceneError::file(SceneErrorKind::UnsupportedFormat, origin, message.into(), Some(help))
        };
        let again = "compile the scene again with `zrak compile`";
        if !bytes.starts_with(&MAGIC) {
            let help = "`zrak compile SCENE -o FILE.zscene` makes one of a scene";
            return Err(other("this is not a compiled scene", help));
        }
        let Some(fixed) = bytes.get(..size_of::<Fixed>()) else {
            return Err(damaged(origin, "it ends in the middle"));
        };
        // Copied first, since these are bytes that others may change.
        let fixed: Fixed = bytemuck::pod_read_unaligned(fixed);
        if fixed.byte_order == BYTE_ORDER.swap_bytes() {
            let message = "it was compiled on a machine with the other order of bytes";
            return Err(other(message, again));
        }
        if fixed.byte_order != BYTE_ORDER {
            return Err(damaged(origin, "its bytes are not the ones that were written"));
        }
        if fixed.format != FORMAT || fixed.layout != fingerprint() {
            let version = String::from_utf8_lossy(&fixed.version);
            let message = format!(
                "it was compiled by zrak {}, whose scenes in memory are not those of this zrak {}",
                version.trim_end_matches('\0'),
                env!("CARGO_PKG_VERSION"),
            );
            return Err(other(&message, again));
        }
        if fixed.file_size != bytes.len() as u64 {
            let (is, should_be) = (bytes.len(), fixed.file_size);
            return Err(damaged(origin, &format!("it has {is} bytes and should have {should_be}")));
        }
        let start = arena_start(fixed.text_len.min(TEXT_MAX) as usize);
        let Some(head) = bytes.get(..start).map(<[u8]>::to_vec) else {
            return Err(damaged(origin, "it ends in the middle"));
        };
        if checksum(&head) != fixed.checksum || fixed.text_len > TEXT_MAX {
            return Err(damaged(origin, "its head is not the one that was written"));
        }
        let lens: Lens = bytemuck::pod_read_unaligned(&head[size_of::<Fixed>()..TEXT_START]);
        if layout(&lens).is_none_or(|(_, size)| size != bytes.len() - start) {
            return Err(damaged(origin, "its arrays are not as long as it says"));
        }
        let text = head[TEXT_START..TEXT_START + fixed.text_len as usize].to_vec();
        let text = String::from_utf8(text).map_err(|_| damaged(origin, "its text is none"))?;
        let Fixed { background, camera_medium, arena_checksum, .. } = fixed;
        Ok((Self { background, camera_medium, arena_checksum, lens, text }, start))
    }
}

/// Makes bytes a file of this zrak whose checksums are right, as somebody would who wants a damaged one to
/// be read: for tests and fuzzers.
#[doc(hidden)]
pub fn sign(file: &mut [u8]) {
    if file.len() < TEXT_START {
        return;
    }
    let mut fixed: Fixed = bytemuck::pod_read_unaligned(&file[..size_of::<Fixed>()]);
    let lens: Lens = bytemuck::pod_read_unaligned(&file[size_of::<Fixed>()..TEXT_START]);
    let start = arena_start(fixed.text_len.min(TEXT_MAX) as usize).min(file.len());
    (fixed.magic, fixed.byte_order, fixed.format) = (MAGIC, BYTE_ORDER, FORMAT);
    (fixed.layout, fixed.file_size) = (fingerprint(), file.len() as u64);
    fixed.arena_checksum = checksum::of_arena(&lens, &file[start..]);
    file[..size_of::<Fixed>()].copy_from_slice(bytemuck::bytes_of(&fixed));
    fixed.checksum = checksum(&file[..start]);
    file[..size_of::<Fixed>()].copy_from_slice(bytemuck::bytes_of(&fixed));
}
