//! Meshes: accessors of every kind, primitives of every mode, what deforms them.

mod builder;

use builder::{Builder, only_mesh};
use serde_json::json;
use zrak_gltf::ErrorKind;

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

/// A file with these positions, and one primitive of this mode.
fn with_mode(positions: &[[f32; 3]], mode: u32) -> Builder {
    let mut file = Builder::triangle();
    let positions = file.floats(positions);
    file.json["meshes"][0]["primitives"][0] =
        json!({"attributes": {"POSITION": positions}, "mode": mode});
    file
}

fn primitive(file: &mut Builder) -> &mut serde_json::Value {
    &mut file.json["meshes"][0]["primitives"][0]
}

#[test]
fn modes_give_their_triangles() {
    let five = [SQUARE.as_slice(), &[[2.0, 0.0, 0.0]]].concat();
    for (positions, mode, expected) in [
        (&SQUARE[..3], 4, vec![[0, 1, 2]]),
        (&SQUARE[..], 5, vec![[0, 1, 2], [1, 3, 2]]),
        (&five, 5, vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (&five, 6, vec![[1, 2, 0], [2, 3, 0], [3, 4, 0]]),
    ] {
        let imported = with_mode(positions, mode).import_clean();
        assert_eq!(only_mesh(&imported).triangles, expected, "mode {mode}");
    }
}

#[test]
fn points_and_lines_are_left_out() {
    for (mode, what) in [(0, "points"), (1, "lines"), (2, "lines"), (3, "lines")] {
        let imported = with_mode(&SQUARE, mode).import_warned(&[what]);
        assert!(imported.desc.objects.is_empty());
    }
    with_mode(&SQUARE, 4).import_warned(&["whole triangles"]);
    with_mode(&SQUARE[..2], 5).import_warned(&["no triangles"]);
    let line = [[0.0; 3], [1.0; 3], [2.0; 3]];
    with_mode(&line, 4).import_warned(&["has an area"]);
    let mut file = Builder::triangle();
    primitive(&mut file)["attributes"] = json!({});
    file.import_warned(&["no POSITION"]);
}

#[test]
fn indices_of_every_width() {
    for (component, bytes) in [
        (5121, vec![0, 1, 2, 2, 1, 3]),
        (5123, [0_u16, 1, 2, 2, 1, 3].iter().flat_map(|x| x.to_le_bytes()).collect()),
        (5125, [0_u32, 1, 2, 2, 1, 3].iter().flat_map(|x| x.to_le_bytes()).collect()),
    ] {
        let mut file = with_mode(&SQUARE, 4);
        let indices = file.accessor("SCALAR", component, 6, &bytes);
        primitive(&mut file)["indices"] = json!(indices);
        let imported = file.import_clean();
        assert_eq!(only_mesh(&imported).triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(only_mesh(&imported).positions, SQUARE);
    }
}

#[test]
fn only_the_vertices_that_are_used_are_taken() {
    let many: Vec<[f32; 3]> = (0..100).map(|i| [i as f32, (i * i) as f32, 0.0]).collect();
    let mut file = with_mode(&many, 4);
    let indices = file.indices(&[70, 20, 90, 90, 20, 5]);
    let colors: Vec<[f32; 3]> = (0..100).map(|i| [i as f32 / 100.0, 0.0, 0.0]).collect();
    let colors = file.floats(&colors);
    primitive(&mut file)["indices"] = json!(indices);
    primitive(&mut file)["attributes"]["COLOR_0"] = json!(colors);
    let imported = file.import_clean();
    let mesh = only_mesh(&imported);
    assert_eq!(mesh.positions, [5, 20, 70, 90].map(|i| many[i]));
    assert_eq!(mesh.triangles, [[2, 1, 3], [3, 1, 0]]);
    assert_eq!(mesh.colors[2], [0.7, 0.0, 0.0, 1.0]);
}

#[test]
fn degenerate_triangles_are_dropped() {
    let mut file = with_mode(&SQUARE, 5);
    let indices = file.indices(&[0, 1, 2, 2, 3]);
    primitive(&mut file)["indices"] = json!(indices);
    assert_eq!(only_mesh(&file.import_clean()).triangles, [[0, 1, 2]]);
}

#[test]
fn attributes_are_read() {
    let mut file = Builder::triangle();
    let normals = file.floats(&[[0.0, 0.0, 1.0]; 3]);
    let tangents = file.floats(&[[2.0, 0.0, 0.0, -1.0]; 3]);
    let uvs = file.floats(&[[0.25, 0.0], [1.0, 0.75], [-1.0, 2.0]]);
    // Normalised numbers of 8 and 16 bits.
    let colors = file.accessor("VEC4", 5121, 3, &[255, 0, 51, 255, 0, 0, 0, 0, 1, 2, 3, 4]);
    file.json["accessors"][colors]["normalized"] = json!(true);
    primitive(&mut file)["attributes"] = json!({
        "POSITION": 0, "NORMAL": normals, "TANGENT": tangents, "TEXCOORD_0": uvs, "COLOR_0": colors
    });
    let imported = file.import_clean();
    let mesh = only_mesh(&imported);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.tangents, [[1.0, 0.0, 0.0, -1.0]; 3]);
    // v points up.
    assert_eq!(mesh.uvs, [[0.25, 1.0], [1.0, 0.25], [-1.0, -1.0]]);
    assert_eq!(mesh.colors[0], [1.0, 0.0, 0.2, 1.0]);
    assert_eq!(mesh.colors[2], [1.0, 2.0, 3.0, 4.0].map(|x| x / 255.0));
}

#[test]
fn bad_directions_are_mended() {
    let mut file = Builder::triangle();
    let normals = file.floats(&[[0.0, 0.0, 1.0], [0.0; 3], [f32::NAN, 0.0, 1.0]]);
    let tangents = file.floats(&[[0.0; 4]; 3]);
    primitive(&mut file)["attributes"] =
        json!({"POSITION": 0, "NORMAL": normals, "TANGENT": tangents});
    let imported = file.import_clean();
    // Those of the triangle, as it lies.
    assert_eq!(only_mesh(&imported).normals, [[0.0, 0.0, 1.0]; 3]);
    assert!(only_mesh(&imported).tangents.is_empty());
}

#[test]
fn interleaved_attributes_are_read() {
    let mut file = Builder::triangle();
    let vertex = |x: f32| [x, x * x, 0.0, 0.0, 0.0, 1.0, 9.0];
    let bytes: Vec<u8> =
        [0.0, 1.0, 4.0].into_iter().flat_map(vertex).flat_map(f32::to_le_bytes).collect();
    let view = file.view(&bytes);
    file.json["bufferViews"][view]["byteStride"] = json!(28);
    let mut accessor = |offset: u32| {
        let kind = json!({"bufferView": view, "byteOffset": offset, "type": "VEC3",
                          "componentType": 5126, "count": 3});
        file.push("accessors", kind)
    };
    let (positions, normals) = (accessor(0), accessor(12));
    primitive(&mut file)["attributes"] = json!({"POSITION": positions, "NORMAL": normals});
    let imported = file.import_clean();
    assert_eq!(only_mesh(&imported).positions[2], [4.0, 16.0, 0.0]);
    assert_eq!(only_mesh(&imported).normals, [[0.0, 0.0, 1.0]; 3]);
}

#[test]
fn sparse_accessors_differ_where_they_say() {
    for has_base in [true, false] {
        let mut file = Builder::triangle();
        let at = file.view(&[0, 2]);
        let values: Vec<u8> =
            [7.0_f32, 8.0, 9.0, 1.0, 1.0, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let values = file.view(&values);
        let accessor = &mut file.json["accessors"][0];
        accessor["sparse"] = json!({"count": 2,
            "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": values}});
        if !has_base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        let imported = file.import_clean();
        let middle = if has_base { [1.0, 0.0, 0.0] } else { [0.0; 3] };
        assert_eq!(only_mesh(&imported).positions, [[7.0, 8.0, 9.0], middle, [1.0; 3]]);
    }
}

#[test]
fn quantized_attributes_are_read() {
    let mut file = Builder::triangle();
    let words = |words: &[i16]| words.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    // Three numbers, and one to keep the stride a multiple of four.
    let positions =
        file.accessor("VEC3", 5122, 3, &words(&[0, 0, 0, 0, 300, 0, 0, 0, 0, -300, 0, 0]));
    let view = file.json["accessors"][positions]["bufferView"].clone();
    file.json["bufferViews"][view.as_u64().unwrap() as usize]["byteStride"] = json!(8);
    let normals = file.accessor("VEC3", 5120, 3, &[0, 0, 0x81, 0, 0, 0, 127, 0, 0, 0x80, 0, 0]);
    file.json["accessors"][normals]["normalized"] = json!(true);
    let view = file.json["accessors"][normals]["bufferView"].clone();
    file.json["bufferViews"][view.as_u64().unwrap() as usize]["byteStride"] = json!(4);
    let uvs = file.accessor("VEC2", 5123, 3, &words(&[-1, 0, 0, 0, 0, 0]));
    file.json["accessors"][uvs]["normalized"] = json!(true);
    primitive(&mut file)["attributes"] =
        json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs});
    file.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let imported = file.import_clean();
    let mesh = only_mesh(&imported);
    assert_eq!(mesh.positions, [[0.0; 3], [300.0, 0.0, 0.0], [0.0, -300.0, 0.0]]);
    // -127 and -128 are both -1.
    assert_eq!(mesh.normals, [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]);
    assert_eq!(mesh.uvs[0], [1.0, 1.0]);
}

