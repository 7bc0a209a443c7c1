//! Meshes, prototypes and instances at rest and in motion, disks, cylinders, holes, mixed materials,
//! media bounded by surfaces, and lights without a surface: what real scenes are made of, in small.

use super::parts::{camera, glass, lambertian, metal, quad, scene, sphere};
use crate::desc::{
    BackgroundDesc, ColorDesc, LightDesc, LightSides, MaterialDesc, MediumDesc,
    MediumInterfaceDesc, MeshDesc, ObjectDesc, ScalarDesc, ScaleDesc, SceneDesc, SpotFalloff,
    TransformStep, Triple,
};

pub(super) fn workshop() -> SceneDesc {
    let camera = camera([0.0, 3.2, 9.0], [0.0, 0.9, 0.0], 38.0, [640, 360]);
    let sky = BackgroundDesc::Gradient { bottom: [0.12, 0.11, 0.1], top: [0.25, 0.35, 0.5] };
    let mut scene = scene("workshop", camera, 200, sky);
    materials(&mut scene);
    scene.meshes.insert("ball".to_owned(), icosphere(3, true));
    scene.meshes.insert("gem".to_owned(), icosphere(0, false));
    scene.lights = vec![
        LightDesc::Point { position: [-3.0, 4.0, 3.0], intensity: [9.0, 8.0, 6.0] },
        LightDesc::Spot {
            position: [3.5, 5.0, 2.0],
            direction: [-0.6, -1.0, -0.3],
            intensity: [40.0, 42.0, 50.0],
            cone_angle_deg: 28.0,
            falloff_start_deg: 18.0,
            falloff: SpotFalloff::Smoothstep,
        },
        LightDesc::Distant { direction: [0.3, -1.0, -0.5], irradiance: [0.8, 0.75, 0.6] },
    ];

    // A tree of a trunk, a crown and a plate below; a row of three of them.
    scene.prototypes.insert(
        "tree".to_owned(),
        vec![
            ObjectDesc::Cylinder {
                radius: 0.08,
                z_min: 0.0,
                z_max: 0.7,
                phi_max_deg: 360.0,
                material: "wood".to_owned(),
                transform: vec![TransformStep::RotateXDeg(-90.0)],
            },
            mesh("ball", "leaves", vec![scaled([0.35, 0.5, 0.35]), moved([0.0, 1.0, 0.0])]),
            ObjectDesc::Disk {
                height: 0.01,
                radius: 0.3,
                inner_radius: 0.1,
                phi_max_deg: 300.0,
                material: "brass".to_owned(),
                transform: vec![TransformStep::RotateXDeg(-90.0)],
            },
        ],
    );
    let row = |x: f64| instance("tree", vec![moved([x, 0.0, 0.0])]);
    scene.prototypes.insert("row".to_owned(), vec![row(-0.8), row(0.0), row(0.8)]);
    // A cabinet that cannot be expressed along the axes, with a mirror ball on it.
    scene.prototypes.insert(
        "cabinet".to_owned(),
        vec![
            ObjectDesc::Box {
                min: [-0.4, 0.0, -0.3],
                max: [0.4, 0.6, 0.3],
                material: "wood".to_owned(),
                transform: vec![TransformStep::RotateYDeg(30.0)],
            },
            sphere([0.0, 0.8, 0.0], 0.2, "mirror"),
        ],
    );
    let mut objects = vec![
        quad([-9.0, 0.0, 6.0], [18.0, 0.0, 0.0], [0.0, 0.0, -14.0], "floor"),
        instance("row", vec![moved([-2.6, 0.0, -1.5])]),
        instance("row", vec![TransformStep::RotateYDeg(50.0), moved([2.4, 0.0, -2.0])]),
        instance(
            "cabinet",
            vec![scaled([1.0, 1.4, 1.0]), TransformStep::RotateYDeg(15.0), moved([0.0, 0.0, -0.6])],
        ),
        mesh("ball", "glass", vec![scaled([0.45; 3]), moved([-1.6, 0.45, 1.6])]),
        mesh("ball", "fog_shell", vec![scaled([0.6; 3]), moved([-0.2, 0.6, 1.9])]),
        mesh("gem", "gold", vec![scaled([0.45; 3]), moved([2.9, 0.5, 1.4])]),
        sphere([1.1, 0.35, 2.4], 0.35, "speckled"),
        quad([-3.9, 0.0, 0.6], [1.4, 0.0, 0.4], [0.0, 1.6, 0.0], "gauze"),
        ObjectDesc::Disk {
            height: 0.0,
            radius: 0.5,
            inner_radius: 0.0,
            phi_max_deg: 360.0,
            material: "lamp".to_owned(),
            transform: vec![
                TransformStep::RotateXDeg(60.0),
                TransformStep::RotateYDeg(25.0),
                moved([0.6, 2.6, -2.0]),
            ],
        },
    ];
    // One that turns and rises while the shutter is open.
    objects.push(ObjectDesc::Instance {
        prototype: "cabinet".to_owned(),
        transform: vec![scaled([0.6; 3]), moved([1.9, 0.0, 0.9])],
        transform_end: Some(vec![
            scaled([0.6; 3]),
            TransformStep::RotateYDeg(20.0),
            moved([2.0, 0.25, 0.9]),
        ]),
    });
    scene.objects = objects;
    scene
}

