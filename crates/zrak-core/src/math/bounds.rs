//! Axis-aligned boxes and the slab test that every hit must pass.
//!
//! The test is monotone: with the same ray, a box that contains another passes whenever the other
//! does, and its interval contains the other's, in floating point as well as in the reals, because
//! subtraction, multiplication by the same factor, minimum and maximum are monotone under rounding.
//! So a tree whose boxes are unions of the boxes of its primitives never loses a hit, whatever its
//! shape; no tolerance is needed, and brute force and every tree agree to the last bit.

use super::scalar::{gamma, max, min};
use super::vec3::Vec3;

/// Axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub lo: Vec3,
    /// Largest coordinates.
    pub hi: Vec3,
}

/// Factor on the far end of a slab interval that makes up for its rounding: three operations.
pub const SLAB_SLACK: f32 = 1.0 + 2.0 * gamma(3);

/// Interval of a ray, in units of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Where the ray enters, at least 0.
    pub t_enter: f32,
    /// Where it leaves.
    pub t_leave: f32,
}

impl Bounds {
    /// Contains nothing; the union with it is the other box. Not to be tested against rays.
    pub const EMPTY: Self =
        Self { lo: Vec3::splat(f32::INFINITY), hi: Vec3::splat(f32::NEG_INFINITY) };

    /// The smallest box that holds both points.
    #[must_use]
    pub fn of_points(a: Vec3, b: Vec3) -> Self {
        Self { lo: a.zip(b, min), hi: a.zip(b, max) }
    }

    /// The smallest box that holds both boxes.
    #[must_use]
    pub fn union(self, o: Self) -> Self {
        Self { lo: self.lo.zip(o.lo, min), hi: self.hi.zip(o.hi, max) }
    }

    /// Centre.
    #[must_use]
    pub fn center(self) -> Vec3 {
        (self.lo + self.hi) * 0.5
    }

    /// Half of the surface area: what a ray's chance to meet the box is proportional to.
    #[must_use]
    pub fn half_area(self) -> f32 {
        let d = self.hi - self.lo;
        if d.x < 0.0 { 0.0 } else { d.x * d.y + d.y * d.z + d.z * d.x }
    }

    /// Enlarged by `margin` and by eight units in the last place of its largest coordinate, so that
    /// rounding in the shapes cannot shave off what they contain, and flat boxes have a volume.
    #[must_use]
    pub fn padded(self, margin: f32) -> Self {
        let largest = self.lo.abs().max_component().max(self.hi.abs().max_component());
        let pad = Vec3::splat(margin + largest * (8.0 * f32::EPSILON));
        Self { lo: self.lo - pad, hi: self.hi + pad }
    }

    /// The part of a ray that lies in the box and ahead of its origin, if there is one.
    /// `inv_d` holds [`super::reciprocal_or_huge`] of the direction's components.
    #[inline(always)]
    #[must_use]
    pub fn slab(&self, o: Vec3, inv_d: Vec3) -> Option<Slab> {
        let t0 = (self.lo - o) * inv_d;
        let t1 = (self.hi - o) * inv_d;
        let near = t0.zip(t1, min);
        let far = t0.zip(t1, max);
        let t_enter = max(max(near.x, near.y), max(near.z, 0.0));
        let t_leave = min(far.x, min(far.y, far.z)) * SLAB_SLACK;
        if t_enter <= t_leave { Some(Slab { t_enter, t_leave }) } else { None }
    }
}
