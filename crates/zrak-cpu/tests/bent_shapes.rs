//! Bilinear patches and curves in pictures: against finely cut meshes, and against closed forms.

mod common;

use common::scenes::{lambertian, quad, scene};
use common::{arena, mean_and_error, render};
use zrak_cpu::Tree;
use zrak_scene::desc::{CurveForm, LightDesc, MeshDesc, ObjectDesc, SceneDesc, TransformStep};

fn mesh(name: &str) -> ObjectDesc {
    ObjectDesc::Mesh {
        mesh: name.to_owned(),
        material: "m".to_owned(),
        group_materials: Vec::new(),
        flip: false,
        transform: vec![TransformStep::RotateYDeg(20.0)],
    }
}

/// The corners of two bent patches that share an edge.
const CORNERS: [[f32; 3]; 6] = [
    [-1.2, -0.9, 0.5],
    [0.0, -1.0, -0.6],
    [-1.0, 1.0, -0.7],
    [0.1, 0.9, 0.8],
    [1.3, -0.8, 0.6],
    [1.1, 1.0, -0.5],
];
const PATCHES: [[u32; 4]; 2] = [[0, 1, 2, 3], [1, 4, 3, 5]];

/// The same surface, each patch cut into 2 n^2 triangles.
fn cut(n: u32) -> MeshDesc {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for patch in PATCHES {
        let first = positions.len() as u32;
        for k in 0..(n + 1) * (n + 1) {
            let (u, v) = ((k % (n + 1)) as f32 / n as f32, (k / (n + 1)) as f32 / n as f32);
            let [a, b, c, d] = patch.map(|i| CORNERS[i as usize]);
            positions.push([0, 1, 2].map(|i| {
                (1.0 - v) * ((1.0 - u) * a[i] + u * b[i]) + v * ((1.0 - u) * c[i] + u * d[i])
            }));
        }
        for k in 0..n * n {
            let a = first + k % n + k / n * (n + 1);
            triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    MeshDesc::Inline {
        positions,
        triangles,
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
    }
}

#[test]
fn patches_look_like_the_many_triangles_that_they_stand_for() {
    let picture = |mesh_desc: MeshDesc| {
        let mut desc = scene([48, 48], 0.6);
        desc.materials.insert("m".to_owned(), lambertian(0.7));
        desc.meshes.insert("surface".to_owned(), mesh_desc);
        desc.objects =
            vec![mesh("surface"), quad([-3.0, -1.1, 3.0], [6.0, 0.0, 0.0], [0.0, 0.0, -6.0], "m")];
        desc.lights =
            vec![LightDesc::Distant { direction: [0.4, -1.0, -0.6], irradiance: [2.0; 3] }];
        render(&arena(&desc), 2, Tree::Wide, 64)
    };
    let patches = MeshDesc::Patches {
        positions: CORNERS.to_vec(),
        patches: PATCHES.to_vec(),
        normals: Vec::new(),
        uvs: Vec::new(),
    };
    let (bent, cut) = (picture(patches), picture(cut(96)));
    let (mut sum, mut worst) = (0.0, 0.0_f32);
    for (a, b) in bent.pixels.iter().zip(&cut.pixels) {
        let off = (a.mean().g - b.mean().g).abs();
        sum += off;
        worst = worst.max(off);
    }
    // The same paths, but where a triangle's edge or its tilt sends one elsewhere.
    let mean = sum / bent.pixels.len() as f32;
    assert!(mean < 0.003 && worst < 0.1, "{mean} {worst}");
}

/// Upright threads that just fill a pixel, lit from where they are seen from.
#[test]
fn threads_are_as_bright_as_their_form_says() {
    let pi = std::f64::consts::PI;
    for (form, normals, expected) in [
        (CurveForm::Flat, Vec::new(), 1.0),
        // The mean cosine across a round thread.
        (CurveForm::Cylinder, Vec::new(), pi / 4.0),
        // Half as wide, and half as much light on it.
        (CurveForm::Ribbon, vec![[0.75_f64.sqrt(), 0.0, 0.5]; 2], 0.25),
    ] {
        let mut desc = scene([1, 1], 0.0);
        desc.camera.look_from = [0.0, 0.0, 1000.0];
        desc.camera.vfov_deg = 2.0 * (0.25_f64 / 1000.0).atan().to_degrees();
        desc.render.samples_per_pixel = 64;
        desc.materials.insert("m".to_owned(), lambertian(0.5));
        desc.objects.push(ObjectDesc::Curve {
            points: [-3.0, -1.0, 1.0, 3.0].map(|y| [0.0, y, 0.0]).to_vec(),
            widths: [0.5; 2],
            form,
            normals,
            material: "m".to_owned(),
            transform: Vec::new(),
        });
        desc.lights =
            vec![LightDesc::Distant { direction: [0.0, 0.0, -1.0], irradiance: [2.0; 3] }];
        check_mean(&desc, expected * 0.5 / pi * 2.0);
    }
}

fn check_mean(desc: &SceneDesc, expected: f64) {
    let mut desc = desc.clone();
    let values: Vec<f64> = (0..60)
        .map(|seed| {
            desc.render.seed = seed;
            let film = render(&arena(&desc), 1, Tree::Wide, desc.render.samples_per_pixel);
            f64::from(film.pixels[0].mean().g)
        })
        .collect();
    let (mean, error) = mean_and_error(&values);
    // The outermost samples may be lost to rounding at this distance.
    let off = (mean - expected).abs();
    assert!(off < 4.0 * error + 1e-3 * expected, "{mean} +- {error}, not {expected}");
}
