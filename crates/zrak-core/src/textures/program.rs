//! Textures made of textures: short programs over a few slots.
//!
//! The host turns a tree of textures into a list of operations, each of which leaves a colour in a slot.
//! Everything is evaluated, also what a checker then does not pick: a GPU's threads would wait for each
//! other anyway, and there is no recursion.
//!
//! # To add an operation
//! 1. Add its code and its arm in [`TextureOp::run`].
//! 2. On the host: `zrak-scene`, `lower/textures.rs` makes it, `arena/check.rs` checks what it refers to.

use bytemuck::{Pod, Zeroable};

use super::{Checker, ColorInput, NO_MAPPING, TextureArrays, TextureContext};
use crate::math::{Color, floor, pcg3d, unit_f32};
use crate::scene::TextureRef;

/// `color`.
pub const OP_SOLID: u32 = 0;
/// Colours of the mesh's vertices; index 0 for the colour, 1 to 4 for one of r, g, b, a.
pub const OP_VERTEX_COLOR: u32 = 1;
/// The noise of this index at the point.
pub const OP_NOISE: u32 = 2;
/// The fractal sum of this index at the point.
pub const OP_FRACTAL: u32 = 3;
/// The image map of this index.
pub const OP_IMAGE: u32 = 4;
/// One of a and b by cubes of side 1 / `value` around the point.
pub const OP_CHECKER: u32 = 5;
/// One of a and b by squares of side 1 in (u, v).
pub const OP_UV_CHECKER: u32 = 6;
/// a in dots in (u, v), b around them.
pub const OP_DOTS: u32 = 7;
/// (1 - t) a + t b, where t is the red channel of c.
pub const OP_MIX: u32 = 8;
/// a b.
pub const OP_MULTIPLY: u32 = 9;
/// a at u = 0, b at u = 1; linear in between and beyond.
pub const OP_LERP_U: u32 = 10;
/// a at v = 0, b at v = 1; linear in between and beyond.
pub const OP_LERP_V: u32 = 11;
/// One more than the last operation.
pub const N_OPS: u32 = 12;

/// Number of slots.
pub const N_SLOTS: usize = 8;

/// A list of operations; the texture is what is in slot 0 at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Program {
    /// Index of the first operation.
    pub first_op: u32,
    /// Number of operations.
    pub n_ops: u32,
}

/// An operation.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TextureOp {
    /// Which one.
    pub op: u32,
    /// Slots, four bits each from the lowest: where the result goes, a, b, c.
    pub slots: u32,
    /// Index of the record, for operations that have one.
    pub index: u32,
    /// Index of the mapping that gives the point (its map alone counts) or (u, v), or [`NO_MAPPING`] for
    /// world space and the surface's own coordinates.
    pub mapping: u32,
    /// A colour.
    pub color: Color,
    /// A number.
    pub value: f32,
}

const _: () = assert!(size_of::<TextureOp>() == 32);

impl Program {
    /// Colour at a point. Always a call: copies of it wherever a texture is looked up would make kernels
    /// that have no programs slow to compile, too.
    #[inline(never)]
    pub(super) fn evaluate(&self, arrays: &TextureArrays, at: &TextureContext) -> Color {
        let mut slots = [Color::BLACK; N_SLOTS];
        let mut i = 0;
        while i < self.n_ops {
            let op = arrays.texture_ops.get(self.first_op + i);
            let slot = |k: u32| (op.slots >> (4 * k)) as usize % N_SLOTS;
            slots[slot(0)] = op.run(arrays, at, slots[slot(1)], slots[slot(2)], slots[slot(3)]);
            i += 1;
        }
        slots[0]
    }
}

impl TextureOp {
    #[inline(always)]
    fn run(
        &self,
        arrays: &TextureArrays,
        at: &TextureContext,
        a: Color,
        b: Color,
        c: Color,
    ) -> Color {
        let mut p = at.p;
        let mut uv = at.uv;
        if self.mapping != NO_MAPPING {
            let mapping = arrays.mappings.get(self.mapping);
            p = mapping.map.point(at.p);
            uv = mapping.uv(at).0;
        }
        match self.op {
            OP_VERTEX_COLOR => match self.index {
                0 => at.color,
                1 => Color::grey(at.color.r),
                2 => Color::grey(at.color.g),
                3 => Color::grey(at.color.b),
                _ => Color::grey(at.alpha),
            },
            OP_NOISE => arrays.noises.get(self.index).evaluate(p),
            OP_FRACTAL => arrays.fractals.get(self.index).evaluate(p),
            OP_IMAGE => arrays.image_maps.get(self.index).evaluate(arrays, at),
            OP_CHECKER => {
                let input = |r| ColorInput { solid: r, texture: TextureRef::default() };
                let (even, odd) = (input(a), input(b));
                let checker = Checker { even, odd, inv_scale: self.value, _pad: [0; 3] };
                checker.pick(p).solid
            }
            OP_UV_CHECKER => {
                let sum = floor(uv[0]).wrapping_add(floor(uv[1]));
                if sum & 1 == 0 { a } else { b }
            }
            OP_DOTS => {
                if in_dot(uv) {
                    a
                } else {
                    b
                }
            }
            OP_MIX => Color::lerp(c.r, a, b),
            OP_MULTIPLY => a * b,
            OP_LERP_U => Color::lerp(uv[0], a, b),
            OP_LERP_V => Color::lerp(uv[1], a, b),
            _ => self.color,
        }
    }
}

/// Whether a point is in one of the dots: in half of the squares around the points with whole coordinates
/// there is one of radius 0.35, as far off the middle as it can be without leaving the square.
///
/// After *Physically Based Rendering*, 2nd edition, section 10.5.2, with a hash for its noise.
#[inline(always)]
fn in_dot(uv: [f32; 2]) -> bool {
    const RADIUS: f32 = 0.35;
    const MAX_SHIFT: f32 = 0.5 - RADIUS;
    let (cell_u, cell_v) = (floor(uv[0] + 0.5), floor(uv[1] + 0.5));
    let h = pcg3d([cell_u as u32, cell_v as u32, 0x646f_7473]);
    let shift = |bits: u32| MAX_SHIFT * (2.0 * unit_f32(bits) - 1.0);
    let du = uv[0] - (cell_u as f32 + shift(h[1]));
    let dv = uv[1] - (cell_v as f32 + shift(h[2]));
    h[0] & 0x8000_0000 == 0 && du * du + dv * dv < RADIUS * RADIUS
}
