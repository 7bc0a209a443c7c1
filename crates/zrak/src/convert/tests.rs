//! Conversions: the arena of what is read back is, byte for byte, that of what was written.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tempfile::TempDir;
use zrak_mesh::TriangleMesh;
use zrak_scene::builtin;
use zrak_scene::desc::{
    BackgroundDesc, ImageFilter, MaterialDesc, MeshDesc, ObjectDesc, SceneDesc, TextureDesc,
};

use super::*;
use crate::{LoadOptions, load_scene, load_scene_with};

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Names of all files below a folder.
fn list(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap();
                names.push(name.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    names.sort();
    names
}

fn seeds() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/gltf")
}

/// Fails unless the scene in a file renders the same picture.
fn assert_same(path: &Path, scene: &Scene) {
    let read = load_scene(path).unwrap();
    let (a, b) = (read.lower().unwrap(), scene.lower().unwrap());
    assert_eq!(a.globals(), b.globals(), "{}", path.display());
    assert!(a.bytes() == b.bytes(), "{}", path.display());
}

/// A picture as a PNG.
fn png(value: f32) -> Vec<u8> {
    let picture = zrak_image::Picture { width: 1, height: 2, pixels: vec![[value; 3]; 2] };
    zrak_image::encode(zrak_image::Format::Png, &picture, None, zrak_image::Transfer::Srgb).unwrap()
}

/// A ring of triangles with everything that meshes have.
fn ring(n: u32) -> TriangleMesh {
    let vertex = |i: u32| {
        let angle = f64::from(i / 2) * std::f64::consts::TAU / f64::from(n);
        [libm::cos(angle) as f32, libm::sin(angle) as f32, (i % 2) as f32]
    };
    TriangleMesh {
        positions: (0..2 * n).map(vertex).collect(),
        normals: (0..2 * n).map(|i| vertex(i - i % 2)).collect(),
        tangents: vec![[0.0, 0.0, 1.0, -1.0]; 2 * n as usize],
        uvs: (0..2 * n).map(|i| [(i / 2) as f32 / n as f32, (i % 2) as f32]).collect(),
        colors: (0..2 * n).map(|i| [0.5, i as f32 / 100.0, 0.25, 1.0]).collect(),
        triangles: (0..2 * n).map(|i| [i, (i + 1) % (2 * n), (i + 2) % (2 * n)]).collect(),
        face_groups: (0..2 * n).map(|i| i % 3).collect(),
        groups: ["a", "b", "c"].map(str::to_owned).to_vec(),
    }
}

/// A scene in memory with meshes and a picture of its own.
fn in_memory() -> Scene {
    let mut scene = load_scene("quads").unwrap();
    let texture = TextureDesc::image("embedded:tile/1.png".to_owned(), ImageFilter::Bilinear);
    scene.desc.textures.insert("tile".into(), texture);
    let material: MaterialDesc =
        serde_json::from_value(serde_json::json!({"kind": "lambertian", "color": "tile"})).unwrap();
    scene.desc.materials.insert("tiled".into(), material);
    scene.embedded.insert("tile/1.png".into(), png(0.25).into());
    for (name, n) in [("ring", 20), ("Ring", 30), ("a/../b", 40)] {
        scene.desc.meshes.insert(name.into(), MeshDesc::Loaded(Arc::new(ring(n))));
        scene.desc.objects.push(ObjectDesc::Mesh {
            mesh: name.into(),
            material: "tiled".into(),
            group_materials: Vec::new(),
            flip: false,
            transform: Vec::new(),
        });
    }
    scene
}

#[test]
fn built_in_scenes_come_back() {
    let folder = folder();
    for builtin in builtin::all() {
        let scene = load_scene(builtin.name).unwrap();
        let path = folder.path().join(format!("{}.toml", builtin.name));
        let converted = convert(&scene, &path).unwrap();
        assert_eq!((converted.files.last(), converted.warnings.len()), (Some(&path), 0));
        assert_same(&path, &scene);
    }
}

#[test]
fn meshes_and_pictures_in_memory_become_files() {
    let (folder, scene) = (folder(), in_memory());
    let path = folder.path().join("scene.toml");
    let converted = convert(&scene, &path).unwrap();
    let names = list(folder.path());
    assert_eq!(names.len(), 5, "{names:?}");
    assert!(names.contains(&"scene.files/tile-1.png".to_owned()), "{names:?}");
    assert!(names.contains(&"scene.files/a-..-b.ply".to_owned()), "{names:?}");
    assert_eq!(converted.files.len(), 5);
    assert_same(&path, &scene);
    // To the same place again, and from there to another.
    convert(&scene, &path).unwrap();
    assert_eq!(list(folder.path()), names);
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let copy = folder.path().join("sub/copy.toml");
    let read = load_scene(&path).unwrap();
    convert(&read, &copy).unwrap();
    assert_eq!(list(&folder.path().join("sub")).len(), 5);
    assert_same(&copy, &scene);
    // Beside each other, they share the files.
    let twin = folder.path().join("twin.toml");
    assert_eq!(convert(&read, &twin).unwrap().files, std::slice::from_ref(&twin));
    assert_same(&twin, &scene);
}

