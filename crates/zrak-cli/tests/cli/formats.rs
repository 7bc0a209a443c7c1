//! Scenes of other formats: rendered, converted, described.

use serde_json::{Value, json};

use crate::harness::Folder;

/// A quad in the plane z = 0 with a texture, seen by two cameras, lit by a lamp; in `quad.gltf`, with
/// its bytes in `quad.bin` and its picture in `quad.png`.
fn quad(folder: &Folder) -> Value {
    let corners: [[f32; 3]; 4] =
        [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let uvs: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    folder.write("quad.bin", &bytes);
    folder.ok("render earth --width 16 --height 16 --spp 4 -q -o quad.png");
    let lens = json!({"yfov": 0.8, "aspectRatio": 1.0, "znear": 0.1});
    let file = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3], "name": "all"}, {"nodes": [0], "name": "bare"}],
        "nodes": [
            {"mesh": 0},
            {"camera": 0, "name": "Front", "translation": [0, 0, 3]},
            {"camera": 0, "name": "Behind", "translation": [0, 0, -3], "rotation": [0, 1, 0, 0]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 2]}
        ],
        "cameras": [{"type": "perspective", "perspective": lens}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness":
            {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0}}],
        "textures": [{"source": 0}],
        "images": [{"uri": "quad.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4,
             "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 4},
            {"bufferView": 2, "componentType": 5123, "type": "SCALAR", "count": 6}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12}
        ],
        "buffers": [{"uri": "quad.bin", "byteLength": 92}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual":
            {"lights": [{"type": "point", "intensity": 6830.0}]}}
    });
    folder.write("quad.gltf", file.to_string());
    file
}

const SMALL: &str = "--height 16 --spp 4 -q";

#[test]
fn gltf_is_rendered_with_the_camera_that_is_asked_for() {
    let folder = Folder::new();
    quad(&folder);
    let ended = folder.ok("render quad.gltf --height 16 --spp 4 -o first.pfm");
    assert!(ended.stderr.contains("warning: quad.gltf: cameras: the scene has 2"), "{ended:?}");
    folder.ok(&format!("render quad.gltf {SMALL} --camera Front -o front.pfm"));
    folder.ok(&format!("render quad.gltf {SMALL} --camera 1 -o number.pfm"));
    folder.ok(&format!("render quad.gltf {SMALL} --camera Behind -o behind.pfm"));
    folder.ok("compare first.pfm front.pfm --identical");
    folder.ok("compare behind.pfm number.pfm --identical");
    // The lamp is on the other side.
    folder.fails("compare behind.pfm front.pfm --max-rmse 0.01", 1, &["over the limit"]);
    folder.fails("render quad.gltf --camera Left", 3, &["no camera 'Left'", "Front, Behind"]);
    folder.fails("render quads --camera Left", 2, &["error: ", "only glTF files"]);
    // Another scene, which has no camera and no lamp of its own.
    folder.ok(&format!("render quad.gltf {SMALL} --gltf-scene bare -o bare.pfm"));
    folder.ok(&format!("render quad.gltf {SMALL} --gltf-scene 1 -o bare1.pfm"));
    folder.ok("compare bare.pfm bare1.pfm --identical");
    folder.fails("render quad.gltf --gltf-scene none", 3, &["no scene 'none'", "all, bare"]);
    folder.fails("render quads --gltf-scene 1", 2, &["only glTF files"]);
    // Units of light, and backs that are holes.
    let mean = |options: &str| {
        folder.ok(&format!("render quad.gltf {SMALL} {options} -o mean.pfm"));
        let pfm = folder.read("mean.pfm");
        let values = pfm[pfm.len() - 16 * 16 * 12..].chunks_exact(4);
        values.map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).sum::<f64>()
    };
    let (plain, brighter) = (mean("--camera Front"), mean("--camera Front --lumens-per-watt 68.3"));
    assert!((brighter / plain - 10.0).abs() < 1e-3, "{brighter} {plain}");
    folder.fails("render quad.gltf --lumens-per-watt 0", 2, &["more than 0"]);
    assert_eq!(mean("--camera Behind --cull-back-faces"), 0.0);
}

