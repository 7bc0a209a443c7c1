//! What is written, and that it is read again as it was.

mod builder;
#[path = "rich/mod.rs"]
mod rich;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use builder::Builder;
use serde_json::json;
use zrak_gltf::{ErrorKind, ImportOptions, Imported, parse_gltf, to_glb};
use zrak_mesh::TriangleMesh;
use zrak_scene::builtin;
use zrak_scene::desc::{
    ColorDesc, LightDesc, MaterialDesc, MeshDesc, ObjectDesc, SceneDesc, TransformStep,
};
use zrak_scene::lower::Transform;

fn no_assets() -> BTreeMap<String, Arc<[u8]>> {
    BTreeMap::new()
}

fn read(bytes: &[u8]) -> Imported {
    let options = ImportOptions::default();
    let none = |name: &str, _| Err(format!("{name} is not inside"));
    let imported = parse_gltf(bytes, &none, &options).unwrap();
    assert_eq!(imported.warnings, []);
    imported
}

/// All meshes with the points where they stand and what they are made of, whatever they are called.
fn placed(desc: &SceneDesc) -> Vec<(Vec<[f64; 3]>, TriangleMesh, MaterialDesc)> {
    let mut all = Vec::new();
    let mut add = |object: &ObjectDesc, outer: &Transform| {
        let ObjectDesc::Mesh { mesh, material, transform, .. } = object else {
            panic!("{object:?}")
        };
        let MeshDesc::Loaded(mesh) = &desc.meshes[mesh] else { panic!() };
        let map = Transform::of_steps(transform).then(outer);
        let points = mesh.positions.iter().map(|p| map.point(p.map(f64::from))).collect();
        all.push((points, (**mesh).clone(), desc.materials[material].clone()));
    };
    for object in &desc.objects {
        match object {
            ObjectDesc::Instance { prototype, transform, .. } => {
                let outer = Transform::of_steps(transform);
                desc.prototypes[prototype].iter().for_each(|object| add(object, &outer));
            }
            object => add(object, &Transform::IDENTITY),
        }
    }
    all.sort_by(|a, b| format!("{:?}", (&a.0, &a.2)).cmp(&format!("{:?}", (&b.0, &b.2))));
    all
}

#[test]
fn what_was_imported_comes_back() {
    let first = rich::rich().import_clean();
    let (bytes, warnings) = to_glb(&first.desc, Path::new(""), &first.assets).unwrap();
    assert_eq!(warnings, []);
    let second = read(&bytes);
    assert_eq!(second.assets, first.assets);
    let (a, b) = (placed(&first.desc), placed(&second.desc));
    assert_eq!(a.len(), 6);
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((&a.0, &a.1), (&b.0, &b.1));
    }
    // Of materials, names may differ; what rounds are an angle, square roots and logarithms.
    let text = |desc: &SceneDesc| {
        let materials: Vec<_> = desc.materials.values().collect();
        let media: Vec<_> = desc.media.values().collect();
        let textures: Vec<_> = desc.textures.values().collect();
        let json = json!([materials, media, textures, desc.lights, desc.camera]);
        rounded(&json.to_string())
    };
    assert_eq!(text(&first.desc), text(&second.desc));
    assert_eq!(second.desc.name, "rich");
    // What was read again is written as it was read.
    let third = read(&to_glb(&second.desc, Path::new(""), &second.assets).unwrap().0);
    assert_eq!(placed(&second.desc).len(), placed(&third.desc).len());
}

/// The text with its numbers rounded to nine digits.
fn rounded(text: &str) -> String {
    let mut out = String::new();
    let mut number = String::new();
    for c in text.chars().chain(['\n']) {
        if c.is_ascii_digit() || ".-+eE".contains(c) && (!number.is_empty() || c == '-') {
            number.push(c);
            continue;
        }
        match number.parse::<f64>() {
            Ok(x) => out.push_str(&format!("{:.9}", (x * 1e9).round() / 1e9 + 0.0)),
            Err(_) => out.push_str(&number),
        }
        number.clear();
        out.push(c);
    }
    out
}

fn scene(materials: &[(&str, MaterialDesc)], objects: Vec<ObjectDesc>) -> SceneDesc {
    let materials = materials.iter().map(|(name, m)| ((*name).to_owned(), m.clone())).collect();
    SceneDesc { name: "test".into(), materials, objects, ..SceneDesc::default() }
}

fn grey() -> MaterialDesc {
    MaterialDesc::Lambertian { color: ColorDesc::Solid([0.5; 3]) }
}

fn square(transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Quad {
        corner: [0.0; 3],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 1.0, 0.0],
        material: "grey".into(),
        transform,
    }
}

#[test]
fn shapes_are_written_where_they_stand() {
    let turn = vec![TransformStep::RotateZDeg(90.0), TransformStep::Translate([5.0, 0.0, 0.0])];
    let objects = vec![
        square(turn.clone()),
        ObjectDesc::Group { objects: vec![square(Vec::new())], transform: turn },
        ObjectDesc::Sphere {
            center: [1.0, 2.0, 3.0],
            center_end: None,
            radius: 2.0,
            z_min: None,
            z_max: None,
            phi_max_deg: None,
            material: "grey".into(),
            transform: Vec::new(),
        },
    ];
    let (bytes, warnings) =
        to_glb(&scene(&[("grey", grey())], objects), Path::new(""), &no_assets()).unwrap();
    assert_eq!(warnings, []);
    let back = read(&bytes).desc;
    assert_eq!(back.objects.len(), 3);
    let corners = placed(&back)
        .into_iter()
        .filter(|(points, ..)| points.len() == 4)
        .map(|(points, ..)| points.into_iter().map(|p| p.map(f64::round)).collect::<Vec<_>>())
        .collect::<Vec<_>>();
    let expected = [[5.0, 0.0, 0.0], [5.0, 1.0, 0.0], [4.0, 1.0, 0.0], [4.0, 0.0, 0.0]];
    assert_eq!(corners, [expected, expected]);
}

