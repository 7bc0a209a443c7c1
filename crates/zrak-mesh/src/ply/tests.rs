//! PLY files, good and bad.

use proptest::prelude::*;

use super::{parse, write};
use crate::{Limits, TriangleMesh};

fn read(bytes: &[u8]) -> Result<TriangleMesh, String> {
    parse(bytes, &Limits::default()).map_err(|e| e.to_string())
}

/// A header of these lines, and a body.
fn file(format: &str, lines: &[&str], body: &[u8]) -> Vec<u8> {
    let mut text = format!("ply\nformat {format} 1.0\n");
    for line in lines {
        text += line;
        text += "\n";
    }
    [text.as_bytes(), b"end_header\n", body].concat()
}

const SQUARE: [&str; 6] = [
    "element vertex 4",
    "property float x",
    "property float y",
    "property float z",
    "element face 1",
    "property list uchar int vertex_indices",
];

#[test]
fn text_is_read() {
    let body = b"0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    let mesh = read(&file("ascii", &SQUARE, body)).unwrap();
    assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn bytes_of_both_orders_are_read() {
    for big in [false, true] {
        let mut body = Vec::new();
        let f = |x: f32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
        for p in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]] {
            p.iter().for_each(|&x| body.extend(f(x)));
        }
        body.push(4);
        for i in [0_i32, 1, 2, 3] {
            body.extend(if big { i.to_be_bytes() } else { i.to_le_bytes() });
        }
        let format = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mesh = read(&file(format, &SQUARE, &body)).unwrap();
        assert_eq!(mesh.positions[3], [0.0, 1.0, 0.5]);
        assert_eq!(mesh.triangles.len(), 2);
    }
}

#[test]
fn attributes_and_unknown_elements() {
    let lines = [
        "comment made by hand",
        "element camera 1",
        "property double x",
        "property list int short trail",
        "element vertex 3",
        "property uchar red",
        "property double z",
        "property float y",
        "property float x",
        "property ushort quality",
        "property uchar green",
        "property uchar blue",
        "property float s",
        "property float t",
        "property float nx",
        "property float ny",
        "property float nz",
        "element face 1",
        "property float area",
        "property list uchar uint vertex_index",
        "property list uchar float texcoord",
    ];
    let body = b"1.5 3 1 2 3\n\
                 255 3 2 1 9 0 128 0.25 0.75 0 0 1\n\
                 0 3 2 5 9 0 0 0 0 0 0 1\n\
                 0 3 8 1 9 0 0 0 0 0 0 1\n\
                 0.5 3 0 1 2 2 0.5 0.5\n";
    let mesh = read(&file("ascii", &lines, body)).unwrap();
    assert_eq!(mesh.positions[0], [1.0, 2.0, 3.0]);
    assert_eq!(mesh.normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.uvs[0], [0.25, 0.75]);
    // 128 of 255 is 0.2158605 in linear light.
    let [r, g, b, a] = mesh.colors[0];
    assert_eq!((r, g, a), (1.0, 0.0, 1.0));
    assert!((b - 0.215_860_5).abs() < 1e-6, "{b}");
}

