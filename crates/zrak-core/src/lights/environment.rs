//! A picture of the whole sphere of directions, infinitely far away.

use bytemuck::{Pod, Zeroable};

use crate::math::{Color, Vec3, atan2, dot, equal_area_sphere_to_square, sqrt};
use crate::textures::TextureArrays;

/// Longitude along the width, latitude along the height: +y up in the first row, -z in the middle of the
/// picture, +x a quarter to its right.
pub const ENVIRONMENT_EQUIRECT: u32 = 0;
/// Clarberg's equal-area map, as [`crate::math::equal_area_square_to_sphere`]; x to the right, y down.
pub const ENVIRONMENT_EQUAL_AREA: u32 = 1;

/// A picture of what is infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Environment {
    /// Rows of the rotation (or mirroring) from the world to the picture's space.
    pub rows: [Vec3; 3],
    /// [`ENVIRONMENT_EQUIRECT`] or [`ENVIRONMENT_EQUAL_AREA`].
    pub mapping: u32,
    /// Index of the picture in the image maps.
    pub image: u32,
    /// Nothing.
    pub _pad: u32,
    /// Factor of the radiance.
    pub tint: Color,
    /// Nothing.
    pub _pad2: u32,
}

const _: () = assert!(size_of::<Environment>() == 64);

impl Environment {
    /// Texture coordinates, v upwards, of the unit direction `d`.
    #[inline(always)]
    #[must_use]
    pub fn uv(&self, d: Vec3) -> [f32; 2] {
        let [x, y, z] = self.rows.map(|row| dot(row, d));
        if self.mapping == ENVIRONMENT_EQUAL_AREA {
            let (u, v) = equal_area_sphere_to_square(Vec3 { x, y, z });
            return [u, 1.0 - v];
        }
        let u = 0.5 + atan2(x, -z) * (0.5 * core::f32::consts::FRAC_1_PI);
        let from_top = atan2(sqrt(x * x + z * z), y) * core::f32::consts::FRAC_1_PI;
        [u, 1.0 - from_top]
    }

    /// Radiance that comes from the unit direction `d`. A call, because the loop over the segments of paths
    /// has better use for registers.
    #[inline(never)]
    pub(crate) fn radiance(&self, arrays: &TextureArrays, d: Vec3) -> Color {
        arrays.image_maps.get(self.image).at_uv(arrays, self.uv(d)) * self.tint
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{equal_area_square_to_sphere, vec3};

    fn environment(rows: [Vec3; 3], mapping: u32) -> Environment {
        Environment { rows, mapping, image: 0, _pad: 0, tint: Color::WHITE, _pad2: 0 }
    }

    const AXES: [Vec3; 3] = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)];

    #[test]
    fn directions_fall_where_the_mappings_say() {
        let equirect = environment(AXES, ENVIRONMENT_EQUIRECT);
        for (d, uv) in [
            (vec3(0.0, 0.0, -1.0), [0.5, 0.5]),
            (vec3(1.0, 0.0, 0.0), [0.75, 0.5]),
            (vec3(-1.0, 0.0, 0.0), [0.25, 0.5]),
            (vec3(0.0, 1.0, 0.0), [0.5, 1.0]),
            (vec3(0.0, -1.0, 0.0), [0.5, 0.0]),
            (vec3(0.0, 0.6, -0.8), [0.5, 0.704_833]),
        ] {
            let got = equirect.uv(d);
            assert!((got[1] - uv[1]).abs() < 1e-6, "{d:?} {got:?}");
            assert!(d.y.abs() == 1.0 || (got[0] - uv[0]).abs() < 1e-6, "{d:?} {got:?}");
        }
        // Turned so that +x of the world is where the picture has -z.
        let turned = environment([AXES[2], AXES[1], -AXES[0]], ENVIRONMENT_EQUIRECT);
        assert_eq!(turned.uv(vec3(1.0, 0.0, 0.0)), [0.5, 0.5]);
        let equal_area = environment(AXES, ENVIRONMENT_EQUAL_AREA);
        for (x, y) in [(0.3, 0.6), (0.9, 0.2), (0.05, 0.9), (0.55, 0.5)] {
            let [u, v] = equal_area.uv(equal_area_square_to_sphere(x, y));
            assert!((u - x).abs() < 1e-4 && (1.0 - v - y).abs() < 1e-4, "{x} {y}: {u} {v}");
        }
    }
}