#[test]
fn missing_pictures_are_an_error_or_a_warning() {
    let folder = Folder::new();
    quad(&folder);
    std::fs::remove_file(folder.path("quad.png")).unwrap();
    let render = "render quad.gltf --height 8 --spp 1 --camera Front -o x.pfm";
    folder.fails(render, 3, &["error: quad.gltf: textures.", "quad.png", "No such file"]);
    let ended = folder.ok(&format!("{render} --missing-textures warn"));
    for words in ["warning: quad.gltf: textures.", "quad.png", "mid grey stands for it"] {
        assert!(ended.stderr.contains(words), "{ended:?}");
    }
    let quiet = folder.ok(&format!("{render} --missing-textures warn -q"));
    assert_eq!(quiet.stderr, "");
    folder.fails(&format!("{render} --missing-textures pink"), 2, &["error, warn"]);
    // The same in a scene file, where the place is shown.
    let scene = folder.ok("export earth --width 16 --spp 1").stdout;
    folder.write("earth.toml", scene.replace("builtin:earth.png", "none.png"));
    folder.fails("render earth.toml -q", 3, &["earth.toml:", "^", "none.png"]);
    let ended = folder.ok("render earth.toml --missing-textures warn -o x.pfm");
    assert!(ended.stderr.contains("none.png"), "{ended:?}");
}

#[test]
fn files_elsewhere_are_read_only_if_that_is_allowed() {
    let folder = Folder::new();
    let mut file = quad(&folder);
    std::fs::create_dir(folder.path("in")).unwrap();
    file["buffers"][0]["uri"] = json!("../quad.bin");
    file["images"][0]["uri"] = json!("../quad.png");
    folder.write("in/quad.gltf", file.to_string());
    folder.ok("convert quad.gltf -q -o quad.toml");
    let toml = String::from_utf8(folder.read("quad.toml")).unwrap();
    folder.write("in/quad.toml", toml.replace("\"quad.png\"", "\"../quad.png\""));
    folder.write(
        "quad.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
        property float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    );
    let pbrt = "Camera \"perspective\"\nWorldBegin\nShape \"plymesh\" \"string filename\" \"../quad.ply\"\n";
    folder.write("in/mesh.pbrt", pbrt);
    let scene = folder.ok("export quads").stdout;
    let mesh = "[meshes]\nm = { kind = \"file\", path = \"../quad.ply\" }\n";
    let object = "[[objects]]\nkind = \"mesh\"\nmesh = \"m\"\nmaterial = \"left_red\"\n";
    folder.write("in/mesh.toml", format!("{scene}\n{mesh}\n{object}"));
    for scene in ["quad.gltf", "quad.toml", "mesh.pbrt", "mesh.toml"] {
        let render = format!("render in/{scene} --height 8 --spp 1 -q -o x.pfm");
        folder.fails(&render, 3, &["folder"]);
        folder.ok(&format!("{render} --allow-external"));
        folder.fails(&format!("convert in/{scene} -o out.glb"), 3, &["folder"]);
        assert!(!folder.path("out.glb").exists());
    }
}

#[test]
fn memory_is_bounded_for_every_format() {
    let folder = Folder::new();
    quad(&folder);
    // A picture of 4096 x 4096 texels in a few thousand bytes.
    folder.ok("render simple-light --width 64 --height 64 --spp 1 -q -o small.png");
    let ended = folder.ok("convert quad.gltf -q -o quad.toml");
    assert_eq!(ended.stderr, "");
    folder.write(
        "mesh.pbrt",
        "Camera \"perspective\"\nWorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n",
    );
    for (scene, bytes, words) in [
        ("quad.gltf", "1k", "more than the 1024 bytes"),
        ("quad.toml", "500", "the file has more than the 500 bytes"),
        ("mesh.pbrt", "10", "the limit of 10 bytes"),
        ("final", "1M", "the scene takes more memory than the limit of 1048576 bytes"),
    ] {
        let render = format!("render {scene} --height 8 --spp 1 -q -o x.pfm --max-bytes {bytes}");
        folder.fails(&render, 3, &["error", words]);
    }
    folder.fails("render quad.gltf --max-bytes 0", 2, &["--max-bytes", "from 1 byte"]);
    folder.fails("render quad.gltf --max-bytes many", 2, &["such as 500M or 16G"]);
}

