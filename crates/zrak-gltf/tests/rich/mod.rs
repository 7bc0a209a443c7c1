//! A file with most of what can be read and written.

#![allow(unreachable_pub)] // It is a module of several test files.

use serde_json::json;

use crate::builder::Builder;

/// Red, green, blue and alpha of one texel, as a PNG.
pub fn picture() -> Vec<u8> {
    // Header, one row of filter 0, end.
    const BYTES: &str = "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c489000000\
        0d4944415478da63f8cfd0f01f000600027ffe5c612b0000000049454e44ae42\
        6082";
    let digits: Vec<u8> = BYTES.chars().filter_map(|c| c.to_digit(16)).map(|d| d as u8).collect();
    digits.chunks_exact(2).map(|d| d[0] << 4 | d[1]).collect()
}

/// Materials of every extension, instances, lights, a camera, an embedded picture.
pub fn rich() -> Builder {
    let mut file = Builder::with_material(json!({"name": "all", "alphaMode": "MASK",
    "alphaCutoff": 0.25, "doubleSided": true,
    "pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 0.75, 1.0, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.25,
        "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
            {"offset": [0.25, 0.5], "scale": [2.0, -3.0], "rotation": 0.5}}},
        "metallicRoughnessTexture": {"index": 0}},
    "normalTexture": {"index": 0, "scale": 0.5},
    "emissiveFactor": [0.5, 0.25, 1.0], "emissiveTexture": {"index": 0},
    "extensions": {
        "KHR_materials_emissive_strength": {"emissiveStrength": 2.0},
        "KHR_materials_ior": {"ior": 1.25},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0},
            "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": {"index": 0}},
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.25, 0.0],
            "sheenRoughnessFactor": 0.5, "sheenRoughnessTexture": {"index": 0}},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 0},
            "specularColorFactor": [0.5, 1.0, 0.25], "specularColorTexture": {"index": 0}},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5,
            "iridescenceIor": 1.75, "iridescenceThicknessMaximum": 500.0}
    }}));
    let picture = file.view(&picture());
    file.json["images"] =
        json!([{"bufferView": picture, "mimeType": "image/png", "name": "texel"}]);
    file.json["textures"][0]["sampler"] = json!(0);
    let sampler = json!({"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648});
    file.push("samplers", sampler);
    file.push(
        "materials",
        json!({"name": "glass", "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.125,
                                 "baseColorFactor": [1.0, 1.0, 1.0, 0.5]},
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.75},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 2.0,
                                     "attenuationColor": [0.5, 0.25, 1.0]}
        }}),
    );
    file.push(
        "materials",
        json!({"name": "pane", "pbrMetallicRoughness": {"metallicFactor": 0.0},
               "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1.0}}}),
    );
    let normals = file.floats(&[[0.0, 0.0, 1.0]; 3]);
    let tangents = file.floats(&[[1.0, 0.0, 0.0, -1.0]; 3]);
    let colors = file.floats(&[[1.0, 0.5, 0.25, 1.0], [0.0; 4], [1.0; 4]]);
    let indices = file.indices(&[0, 1, 2]);
    let first = &mut file.json["meshes"][0]["primitives"][0];
    first["attributes"]["NORMAL"] = json!(normals);
    first["attributes"]["TANGENT"] = json!(tangents);
    let mut second = first.clone();
    first["attributes"]["COLOR_0"] = json!(colors);
    first["indices"] = json!(indices);
    second["material"] = json!(1);
    let mut third = second.clone();
    third["material"] = json!(2);
    file.json["meshes"][0]["name"] = json!("leaf");
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().extend([second, third]);
    file.push(
        "cameras",
        json!({"type": "perspective",
        "perspective": {"yfov": 0.75, "aspectRatio": 1.5, "znear": 0.1}}),
    );
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1.0, 0.5, 0.25], "intensity": 683.0},
        {"type": "directional", "intensity": 1366.0},
        {"type": "spot", "intensity": 683.0, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}
    ]}});
    let light = |i: u32| json!({"KHR_lights_punctual": {"light": i}});
    let half = std::f64::consts::FRAC_1_SQRT_2;
    file.json["nodes"] = json!([
        {"mesh": 0, "translation": [1, 2, 3]},
        {"mesh": 0, "scale": [-1, 2, 1]},
        {"camera": 0, "translation": [0, 0, 9]},
        {"extensions": light(0), "translation": [4, 5, 6]},
        {"extensions": light(1), "rotation": [-half, 0, 0, half]},
        {"extensions": light(2), "translation": [0, 7, 0], "rotation": [0, half, 0, half]}
    ]);
    file.json["extensionsUsed"] = json!([
        "KHR_lights_punctual",
        "KHR_materials_clearcoat",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_texture_transform"
    ]);
    file.json["scenes"][0] = json!({"nodes": [0, 1, 2, 3, 4, 5], "name": "rich"});
    file
}
