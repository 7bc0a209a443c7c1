//! Short constructors of scene descriptions.

use std::collections::BTreeMap;

use zrak_scene::desc::{
    BackgroundDesc, BoundaryDesc, CameraDesc, ColorDesc, FresnelDesc, LightSides, MaterialDesc,
    ObjectDesc, RenderDesc, SceneDesc, TransformStep, Triple,
};

/// An empty scene, seen from (0, 0, 5) by a camera 40 degrees high, under this constant sky.
pub fn scene(size: [u32; 2], sky: f64) -> SceneDesc {
    SceneDesc {
        format: 1,
        name: "test".to_owned(),
        description: String::new(),
        camera: CameraDesc {
            look_from: [0.0, 0.0, 5.0],
            look_at: [0.0; 3],
            vup: [0.0, 1.0, 0.0],
            vfov_deg: 40.0,
            width: size[0],
            height: size[1],
            defocus_angle_deg: 0.0,
            focus_distance: 5.0,
            shutter_open_s: 0.0,
            shutter_close_s: 1.0,
            ..CameraDesc::default()
        },
        render: RenderDesc { samples_per_pixel: 1, seed: 1, ..RenderDesc::default() },
        background: BackgroundDesc::Constant { color: [sky; 3] },
        textures: BTreeMap::new(),
        materials: BTreeMap::new(),
        objects: Vec::new(),
        ..SceneDesc::default()
    }
}

pub fn lambertian(albedo: f64) -> MaterialDesc {
    MaterialDesc::Lambertian { color: ColorDesc::Solid([albedo; 3]) }
}

pub fn metal(tint: f64, fuzz: f64) -> MaterialDesc {
    MaterialDesc::Metal { color: ColorDesc::Solid([tint; 3]), fuzz }
}

pub fn glass(ior: f64, fresnel: FresnelDesc) -> MaterialDesc {
    MaterialDesc::Dielectric { ior, fresnel }
}

pub fn isotropic(albedo: f64) -> MaterialDesc {
    MaterialDesc::Isotropic { color: ColorDesc::Solid([albedo; 3]) }
}

pub fn light(radiance: f64, sides: LightSides) -> MaterialDesc {
    MaterialDesc::DiffuseLight { color: ColorDesc::Solid([radiance; 3]), sides }
}

pub fn sphere(center: Triple, radius: f64, material: &str) -> ObjectDesc {
    let material = material.to_owned();
    whole_sphere(center, None, radius, material)
}

fn whole_sphere(
    center: Triple,
    center_end: Option<Triple>,
    radius: f64,
    material: String,
) -> ObjectDesc {
    ObjectDesc::Sphere {
        center,
        center_end,
        radius,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material,
        transform: Vec::new(),
    }
}

pub fn moving_sphere(center: Triple, end: Triple, radius: f64, material: &str) -> ObjectDesc {
    let material = material.to_owned();
    whole_sphere(center, Some(end), radius, material)
}

pub fn quad(corner: Triple, u: Triple, v: Triple, material: &str) -> ObjectDesc {
    ObjectDesc::Quad { corner, u, v, material: material.to_owned(), transform: Vec::new() }
}

pub fn triangle(vertices: [Triple; 3], material: &str) -> ObjectDesc {
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    ObjectDesc::Triangle { vertices, uv, material: material.to_owned(), transform: Vec::new() }
}

pub fn cuboid(min: Triple, max: Triple, material: &str) -> ObjectDesc {
    ObjectDesc::Box { min, max, material: material.to_owned(), transform: Vec::new() }
}

pub fn medium(boundary: BoundaryDesc, density: f64, material: &str) -> ObjectDesc {
    ObjectDesc::Medium { boundary, density, material: material.to_owned(), transform: Vec::new() }
}

pub fn in_sphere(center: Triple, radius: f64) -> BoundaryDesc {
    BoundaryDesc::Sphere { center, center_end: None, radius, transform: Vec::new() }
}

pub fn in_box(min: Triple, max: Triple) -> BoundaryDesc {
    BoundaryDesc::Box { min, max, transform: Vec::new() }
}

/// Objects under steps, the first first.
pub fn group(objects: Vec<ObjectDesc>, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Group { objects, transform }
}

/// A cube from -1 to 1 of triangles, counter-clockwise seen from outside.
pub fn triangle_cube(material: &str) -> Vec<ObjectDesc> {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|b| b as f64 * 2.0 - 1.0);
    let sides =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .map(|t| triangle(t.map(corner), material))
        .collect()
}

/// Scales a scene about the origin, camera and densities with it, and then moves it.
pub fn placed(mut desc: SceneDesc, size: f64, shift: Triple) -> SceneDesc {
    let place = |p: Triple| [0, 1, 2].map(|i| p[i] * size + shift[i]);
    desc.camera.look_from = place(desc.camera.look_from);
    desc.camera.look_at = place(desc.camera.look_at);
    desc.camera.focus_distance *= size;
    fn thin(objects: &mut [ObjectDesc], size: f64) {
        for object in objects {
            match object {
                ObjectDesc::Medium { density, .. } => *density /= size,
                ObjectDesc::Group { objects, .. } => thin(objects, size),
                _ => {}
            }
        }
    }
    thin(&mut desc.objects, size);
    let steps = vec![
        TransformStep::Scale(zrak_scene::desc::ScaleDesc::Uniform(size)),
        TransformStep::Translate(shift),
    ];
    desc.objects = vec![group(desc.objects, steps)];
    desc
}