#[test]
fn compressed_views_are_read() {
    let mut file = Builder::triangle();
    // Three indices, 0, 1 and 2: differences of 0, 1 and 1 from the first baseline.
    let data = file.view(&[0xd1, 0, 4, 4, 0, 0, 0, 0]);
    let mut view = file.json["bufferViews"][data].clone();
    view["mode"] = json!("INDICES");
    view["byteStride"] = json!(2);
    view["count"] = json!(3);
    let fallback = json!({"buffer": 1, "byteLength": 6,
                          "extensions": {"EXT_meshopt_compression": view}});
    let view = file.push("bufferViews", fallback);
    let accessor = json!({"bufferView": view, "type": "SCALAR", "componentType": 5123, "count": 3});
    let indices = file.push("accessors", accessor);
    primitive(&mut file)["indices"] = json!(indices);
    file.json["buffers"] = json!([{"byteLength": file.bin.len()}, {"byteLength": 6}]);
    file.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    assert_eq!(only_mesh(&file.import_clean()).triangles, [[0, 1, 2]]);
}

#[test]
fn draco_is_named() {
    let mut file = Builder::triangle();
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    primitive(&mut file)["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    file.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let error = file.import().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert_eq!(error.location(), "meshes[0].primitives[0]");
    assert!(error.to_string().contains("KHR_draco_mesh_compression"));
}

#[test]
fn morph_targets_are_applied() {
    let mut file = Builder::triangle();
    let up = file.floats(&[[0.0, 0.0, 1.0]; 3]);
    let right = file.floats(&[[1.0, 0.0, 0.0]; 3]);
    primitive(&mut file)["targets"] = json!([{"POSITION": up}, {"POSITION": right}]);
    file.json["meshes"][0]["weights"] = json!([0.5, 0.0]);
    assert_eq!(only_mesh(&file.import_clean()).positions[1], [1.0, 0.0, 0.5]);
    // Each node may have its own.
    file.push("nodes", json!({"mesh": 0, "weights": [1.0, 2.0]}));
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    let imported = file.import_clean();
    assert_eq!((imported.desc.meshes.len(), imported.desc.objects.len()), (2, 2));
    assert!(imported.desc.prototypes.is_empty());
}

#[test]
fn skins_are_posed_by_their_joints() {
    let mut file = Builder::triangle();
    let ids = file.accessor("VEC4", 5121, 3, &[0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
    let weights = file.floats(&[[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]]);
    let normals = file.floats(&[[0.0, 1.0, 0.0]; 3]);
    primitive(&mut file)["attributes"] =
        json!({"POSITION": 0, "NORMAL": normals, "JOINTS_0": ids, "WEIGHTS_0": weights});
    // The second joint was bound at x = 10 and now is at y = 5.
    let unit =
        |x: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, 0.0, 0.0, 1.0];
    let inverse = file.floats(&[unit(0.0), unit(-10.0)]);
    file.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": inverse}));
    file.push("nodes", json!({}));
    file.push("nodes", json!({"translation": [0.0, 5.0, 0.0]}));
    // The node's own place does not count.
    file.json["nodes"][0] = json!({"mesh": 0, "skin": 0, "translation": [100.0, 0.0, 0.0]});
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let imported = file.import_clean();
    let mesh = only_mesh(&imported);
    assert_eq!(mesh.positions, [[0.0; 3], [-9.0, 5.0, 0.0], [-5.0, 3.5, 0.0]]);
    assert_eq!(mesh.normals, [[0.0, 1.0, 0.0]; 3]);
}
