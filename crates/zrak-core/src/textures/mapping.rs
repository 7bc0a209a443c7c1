//! Where in (u, v) a point of a surface falls.

use bytemuck::{Pod, Zeroable};

use super::TextureContext;
use crate::math::{Affine, atan2, max, sqrt, vec3};

/// The rows of the map applied to the surface's own (u, v, 0).
pub const MAPPING_UV: u32 = 0;
/// The first two rows of the map applied to the point in world space.
pub const MAPPING_PLANAR: u32 = 1;
/// Of the point under the map: u = angle about z over a turn, v = angle from +z over half a turn.
pub const MAPPING_SPHERICAL: u32 = 2;
/// Of the point under the map: u = angle about z over a turn, v = z.
pub const MAPPING_CYLINDRICAL: u32 = 3;

/// A mapping of surfaces to (u, v).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TextureMapping {
    /// The map.
    pub map: Affine,
    /// [`MAPPING_UV`], [`MAPPING_PLANAR`], [`MAPPING_SPHERICAL`] or [`MAPPING_CYLINDRICAL`].
    pub kind: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<TextureMapping>() == 64);

impl TextureMapping {
    /// Texture coordinates, and how much they change over the ray's footprint.
    #[inline(always)]
    #[must_use]
    pub fn uv(&self, at: &TextureContext) -> ([f32; 2], [f32; 2]) {
        const PER_TURN: f32 = 0.5 * core::f32::consts::FRAC_1_PI;
        let [row_u, row_v, row_z] = self.map.rows;
        if self.kind == MAPPING_UV {
            let p = self.map.point(vec3(at.uv[0], at.uv[1], 0.0));
            let change = |row: [f32; 4]| row[0].abs() * at.duv[0] + row[1].abs() * at.duv[1];
            return ([p.x, p.y], [change(row_u), change(row_v)]);
        }
        let length = |row: [f32; 4]| vec3(row[0], row[1], row[2]).length();
        let p = self.map.point(at.p);
        if self.kind == MAPPING_PLANAR {
            let change = [length(row_u) * at.footprint, length(row_v) * at.footprint];
            return ([p.x, p.y], change);
        }
        let turns = atan2(p.y, p.x) * PER_TURN;
        let u = if turns < 0.0 { turns + 1.0 } else { turns };
        let from_axis = sqrt(p.x * p.x + p.y * p.y);
        let width = length(row_z) * at.footprint;
        let du = width * PER_TURN / max(from_axis, 1e-20);
        if self.kind == MAPPING_SPHERICAL {
            let half_turns = atan2(from_axis, p.z) * core::f32::consts::FRAC_1_PI;
            let dv = width * core::f32::consts::FRAC_1_PI / max(p.length(), 1e-20);
            ([u, half_turns], [du, dv])
        } else {
            ([u, p.z], [du, width])
        }
    }
}
