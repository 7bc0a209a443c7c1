//! Nodes, instances, cameras, lights, and what a file without them gets.

mod builder;

use builder::{Builder, only_mesh};
use serde_json::{Value, json};
use zrak_gltf::ImportOptions;
use zrak_scene::desc::{
    BackgroundDesc, LightDesc, ObjectDesc, ProjectionDesc, SpotFalloff, TransformStep,
};
use zrak_scene::lower::Transform;

/// The map of the only object.
fn only_map(file: &Builder) -> Transform {
    let imported = file.import_clean();
    assert_eq!(imported.desc.objects.len(), 1);
    map_of(&imported.desc.objects[0])
}

fn map_of(object: &ObjectDesc) -> Transform {
    match object {
        ObjectDesc::Mesh { transform, .. } | ObjectDesc::Instance { transform, .. } => {
            Transform::of_steps(transform)
        }
        other => panic!("{other:?}"),
    }
}

fn close(a: [f64; 3], b: [f64; 3]) {
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() < 1e-12, "{a:?} is not {b:?}");
    }
}

#[test]
fn nodes_multiply_up() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let mut file = Builder::triangle();
    file.json["nodes"] = json!([
        {"children": [1], "translation": [1, 2, 3], "rotation": [0, 0, half, half], "scale": [2, 2, 2]},
        {"children": [2], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        {"mesh": 0, "scale": [1, 3, 1]}
    ]);
    let map = only_map(&file);
    // (1, 1, 0) -> (1, 3, 0) -> (6, 3, 0) -> (12, 6, 0) -> (-6, 12, 0) -> (-5, 14, 3).
    close(map.point([1.0, 1.0, 0.0]), [-5.0, 14.0, 3.0]);
}

#[test]
fn a_deep_chain_of_nodes_is_no_trouble() {
    let mut file = Builder::triangle();
    let n = 50_000;
    let nodes: Vec<Value> = (0..n)
        .map(|i| match i {
            _ if i + 1 == n => json!({"mesh": 0, "translation": [1, 0, 0]}),
            _ => json!({"children": [i + 1], "translation": [1, 0, 0]}),
        })
        .collect();
    file.json["nodes"] = Value::Array(nodes);
    close(only_map(&file).point([0.0; 3]), [f64::from(n), 0.0, 0.0]);
}

#[test]
fn several_nodes_of_a_mesh_are_instances() {
    let mut file = Builder::triangle();
    file.push("nodes", json!({"mesh": 0, "translation": [0, 0, 4]}));
    // A mirror image.
    file.push("nodes", json!({"mesh": 0, "scale": [-1, 1, 1]}));
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let imported = file.import_clean();
    let desc = &imported.desc;
    assert_eq!((desc.meshes.len(), desc.prototypes.len(), desc.objects.len()), (1, 1, 3));
    close(map_of(&desc.objects[1]).point([0.0; 3]), [0.0, 0.0, 4.0]);
    assert!(map_of(&desc.objects[2]).determinant() < 0.0);
    let problems = zrak_scene::validate::validate(desc);
    assert!(problems.iter().all(|p| p.message.contains("not rendered yet")), "{problems:?}");
}

#[test]
fn mirrored_meshes_keep_their_side() {
    // The lowering turns the corners of mirrored meshes round, so they stay as they are here.
    let mut file = Builder::triangle();
    file.json["nodes"][0]["scale"] = json!([1, 1, -1]);
    let imported = file.import_clean();
    assert_eq!(only_mesh(&imported).triangles, [[0, 1, 2]]);
    assert!(only_map(&file).determinant() < 0.0);
}