fn materials(scene: &mut SceneDesc) {
    scene.media.insert(
        "fog".to_owned(),
        MediumDesc { sigma_a: [0.1, 0.3, 0.8], sigma_s: [2.5, 2.0, 1.0], g: 0.4 },
    );
    let mut add = |name: &str, material| scene.materials.insert(name.to_owned(), material);
    add("floor", lambertian([0.55, 0.5, 0.45]));
    add("wood", lambertian([0.45, 0.25, 0.12]));
    add("leaves", lambertian([0.15, 0.45, 0.12]));
    add("brass", metal([0.85, 0.65, 0.3], 0.3));
    add("gold", metal([0.95, 0.75, 0.35], 0.05));
    add("mirror", metal([0.9, 0.9, 0.9], 0.0));
    add("glass", glass());
    add("air", MaterialDesc::Interface);
    add("white", lambertian([0.8, 0.8, 0.8]));
    add(
        "speckled",
        MaterialDesc::Mix {
            materials: ["white".to_owned(), "mirror".to_owned()],
            amount: ScalarDesc::Value(0.4),
        },
    );
    add(
        "fog_shell",
        surface("air", |s| {
            if let MaterialDesc::Surface { medium, .. } = s {
                *medium =
                    Some(MediumInterfaceDesc { inside: Some("fog".to_owned()), outside: None });
            }
        }),
    );
    add(
        "gauze",
        surface("white", |s| {
            if let MaterialDesc::Surface { alpha, .. } = s {
                *alpha = Some(ScalarDesc::Value(0.4));
            }
        }),
    );
    add(
        "lamp",
        surface("white", |s| {
            if let MaterialDesc::Surface { emission, emission_strength, emission_sides, .. } = s {
                *emission = Some(ColorDesc::Solid([1.0, 0.6, 0.3]));
                *emission_strength = 6.0;
                *emission_sides = LightSides::Front;
            }
        }),
    );
}

fn surface(base: &str, change: impl FnOnce(&mut MaterialDesc)) -> MaterialDesc {
    let mut material = MaterialDesc::surface(base);
    change(&mut material);
    material
}

fn scaled(factors: Triple) -> TransformStep {
    TransformStep::Scale(ScaleDesc::PerAxis(factors))
}

fn moved(by: Triple) -> TransformStep {
    TransformStep::Translate(by)
}

fn mesh(mesh: &str, material: &str, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Mesh {
        mesh: mesh.to_owned(),
        material: material.to_owned(),
        group_materials: Vec::new(),
        flip: false,
        transform,
    }
}

fn instance(prototype: &str, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Instance { prototype: prototype.to_owned(), transform, transform_end: None }
}

/// A unit sphere of 20 times 4^`levels` triangles, with or without smooth normals.
fn icosphere(levels: u32, smooth: bool) -> MeshDesc {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut points: Vec<Triple> = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(unit)
    .to_vec();
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (p, q) = (points[a as usize], points[b as usize]);
                points.push(unit([p[0] + q[0], p[1] + q[1], p[2] + q[2]]));
                points.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let positions: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let normals = if smooth { positions.clone() } else { Vec::new() };
    MeshDesc::Inline { positions, triangles, normals, uvs: Vec::new(), colors: Vec::new() }
}

fn unit(v: Triple) -> Triple {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}
