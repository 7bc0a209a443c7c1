//! Backgrounds that are pictures of all directions.

use zrak_core::lights::{ENVIRONMENT_EQUAL_AREA, ENVIRONMENT_EQUIRECT, Environment};
use zrak_core::math::{Color, Vec3};
use zrak_core::textures::{
    CHANNEL_COLOR, FILTER_BILINEAR, FILTER_NEAREST, ImageMap, ImageTexture, NO_MAPPING,
    TEXELS_LINEAR, WRAP_CLAMP, WRAP_REPEAT,
};

use super::sky::{self, Sky};
use super::textures::Textures;
use super::{Transform, lights};
use crate::arena::SceneArrays;
use crate::desc::{BackgroundDesc, EnvironmentMapping, LightDesc, Triple};

/// Adds the environment of a background that has one.
pub(super) fn lower<'a>(
    desc: &'a BackgroundDesc,
    textures: &mut Textures<'a>,
    arrays: &mut SceneArrays,
) {
    match desc {
        BackgroundDesc::Constant { .. } | BackgroundDesc::Gradient { .. } => {}
        BackgroundDesc::Image { path, mapping, strength, tint, transform } => {
            let (mapping, filter, wrap_u) = match mapping {
                EnvironmentMapping::Equirect => {
                    (ENVIRONMENT_EQUIRECT, FILTER_BILINEAR, WRAP_REPEAT)
                }
                // Its neighbours beyond the rim are elsewhere on the rim; pbrt does not blend, either.
                EnvironmentMapping::EqualArea => {
                    (ENVIRONMENT_EQUAL_AREA, FILTER_NEAREST, WRAP_CLAMP)
                }
            };
            let image = textures.environment(arrays, path, filter, wrap_u);
            // Rows of the way back are the directions of the picture's axes: those of the turn's columns.
            let turn = Transform::of_steps(transform);
            let axes = [0, 1, 2].map(|j| {
                let mut axis = [0.0; 3];
                axis[j] = 1.0;
                turn.vector(axis)
            });
            arrays.environments.push(Environment {
                rows: orthonormal(axes).map(|v| Vec3::from_array(v.map(|x| x as f32))),
                mapping,
                image,
                _pad: 0,
                tint: Color::from_array(tint.map(|x| (x * strength) as f32)),
                _pad2: 0,
            });
        }
        BackgroundDesc::Sky { sun_direction, up, turbidity, ground_albedo, sun, strength } => {
            let up = unit(*up);
            let to_sun = unit(*sun_direction);
            let cos_zenith = dot(up, to_sun).clamp(-1.0, 1.0);
            let sky = Sky::new(cos_zenith, *turbidity, *ground_albedo);
            let first_word = arrays.texels.len() as u32;
            arrays.texels.extend(sky.pixels.iter().flatten().map(|x| x.to_bits()));
            arrays.image_maps.push(ImageMap {
                raster: ImageTexture {
                    first_word,
                    width: sky::WIDTH as u32,
                    height: sky::HEIGHT as u32,
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
            // The sun is above -z of the picture.
            let horizontal = sub(to_sun, scale(up, cos_zenith));
            let behind = if dot(horizontal, horizontal) > 1e-12 {
                scale(unit(horizontal), -1.0)
            } else {
                any_perpendicular(up)
            };
            let right = cross(up, behind);
            arrays.environments.push(Environment {
                rows: [right, up, behind].map(|v| Vec3::from_array(v.map(|x| x as f32))),
                mapping: ENVIRONMENT_EQUIRECT,
                image: arrays.image_maps.len() as u32 - 1,
                _pad: 0,
                tint: Color::grey(*strength as f32),
                _pad2: 0,
            });
            if *sun && sky.sun.iter().any(|x| *x > 0.0) {
                arrays.lights.push(lights::light(&LightDesc::Distant {
                    direction: scale(to_sun, -1.0),
                    irradiance: sky.sun.map(|x| x * strength),
                }));
            }
        }
    }
}

/// Unit vectors as near to these as Gram and Schmidt's method gets; handedness is kept.
fn orthonormal([x, y, z]: [Triple; 3]) -> [Triple; 3] {
    let x = unit(x);
    let y = unit(sub(y, scale(x, dot(x, y))));
    let side = cross(x, y);
    [x, y, if dot(side, z) < 0.0 { scale(side, -1.0) } else { side }]
}

fn any_perpendicular(v: Triple) -> Triple {
    let other = if v[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    unit(cross(v, other))
}

fn unit(v: Triple) -> Triple {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let v = v.map(|x| x / largest);
    scale(v, 1.0 / dot(v, v).sqrt())
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn sub(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scale(v: Triple, s: f64) -> Triple {
    v.map(|x| x * s)
}