#[test]
fn instancing_attributes_place_copies() {
    let mut file = Builder::triangle();
    let moves = file.floats(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    let scales = file.floats(&[[2.0, 2.0, 2.0], [0.0; 3], [1.0; 3]]);
    file.json["nodes"][0] = json!({"mesh": 0, "translation": [0, 10, 0], "extensions":
        {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": moves, "SCALE": scales}}}});
    file.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let imported = file.import_warned(&["without size"]);
    assert_eq!(imported.desc.objects.len(), 2);
    close(map_of(&imported.desc.objects[0]).point([1.0, 0.0, 0.0]), [3.0, 10.0, 0.0]);
}

#[test]
fn the_right_scene_is_chosen() {
    let mut file = Builder::triangle();
    file.push("nodes", json!({"mesh": 0, "translation": [7, 0, 0]}));
    file.push("scenes", json!({"nodes": [1], "name": "second"}));
    let x = |file: &Builder, scene: Option<usize>| {
        let scene = scene.map(|i| i.to_string());
        let options = ImportOptions { scene, ..ImportOptions::default() };
        map_of(&file.import_with(&options).unwrap().desc.objects[0]).rows[0][3]
    };
    assert_eq!(x(&file, None), 0.0);
    assert_eq!(x(&file, Some(1)), 7.0);
    file.json["scene"] = json!(1);
    assert_eq!(x(&file, None), 7.0);
    assert_eq!(x(&file, Some(0)), 0.0);
    assert_eq!(file.import_clean().desc.name, "second");
    let options = ImportOptions { scene: Some("2".into()), ..ImportOptions::default() };
    assert!(file.import_with(&options).is_err());
}

#[test]
fn nodes_without_size_are_left_out() {
    let mut file = Builder::triangle();
    for scale in [json!([0, 0, 0]), json!([1, 0, 1]), json!([1e300, 1e300, 1e300])] {
        file.json["nodes"][0]["scale"] = scale;
        assert!(file.import_warned(&["without size"]).desc.objects.is_empty());
    }
}

#[test]
fn perspective_cameras_look_along_minus_z() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let mut file = Builder::triangle();
    file.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 1.5, "znear": 0.1}}),
    );
    // A quarter turn about y: towards -x.
    file.push(
        "nodes",
        json!({"camera": 0, "translation": [1, 2, 3], "rotation": [0, half, 0, half]}),
    );
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    let camera = file.import_clean().desc.camera;
    close(camera.look_from, [1.0, 2.0, 3.0]);
    close(camera.look_at, [-2.0, 2.0, 3.0]);
    close(camera.vup, [0.0, 1.0, 0.0]);
    assert!((camera.vfov_deg - 57.295_779_513_082_32).abs() < 1e-12);
    assert_eq!((camera.width, camera.height, camera.flip_x), (1080, 720, false));
    assert_eq!(camera.projection, ProjectionDesc::Perspective);
}

#[test]
fn orthographic_cameras_and_the_choice_among_several() {
    let mut file = Builder::triangle();
    let lens = json!({"xmag": 2.0, "ymag": 4.0, "znear": 0.1, "zfar": 1});
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 1}}));
    file.push("cameras", json!({"type": "orthographic", "orthographic": lens}));
    file.push("nodes", json!({"camera": 0}));
    file.push("nodes", json!({"camera": 1, "scale": [-1, 1, 1]}));
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let first = file.import_warned(&["2 cameras"]).desc.camera;
    assert_eq!((first.width, first.height), (1280, 720));
    let with = |camera: &str| ImportOptions {
        camera: Some(camera.to_owned()),
        height: 100,
        ..ImportOptions::default()
    };
    let second = file.import_with(&with("1")).unwrap().desc.camera;
    assert_eq!(second.projection, ProjectionDesc::Orthographic { height: 8.0 });
    assert_eq!((second.width, second.height, second.flip_x), (50, 100, true));
    // By name: of nodes, then of cameras, then by number.
    file.json["nodes"][1]["name"] = json!("front");
    file.json["cameras"][1]["name"] = json!("plan");
    for (camera, expected) in [("front", 178), ("plan", 50), ("0", 178), ("1", 50)] {
        let camera = file.import_with(&with(camera)).unwrap().desc.camera;
        assert_eq!(camera.width, expected);
    }
    file.json["nodes"][2]["name"] = json!("0");
    assert_eq!(file.import_with(&with("0")).unwrap().desc.camera.width, 50);
    let error = file.import_with(&with("2")).unwrap_err().to_string();
    assert!(error.contains("no camera '2'") && error.contains("front, 0"), "{error}");
}

#[test]
fn scenes_are_chosen_by_name_or_number() {
    let mut file = Builder::triangle();
    file.json["scenes"] = json!([{"nodes": [0], "name": "full"}, {"nodes": [], "name": "empty"}]);
    let with =
        |scene: &str| ImportOptions { scene: Some(scene.to_owned()), ..ImportOptions::default() };
    for (scene, n_objects) in [("full", 1), ("empty", 0), ("0", 1), ("1", 0)] {
        let imported = file.import_with(&with(scene)).unwrap();
        assert_eq!(imported.desc.objects.len(), n_objects, "{scene}");
    }
    let error = file.import_with(&with("none")).unwrap_err().to_string();
    assert!(error.contains("no scene 'none'") && error.contains("full, empty"), "{error}");
}

#[test]
fn a_file_without_camera_and_light_gets_both() {
    let mut file = Builder::triangle();
    file.json["nodes"][0]["translation"] = json!([100, 0, 0]);
    let desc = file.import_clean().desc;
    close(desc.camera.look_at, [100.5, 0.5, 0.0]);
    assert_eq!((desc.camera.width, desc.camera.height, desc.camera.vfov_deg), (1280, 720, 40.0));
    assert!(matches!(desc.background, BackgroundDesc::Gradient { .. }));
    let options = ImportOptions { default_light: false, ..ImportOptions::default() };
    let dark = file.import_with(&options).unwrap().desc;
    assert_eq!(dark.background, BackgroundDesc::default());
}