#[test]
fn sheared_meshes_are_baked() {
    let mesh = TriangleMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    };
    let shear = [[1.0, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 4.0]];
    let object = ObjectDesc::Mesh {
        mesh: "m".into(),
        material: "grey".into(),
        group_materials: Vec::new(),
        flip: false,
        transform: vec![TransformStep::Matrix(shear)],
    };
    let mut desc = scene(&[("grey", grey())], vec![object]);
    desc.meshes.insert("m".into(), MeshDesc::Loaded(Arc::new(mesh)));
    let back = read(&to_glb(&desc, Path::new(""), &no_assets()).unwrap().0).desc;
    let (_, mesh, _) = &placed(&back)[0];
    assert_eq!(mesh.positions, [[0.0, 0.0, 4.0], [1.0, 0.0, 4.0], [0.5, 1.0, 4.0]]);
    // The mirror turns the corners and the normals alike.
    assert_eq!(mesh.triangles, [[0, 2, 1]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, -1.0]; 3]);
}

#[test]
fn groups_of_faces_become_primitives() {
    let mesh = TriangleMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        face_groups: vec![1, 0],
        groups: vec!["a".into(), "b".into()],
        ..TriangleMesh::default()
    };
    let object = ObjectDesc::Mesh {
        mesh: "m".into(),
        material: "grey".into(),
        group_materials: vec!["light".into()],
        flip: true,
        transform: Vec::new(),
    };
    let light = MaterialDesc::DiffuseLight {
        color: ColorDesc::Solid([3.0, 6.0, 1.5]),
        sides: zrak_scene::desc::LightSides::Front,
    };
    let mut desc = scene(&[("grey", grey()), ("light", light)], vec![object]);
    desc.meshes.insert("m".into(), MeshDesc::Loaded(Arc::new(mesh)));
    let back = read(&to_glb(&desc, Path::new(""), &no_assets()).unwrap().0).desc;
    let parts = placed(&back);
    assert_eq!(parts.len(), 2);
    let MaterialDesc::Surface { emission, emission_strength, .. } =
        parts.iter().map(|p| &p.2).find(|m| matches!(m, MaterialDesc::Surface { .. })).unwrap()
    else {
        panic!()
    };
    assert_eq!(*emission, Some(ColorDesc::Solid([0.5, 1.0, 0.25])));
    assert_eq!(*emission_strength, 6.0);
}

#[test]
fn built_in_scenes_are_written() {
    for builtin::Builtin { name, build, .. } in builtin::all() {
        let desc = build();
        let (bytes, _) = to_glb(&desc, Path::new(""), &no_assets()).unwrap();
        let back = read(&bytes).desc;
        assert_eq!(back.camera.look_from, desc.camera.look_from, "{name}");
        assert!((back.camera.vfov_deg - desc.camera.vfov_deg).abs() < 1e-9, "{name}");
        assert!(!back.objects.is_empty(), "{name}");
    }
}

#[test]
fn what_gltf_cannot_say_is_warned_of() {
    let mut desc = scene(&[("grey", grey())], vec![square(Vec::new())]);
    desc.background = zrak_scene::defaults::default_background();
    desc.camera.defocus_angle_deg = 1.0;
    desc.lights.push(LightDesc::Spot {
        position: [0.0; 3],
        direction: [0.0, -1.0, 0.0],
        intensity: [1.0; 3],
        cone_angle_deg: 120.0,
        falloff_start_deg: 100.0,
        falloff: zrak_scene::desc::SpotFalloff::Square,
    });
    let (bytes, warnings) = to_glb(&desc, Path::new(""), &no_assets()).unwrap();
    let places: Vec<_> = warnings.iter().map(|w| w.location.as_str()).collect();
    assert_eq!(places, ["background", "camera.defocus_angle_deg", "lights[0]"]);
    read(&bytes);
}

#[test]
fn scenes_that_lead_nowhere_are_refused() {
    let instance = |prototype: &str| ObjectDesc::Instance {
        prototype: prototype.into(),
        transform: Vec::new(),
        transform_end: None,
    };
    let mesh = ObjectDesc::Mesh {
        mesh: "m".into(),
        material: "grey".into(),
        group_materials: Vec::new(),
        flip: false,
        transform: Vec::new(),
    };
    for objects in [vec![instance("none")], vec![instance("itself")], vec![mesh]] {
        let mut desc = scene(&[("grey", grey())], objects);
        desc.prototypes.insert("itself".into(), vec![instance("itself")]);
        let error = to_glb(&desc, Path::new(""), &no_assets()).unwrap_err();
        assert_eq!((error.kind(), error.location()), (ErrorKind::Invalid, "objects[0]"));
    }
    let error = to_glb(&scene(&[], vec![square(Vec::new())]), Path::new(""), &no_assets());
    assert_eq!(error.unwrap_err().kind(), ErrorKind::Invalid);
}

#[test]
fn files_are_written_whole() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.glb");
    let imported = Builder::triangle().import_clean();
    let write = |path: &Path| {
        zrak_gltf::write_glb(&imported.desc, &imported.base_dir, &imported.assets, path)
    };
    write(&path).unwrap();
    assert_eq!(read(&std::fs::read(&path).unwrap()).desc.objects.len(), 1);
    let error = write(&dir.path().join("none/a.glb")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Io);
}
