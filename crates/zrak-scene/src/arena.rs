//! The arena: one contiguous buffer with everything that a render reads.
//!
//! [`SceneArrays`] is filled by the lowering, [`SceneArena::pack`] lays it out, and backends render
//! from a [`SceneView`] of it; the GPU gets it in one copy. Every handle in it is checked when it is
//! packed, because the GPU does not.

mod check;
pub mod stats;
mod storage;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use zrak_core::accessor::Array;
use zrak_core::for_each_scene_array;
use zrak_core::scene::{Globals, Kinds, SceneView, Span, Spans};

pub use check::Corrupt;
pub(crate) use storage::{Storage, map};

/// What the arena's start and its arrays are aligned to.
pub const ARENA_ALIGNMENT: usize = 256;
/// Unit of [`Span::offset`].
const OFFSET_UNIT: usize = 16;

/// Bytes of an array that are checked, and hashed, at a time: they stay in a processor's cache, and they
/// are a whole number of nodes and of triangles.
pub(crate) const PIECE_SIZE: usize = 256 << 10;

/// What the list of arrays says of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArrayType {
    pub(crate) name: &'static str,
    /// Name of the type of its records.
    pub(crate) record: &'static str,
    /// Bytes of a record.
    pub(crate) size: usize,
    /// What a record is aligned to.
    pub(crate) alignment: usize,
}

/// Up to [`PIECE_SIZE`] bytes of an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) array: ArrayName,
    /// Its number among those of the array.
    pub(crate) index: usize,
}

macro_rules! define_arrays {
    ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
        /// The arrays, in the order of the list.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum ArrayName {
            $($name,)*
        }

        /// The list of arrays as data.
        pub(crate) const ARRAY_TYPES: &[ArrayType] = &[
            $(ArrayType {
                name: stringify!($name),
                record: stringify!($record),
                size: size_of::<$record>(),
                alignment: align_of::<$record>(),
            },)*
        ];

        const ARRAY_NAMES: [ArrayName; ARRAY_TYPES.len()] = [$(ArrayName::$name,)*];

        /// Numbers of records, in the order of the list.
        pub(crate) type Lens = [u32; ARRAY_TYPES.len()];

        /// The spans in the order of the list.
        pub(crate) const fn spans_in_order(spans: &Spans) -> [Span; ARRAY_TYPES.len()] {
            [$(spans.$name,)*]
        }

        /// Where arrays with these numbers of records lie, and the size of all of them in bytes; `None`
        /// if that is more than an arena can hold.
        pub(crate) fn layout(lens: &Lens) -> Option<(Spans, usize)> {
            let mut end = 0_u64;
            let mut lens = lens.iter();
            let mut next = |size: usize| {
                let offset = end;
                let len = *lens.next()?;
                // Sums of 2^32 records of a kind stay far below 2^64.
                end = (end + u64::from(len) * size as u64).next_multiple_of(ARENA_ALIGNMENT as u64);
                let offset = u32::try_from(offset / OFFSET_UNIT as u64).ok()?;
                Some(Span { offset, len })
            };
            let spans = Spans { $($name: next(size_of::<$record>())?,)* };
            let fits = end <= u64::from(u32::MAX) * OFFSET_UNIT as u64;
            Some((spans, usize::try_from(end).ok().filter(|_| fits)?))
        }

        /// The arrays of a scene while it is being built.
        #[derive(Clone, Debug, Default)]
        pub struct SceneArrays {
            $($(#[$doc])* pub $name: Vec<$record>,)*
        }

        impl SceneArrays {
            /// The scene as it stands.
            #[must_use]
            pub fn view(&self, globals: Globals) -> SceneView<'_> {
                SceneView { globals, kinds: Kinds::ALL, $($name: Array::new(&self.$name),)* }
            }

            /// Bytes of all records.
            #[must_use]
            pub fn n_bytes(&self) -> usize {
                0 $(+ size_of_val(self.$name.as_slice()))*
            }

            /// Number of records of each array, by name.
            fn lens(&self) -> Vec<(&'static str, usize)> {
                vec![$((stringify!($name), self.$name.len()),)*]
            }

            /// Appends the arrays one after the other, and frees each when it is done: of large scenes
            /// there must not be two copies.
            fn move_into(self, chunks: &mut Vec<storage::Chunk>) {
                $(
                    storage::append(chunks, bytemuck::cast_slice(&self.$name));
                    drop(self.$name);
                )*
            }
        }

        impl SceneArena {
            /// The scene, borrowed.
            #[must_use]
            pub fn view(&self) -> SceneView<'_> {
                let bytes = self.bytes();
                SceneView {
                    globals: self.globals,
                    kinds: Kinds::ALL,
                    $($name: {
                        let span = self.spans.$name;
                        let start = span.offset as usize * OFFSET_UNIT;
                        let size = span.len as usize * size_of::<$record>();
                        let records: &[$record] = bytemuck::cast_slice(&bytes[start..start + size]);
                        Array::new(records)
                    },)*
                }
            }

            /// Bytes of each array, by name.
            #[must_use]
            pub fn sizes(&self) -> Vec<(&'static str, usize)> {
                vec![$((
                    stringify!($name),
                    self.spans.$name.len as usize * size_of::<$record>(),
                ),)*]
            }
        }
    };
}