#[test]
fn what_is_wrong_is_said() {
    let good = b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n".as_slice();
    let ascii = |body: &[u8]| read(&file("ascii", &SQUARE, body)).unwrap_err();
    let header = |lines: &[&str]| read(&file("ascii", lines, good)).unwrap_err();
    for (message, words) in [
        (read(b"plx\n").unwrap_err(), "line 1: a PLY file begins"),
        (read(b"").unwrap_err(), "end_header"),
        (read(b"ply\nformat ascii 1.0\n").unwrap_err(), "line 3: the header has no `end_header`"),
        (read(b"ply\n\xff\xff\n").unwrap_err(), "line 2: the header is not text"),
        (read(b"ply\nend_header\n").unwrap_err(), "no `format`"),
        (read(&file("binary", &SQUARE, good)).unwrap_err(), "unknown format `binary`"),
        (header(&["element vertex many"]), "`many` is not a number"),
        (header(&["property float x"]), "before any element"),
        (header(&["element vertex 1", "property real x"]), "unknown type"),
        (header(&["elephant"]), "`elephant` is not understood"),
        (header(&["element vertex 2", "property float x"]), "lack x, y or z"),
        (
            ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1\n4 0 1 2 3\n"),
            "line 13, column 4: element `vertex` number 3 ends",
        ),
        (
            ascii(b"0 0 0\n1 0 zero\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
            "line 11, column 5: `zero` is not a number",
        ),
        (ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n"), "ends within"),
        (ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n\n \n"), "ends within element `face` number 0"),
        (ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 4\n"), "face 0 has a corner 4"),
        (ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 -1\n"), "face 0 has a corner -1"),
        (ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n"), "no triangles"),
        (ascii(b"0 0 0\n1 0 nan\n1 1 0\n0 1 0\n4 0 1 2 3\n"), "vertex 1 of the mesh is not finite"),
        (
            ascii(b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n99999999 0 1 2 3\n"),
            "line 14, column 1: a list `vertex_indices` of 99999999 entries",
        ),
    ] {
        assert!(message.contains(words), "{message:?} does not say {words:?}");
    }
}

#[test]
fn polygons_of_bytes_of_any_type_are_read() {
    for (count, index) in
        [("uchar", "uchar"), ("int", "ushort"), ("char", "uint"), ("ushort", "short")]
    {
        for big in [false, true] {
            let mut body = Vec::new();
            let put = |body: &mut Vec<u8>, kind: &str, x: u8| {
                let n = match kind {
                    "uchar" | "char" => 1,
                    "ushort" | "short" => 2,
                    _ => 4,
                };
                let at = if big { n - 1 } else { 0 };
                body.extend((0..n).map(|i| if i == at { x } else { 0 }));
            };
            for p in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                for x in [p[0], p[1], 0.0_f32] {
                    body.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
                }
            }
            let faces: [&[u8]; 3] = [&[0, 1, 2], &[0, 1, 2, 3], &[1, 2, 3]];
            for (i, face) in faces.iter().enumerate() {
                body.push(7);
                put(&mut body, count, face.len() as u8);
                face.iter().for_each(|&x| put(&mut body, index, x));
                body.push(i as u8);
            }
            let list = format!("property list {count} {index} vertex_index");
            let lines = [
                &SQUARE[..4],
                &["element face 3", "property uchar flags", &list, "property uchar group"],
            ]
            .concat();
            let format = if big { "binary_big_endian" } else { "binary_little_endian" };
            let mesh = read(&file(format, &lines, &body)).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3], [1, 2, 3]]);
            assert_eq!(
                (mesh.face_groups.as_slice(), mesh.groups.len()),
                ([0, 1, 1, 2].as_slice(), 3)
            );
            // Cut off anywhere, it is refused.
            for len in 0..body.len() {
                let error = read(&file(format, &lines, &body[..len])).unwrap_err();
                assert!(error.contains("the file ends"), "{error}");
            }
        }
    }
}

#[test]
fn claims_are_not_believed() {
    let lines = [
        "element vertex 1000000000000",
        "property float x",
        "property float y",
        "property float z",
    ];
    for format in ["ascii", "binary_little_endian"] {
        let error = read(&file(format, &lines, &[0; 1000])).unwrap_err();
        assert!(error.contains("1000000000000 elements"), "{error}");
    }
    // Elements without a size, as many as there may be.
    let error =
        read(&file("binary_big_endian", &["element nothing 99999999999"], b"")).unwrap_err();
    assert!(error.contains("the file ends before"), "{error}");
    // More than the limit, though it is all there.
    let body = "0 0 0\n".repeat(1000);
    let lines = ["element vertex 1000", lines[1], lines[2], lines[3]];
    let error = parse(&file("ascii", &lines, body.as_bytes()), &Limits { max_bytes: 10_000 });
    assert!(error.unwrap_err().to_string().contains("limit"));
}

#[test]
fn gzip_bombs_stop_at_the_limit() {
    use std::io::Write;
    let folder = std::env::temp_dir().join(format!("zrak-mesh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("bomb.ply.gz");
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packed.write_all(&vec![b'\n'; 20_000_000]).unwrap();
    std::fs::write(&path, packed.finish().unwrap()).unwrap();
    let error = super::read(&path, &Limits { max_bytes: 1_000_000 }).unwrap_err().to_string();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(error.contains("larger than the limit"), "{error}");
}

/// A mesh of a few vertices with any of the attributes.
fn any_mesh() -> impl Strategy<Value = TriangleMesh> {
    (3_usize..20, any::<[bool; 5]>(), any::<u32>()).prop_map(|(n, has, seed)| {
        let [normals, uvs, colors, tangents, groups] = has;
        let mut state = seed;
        let mut random = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 1e5 - 80.0
        };
        let mut mesh = TriangleMesh::default();
        for i in 0..n {
            mesh.positions.push([random(), random(), random()]);
            if normals {
                mesh.normals.push([random(), random(), random()]);
            }
            if uvs {
                mesh.uvs.push([random(), random()]);
            }
            if colors {
                mesh.colors.push([random(), random(), random(), random()]);
            }
            if tangents {
                mesh.tangents.push([random(), random(), random(), 1.0]);
            }
            if i >= 2 {
                mesh.triangles.push([0, i as u32 - 1, i as u32]);
                if groups {
                    mesh.face_groups.push(i as u32 % 3);
                }
            }
        }
        mesh.drop_degenerate();
        let n_groups = mesh.face_groups.iter().max().map_or(0, |g| g + 1);
        mesh.groups = (0..n_groups).map(|i| i.to_string()).collect();
        mesh
    })
}

proptest! {
    #[test]
    fn what_is_written_is_read(mesh in any_mesh()) {
        prop_assume!(!mesh.triangles.is_empty());
        let mut bytes = Vec::new();
        write(&mut bytes, &mesh).unwrap();
        prop_assert_eq!(read(&bytes), Ok(mesh));
    }

    #[test]
    fn damaged_files_do_no_harm(mesh in any_mesh(), at in any::<usize>(), byte in any::<u8>(), cut in any::<bool>()) {
        let mut bytes = Vec::new();
        write(&mut bytes, &mesh).unwrap();
        let at = at % bytes.len();
        if cut {
            bytes.truncate(at);
        } else {
            bytes[at] = byte;
        }
        let _ = read(&bytes);
    }
}
