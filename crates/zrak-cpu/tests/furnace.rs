//! White furnaces: what absorbs nothing is invisible in a uniform glow, and every sample of every
//! pixel is exactly the glow. Any leak of light into a closed object, any ray that meets the
//! surface it left, any absorption shows as a sample below 1.

mod common;

use common::scenes::{
    cuboid, glass, group, in_box, in_sphere, isotropic, lambertian, light, medium, metal,
    moving_sphere, placed, quad, scene, sphere, triangle_cube,
};
use common::{arena, render};
use zrak_cpu::Tree;
use zrak_scene::desc::{
    BoundaryDesc, FresnelDesc, LightSides, MaterialDesc, MeshDesc, ObjectDesc, ScaleDesc,
    SceneDesc, TransformStep,
};

const N_SAMPLES: u32 = 40;
const SIZE: u32 = 64;

/// Objects of albedo 1 in a glow of 1.
fn furnace(materials: &[(&str, MaterialDesc)], objects: Vec<ObjectDesc>) -> SceneDesc {
    let mut desc = scene([SIZE, SIZE], 1.0);
    // Long enough that nothing but a trap cuts a path.
    desc.render.max_depth = 20_000;
    for (name, material) in materials {
        desc.materials.insert((*name).to_owned(), material.clone());
    }
    desc.objects = objects;
    desc
}

/// Number of samples that are not exactly 1.
fn n_wrong(desc: &SceneDesc) -> u64 {
    let film = render(&arena(desc), 2, Tree::Wide, N_SAMPLES);
    let mut n_wrong = 0;
    for pixel in &film.pixels {
        for channel in pixel.radiance {
            assert_eq!(channel.fraction, 0, "samples are 0 or 1");
            assert_eq!(channel, pixel.radiance[0]);
        }
        n_wrong += pixel.n_samples - pixel.radiance[0].whole;
    }
    n_wrong
}

/// At every scale, at the origin and far from it.
fn check(name: &str, desc: &SceneDesc) {
    let mut failures = Vec::new();
    for size in [1e-3, 1.0, 1e5] {
        for shift in [[0.0; 3], [30.0 * size, -20.0 * size, 10.0 * size]] {
            let n_wrong = n_wrong(&placed(desc.clone(), size, shift));
            if n_wrong > 0 {
                let n = u64::from(SIZE * SIZE * N_SAMPLES);
                failures.push(format!("{n_wrong} of {n} at size {size}, shift {shift:?}"));
            }
        }
    }
    assert!(failures.is_empty(), "{name}: {failures:#?}");
}

fn moved(by: [f64; 3]) -> TransformStep {
    TransformStep::Translate(by)
}

fn mesh(mesh: &str, material: &str, transform: Vec<TransformStep>) -> ObjectDesc {
    let (mesh, material) = (mesh.to_owned(), material.to_owned());
    ObjectDesc::Mesh { mesh, material, group_materials: Vec::new(), flip: false, transform }
}

/// Round and flat meshes, and a can of a cylinder and two disks.
fn add_meshes(desc: &mut SceneDesc) {
    desc.meshes = (zrak_scene::builtin::find("workshop").unwrap().build)().meshes;
    // With normals of their own, meshes are not what they look like, and some light is lost.
    for mesh in desc.meshes.values_mut() {
        if let MeshDesc::Inline { normals, .. } = mesh {
            normals.clear();
        }
    }
    // A ball of bent patches: the corners of a cube, pushed out, and the middles of its sides.
    let mut positions = Vec::new();
    let mut patches = Vec::new();
    for axis in 0..3_usize {
        for side in [-1.0_f32, 1.0] {
            let first = positions.len() as u32;
            for k in 0..9 {
                let mut p = [0.0; 3];
                p[axis] = side;
                p[(axis + 1) % 3] = (k % 3) as f32 - 1.0;
                p[(axis + 2) % 3] = (k / 3) as f32 - 1.0;
                let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
                positions.push(p.map(|x| x / length));
            }
            for cell in [0, 1, 3, 4] {
                let corners = [cell, cell + 1, cell + 3, cell + 4].map(|k| first + k);
                let [a, b, c, d] = corners;
                patches.push(if side > 0.0 { corners } else { [a, c, b, d] });
            }
        }
    }
    let ball = MeshDesc::Patches { positions, patches, normals: Vec::new(), uvs: Vec::new() };
    desc.meshes.insert("patches".to_owned(), ball);
    let lid = |height, radius, transform| ObjectDesc::Disk {
        height,
        radius,
        inner_radius: 0.0,
        phi_max_deg: 360.0,
        material: "m".to_owned(),
        transform,
    };
    desc.prototypes.insert(
        "can".to_owned(),
        vec![
            ObjectDesc::Cylinder {
                radius: 1.0,
                z_min: -1.0,
                z_max: 1.0,
                phi_max_deg: 360.0,
                material: "m".to_owned(),
                transform: Vec::new(),
            },
            // A little larger than the cylinder: rims of disks and cylinders are not watertight.
            lid(0.999, 1.001, Vec::new()),
            lid(0.999, 1.001, vec![TransformStep::RotateXDeg(180.0)]),
        ],
    );
}