#[test]
fn punctual_lights_are_placed() {
    let mut file = Builder::triangle();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1.0, 0.5, 0.0], "intensity": 683.0},
        {"type": "directional", "intensity": 1366.0},
        {"type": "spot", "intensity": 683.0, "range": 5,
         "spot": {"innerConeAngle": 0.5, "outerConeAngle": 1.0}},
        {"type": "spot"},
        {"type": "ambient"}
    ]}});
    let light = |i: u32| json!({"KHR_lights_punctual": {"light": i}});
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let down = json!([-half, 0, 0, half]);
    file.json["nodes"] = json!([
        {"mesh": 0},
        {"extensions": light(0), "translation": [1, 2, 3], "scale": [5, 5, 5]},
        {"extensions": light(1), "rotation": down},
        {"extensions": light(2), "translation": [0, 9, 0], "rotation": down},
        {"extensions": light(3)},
        {"extensions": light(4)}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4, 5]);
    let desc = file.import_warned(&["ambient"]).desc;
    // There is light, so no environment is made up.
    assert_eq!(desc.background, BackgroundDesc::default());
    let intensity = [1.0, 0.5, 0.0];
    assert_eq!(desc.lights[0], LightDesc::Point { position: [1.0, 2.0, 3.0], intensity });
    let LightDesc::Distant { direction, irradiance } = desc.lights[1] else { panic!() };
    close(direction, [0.0, -1.0, 0.0]);
    assert_eq!(irradiance, [2.0; 3]);
    let LightDesc::Spot { direction, cone_angle_deg, falloff_start_deg, falloff, .. } =
        desc.lights[2]
    else {
        panic!()
    };
    close(direction, [0.0, -1.0, 0.0]);
    assert!((cone_angle_deg - 1.0_f64.to_degrees()).abs() < 1e-12);
    assert!((falloff_start_deg - 0.5_f64.to_degrees()).abs() < 1e-12);
    assert_eq!(falloff, SpotFalloff::Square);
    let LightDesc::Spot { cone_angle_deg, falloff_start_deg, .. } = desc.lights[3] else {
        panic!()
    };
    assert_eq!((cone_angle_deg, falloff_start_deg), (45.0, 0.0));
    let options = ImportOptions { lumens_per_watt: 1.0, ..ImportOptions::default() };
    let raw = file.import_with(&options).unwrap().desc;
    let LightDesc::Distant { irradiance, .. } = raw.lights[1] else { panic!() };
    assert_eq!(irradiance, [1366.0; 3]);
}

#[test]
fn what_is_ignored_is_said() {
    let mut file = Builder::triangle();
    file.json["animations"] = json!([{"channels": [], "samplers": []}]);
    file.json["extensionsUsed"] = json!(["FANTASY_extension", "KHR_materials_variants"]);
    file.json["extras"] = json!({"any": ["thing", {"at": "all"}]});
    file.import_warned(&["FANTASY_extension is unknown", "animations are not played"]);
}

#[test]
fn text_files_and_their_neighbours_are_read() {
    let dir = tempfile::tempdir().unwrap();
    let mut file = Builder::triangle();
    std::fs::create_dir(dir.path().join("sub dir")).unwrap();
    std::fs::write(dir.path().join("sub dir/a.bin"), &file.bin).unwrap();
    file.json["buffers"] = json!([{"byteLength": file.bin.len(), "uri": "sub%20dir/a.bin"}]);
    let path = dir.path().join("model.gltf");
    let text = format!("\u{feff}{:#}", file.json);
    std::fs::write(&path, text).unwrap();
    let imported = zrak_gltf::import(&path, &ImportOptions::default()).unwrap();
    assert_eq!(only_mesh(&imported).positions.len(), 3);
    assert_eq!((imported.desc.name.as_str(), imported.base_dir.as_path()), ("model", dir.path()));
    // One name of the buffer that is not there, and one that is a folder.
    for uri in ["b.bin", "sub%20dir"] {
        file.json["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, file.json.to_string()).unwrap();
        let error = zrak_gltf::import(&path, &ImportOptions::default()).unwrap_err().to_string();
        assert!(error.contains("model.gltf") && error.contains("buffers[0].uri"), "{error}");
    }
    assert!(matches!(file.json["nodes"][0]["mesh"], Value::Number(_)));
}

#[test]
fn transforms_of_the_identity_are_left_out() {
    let imported = Builder::triangle().import_clean();
    let ObjectDesc::Mesh { transform, .. } = &imported.desc.objects[0] else { panic!() };
    assert_eq!(*transform, Vec::<TransformStep>::new());
}