#[test]
fn a_converted_scene_renders_the_same_picture() {
    let folder = Folder::new();
    quad(&folder);
    let seeds = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds/gltf");
    std::fs::copy(format!("{seeds}/rich.glb"), folder.path("rich.glb")).unwrap();
    std::fs::create_dir(folder.path("sub")).unwrap();
    for (scene, output) in [
        ("quad.gltf", "quad.toml"),
        ("rich.glb", "rich.toml"),
        ("rich.glb", "sub/rich.toml"),
        ("quad.gltf", "sub/quad.toml"),
        ("sub/rich.toml", "again.toml"),
    ] {
        folder.ok(&format!("convert {scene} -o {output} --height 20 --spp 3"));
        folder.ok(&format!("render {scene} --height 20 --spp 3 -q -o a.pfm"));
        folder.ok(&format!("render {output} -q -o b.pfm"));
        folder.ok("compare a.pfm b.pfm --identical");
    }
    // What stays in the folder is not copied, and what does not is.
    assert!(!folder.path("quad.files").exists());
    assert!(folder.path("sub/quad.files/quad.png").is_file());
    assert!(folder.path("sub/rich.files").is_dir());
    // Through glTF, as far as that goes: the material's parameters are in single precision there.
    folder.ok("convert quad.gltf -o twice.glb -q");
    folder.ok(&format!("render quad.gltf {SMALL} -o a.pfm"));
    folder.ok(&format!("render twice.glb {SMALL} -o b.pfm"));
    folder.ok("compare a.pfm b.pfm --max-rmse 0.01");
}

#[test]
fn a_conversion_says_what_is_lost_and_where_it_cannot_write() {
    let folder = Folder::new();
    let ended = folder.ok("convert cover -o cover.glb");
    assert!(ended.stderr.contains("warning: "), "{ended:?}");
    assert_eq!(folder.read("cover.glb")[..4], *b"glTF");
    assert_eq!(folder.ok("convert cover -o cover.glb --quiet").stderr, "");
    folder.fails(
        "convert cover -o cover.obj",
        2,
        &["error: ", "cover.obj", ".toml, .glb or .pbrt"],
    );
    folder.fails("convert cover -o none/cover.glb", 4, &["none/cover.glb", "folder"]);
    folder.fails("convert none.pbrt -o x.toml", 3, &["none.pbrt"]);
    folder.write("model.fbx", "Kaydara");
    folder.fails("render model.fbx", 3, &["model.fbx", "no .fbx files", ".gltf"]);
    assert_eq!(folder.list(), ["cover.glb", "model.fbx"]);
}

#[test]
fn damaged_gltf_is_refused_with_its_place() {
    let folder = Folder::new();
    let mut file = quad(&folder);
    file["meshes"][0]["primitives"][0]["indices"] = json!(7);
    folder.write("bad.gltf", file.to_string());
    folder.fails("render bad.gltf", 3, &["error: bad.gltf: meshes[0].primitives[0].indices"]);
    folder.write("bad.glb", "glTF");
    folder.fails("info bad.glb", 3, &["error: bad.glb"]);
    folder.write("text.gltf", "{\"asset\": ");
    folder.fails("convert text.gltf", 3, &["error: text.gltf"]);
    folder.fails("render none.glb", 3, &["none.glb", "No such file"]);
}

#[test]
fn info_counts_what_is_in_a_scene() {
    let folder = Folder::new();
    quad(&folder);
    let text = folder.ok("info quad.gltf").stdout;
    for line in [
        "scene",
        "camera",
        "bounds",
        "primitives",
        "  mesh triangle",
        "materials",
        "lights",
        "images",
    ] {
        assert!(text.lines().any(|found| found.starts_with(line)), "no {line} in {text}");
    }
    assert!(text.contains("  quad.png"), "{text}");
    let json = folder.ok("info quad.gltf --json").json();
    assert_eq!(json["primitives"]["unique"], 2);
    assert_eq!(json["primitives"]["kinds"][0]["kind"], "mesh triangle");
    let lights = json!([{"kind": "point", "count": 1}]);
    assert_eq!(json["lights"], lights);
    assert_eq!(json["images"][0]["path"], "quad.png");
    assert_eq!(
        (&json["images"][0]["width"], &json["images"][0]["bytes"]),
        (&16.into(), &1024.into())
    );
    assert_eq!(json["camera"]["position"], json!([0.0, 0.0, 3.0]));
    assert!(json["warnings"][0].as_str().unwrap().contains("2 cameras"));
    let memory = json["memory"].as_array().unwrap().iter();
    let sum: u64 = memory.map(|entry| entry["bytes"].as_u64().unwrap()).sum();
    assert!(sum > 0 && sum <= json["memory_bytes"].as_u64().unwrap());
    for name in ["final", "workshop", "everything"] {
        let json = folder.ok(&format!("info {name} --json")).json();
        assert!(json["primitives"]["placed"].as_u64() >= json["primitives"]["unique"].as_u64());
        assert_eq!(json["scene"], name);
    }
    folder.fails("info nothing", 3, &["'nothing'"]);
}