/// A cap of a sphere, open.
fn part_of_sphere(z_min: Option<f64>, z_max: Option<f64>) -> ObjectDesc {
    ObjectDesc::Sphere {
        center: [0.0; 3],
        center_end: None,
        radius: 1.0,
        z_min,
        z_max,
        phi_max_deg: None,
        material: "m".to_owned(),
        transform: Vec::new(),
    }
}

fn turned(object: ObjectDesc) -> ObjectDesc {
    let axis = [1.0, 2.0, 3.0];
    group(vec![object], vec![TransformStep::Rotate { axis, angle_deg: 35.0 }])
}

fn stretched(object: ObjectDesc) -> ObjectDesc {
    let steps = vec![
        TransformStep::Scale(ScaleDesc::PerAxis([1.0, 0.5, -1.5])),
        TransformStep::RotateXDeg(20.0),
    ];
    group(vec![object], steps)
}

/// Every shape, one material.
fn shapes(material: &MaterialDesc) -> Vec<(&'static str, SceneDesc)> {
    let unit_box = || cuboid([-1.0; 3], [1.0; 3], "m");
    let cases = vec![
        ("sphere", vec![sphere([0.0; 3], 1.2, "m")]),
        ("moving sphere", vec![moving_sphere([-0.5, 0.0, 0.0], [0.5, 0.3, 0.0], 1.0, "m")]),
        ("box", vec![unit_box()]),
        ("turned box", vec![turned(unit_box())]),
        ("stretched sphere", vec![stretched(sphere([0.0; 3], 1.0, "m"))]),
        ("triangles", vec![turned(group(triangle_cube("m"), Vec::new()))]),
        ("mesh", vec![turned(mesh("ball", "m", Vec::new()))]),
        ("patches", vec![turned(mesh("patches", "m", Vec::new()))]),
        ("stretched patches", vec![stretched(mesh("patches", "m", Vec::new()))]),
        (
            "parts of a sphere",
            vec![turned(part_of_sphere(None, Some(0.2))), turned(part_of_sphere(Some(0.2), None))],
        ),
        ("flat mesh", vec![stretched(mesh("gem", "m", Vec::new()))]),
        (
            "shared mesh",
            vec![
                mesh("ball", "m", vec![moved([-0.8, 0.0, 0.0])]),
                stretched(mesh("ball", "m", vec![moved([0.9, 0.1, 0.0])])),
            ],
        ),
        (
            "moving instance",
            vec![ObjectDesc::Instance {
                prototype: "can".to_owned(),
                transform: vec![TransformStep::RotateXDeg(30.0)],
                transform_end: Some(vec![TransformStep::RotateXDeg(50.0), moved([0.3, 0.2, 0.0])]),
            }],
        ),
    ];
    let materials = [("m", material.clone())];
    cases
        .into_iter()
        .map(|(name, objects)| {
            let mut desc = furnace(&materials, objects);
            add_meshes(&mut desc);
            (name, desc)
        })
        .collect()
}

#[test]
fn diffuse_shapes() {
    for (name, desc) in shapes(&lambertian(1.0)) {
        check(&format!("diffuse {name}"), &desc);
    }
}

