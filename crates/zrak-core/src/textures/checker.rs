//! Alternating cubes in world space.

use bytemuck::{Pod, Zeroable};

use super::ColorInput;
use crate::math::{Vec3, floor};

/// Checker pattern of two inputs.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Checker {
    /// Input where the sum of the cube's indices is even.
    pub even: ColorInput,
    /// Input where it is odd.
    pub odd: ColorInput,
    /// Cubes per world unit.
    pub inv_scale: f32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Checker>() == 48);

impl Checker {
    /// The input that counts at `p`.
    #[inline(always)]
    #[must_use]
    pub fn pick(&self, p: Vec3) -> ColorInput {
        let index = |x: f32| floor(x * self.inv_scale);
        let sum = index(p.x).wrapping_add(index(p.y)).wrapping_add(index(p.z));
        if sum & 1 == 0 { self.even } else { self.odd }
    }
}
