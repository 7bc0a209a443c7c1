//! The committed kernels.

/// PTX of crate `zrak-kernels`, made by `cargo xtask kernels`; the driver compiles it for the card.
pub(crate) const PTX: &str = include_str!("../ptx/zrak_kernels.ptx");

/// Renders with the naive estimator: (arena, film, [`zrak_core::launch::RenderParams`]).
pub(crate) const RENDER_NAIVE: &str = "render_naive";

/// Oldest compute capability that the kernels run on: Turing, the oldest that today's drivers take.
pub(crate) const MIN_COMPUTE_CAPABILITY: (i32, i32) = (7, 5);

/// Registers that a thread may use. More mean fewer threads at a time to hide the latency of memory,
/// fewer mean spills; measured in docs/benchmarks.
pub(crate) const MAX_REGISTERS: u32 = 96;
