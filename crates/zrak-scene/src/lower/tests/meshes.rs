//! Meshes in files.

use super::{arena, scene};
use crate::desc::{MeshDesc, ObjectDesc, SceneDesc};
use crate::lower::{LowerOptions, lower};

fn mesh(name: &str) -> ObjectDesc {
    ObjectDesc::Mesh {
        mesh: name.to_owned(),
        material: "m".to_owned(),
        group_materials: Vec::new(),
        flip: false,
        transform: Vec::new(),
    }
}

fn with_files(objects: &[&str], files: &[(&str, &str)]) -> SceneDesc {
    let mut desc = scene(objects.iter().map(|name| mesh(name)).collect());
    for (name, path) in files {
        desc.meshes.insert((*name).to_owned(), MeshDesc::File { path: (*path).to_owned() });
    }
    desc
}

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

#[test]
fn the_file_and_its_form_make_no_difference() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.obj"), OBJ).unwrap();
    std::fs::write(folder.path().join("b.ply"), PLY).unwrap();
    let options = LowerOptions::new(folder.path());
    let inline = MeshDesc::Inline {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
    };
    let mut written_out = scene(vec![mesh("a"), mesh("b")]);
    written_out.meshes.insert("a".to_owned(), inline.clone());
    written_out.meshes.insert("b".to_owned(), inline);
    let expected = arena(&written_out);
    let read = with_files(&["a", "b"], &[("a", "a.obj"), ("b", "b.ply")]);
    let read = lower(&read, &options).unwrap();
    assert!(read.bytes() == expected.bytes());
}

#[test]
fn errors_come_in_the_order_of_the_objects() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    std::fs::write(folder.path().join("bad.ply"), "plx\n").unwrap();
    let options = LowerOptions::new(folder.path());
    let files = [("a", "none.ply"), ("b", "bad.obj"), ("c", "bad.ply")];
    let mut desc = with_files(&["c", "b", "a", "b"], &files);
    let Err(problems) = lower(&desc, &options) else { panic!("there are no such files") };
    let messages: Vec<String> =
        problems.iter().map(|p| format!("{}: {}", p.path, p.message)).collect();
    let expected = [
        "meshes.c",
        "bad.obj: line 2, column 5: there is no 2 of the vertices: 1 came before",
        "none.ply",
    ];
    assert!(messages.len() >= expected.len(), "{messages:#?}");
    for (message, words) in messages.iter().zip(expected) {
        assert!(message.contains(words), "{messages:#?} lack {words}");
    }
    // What is not placed is not read.
    desc.objects.clear();
    desc.prototypes.insert("unused".to_owned(), vec![mesh("a")]);
    assert!(lower(&desc, &options).is_ok());
}