#[test]
fn mirrors() {
    for (name, desc) in shapes(&metal(1.0, 0.0)) {
        check(&format!("mirror {name}"), &desc);
    }
}

#[test]
fn glass_shapes() {
    for (name, desc) in shapes(&glass(1.5, FresnelDesc::Exact)) {
        check(&format!("glass {name}"), &desc);
    }
}

#[test]
fn bubbles_and_schlick() {
    for (name, desc) in shapes(&glass(0.7, FresnelDesc::Schlick)).into_iter().take(3) {
        check(&format!("bubble {name}"), &desc);
    }
}

/// Open surfaces, crossing and touching each other.
#[test]
fn sheets() {
    let objects = vec![
        quad([-1.5, -1.0, -1.0], [3.0, 0.0, 0.0], [0.0, 0.0, 2.0], "m"),
        quad([-1.5, -1.0, -1.0], [0.0, 2.0, 0.5], [3.0, 0.0, 0.0], "m"),
        quad([-1.0, -1.0, -0.5], [2.0, 2.0, 0.3], [-0.3, 0.5, 2.0], "m"),
        common::scenes::triangle([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.7], [0.0, 1.2, -0.4]], "m"),
    ];
    check("sheets", &furnace(&[("m", lambertian(1.0))], objects));
}

#[test]
fn media() {
    let white = [("mist", isotropic(1.0))];
    let cases = [
        ("sphere", vec![medium(in_sphere([0.0; 3], 1.2), 1.0, "mist")]),
        ("box", vec![medium(in_box([-1.0; 3], [1.0; 3]), 1.5, "mist")]),
        ("turned box", vec![turned(medium(in_box([-1.0; 3], [1.0; 3]), 1.0, "mist"))]),
        ("camera inside", vec![medium(in_sphere([0.0; 3], 8.0), 0.2, "mist")]),
        (
            "overlapping",
            vec![
                medium(in_sphere([-0.3, 0.0, 0.0], 1.0), 1.0, "mist"),
                medium(in_box([-0.5; 3], [1.0; 3]), 2.0, "mist"),
                medium(
                    BoundaryDesc::Sphere {
                        center: [0.0; 3],
                        center_end: Some([0.5, 0.5, 0.0]),
                        radius: 0.7,
                        transform: Vec::new(),
                    },
                    1.0,
                    "mist",
                ),
            ],
        ),
    ];
    for (name, objects) in cases {
        check(&format!("mist in {name}"), &furnace(&white, objects));
    }
}

/// A white fluid in glass, and mist around a solid that touches its boundary.
#[test]
fn media_in_glass_and_around_walls() {
    let materials = [
        ("mist", isotropic(1.0)),
        ("glass", glass(1.5, FresnelDesc::Exact)),
        ("white", lambertian(1.0)),
    ];
    let in_glass =
        vec![sphere([0.0; 3], 1.0, "glass"), medium(in_sphere([0.0; 3], 1.0), 1.0, "mist")];
    check("fluid in a glass sphere", &furnace(&materials, in_glass));
    let on_wall = vec![
        quad([-2.0, -1.0, -2.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0], "white"),
        medium(in_box([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]), 1.0, "mist"),
        sphere([0.0, -0.5, 0.0], 0.5, "white"),
    ];
    check("mist on a wall", &furnace(&materials, on_wall));
}

/// Everything at once: touching, resting on each other, one inside the other.
#[test]
fn a_still_life() {
    let materials = [
        ("mist", isotropic(1.0)),
        ("glass", glass(1.5, FresnelDesc::Exact)),
        ("inner", glass(1.0 / 1.5, FresnelDesc::Exact)),
        ("white", lambertian(1.0)),
        ("mirror", metal(1.0, 0.0)),
    ];
    let objects = vec![
        sphere([0.0, -101.0, 0.0], 100.0, "white"),
        sphere([0.0, -0.5, 0.0], 0.5, "glass"),
        sphere([0.0, -0.5, 0.0], 0.4, "inner"),
        sphere([-1.0, -0.5, 0.0], 0.5, "mirror"),
        turned(cuboid([0.6, -1.0, -0.5], [1.4, 0.0, 0.5], "white")),
        medium(in_sphere([0.0, 0.0, 0.0], 1.5), 0.3, "mist"),
    ];
    check("still life", &furnace(&materials, objects));
}

