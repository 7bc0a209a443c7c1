//! The one place with `unsafe`: reading the arena, and the traversal stack.
//!
//! On the processor every access is bounds-checked. On the GPU it is not: there, [`Array`] relies on
//! the arena's handles having been checked by the host before the upload, which is part of the
//! contract of [`crate::scene::SceneView::from_raw`].

#![allow(unsafe_code)]

use core::marker::PhantomData;
use core::mem::MaybeUninit;

use bytemuck::{Pod, Zeroable};

/// Borrowed array of records.
pub struct Array<'a, T> {
    data: *const T,
    len: u32,
    lifetime: PhantomData<&'a [T]>,
}

// SAFETY: an `Array` is a shared slice; sharing it is as sound as sharing `&[T]`.
unsafe impl<T: Sync> Send for Array<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Sync> Sync for Array<'_, T> {}

impl<T> Clone for Array<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Array<'_, T> {}

impl<'a, T: Pod> Array<'a, T> {
    /// Array of the records of a slice.
    ///
    /// # Panics
    /// If there are more than 2^32 - 1 records.
    #[must_use]
    pub fn new(records: &'a [T]) -> Self {
        let Ok(len) = u32::try_from(records.len()) else { panic!("more than 2^32 - 1 records") };
        Self { data: records.as_ptr(), len, lifetime: PhantomData }
    }

    /// Array at `data`.
    ///
    /// # Safety
    /// `data` points to `len` records, aligned and valid for `'a`.
    #[inline(always)]
    #[must_use]
    pub const unsafe fn from_raw(data: *const T, len: u32) -> Self {
        Self { data, len, lifetime: PhantomData }
    }

    /// Number of records.
    #[inline(always)]
    #[must_use]
    pub const fn len(&self) -> u32 {
        self.len
    }

    /// Whether there is no record.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Record number `i`, read whole, so that the GPU loads it in pieces of 16 bytes.
    ///
    /// # Panics
    /// On the processor, if there is no such record.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, i: u32) -> T {
        #[cfg(not(target_arch = "nvptx64"))]
        assert!(i < self.len, "handle {i} out of bounds of {} records", self.len);
        // SAFETY: `i` is in bounds: just checked on the processor, and by the contract of
        // `SceneView::from_raw` on the GPU. `data` is aligned and valid by construction.
        unsafe { self.data.add(i as usize).read() }
    }
}

/// Memory for a [`Stack`]. It is not written before it is used: clearing it would cost the GPU a
/// loop over local memory for each ray.
pub struct StackMemory<T: Copy, const N: usize>([MaybeUninit<T>; N]);

impl<T: Copy, const N: usize> Default for StackMemory<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Copy, const N: usize> StackMemory<T, N> {
    /// Memory for `N` entries.
    #[inline(always)]
    #[must_use]
    pub const fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; N])
    }
}

/// Stack of at most `N` entries. It is apart from its memory so that its length stays in a
/// register.
pub struct Stack<'a, T: Copy, const N: usize> {
    entries: &'a mut [MaybeUninit<T>; N],
    len: u32,
}

impl<'a, T: Copy, const N: usize> Stack<'a, T, N> {
    /// Stack with no entry.
    #[inline(always)]
    #[must_use]
    pub const fn new(memory: &'a mut StackMemory<T, N>) -> Self {
        Self { entries: &mut memory.0, len: 0 }
    }

    /// Puts an entry on top. Builders bound the depth of their trees so that it fits; see
    /// [`crate::accel::MAX_DEPTH`].
    ///
    /// # Panics
    /// On the processor, if the stack is full.
    #[inline(always)]
    pub fn push(&mut self, entry: T) {
        #[cfg(not(target_arch = "nvptx64"))]
        assert!((self.len as usize) < N, "traversal stack overflow");
        // SAFETY: in bounds: just checked on the processor; on the GPU by the bound on the tree's
        // depth that the host checked.
        unsafe { self.entries.get_unchecked_mut(self.len as usize).write(entry) };
        self.len += 1;
    }

    /// Number of entries.
    #[inline(always)]
    #[must_use]
    pub const fn len(&self) -> u32 {
        self.len
    }

    /// Whether there is no entry.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Takes the entry on top.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        self.pop_above(0)
    }

    /// Takes the entry on top, if there are more than `base`.
    #[inline(always)]
    pub fn pop_above(&mut self, base: u32) -> Option<T> {
        if self.len <= base {
            return None;
        }
        self.len -= 1;
        // SAFETY: entries below `len` were written by `push`, and `len` was above `base`.
        Some(unsafe { self.entries.get_unchecked(self.len as usize).assume_init_read() })
    }
}

// SAFETY: `Node` is `repr(C)`, all its fields are Pod, and the assertions beside it show that it has no
// padding for the widths in use.
unsafe impl<const N: usize> Zeroable for crate::accel::Node<N> {}
// SAFETY: as above; `Copy` and `'static` by its definition.
unsafe impl<const N: usize> Pod for crate::accel::Node<N> {}

impl<'a> crate::scene::SceneView<'a> {
    /// View of an arena at `base` whose arrays lie where `spans` says, and in which only `kinds` occur.
    ///
    /// # Safety
    /// `base` is 256-byte aligned and valid for reads over all `spans` for `'a`; the spans are those of
    /// a checked arena: every handle, link and texel offset in it is in bounds, and its trees are no
    /// deeper than [`crate::accel::MAX_DEPTH`].
    #[inline(always)]
    #[must_use]
    pub unsafe fn from_raw(
        base: *const u8,
        globals: crate::scene::Globals,
        kinds: crate::scene::Kinds,
        spans: &crate::scene::Spans,
    ) -> Self {
        macro_rules! view {
            ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
                Self {
                    globals,
                    kinds,
                    $($name: {
                        let span = spans.$name;
                        // SAFETY: by this function's contract.
                        unsafe {
                            Array::from_raw(
                                base.add(span.offset as usize * 16).cast::<$record>(),
                                span.len,
                            )
                        }
                    },)*
                }
            };
        }
        crate::for_each_scene_array!(view)
    }
}
