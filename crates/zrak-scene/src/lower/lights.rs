//! Lights without a surface, and media that surfaces bound.

use zrak_core::lights::{
    FALLOFF_SMOOTHSTEP, FALLOFF_SQUARE, LIGHT_DISTANT, LIGHT_POINT, LIGHT_SPOT, Light,
};
use zrak_core::math::{Color, Vec3};
use zrak_core::media::HomogeneousMedium;

use crate::arena::SceneArrays;
use crate::desc::{LightDesc, SceneDesc, SpotFalloff, Triple};

/// Lowers all lights, and all media in the order of their names.
pub(super) fn lower(desc: &SceneDesc, arrays: &mut SceneArrays) {
    arrays.lights = desc.lights.iter().map(light).collect();
    arrays.homogeneous_media = desc
        .media
        .values()
        .map(|medium| HomogeneousMedium {
            sigma_a: color(medium.sigma_a),
            g: medium.g as f32,
            sigma_s: color(medium.sigma_s),
            _pad: 0,
        })
        .collect();
}

/// A light.
pub(super) fn light(desc: &LightDesc) -> Light {
    let none = Light {
        position: Vec3::ZERO,
        kind: LIGHT_POINT,
        direction: Vec3::from_array([0.0, 0.0, 1.0]),
        cos_start: 1.0,
        intensity: Color::BLACK,
        cos_rim: 1.0,
        falloff: FALLOFF_SMOOTHSTEP,
        _pad: [0; 3],
    };
    match *desc {
        LightDesc::Point { position, intensity } => {
            Light { position: single(position), intensity: color(intensity), ..none }
        }
        LightDesc::Spot {
            position,
            direction,
            intensity,
            cone_angle_deg,
            falloff_start_deg,
            falloff,
        } => Light {
            position: single(position),
            kind: LIGHT_SPOT,
            direction: unit(direction),
            cos_start: cos_deg(falloff_start_deg),
            intensity: color(intensity),
            cos_rim: cos_deg(cone_angle_deg),
            falloff: match falloff {
                SpotFalloff::Smoothstep => FALLOFF_SMOOTHSTEP,
                SpotFalloff::Square => FALLOFF_SQUARE,
            },
            ..none
        },
        LightDesc::Distant { direction, irradiance } => Light {
            kind: LIGHT_DISTANT,
            direction: unit(direction),
            intensity: color(irradiance),
            ..none
        },
    }
}

fn cos_deg(degrees: f64) -> f32 {
    libm::cos(degrees * (std::f64::consts::PI / 180.0)) as f32
}

fn color(c: Triple) -> Color {
    Color::from_array(c.map(|x| x as f32))
}

fn single(v: Triple) -> Vec3 {
    Vec3::from_array(v.map(|x| x as f32))
}

fn unit(v: Triple) -> Vec3 {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    single(v.map(|x| x / length))
}