/// A closed light: whatever stands inside and absorbs nothing cannot be seen either.
#[test]
fn closed_lights() {
    let materials = [
        ("light", light(0.5, LightSides::Both)),
        ("white", lambertian(1.0)),
        ("glass", glass(1.5, FresnelDesc::Exact)),
    ];
    for walls in [
        vec![sphere([0.0; 3], 10.0, "light")],
        vec![cuboid([-10.0; 3], [10.0; 3], "light")],
        vec![turned(cuboid([-10.0; 3], [10.0; 3], "light"))],
    ] {
        for size in [1e-3, 1.0, 1e5] {
            let mut objects = walls.clone();
            objects.push(sphere([-0.7, 0.0, 0.0], 0.7, "white"));
            objects.push(turned(cuboid([0.5, -0.5, -0.5], [1.5, 0.5, 0.5], "glass")));
            let mut desc = furnace(&materials, objects);
            desc.background = zrak_scene::desc::BackgroundDesc::Constant { color: [0.0; 3] };
            let shift = [10.0 * size, 20.0 * size, -5.0 * size];
            let film = render(&arena(&placed(desc, size, shift)), 2, Tree::Wide, 16);
            for pixel in &film.pixels {
                assert_eq!(pixel.mean().to_array(), [0.5; 3], "size {size}");
            }
        }
    }
}

/// What leaves a convex body of albedo 1/2 sees nothing but the glow: exactly half of it.
#[test]
fn grey_convex_shapes_are_exactly_half_as_bright() {
    // Two bodies see each other, the rims of the lids see the side of the can, and patches are bent inwards.
    let others = ["shared mesh", "moving instance", "patches", "stretched patches"];
    let is_convex = |case: &(&str, SceneDesc)| !others.contains(&case.0);
    for (name, mut desc) in shapes(&lambertian(0.5)).into_iter().filter(is_convex) {
        // One segment to the body and one away from it: a path that needs more is wrong.
        desc.render.max_depth = 2;
        for size in [1e-3, 1.0, 1e5] {
            let desc = placed(desc.clone(), size, [10.0 * size, 0.0, -3.0 * size]);
            let film = render(&arena(&desc), 2, Tree::Wide, N_SAMPLES);
            let half = 1_u64 << 63;
            let mut n_inside = 0;
            for pixel in &film.pixels {
                // Each ray that met the body took one half.
                let n_hits = pixel.n_rays - pixel.n_samples;
                let expected = u128::from(pixel.n_samples) << 64;
                let lost = u128::from(half) * u128::from(n_hits);
                let sum = pixel.radiance[0];
                let sum = u128::from(sum.fraction) | u128::from(sum.whole) << 64;
                assert_eq!(sum, expected - lost, "{name} at size {size}");
                n_inside += n_hits;
            }
            assert!(n_inside > 10_000, "{name} fills some of the picture");
        }
    }
}

/// Black mist between the camera and a glowing wall: exp(-density distance) of the light arrives.
#[test]
fn absorption_is_exponential() {
    for size in [1e-3, 1.0, 1e5] {
        let materials = [("light", light(1.0, LightSides::Both)), ("smoke", isotropic(0.0))];
        let walls = sphere([0.0, 0.0, 5.0], 10.0, "light");
        let smoke = medium(in_sphere([0.0, 0.0, 5.0], 10.0), 0.1, "smoke");
        let desc = furnace(&materials, vec![walls, smoke]);
        let film = render(&arena(&placed(desc, size, [0.0; 3])), 2, Tree::Wide, 100);
        let n = (SIZE * SIZE * 100) as f64;
        let bright: u64 = film.pixels.iter().map(|pixel| pixel.radiance[0].whole).sum();
        let p = (-1.0_f64).exp();
        let sigma = (n * p * (1.0 - p)).sqrt();
        assert!((bright as f64 - n * p).abs() < 4.0 * sigma, "{} {p}", bright as f64 / n);
    }
}
