//! The seeds of the fuzz target: small files that reach every reader. They are in the repository; to
//! write them again, `cargo test -p zrak-gltf --test seeds -- --ignored`.

mod builder;
#[path = "rich/mod.rs"]
mod rich;

use std::path::Path;

use builder::Builder;
use serde_json::json;

/// A triangle with everything that moves vertices, and every odd way to say numbers.
fn deformed() -> Builder {
    let mut file = Builder::triangle();
    let ids = file.accessor("VEC4", 5121, 3, &[0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
    let weights = file.floats(&[[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]);
    let up = file.floats(&[[0.0, 0.0, 1.0]; 3]);
    let uvs = file.accessor("VEC2", 5121, 3, &[0, 255, 0, 0, 255, 0, 0, 0, 9, 9]);
    file.json["accessors"][uvs]["normalized"] = json!(true);
    let view = file.json["bufferViews"].as_array().unwrap().len() - 1;
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    let indices = file.indices(&[0, 1, 2]);
    let at = file.view(&[0, 2]);
    let moved = [0.0_f32, 0.0, 0.0, 0.0, 2.0, 0.0];
    let values = file.view(&moved.map(f32::to_le_bytes).concat());
    file.json["accessors"][0]["sparse"] = json!({"count": 2,
        "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": values}});
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let inverse = file.floats(&[identity; 2]);
    file.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": inverse}));
    file.json["meshes"][0] = json!({"weights": [0.5], "primitives": [{
        "attributes": {"POSITION": 0, "NORMAL": up, "TEXCOORD_0": uvs, "JOINTS_0": ids,
                       "WEIGHTS_0": weights},
        "targets": [{"POSITION": up, "NORMAL": up}], "indices": indices, "mode": 5}]});
    let moves = file.floats(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    let instancing = json!({"attributes": {"TRANSLATION": moves}});
    file.json["nodes"] = json!([
        {"mesh": 0, "skin": 0},
        {"children": [2], "rotation": [0, 0, 0, 1]},
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": instancing}}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 1, 3]);
    file
}

/// A triangle with compressed indices.
fn compressed() -> Builder {
    let mut file = Builder::triangle();
    for (mode, data, n_bytes) in [
        ("INDICES", &[0xd1, 0, 4, 4, 0, 0, 0, 0][..], 2),
        ("TRIANGLES", &[0xe1, 0xf0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], 4),
    ] {
        let view = file.view(data);
        let mut compressed = file.json["bufferViews"][view].clone();
        compressed["mode"] = json!(mode);
        compressed["byteStride"] = json!(n_bytes);
        compressed["count"] = json!(3);
        let view = file.push(
            "bufferViews",
            json!({"buffer": 0, "byteLength": 3 * n_bytes,
                   "extensions": {"EXT_meshopt_compression": compressed}}),
        );
        let component = if n_bytes == 2 { 5123 } else { 5125 };
        let accessor =
            json!({"bufferView": view, "type": "SCALAR", "componentType": component, "count": 3});
        let indices = file.push("accessors", accessor);
        let primitive = json!({"attributes": {"POSITION": 0}, "indices": indices});
        file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }
    file
}

#[test]
fn seeds_are_good_files() {
    for file in [rich::rich(), deformed(), compressed()] {
        file.import_clean();
    }
}

#[test]
#[ignore = "writes into the repository"]
fn write_the_seeds() {
    use base64::Engine as _;
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/gltf");
    std::fs::create_dir_all(&dir).unwrap();
    for (name, mut file) in
        [("rich", rich::rich()), ("deformed", deformed()), ("compressed", compressed())]
    {
        std::fs::write(dir.join(format!("{name}.glb")), file.glb()).unwrap();
        let data = base64::prelude::BASE64_STANDARD.encode(&file.bin);
        let uri = format!("data:application/octet-stream;base64,{data}");
        file.json["buffers"] = json!([{"byteLength": file.bin.len(), "uri": uri}]);
        std::fs::write(dir.join(format!("{name}.gltf")), file.json.to_string()).unwrap();
    }
}
