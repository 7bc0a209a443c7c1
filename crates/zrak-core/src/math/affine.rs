//! Affine maps of space, and the rounding errors of applying them.

use bytemuck::{Pod, Zeroable};

use super::scalar::gamma;
use super::vec3::{Vec3, vec3};

/// Affine map p' = L p + t, stored as the rows of the 3x4 matrix (L | t).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Affine {
    /// Rows of (L | t).
    pub rows: [[f32; 4]; 3],
}

const _: () = assert!(size_of::<Affine>() == 48);

impl Affine {
    /// The map that leaves every point where it is.
    pub const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// Image of a point.
    #[inline(always)]
    #[must_use]
    pub fn point(&self, p: Vec3) -> Vec3 {
        let row = |r: [f32; 4]| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
        vec3(row(self.rows[0]), row(self.rows[1]), row(self.rows[2]))
    }

    /// Image of a direction: L v.
    #[inline(always)]
    #[must_use]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let row = |r: [f32; 4]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
        vec3(row(self.rows[0]), row(self.rows[1]), row(self.rows[2]))
    }

    /// Transposed linear part applied to a direction: maps normals when `self` is the inverse of
    /// the map of the points. The result is not normalised.
    #[inline(always)]
    #[must_use]
    pub fn transposed_vector(&self, n: Vec3) -> Vec3 {
        let [a, b, c] = self.rows;
        vec3(
            a[0] * n.x + b[0] * n.y + c[0] * n.z,
            a[1] * n.x + b[1] * n.y + c[1] * n.z,
            a[2] * n.x + b[2] * n.y + c[2] * n.z,
        )
    }

    /// |L| |v|: bound of the image of a box of errors with half-widths `v`.
    #[inline(always)]
    #[must_use]
    pub fn abs_vector(&self, v: Vec3) -> Vec3 {
        let v = v.abs();
        let row = |r: [f32; 4]| r[0].abs() * v.x + r[1].abs() * v.y + r[2].abs() * v.z;
        vec3(row(self.rows[0]), row(self.rows[1]), row(self.rows[2]))
    }

    /// Bound of the rounding error of [`Affine::point`] for an exact `p`.
    #[inline(always)]
    #[must_use]
    pub fn point_rounding(&self, p: Vec3) -> Vec3 {
        let t = vec3(self.rows[0][3].abs(), self.rows[1][3].abs(), self.rows[2][3].abs());
        // Four products and sums in a row, and the rounding of the matrix itself.
        (self.abs_vector(p) + t) * gamma(5)
    }
}
