//! What a kernel is told when it is launched.
//!
//! It goes by value into the kernel's constant bank, where reading it costs no register.

use bytemuck::{Pod, Zeroable};

use crate::scene::{Globals, Spans};

/// Parameters of the kernels that render a region of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RenderParams {
    /// What there is one of in the scene.
    pub globals: Globals,
    /// Where the arrays lie in the arena.
    pub spans: Spans,
    /// First column of the region.
    pub x: u32,
    /// First row of the region.
    pub y: u32,
    /// Columns of the region.
    pub width: u32,
    /// Rows of the region.
    pub height: u32,
    /// Index of the first sample.
    pub first_sample: u32,
    /// Number of samples of each pixel.
    pub n_samples: u32,
}
