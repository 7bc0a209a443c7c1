//! Entry points on the GPU: find out which pixel, check that it exists, call the core, store.
//!
//! Nothing here decides what a sample is; that is `zrak_core`, the same source as on the processor.

#![no_std]
#![feature(abi_ptx, stdarch_nvptx, core_intrinsics)]
#![allow(internal_features)]

use core::arch::nvptx::{
    _block_dim_x, _block_dim_y, _block_idx_x, _block_idx_y, _thread_idx_x, _thread_idx_y,
};

use zrak_core::accel::Bvh2;
use zrak_core::film::PixelSum;
use zrak_core::integrators::render_pixel;
use zrak_core::launch::RenderParams;
use zrak_core::scene::{Kinds, SceneView};

/// Defines a kernel that adds samples to the film with the naive estimator, one thread for each pixel
/// of the region, with the code of some kinds of things.
macro_rules! render_kernel {
    ($(#[$doc:meta])* $name:ident, $kinds:expr) => {
        $(#[$doc])*
        ///
        /// # Safety
        /// `arena` and `params` are those of a checked arena in device memory in which only the
        /// kernel's kinds occur; `film` points to the `params.width * params.height` pixels of the region.
        #[unsafe(no_mangle)]
        pub unsafe extern "ptx-kernel" fn $name(
            arena: *const u8,
            film: *mut PixelSum,
            params: RenderParams,
        ) {
            // SAFETY: this function's contract is that of the callee.
            unsafe { render(arena, film, params, $kinds) };
        }
    };
}

render_kernel! {
    /// Any scene.
    render_naive, Kinds::ALL
}

render_kernel! {
    /// Scenes such as the books'.
    render_naive_books, Kinds::BOOKS
}

render_kernel! {
    /// The same without instances.
    render_naive_books_in_world_space, Kinds::BOOKS_IN_WORLD_SPACE
}

render_kernel! {
    /// Scenes of plain spheres.
    render_naive_plain_spheres, Kinds::PLAIN_SPHERES
}

/// Finds out which pixel this thread has, renders it and stores it.
///
/// # Safety
/// That of the kernels above.
#[inline(always)]
unsafe fn render(arena: *const u8, film: *mut PixelSum, params: RenderParams, kinds: Kinds) {
    // SAFETY: these only read special registers.
    let (i, j) = unsafe {
        (
            _block_idx_x() as u32 * _block_dim_x() as u32 + _thread_idx_x() as u32,
            _block_idx_y() as u32 * _block_dim_y() as u32 + _thread_idx_y() as u32,
        )
    };
    if i >= params.width || j >= params.height {
        return;
    }
    // SAFETY: by this function's contract.
    let scene = unsafe { SceneView::from_raw(arena, params.globals, kinds, &params.spans) };
    let accel = Bvh2 { nodes: scene.nodes2 };
    let (x, y) = (params.x + i, params.y + j);
    let sum = render_pixel(&scene, accel, x, y, params.first_sample, params.n_samples);
    // SAFETY: the pixel is inside the region, and no other thread has it.
    unsafe { (*film.add((j * params.width + i) as usize)).merge(&sum) };
}

/// Required without `std`; the core cannot fail, so nothing ever calls it.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::intrinsics::abort()
}
