//! Short constructors for what the built-in scenes are made of, with the books' conventions:
//! Schlick's approximation for glass, and lights that emit on both sides.

use crate::desc::{
    BackgroundDesc, CameraDesc, ColorDesc, FresnelDesc, LightSides, MaterialDesc, NoisePattern,
    ObjectDesc, RenderDesc, SceneDesc, TextureDesc, TransformStep, Triple,
};

/// A scene with nothing in it, of the present format and a depth of 50.
pub(super) fn scene(
    name: &str,
    camera: CameraDesc,
    samples_per_pixel: u32,
    background: BackgroundDesc,
) -> SceneDesc {
    let summary = super::find(name).map_or("", |builtin| builtin.summary);
    SceneDesc {
        format: 1,
        name: name.to_owned(),
        description: summary.to_owned(),
        camera,
        render: RenderDesc { samples_per_pixel, ..RenderDesc::default() },
        background,
        ..SceneDesc::default()
    }
}

/// A pinhole camera, upright, whose shutter is open over [0, 1].
pub(super) fn camera(
    look_from: Triple,
    look_at: Triple,
    vfov_deg: f64,
    [width, height]: [u32; 2],
) -> CameraDesc {
    CameraDesc {
        look_from,
        look_at,
        vup: [0.0, 1.0, 0.0],
        vfov_deg,
        width,
        height,
        defocus_angle_deg: 0.0,
        focus_distance: 10.0,
        shutter_open_s: 0.0,
        shutter_close_s: 1.0,
        ..CameraDesc::default()
    }
}

/// The constant sky of *The Next Week*.
pub(super) fn blue_sky() -> BackgroundDesc {
    BackgroundDesc::Constant { color: [0.7, 0.8, 1.0] }
}

/// No light from outside.
pub(super) fn darkness() -> BackgroundDesc {
    BackgroundDesc::Constant { color: [0.0; 3] }
}

/// The dark green and white ground of the books.
pub(super) fn green_checker() -> TextureDesc {
    TextureDesc::Checker {
        scale: 0.32,
        even: ColorDesc::Solid([0.2, 0.3, 0.1]),
        odd: ColorDesc::Solid([0.9, 0.9, 0.9]),
    }
}

/// Black and white marble.
pub(super) fn marble(scale: f64) -> TextureDesc {
    TextureDesc::Noise {
        scale,
        pattern: NoisePattern::Marble,
        octaves: 7,
        seed: 0,
        low: [0.0; 3],
        high: [1.0; 3],
    }
}

pub(super) fn texture(name: &str) -> ColorDesc {
    ColorDesc::Texture(name.to_owned())
}

pub(super) fn lambertian(color: Triple) -> MaterialDesc {
    MaterialDesc::Lambertian { color: ColorDesc::Solid(color) }
}

pub(super) fn metal(color: Triple, fuzz: f64) -> MaterialDesc {
    MaterialDesc::Metal { color: ColorDesc::Solid(color), fuzz }
}

pub(super) fn glass() -> MaterialDesc {
    MaterialDesc::Dielectric { ior: 1.5, fresnel: FresnelDesc::Schlick }
}

pub(super) fn isotropic(color: Triple) -> MaterialDesc {
    MaterialDesc::Isotropic { color: ColorDesc::Solid(color) }
}

pub(super) fn light(radiance: Triple) -> MaterialDesc {
    MaterialDesc::DiffuseLight { color: ColorDesc::Solid(radiance), sides: LightSides::Both }
}

pub(super) fn sphere(center: Triple, radius: f64, material: &str) -> ObjectDesc {
    ObjectDesc::Sphere {
        center,
        center_end: None,
        radius,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material: material.to_owned(),
        transform: Vec::new(),
    }
}

pub(super) fn moving_sphere(
    center: Triple,
    center_end: Triple,
    radius: f64,
    material: &str,
) -> ObjectDesc {
    let material = material.to_owned();
    ObjectDesc::Sphere {
        center,
        center_end: Some(center_end),
        radius,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material,
        transform: Vec::new(),
    }
}

pub(super) fn quad(corner: Triple, u: Triple, v: Triple, material: &str) -> ObjectDesc {
    ObjectDesc::Quad { corner, u, v, material: material.to_owned(), transform: Vec::new() }
}

/// Turn about y, then move: how the books stand things in a room.
pub(super) fn turned_then_moved(angle_deg: f64, translation: Triple) -> Vec<TransformStep> {
    vec![TransformStep::RotateYDeg(angle_deg), TransformStep::Translate(translation)]
}