#[test]
fn gltf_files_come_back() {
    let folder = folder();
    for name in ["rich.glb", "rich.gltf", "deformed.glb", "compressed.gltf"] {
        let scene = load_scene(seeds().join(name)).unwrap();
        let path = folder.path().join(name.replace('.', "-") + ".toml");
        convert(&scene, &path).unwrap();
        assert_same(&path, &scene);
    }
}

#[test]
fn a_scene_on_the_standard_output_refers_to_where_its_files_are() {
    let folder = folder();
    let path = folder.path().join("scene.toml");
    convert(&in_memory(), &path).unwrap();
    let read = load_scene(&path).unwrap();
    // In the same folder, paths stay.
    let (text, warnings) = to_toml(&read, folder.path()).unwrap();
    assert_eq!(text.as_bytes(), std::fs::read(&path).unwrap());
    assert_eq!(warnings, [""; 0]);
    // Elsewhere, they lead back.
    let elsewhere = tempfile::tempdir().unwrap();
    let (text, warnings) = to_toml(&read, elsewhere.path()).unwrap();
    assert!(warnings[0].contains("4 files") && warnings[0].contains("--allow-external"));
    let other = elsewhere.path().join("other.toml");
    std::fs::write(&other, text).unwrap();
    assert!(load_scene(&other).unwrap().lower().is_err());
    let options = LoadOptions { allow_external: true, ..LoadOptions::default() };
    let read = load_scene_with(&other, &options).unwrap();
    assert!(read.lower().unwrap().bytes() == in_memory().lower().unwrap().bytes());
    // What is in memory cannot all be said.
    let (_, warnings) = to_toml(&in_memory(), folder.path()).unwrap();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
}

#[test]
fn everything_becomes_gltf() {
    let folder = folder();
    let mut scenes: Vec<Scene> =
        builtin::all().iter().map(|builtin| load_scene(builtin.name).unwrap()).collect();
    scenes.push(in_memory());
    for scene in scenes {
        let path = folder.path().join("scene.glb");
        let converted = convert(&scene, &path).unwrap();
        assert_eq!(converted.files, std::slice::from_ref(&path));
        let read = load_scene(&path).unwrap();
        read.lower().unwrap();
        // Nothing is lost without a word.
        let says = |words: &str| converted.warnings.iter().any(|w| w.contains(words));
        let is_plain = scene.desc.background == BackgroundDesc::default();
        assert!(is_plain || says("background"), "{}: {:?}", scene.desc.name, converted.warnings);
    }
    // zrak's own picture is in the file.
    let path = folder.path().join("earth.glb");
    convert(&load_scene("earth").unwrap(), &path).unwrap();
    assert_eq!(load_scene(&path).unwrap().embedded.len(), 1);
}

#[test]
fn files_that_may_not_be_read_are_not_given_away() {
    let outside = folder();
    std::fs::write(outside.path().join("secret.png"), png(0.75)).unwrap();
    convert(&in_memory(), &outside.path().join("a.toml")).unwrap();
    std::fs::create_dir(outside.path().join("in")).unwrap();
    let path = outside.path().join("in/scene.toml");
    let mut desc: SceneDesc = load_scene("earth").unwrap().desc;
    for (picture, mesh) in
        [("../secret.png", None), ("builtin:earth.png", Some("../a.files/ring.ply"))]
    {
        for texture in desc.textures.values_mut() {
            if let TextureDesc::Image { path, .. } = texture {
                *path = picture.to_owned();
            }
        }
        if let Some(mesh) = mesh {
            desc.meshes.insert("m".into(), MeshDesc::File { path: mesh.into() });
        }
        std::fs::write(&path, zrak_scene::file::write_string(&desc)).unwrap();
        let scene = load_scene(&path).unwrap();
        std::fs::create_dir_all(outside.path().join("out")).unwrap();
        for name in ["x.glb", "x.toml"] {
            let error = convert(&scene, &outside.path().join("out").join(name)).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Scene, "{error}");
            assert!(error.to_string().contains("outside of the scene's folder"), "{error}");
            assert!(error.scene().unwrap().line_column().is_some(), "{error}");
        }
        assert_eq!(list(&outside.path().join("out")), [""; 0]);
    }
}

#[test]
fn what_cannot_be_written_leaves_nothing() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("taken.toml")).unwrap();
    let error = convert(&in_memory(), &folder.path().join("taken.toml")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Image);
    assert!(error.to_string().contains("it is a folder"), "{error}");
    assert_eq!(list(folder.path()), [""; 0]);
    assert!(!folder.path().join("taken.files").exists());
    for name in ["x.obj", "x", "x.toml.gz"] {
        let error = convert(&in_memory(), &folder.path().join(name)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidOption);
        assert!(error.to_string().contains(".toml, .glb or .pbrt"), "{error}");
    }
}

#[test]
fn everything_becomes_a_scene_for_pbrt() {
    for builtin in builtin::all() {
        let folder = folder();
        let path = folder.path().join("scene.pbrt");
        let converted = convert(&load_scene(builtin.name).unwrap(), &path).unwrap();
        assert_eq!(converted.files.last(), Some(&path));
        assert!(converted.files.iter().all(|file| file.is_file()));
        let read = load_scene(&path).unwrap();
        read.lower().unwrap();
    }
}
