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

    /// A picture whose texels say where they are, under any turn: bilinear look-ups of a smooth function of
    /// the direction give that function.
    #[test]
    fn a_turned_picture_shows_what_it_should() {
        use crate::testing::{Rng, TestScene, cross, dot, double, unit};
        use crate::textures::{
            CHANNEL_COLOR, FILTER_BILINEAR, ImageMap, ImageTexture, NO_MAPPING, TEXELS_LINEAR,
            WRAP_CLAMP, WRAP_REPEAT,
        };
        let (width, height) = (256_u32, 128_u32);
        let mut scene = TestScene::default();
        for y in 0..height {
            for x in 0..width {
                let phi = std::f64::consts::TAU * ((f64::from(x) + 0.5) / f64::from(width) - 0.5);
                let theta = std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(height);
                let d = [theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos()];
                scene.texels.extend(d.map(|x| (1.0 + x) as f32).map(f32::to_bits));
            }
        }
        scene.image_maps.push(ImageMap {
            raster: ImageTexture {
                first_word: 0,
                width,
                height,
                format: TEXELS_LINEAR,
                bilinear: 0,
                _pad: [0; 3],
            },
            n_levels: 1,
            filter: FILTER_BILINEAR,
            wrap_u: WRAP_REPEAT,
            wrap_v: WRAP_CLAMP,
            channel: CHANNEL_COLOR,
            mapping: NO_MAPPING,
            scale: 1.0,
            invert: 0,
        });
        let view = scene.view();
        let arrays = TextureArrays::of(&view);
        let mut rng = Rng::new(1);
        for case in 0..100 {
            let x = double(rng.direction());
            let y = unit(cross(x, double(rng.direction())));
            let z = cross(x, y).map(|c| if case % 2 == 0 { c } else { -c });
            let rows = [x, y, z].map(crate::testing::single);
            let tint = Color::new(0.5, 1.0, 2.0);
            let light = Environment { tint, ..environment(rows, ENVIRONMENT_EQUIRECT) };
            for _ in 0..500 {
                let d = rng.direction();
                let got = light.radiance(&arrays, d).to_array().map(f64::from);
                let exact = [x, y, z].map(|axis| 1.0 + dot(axis, double(d)));
                for (c, (got, exact)) in got.into_iter().zip(exact).enumerate() {
                    let exact = exact * [0.5, 1.0, 2.0][c];
                    // A texel is 1.4 degrees wide; beyond the outermost rows nothing changes any more.
                    assert!((got - exact).abs() < 0.03, "{d:?}, channel {c}: {got} {exact}");
                }
            }
        }
    }
}
