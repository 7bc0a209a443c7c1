//! The committed kernels, and which of them a scene needs.
//!
//! To add a kernel: write its entry point in crate `zrak-kernels`, run `cargo xtask kernels`, and
//! name it here.

use zrak_core::scene::Kinds;

/// PTX of crate `zrak-kernels`, made by `cargo xtask kernels`; the driver compiles it for the card.
pub(crate) const PTX: &str = include_str!("../ptx/zrak_kernels.ptx");

/// Oldest compute capability that the kernels run on: Turing, the oldest that today's drivers take.
pub(crate) const MIN_COMPUTE_CAPABILITY: (i32, i32) = (7, 5);

/// A kernel that renders: (arena, film, [`zrak_core::launch::RenderParams`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RenderKernel {
    pub(crate) name: &'static str,
    /// What it has the code of.
    kinds: Kinds,
    /// Registers that a thread may use. More mean fewer threads at a time to hide the latency of
    /// memory, fewer mean spills; measured, see docs/benchmarks.
    pub(crate) max_registers: u32,
}

/// From the most special to the one that renders everything.
const RENDER_KERNELS: [RenderKernel; 4] = [
    RenderKernel {
        name: "render_naive_plain_spheres",
        kinds: Kinds::PLAIN_SPHERES,
        max_registers: 80,
    },
    RenderKernel {
        name: "render_naive_books_in_world_space",
        kinds: Kinds::BOOKS_IN_WORLD_SPACE,
        max_registers: 80,
    },
    RenderKernel { name: "render_naive_books", kinds: Kinds::BOOKS, max_registers: 80 },
    RenderKernel { name: "render_naive", kinds: Kinds::ALL, max_registers: 128 },
];

/// The most special kernel that has the code of all these kinds.
pub(crate) fn render_kernel(kinds: &Kinds) -> RenderKernel {
    let [special @ .., all] = RENDER_KERNELS;
    special.into_iter().find(|kernel| kernel.kinds.include(kinds)).unwrap_or(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_is_in_the_ptx() {
        for kernel in RENDER_KERNELS {
            assert!(PTX.contains(&format!(".visible .entry {}(", kernel.name)), "{}", kernel.name);
        }
    }

    #[test]
    fn kernels_are_chosen_by_what_they_can_do() {
        let spheres = render_kernel(&Kinds::PLAIN_SPHERES);
        assert_eq!(spheres.name, "render_naive_plain_spheres");
        assert_eq!(render_kernel(&Kinds::default()), spheres);
        assert_eq!(render_kernel(&Kinds::ALL).name, "render_naive");
        let with_images = Kinds { textures: 1 << 3 | 1, ..Kinds::PLAIN_SPHERES };
        assert_eq!(render_kernel(&with_images).name, "render_naive_books_in_world_space");
        assert_eq!(render_kernel(&Kinds::BOOKS).name, "render_naive_books");
    }
}