for_each_scene_array!(define_arrays);

/// The pieces of arrays with these numbers of records, array by array.
pub(crate) fn pieces(lens: &Lens) -> Vec<Piece> {
    let of_array = |((&array, kind), &len): ((&ArrayName, &ArrayType), &u32)| {
        let n_pieces = (len as usize * kind.size).div_ceil(PIECE_SIZE);
        (0..n_pieces).map(move |index| Piece { array, index })
    };
    ARRAY_NAMES.iter().zip(ARRAY_TYPES).zip(lens).flat_map(of_array).collect()
}

/// A scene ready to render. A copy shares the arrays.
#[derive(Clone)]
pub struct SceneArena {
    globals: Globals,
    spans: Spans,
    storage: Storage,
}

impl SceneArena {
    /// Lays out the arrays in one buffer and checks every handle in them.
    ///
    /// # Errors
    /// If a handle leads out of bounds, or the arrays are larger than an arena can be (64 GiB).
    pub fn pack(globals: Globals, arrays: SceneArrays) -> Result<Self, Corrupt> {
        let mut lens: Lens = [0; ARRAY_TYPES.len()];
        for (len, (name, n)) in lens.iter_mut().zip(arrays.lens()) {
            *len = u32::try_from(n)
                .map_err(|_| Corrupt::new(format!("{n} {name} are more than an array can hold")))?;
        }
        let Some((spans, size)) = layout(&lens) else {
            return Err(Corrupt::new("the arrays are more than an arena can hold: 64 GiB"));
        };
        let mut chunks = Vec::with_capacity(size / ARENA_ALIGNMENT);
        arrays.move_into(&mut chunks);
        let arena = Self { globals, spans, storage: Storage::Owned(Arc::new(chunks)) };
        check::check(&arena.view(), &pieces(&lens), &|_| ())?;
        Ok(arena)
    }

    /// Arena of arrays with these numbers of records that are already laid out; `at_piece` is called
    /// with the bytes of every piece on the way, from several threads, unless there is an error.
    ///
    /// # Errors
    /// If a handle leads out of bounds, or the bytes are not as many as the arrays have.
    pub(crate) fn from_storage(
        globals: Globals,
        lens: &Lens,
        storage: Storage,
        at_piece: &(dyn Fn(usize, &[u8]) + Sync),
    ) -> Result<Self, Corrupt> {
        let Some((spans, size)) = layout(lens).filter(|(_, size)| *size == storage.bytes().len())
        else {
            return Err(Corrupt::new("its arrays are not as long as it says"));
        };
        let arena = Self { globals, spans, storage };
        let pieces = pieces(lens);
        let bytes = arena.bytes();
        debug_assert_eq!(bytes.len(), size);
        check::check(&arena.view(), &pieces, &|i| {
            at_piece(i, &bytes[piece_range(&spans, pieces[i])]);
        })?;
        Ok(arena)
    }

    /// The same scene with another camera, depth and seed; the background and what the camera is in
    /// stay the same.
    #[must_use]
    pub(crate) fn with_globals(&self, globals: Globals) -> Self {
        let Globals { background, camera_medium, .. } = self.globals;
        Self { globals: Globals { background, camera_medium, ..globals }, ..self.clone() }
    }

    /// What there is one of in the scene.
    #[must_use]
    pub const fn globals(&self) -> &Globals {
        &self.globals
    }

    /// Where the arrays lie.
    #[must_use]
    pub const fn spans(&self) -> &Spans {
        &self.spans
    }

    /// The whole buffer, aligned to [`ARENA_ALIGNMENT`].
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.storage.bytes()
    }

    /// Whether the arrays lie in a file that is mapped into memory.
    #[must_use]
    pub const fn is_mapped(&self) -> bool {
        matches!(self.storage, Storage::Mapped { .. })
    }
}

/// Where a piece lies in the arena, with what is unused behind the last record.
pub(crate) fn piece_range(spans: &Spans, piece: Piece) -> std::ops::Range<usize> {
    let i = piece.array as usize;
    let span = spans_in_order(spans)[i];
    let start = span.offset as usize * OFFSET_UNIT;
    let size = (span.len as usize * ARRAY_TYPES[i].size).next_multiple_of(ARENA_ALIGNMENT);
    let at = |n: usize| start + (n * PIECE_SIZE).min(size);
    at(piece.index)..at(piece.index + 1)
}
