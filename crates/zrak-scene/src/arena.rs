//! The arena: one contiguous buffer with everything that a render reads.
//!
//! [`SceneArrays`] is filled by the lowering, [`SceneArena::pack`] lays it out, and backends render
//! from a [`SceneView`] of it; the GPU gets it in one copy. Every handle in it is checked when it is
//! packed, because the GPU does not.

mod check;
#[cfg(test)]
mod tests;

use bytemuck::{Pod, Zeroable};
use zrak_core::accessor::Array;
use zrak_core::for_each_scene_array;
use zrak_core::scene::{Globals, Kinds, SceneView, Span, Spans};

pub use check::Corrupt;

/// What the arena's start and its arrays are aligned to.
pub const ARENA_ALIGNMENT: usize = 256;
/// Unit of [`Span::offset`].
const OFFSET_UNIT: usize = 16;

/// Piece of an arena: gives the buffer its alignment.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, align(256))]
struct Chunk([u8; ARENA_ALIGNMENT]);

macro_rules! define_arrays {
    ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
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

            /// Number of records of each array, by name.
            fn lens(&self) -> Vec<(&'static str, usize)> {
                vec![$((stringify!($name), self.$name.len()),)*]
            }

            /// Where each array will lie, and the size of all of them in bytes.
            fn layout(&self) -> (Spans, usize) {
                let mut end = 0_usize;
                let spans = Spans {
                    $($name: {
                        let offset = end;
                        end += size_of_val(self.$name.as_slice());
                        end = end.next_multiple_of(ARENA_ALIGNMENT);
                        Span { offset: (offset / OFFSET_UNIT) as u32, len: self.$name.len() as u32 }
                    },)*
                };
                (spans, end)
            }

            /// Appends the arrays one after the other, and frees each when it is done: of large scenes
            /// there must not be two copies.
            fn move_into(self, chunks: &mut Vec<Chunk>) {
                $(
                    append(chunks, bytemuck::cast_slice(&self.$name));
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

/// Appends bytes, and zeros up to the next multiple of the alignment.
fn append(chunks: &mut Vec<Chunk>, bytes: &[u8]) {
    let (whole, rest) = bytes.as_chunks::<ARENA_ALIGNMENT>();
    chunks.extend(whole.iter().map(|bytes| Chunk(*bytes)));
    if !rest.is_empty() {
        let mut last = Chunk::zeroed();
        last.0[..rest.len()].copy_from_slice(rest);
        chunks.push(last);
    }
}

/// A scene ready to render.
#[derive(Clone)]
pub struct SceneArena {
    globals: Globals,
    spans: Spans,
    chunks: Vec<Chunk>,
}

impl SceneArena {
    /// Lays out the arrays in one buffer and checks every handle in them.
    ///
    /// # Errors
    /// If a handle leads out of bounds, or the arrays are larger than an arena can be (64 GiB).
    pub fn pack(globals: Globals, arrays: SceneArrays) -> Result<Self, Corrupt> {
        if let Some((name, len)) = arrays.lens().into_iter().find(|l| u32::try_from(l.1).is_err()) {
            return Err(Corrupt::new(format!("{len} {name} are more than an array can hold")));
        }
        let (spans, size) = arrays.layout();
        if size > u32::MAX as usize * OFFSET_UNIT {
            return Err(Corrupt::new(format!("{size} bytes are more than an arena can hold")));
        }
        let mut chunks = Vec::with_capacity(size / ARENA_ALIGNMENT);
        arrays.move_into(&mut chunks);
        let arena = Self { globals, spans, chunks };
        check::check(&arena.view())?;
        Ok(arena)
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
        bytemuck::cast_slice(&self.chunks)
    }
}
