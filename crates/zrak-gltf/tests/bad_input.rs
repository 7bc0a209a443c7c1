//! Bad input: an error that says where and what, never a panic or unbounded memory.

mod builder;

use builder::Builder;
use proptest::prelude::*;
use serde_json::{Value, json};
use zrak_gltf::{ErrorKind, ImportOptions, Limits, parse_gltf};

type Change = fn(&mut Builder);

#[test]
fn contradictions_are_found_where_they_are() {
    use ErrorKind::{Invalid, Io, NotGltf, Syntax, TooLarge, Unsupported};
    let skinned: Change = |f| {
        let n = f.floats(&[[1.0; 4]; 3]);
        let ids = f.accessor("VEC4", 5121, 3, &[9; 12]);
        f.push("skins", json!({"joints": [0]}));
        f.json["nodes"][0]["skin"] = json!(0);
        f.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(n);
        f.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(ids);
    };
    let cases: &[(Change, ErrorKind, &str, &str)] = &[
        (|f| f.json = json!([]), NotGltf, "asset", "version"),
        (|f| f.json["asset"] = Value::Null, NotGltf, "asset", "version"),
        (|f| f.json["asset"]["version"] = json!("1.0"), Unsupported, "asset", "glTF 1.0"),
        (
            |f| f.json["asset"]["minVersion"] = json!("2.1"),
            Unsupported,
            "asset.minVersion",
            "later",
        ),
        (|f| f.json["nodes"] = json!(5), Syntax, "nodes", "invalid type"),
        (|f| f.json["nodes"][0]["mesh"] = json!(-1), Syntax, "nodes[0].mesh", "-1"),
        (|f| f.json["accessors"][0]["count"] = json!("3"), Syntax, "accessors[0].count", "string"),
        (
            |f| f.json["extensionsRequired"] = json!(["X_y"]),
            Unsupported,
            "extensionsRequired[0]",
            "X_y",
        ),
        (|f| f.json["scene"] = json!(3), Invalid, "scene", "scenes[3]"),
        (|f| f.json["scenes"][0]["nodes"] = json!([0, 0]), Invalid, "scenes[0].nodes[1]", "twice"),
        (|f| f.json["scenes"][0]["nodes"] = json!([9]), Invalid, "scenes[0].nodes[0]", "nodes[9]"),
        (|f| f.json["nodes"][0]["children"] = json!([0]), Invalid, "nodes[0]", "ancestor"),
        (
            |f| f.json["nodes"][0]["children"] = json!([4]),
            Invalid,
            "nodes[0].children[0]",
            "nodes[4]",
        ),
        (
            |f| f.json["nodes"] = json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
            Invalid,
            "nodes[1]",
            "ancestor",
        ),
        (
            |f| f.json["nodes"] = json!([{"children": [2]}, {"children": [2]}, {}]),
            Invalid,
            "nodes[1].children[0]",
            "already a child",
        ),
        (
            |f| f.json["nodes"] = json!([{}, {"children": [0]}]),
            Invalid,
            "scenes[0].nodes[0]",
            "is a child",
        ),
        (|f| f.json["nodes"][0]["mesh"] = json!(1), Invalid, "nodes[0].mesh", "meshes[1]"),
        (|f| f.json["nodes"][0]["camera"] = json!(0), Invalid, "nodes[0].camera", "cameras[0]"),
        (
            |f| f.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]),
            Invalid,
            "nodes[0].rotation",
            "length",
        ),
        (
            |f| f.json["nodes"][0]["matrix"] = json!(vec![1; 16]),
            Invalid,
            "nodes[0].matrix",
            "last row",
        ),
        (|f| f.json["nodes"][0]["skin"] = json!(0), Invalid, "nodes[0].skin", "skins[0]"),
        (skinned, Invalid, "meshes[0].primitives[0].attributes.JOINTS_0", "joint 9"),
        (
            |f| f.json["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 1}}),
            Invalid,
            "nodes[0].extensions.KHR_lights_punctual.light",
            "lights[1]",
        ),
        (
            |f| f.json["meshes"][0]["primitives"][0]["mode"] = json!(7),
            Invalid,
            "meshes[0].primitives[0].mode",
            "no mode",
        ),
        (
            |f| f.json["meshes"][0]["primitives"][0]["material"] = json!(2),
            Invalid,
            "meshes[0].primitives[0].material",
            "materials[2]",
        ),
        (
            |f| f.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9),
            Invalid,
            "meshes[0].primitives[0].attributes.POSITION",
            "accessors[9]",
        ),
        (
            |f| f.json["meshes"][0]["primitives"][0]["indices"] = json!(0),
            Invalid,
            "meshes[0].primitives[0].indices",
            "VEC3",
        ),
        (
            |f| {
                let i = f.indices(&[0, 1, 3]);
                f.json["meshes"][0]["primitives"][0]["indices"] = json!(i);
            },
            Invalid,
            "meshes[0].primitives[0].indices",
            "index 2 is 3",
        ),
        (
            |f| {
                let i = f.floats(&[[0.0], [1.0], [2.0]]);
                f.json["meshes"][0]["primitives"][0]["indices"] = json!(i);
            },
            Invalid,
            "meshes[0].primitives[0].indices",
            "whole numbers",
        ),
        (
            |f| {
                let n = f.floats(&[[0.0, 0.0, 1.0]; 2]);
                f.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(n);
            },
            Invalid,
            "meshes[0].primitives[0].attributes.NORMAL",
            "2 elements",
        ),
        (
            |f| {
                let p = f.floats(&[[f32::INFINITY, 0.0, 0.0], [1.0; 3], [2.0, 0.0, 0.0]]);
                f.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(p);
            },
            Invalid,
            "meshes[0].primitives[0].attributes.POSITION",
            "vertex 0",
        ),
        (
            |f| f.json["accessors"][0]["componentType"] = json!(5124),
            Invalid,
            "accessors[0].componentType",
            "5124",
        ),
        (|f| f.json["accessors"][0]["count"] = json!(4), Invalid, "accessors[0]", "reach beyond"),
        (
            |f| f.json["accessors"][0]["count"] = json!(u64::MAX),
            Invalid,
            "accessors[0].count",
            "2^32",
        ),
        (
            |f| f.json["accessors"][0]["byteOffset"] = json!(u64::MAX),
            Invalid,
            "accessors[0]",
            "reach beyond",
        ),
        (
            |f| f.json["accessors"][0]["bufferView"] = json!(1),
            Invalid,
            "accessors[0].bufferView",
            "bufferViews[1]",
        ),
        (
            |f| f.json["bufferViews"][0]["byteStride"] = json!(4),
            Invalid,
            "bufferViews[0]",
            "byteStride is 4",
        ),
        (
            |f| f.json["bufferViews"][0]["byteLength"] = json!(1_u64 << 40),
            Invalid,
            "bufferViews[0]",
            "reach beyond",
        ),
        (
            |f| f.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            Invalid,
            "bufferViews[0]",
            "reach beyond",
        ),
        (
            |f| f.json["bufferViews"][0]["buffer"] = json!(1),
            Invalid,
            "bufferViews[0].buffer",
            "buffers[1]",
        ),
        (|f| f.json["buffers"] = json!([{"byteLength": 4096}]), Invalid, "buffers[0]", "4096"),
        (
            |f| f.json["buffers"] = json!([{"byteLength": 36, "uri": "a.bin"}]),
            Io,
            "buffers[0].uri",
            "a.bin",
        ),
        (
            |f| f.json["buffers"] = json!([{"byteLength": 36, "uri": "../a"}]),
            Invalid,
            "buffers[0].uri",
            "leaves",
        ),
        (
            |f| f.json["buffers"] = json!([{"byteLength": 36, "uri": "data:;base64,*"}]),
            Invalid,
            "buffers[0].uri",
            "base64",
        ),
        (
            |f| {
                f.json["accessors"][0]["sparse"] = json!({"count": 4,
                "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}})
            },
            Invalid,
            "accessors[0].sparse.count",
            "4 of 3",
        ),
        (
            |f| {
                f.json["accessors"][0]["sparse"] = json!({"count": 2,
                "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}})
            },
            Invalid,
            "accessors[0].sparse.indices",
            "grow",
        ),
        (
            |f| {
                // Zeros out of nothing: 4 GiB of positions in a hundred bytes.
                f.json["accessors"][0] =
                    json!({"type": "VEC3", "componentType": 5126, "count": 1_u64 << 31});
            },
            TooLarge,
            "meshes[0].primitives[0].indices",
            "MiB",
        ),
        (
            |f| {
                let one = json!({"attributes": {"POSITION": 1}, "mode": 5});
                f.push(
                    "accessors",
                    json!({"type": "VEC3", "componentType": 5126, "count": 3_000_000}),
                );
                f.json["meshes"][0]["primitives"] = vec![one; 100].into();
            },
            TooLarge,
            "meshes[0].primitives[",
            "MiB",
        ),
        (
            |f| {
                f.push(
                    "cameras",
                    json!({"type": "perspective", "perspective": {"yfov": 0, "znear": 1}}),
                );
                f.json["nodes"][0]["camera"] = json!(0);
            },
            Invalid,
            "cameras[0].perspective.yfov",
            "not more than 0",
        ),
        (
            |f| {
                f.push("cameras", json!({"type": "fisheye"}));
                f.json["nodes"][0]["camera"] = json!(0);
            },
            Invalid,
            "cameras[0]",
            "fisheye",
        ),
    ];
    let options = ImportOptions {
        limits: Limits { max_bytes: 64 << 20, ..Limits::default() },
        ..ImportOptions::default()
    };
    for (change, kind, location, part) in cases {
        let mut file = Builder::triangle();
        change(&mut file);
        let error = match file.import_with(&options) {
            Ok(_) => panic!("{location}: {part}: it was read"),
            Err(error) => error,
        };
        assert_eq!(error.kind(), *kind, "{error}");
        let is_there = match location.strip_suffix('[') {
            Some(start) => error.location().starts_with(start),
            None => error.location() == *location,
        };
        assert!(is_there, "{error}: not at {location}");
        assert!(error.message().contains(part), "{error}: no {part:?}");
    }
}

#[test]
fn broken_textures_are_found() {
    let material = || json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    for (list, entry, location) in [
        ("materials", json!({"normalTexture": {"index": 5}}), "materials[0].normalTexture.index"),
        ("textures", json!({"source": 0, "sampler": 3}), "textures[0].sampler"),
        ("textures", json!({"source": 4}), "textures[0].source"),
        ("images", json!({"bufferView": 9}), "images[0].bufferView"),
        ("images", json!({"uri": "/etc/passwd"}), "images[0].uri"),
    ] {
        let mut file = Builder::with_material(material());
        file.json[list][0] = entry;
        assert_eq!(file.import().unwrap_err().location(), location);
    }
}

#[test]
fn broken_containers_are_found() {
    let whole = Builder::triangle().glb();
    let parse =
        |bytes: &[u8]| parse_gltf(bytes, &|_, _| Err(String::new()), &ImportOptions::default());
    assert!(parse(&whole).is_ok());
    for n in 0..whole.len() {
        assert!(parse(&whole[..n]).is_err(), "cut to {n} bytes");
    }
    let patched = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        parse(&bytes).unwrap_err()
    };
    assert_eq!(patched(4, 1).kind(), ErrorKind::Unsupported);
    assert_eq!(patched(4, 3).kind(), ErrorKind::Unsupported);
    for (at, word) in [(8, 11), (8, 13), (8, u32::MAX), (12, u32::MAX), (12, 0), (16, 7)] {
        let error = patched(at, word);
        assert!(matches!(error.kind(), ErrorKind::NotGltf | ErrorKind::Syntax), "{error}");
    }
    for bytes in [
        &b""[..],
        b"PNG",
        b"glTF",
        b"\xff\xfe",
        b"{",
        b"{}{}",
        b"{\"asset\":{\"version\":\"2.0\"}}x",
    ] {
        assert!(parse(bytes).is_err());
    }
    let deep = [vec![b'['; 100_000], vec![b']'; 100_000]].concat();
    // What is skipped may be as deep as it likes; what is read may not.
    let start = |key: &str| format!("{{\"asset\":{{\"version\":\"2.0\"}},\"{key}\":");
    assert!(parse(&[start("extras").as_bytes(), &deep, b"}"].concat()).is_ok());
    assert!(parse(&[start("nodes").as_bytes(), &deep, b"}"].concat()).is_err());
}

#[test]
fn objects_are_counted_before_they_are_read() {
    let text = format!("{{\"nodes\":[{}{{}}]}}", "{},".repeat(1000));
    let limits = Limits { max_objects: 1000, ..Limits::default() };
    let options = ImportOptions { limits, ..ImportOptions::default() };
    let error = parse_gltf(text.as_bytes(), &|_, _| Err(String::new()), &options).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::TooLarge);
}

#[test]
fn files_that_are_not_there_are_named() {
    let dir = tempfile::tempdir().unwrap();
    for path in [dir.path().join("none.gltf"), dir.path().to_owned()] {
        let error = zrak_gltf::import(&path, &ImportOptions::default()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert!(error.to_string().starts_with(&path.display().to_string()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever a few bytes are changed to, the file is read or refused.
    #[test]
    fn damaged_files_do_no_harm(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut file = Builder::with_material(json!({"normalTexture": {"index": 0}}));
        let indices = file.indices(&[0, 1, 2]);
        file.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        let mut bytes = file.glb();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let options = ImportOptions {
            limits: Limits { max_bytes: 16 << 20, ..Limits::default() },
            ..ImportOptions::default()
        };
        let _ = parse_gltf(&bytes, &|_, _| Err(String::new()), &options);
    }
}
