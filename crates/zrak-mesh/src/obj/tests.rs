//! OBJ files, good and bad.

use proptest::prelude::*;

use super::{Obj, parse};
use crate::Limits;

fn read(text: &str) -> Result<Obj, String> {
    parse(text.as_bytes(), &Limits::default()).map_err(|e| e.to_string())
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn polygons_become_triangles() {
    let text = format!("{SQUARE}v 0.5 2 0\nf 1 2 3 4\nf -3 -1 -2\nf 1 2 3 5 4\n");
    let mesh = read(&text).unwrap().mesh;
    assert_eq!(mesh.triangles.len(), 2 + 1 + 3);
    let at = |v: u32| mesh.positions[v as usize];
    assert_eq!(mesh.triangles[0].map(at), [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles[2].map(at), [[1.0, 1.0, 0.0], [0.5, 2.0, 0.0], [0.0, 1.0, 0.0]]);
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && mesh.colors.is_empty());
    // Equal corners are one vertex.
    assert_eq!(mesh.positions.len(), 5);
}

#[test]
fn corners_with_equal_parts_are_shared() {
    let text = format!(
        "{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0.5\nvn 0 0 1\nvn 0 0 2\n\
         f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/2/1 2/2/1 4/4/1\nf 1//2 3//2 4//2\n"
    );
    let mesh = read(&text).unwrap().mesh;
    assert_eq!(mesh.positions.len(), 4 + 1 + 3);
    assert_eq!((mesh.uvs[2], mesh.uvs[7]), ([1.0, 1.0], [0.0, 0.0]));
    assert_eq!((mesh.normals[0], mesh.normals[7]), ([0.0, 0.0, 1.0], [0.0, 0.0, 2.0]));
}

#[test]
fn smoothing_groups_have_mean_normals_and_other_faces_their_own() {
    // Two squares that meet in the edge of x = 1 at a right angle, and a flat triangle.
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n";
    let bent = format!("{corners}s 1\nf 1 2 3 4\nf 2 5 6 3\n");
    let mesh = read(&bent).unwrap().mesh;
    assert_eq!(mesh.positions.len(), 6);
    let h = 0.5_f32.sqrt();
    for v in 0..6 {
        let [x, y, z] = mesh.positions[v];
        let n = mesh.normals[v];
        let expected = match (x, z) {
            (1.0, 0.0) => [h, 0.0, h],
            (1.0, _) => [1.0, 0.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        let expected = [if x == 1.0 { -expected[0] } else { 0.0 }, expected[1], expected[2]];
        // The second square looks towards -x, as its corners run.
        for i in 0..3 {
            assert!((n[i].abs() - (expected[i]).abs()).abs() < 1e-6, "{y} {n:?}");
        }
    }
    // In two groups, or none, the edge is sharp.
    for (first, second) in [("s 1", "s 2"), ("s 1", "s off"), ("s 0", "s 7")] {
        let text = format!("{corners}{first}\nf 1 2 3 4\n{second}\nf 2 5 6 3\n");
        let mesh = read(&text).unwrap().mesh;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.normals[v as usize]);
            assert!(a == b && b == c, "{first} {second} {a:?} {b:?} {c:?}");
            assert!([a[0].abs(), a[2].abs()].contains(&1.0), "{a:?}");
        }
    }
    // A seam of texture coordinates is no edge.
    let text = format!("{corners}vt 0 0\nvt 1 1\ns 1\nf 1/1 2/1 3/1 4/1\nf 2/2 5/2 6/2 3/2\n");
    let seam = read(&text).unwrap().mesh;
    assert_eq!(seam.positions.len(), 8);
    let normals_at = |p: [f32; 3]| -> Vec<[f32; 3]> {
        (0..8).filter(|&v| seam.positions[v] == p).map(|v| seam.normals[v]).collect()
    };
    let both = normals_at([1.0, 1.0, 0.0]);
    assert!(both.len() == 2 && both[0] == both[1] && both[0][0] != 0.0, "{both:?}");
    // A normal without a length says nothing.
    let text = format!("{SQUARE}vn 0 0 0\nvn 0 1 0\nf 1//1 2//2 3//2\n");
    let mesh = read(&text).unwrap().mesh;
    let own = mesh.triangles[0].map(|v| mesh.normals[v as usize]);
    assert_eq!(own, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn groups_are_materials_or_else_groups() {
    let faces = "f 1 2 3\n";
    let materials = format!(
        "mtllib a b.mtl\no thing\n{SQUARE}g one\n{faces}usemtl red paint\n{faces}g two\n{faces}\
         usemtl blue\n{faces}usemtl red paint\n{faces}"
    );
    let obj = read(&materials).unwrap();
    assert_eq!(obj.mesh.groups, ["", "red paint", "blue"]);
    assert_eq!(obj.mesh.face_groups, [0, 1, 1, 2, 1]);
    assert_eq!(obj.group_lines, [0, 9, 13]);
    assert_eq!(obj.libraries, [("a b.mtl".to_owned(), 1)]);
    assert_eq!((obj.name.as_deref(), obj.has_materials), (Some("thing"), true));
    let groups =
        read(&format!("{SQUARE}g a\ng b\n{faces}g a\n{faces}{faces}g b\n{faces}")).unwrap();
    assert_eq!(groups.mesh.groups, ["a", "b"]);
    assert_eq!(groups.mesh.face_groups, [1, 0, 0, 1]);
    assert!(!groups.has_materials);
    let one = read(&format!("{SQUARE}usemtl a\n{faces}")).unwrap().mesh;
    assert_eq!((one.groups.len(), one.face_groups.len()), (1, 0));
}

#[test]
fn colors_are_srgb_codes() {
    let text = "v 0 0 0 1 0.5019608 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n";
    let mesh = read(text).unwrap().mesh;
    let [r, g, b, a] = mesh.colors[0];
    assert_eq!((r, b, a), (1.0, 0.0, 1.0));
    assert!((g - 0.215_860_5).abs() < 1e-6, "{g}");
    assert_eq!(mesh.colors[2], [1.0; 4]);
    let bytes = "v 0 0 0 255 128 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n";
    let obj = read(bytes).unwrap();
    assert!((obj.mesh.colors[0][1] - 0.215_860_5).abs() < 1e-6);
    assert!(obj.warnings[0].1.contains("bytes"));
    // A weight is no colour.
    assert!(read("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").unwrap().mesh.colors.is_empty());
}

#[test]
fn what_is_left_out_is_said_once() {
    let text = format!(
        "# a comment\n{SQUARE}p 1\nl 1 2\nl 2 3\ncstype bezier\nfoo 1\nfoo 2\nf 1 2 3 # this\nf 1 1 2\n"
    );
    let warnings = read(&text).unwrap().warnings;
    let lines: Vec<usize> = warnings.iter().map(|w| w.0).collect();
    assert_eq!(lines, [6, 9, 10, 0], "{warnings:?}");
    assert!(warnings[3].1.contains("1 triangles without an area"));
}

#[test]
fn what_is_wrong_is_said() {
    let with = |rest: &str| format!("{SQUARE}{rest}");
    for (text, words) in [
        (String::new(), "the file has no vertices"),
        ("# nothing\n".to_owned(), "the file has no vertices"),
        (SQUARE.to_owned(), "vertices but no faces"),
        (with("f 1 2 5\n"), "line 5, column 7: there is no 5 of the vertices: 4 came before"),
        (with("f 1 -5 2\n"), "line 5, column 5: there is no -5 of the vertices"),
        (with("f 0 1 2\n"), "line 5, column 3: there is no index 0"),
        (with("f 1/1 2 3\n"), "line 5, column 5: there is no 1 of the texture coordinates: none"),
        (with("f 1//1 2 3\n"), "column 6: there is no 1 of the normals"),
        (with("f 1 2 99999999999999999999\n"), "column 7: `99999999999999999999` is not an index"),
        (with("f 1 2 4294967297\n"), "there is no 4294967297"),
        (with("f 1 2 3.5\n"), "column 7: `3.5` is not an index"),
        (with("f 1 2 x\n"), "`x` is not an index"),
        (with("f 1 2 /1\n"), "column 7: `` is not an index"),
        (with("vt 0 0\nf 1/1/1/1 2 3\n"), "there is no 1 of the normals"),
        (with("vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n"), "column 3: a corner is `v`"),
        (with("f 1 2\n"), "line 5, column 6: a face has three corners or more, this one 2"),
        (with("f\n"), "this one 0"),
        (with("f 1 1 2\nf 2 2 2\n"), "no face of the file has an area"),
        ("v 0 0\n".to_owned(), "line 1, column 6: a vertex ends here"),
        ("v 0 0 nan\n".to_owned(), "line 1, column 7: `nan` is not a finite number"),
        ("v 0 0 1e39\n".to_owned(), "`1e39` is not a finite number"),
        ("v 0 0 1e13\n".to_owned(), "line 1, column 3: the vertex is farther than 1e12"),
        ("v 0 0 0,5\n".to_owned(), "`0,5` is not a finite number"),
        ("v 0 0 0 1 1 inf\n".to_owned(), "`inf` is not a finite number"),
        ("vn 0 1\n".to_owned(), "a normal ends here"),
        ("vt\n".to_owned(), "texture coordinates ends here"),
        ("mtllib \n".to_owned(), "`mtllib` is followed by"),
        ("ply\n\u{1}\u{2} 1\n".to_owned(), "line 2, column 1: this is not a line of an OBJ file"),
    ] {
        let message = read(&text).unwrap_err();
        assert!(message.contains(words), "{message:?} does not say {words:?}");
    }
}

#[test]
fn memory_is_bounded() {
    let text = "v 0 0 0\n".repeat(10_000);
    let error = parse(text.as_bytes(), &Limits { max_bytes: 100_000 }).unwrap_err();
    assert!(error.to_string().contains("limit of 100000 bytes"), "{error}");
    // Many different vertices at one position take no longer than others.
    let mut text = SQUARE.to_owned();
    for i in 1..=50_000 {
        text += &format!("vt {i} 0\nf 1/{i} 2 3\n");
    }
    assert_eq!(read(&text).unwrap().mesh.triangles.len(), 50_000);
}

proptest! {
    #[test]
    fn damaged_files_do_no_harm(at in any::<usize>(), bytes in any::<[u8; 2]>(), cut in any::<bool>()) {
        let text = format!(
            "mtllib a.mtl\n{SQUARE}vt 0 0\nvn 0 0 1\ns 1\nusemtl a\nf 1/1/1 2/1/1 3//1 4\ng b\\\n c\nf 1 2 -1\n"
        );
        let mut file = text.into_bytes();
        let at = at % file.len();
        if cut {
            file.truncate(at);
        } else {
            file[at] = bytes[0];
            file.insert(at, bytes[1]);
        }
        if let Ok(obj) = parse(&file, &Limits::default()) {
            prop_assert!(obj.mesh.validate().is_ok());
        }
    }
}
