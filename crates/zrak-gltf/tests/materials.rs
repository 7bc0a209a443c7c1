//! Materials and textures.

mod builder;

use builder::{Builder, PNG, principled};
use serde_json::{Value, json};
use zrak_gltf::{ImportOptions, Imported};
use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageEncoding, ImageFilter, LightSides, MappingDesc, MaterialDesc,
    MediumDesc, PrincipledDesc, ScalarDesc, TextureDesc, WrapMode,
};

fn import(material: Value) -> Imported {
    Builder::with_material(material).import_clean()
}

fn surface_of(imported: &Imported) -> &PrincipledDesc {
    principled(&imported.desc.materials)
}

/// The `surface` around the material.
fn wrapper(imported: &Imported) -> &MaterialDesc {
    let mut found =
        imported.desc.materials.values().filter(|m| matches!(m, MaterialDesc::Surface { .. }));
    found.next().expect("there is a surface")
}

/// Path, encoding, channel and scale of the picture that a texture is.
fn image<'a>(imported: &'a Imported, name: &str) -> (&'a str, ImageEncoding, ImageChannel, f64) {
    match &imported.desc.textures[name] {
        TextureDesc::Image { path, encoding, channel, scale, .. } => {
            (path, *encoding, *channel, *scale)
        }
        other => panic!("{other:?}"),
    }
}

fn channel(imported: &Imported, input: &ScalarDesc) -> (ImageChannel, f64) {
    let ScalarDesc::Texture(name) = input else { panic!("{input:?}") };
    let (_, encoding, channel, scale) = image(imported, name);
    assert_eq!(encoding, ImageEncoding::Linear);
    (channel, scale)
}

#[test]
fn the_default_material_is_white_metal() {
    for imported in [Builder::triangle().import_clean(), import(json!({}))] {
        let surface = surface_of(&imported);
        assert_eq!(surface.base_color, ColorDesc::Solid([1.0; 3]));
        assert_eq!(surface.base_metalness, ScalarDesc::Value(1.0));
        assert_eq!(surface.specular_roughness, ScalarDesc::Value(1.0));
        assert_eq!(imported.desc.materials.len(), 1);
    }
}

#[test]
fn metallic_roughness_factors_and_textures() {
    let imported = import(json!({"name": "steel", "pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 1.0, 0.25, 1.0], "metallicFactor": 0.75, "roughnessFactor": 0.5,
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}
    }}));
    let surface = surface_of(&imported);
    assert_eq!(channel(&imported, &surface.base_metalness), (ImageChannel::B, 0.75));
    assert_eq!(channel(&imported, &surface.specular_roughness), (ImageChannel::G, 0.5));
    let ColorDesc::Texture(product) = &surface.base_color else { panic!() };
    let TextureDesc::Multiply { a: ColorDesc::Texture(a), b } = &imported.desc.textures[product]
    else {
        panic!()
    };
    assert_eq!(*b, ColorDesc::Solid([0.5, 1.0, 0.25]));
    let expected = ("picture.png", ImageEncoding::Srgb, ImageChannel::Color, 1.0);
    assert_eq!(image(&imported, a), expected);
    assert!(imported.desc.materials.contains_key("steel"));
}

#[test]
fn samplers_and_texture_transforms() {
    let material = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
        {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2.0, 3.0],
                                   "rotation": std::f64::consts::FRAC_PI_2}}}}});
    let mut file = Builder::with_material(material);
    file.json["textures"][0]["sampler"] = json!(0);
    for (sampler, filter, wraps) in [
        (json!({}), ImageFilter::Bilinear, [WrapMode::Repeat; 2]),
        (
            json!({"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}),
            ImageFilter::Nearest,
            [WrapMode::Clamp, WrapMode::Mirror],
        ),
        (
            json!({"magFilter": 9729, "minFilter": 9987, "wrapS": 10497}),
            ImageFilter::Trilinear,
            [WrapMode::Repeat; 2],
        ),
        (
            json!({"magFilter": 9729, "minFilter": 9729}),
            ImageFilter::Bilinear,
            [WrapMode::Repeat; 2],
        ),
    ] {
        file.json["samplers"] = json!([sampler]);
        let imported = file.import_clean();
        let texture = imported.desc.textures.values().next().unwrap();
        let TextureDesc::Image { filter: f, wrap_u, wrap_v, mapping, .. } = texture else {
            panic!()
        };
        assert_eq!((*f, [*wrap_u, *wrap_v]), (filter, wraps));
        let MappingDesc::UvAffine { matrix } = mapping else { panic!() };
        // glTF: (1, 0) is scaled to (2, 0), turned to (0, -2), since v points down, moved to
        // (0.5, -1.75). With v up, that is (1, 1) to (0.5, 2.75). Likewise the others.
        let map = |u: f64, v: f64| matrix.map(|[a, b, c]| a * u + b * v + c);
        for (from, to) in
            [([1.0, 1.0], [0.5, 2.75]), ([0.0, 1.0], [0.5, 0.75]), ([0.0, 0.0], [3.5, 0.75])]
        {
            let got = map(from[0], from[1]);
            assert!((got[0] - to[0]).abs() + (got[1] - to[1]).abs() < 1e-12, "{got:?} {to:?}");
        }
    }
}

#[test]
fn the_second_set_of_texture_coordinates() {
    let mut file = Builder::with_material(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}},
        "occlusionTexture": {"index": 0}
    }));
    file.import_warned(&["TEXCOORD_1, which is missing"]);
    let second = file.floats(&[[0.5, 0.5]; 3]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(second);
    let imported = file.import_clean();
    assert_eq!(builder::only_mesh(&imported).uvs, [[0.5, 0.5]; 3]);
    file.json["materials"][0]["normalTexture"] = json!({"index": 0});
    let imported = file.import_warned(&["materials[0].normalTexture: it is on TEXCOORD_0"]);
    assert_eq!(builder::only_mesh(&imported).uvs, [[0.5, 0.5]; 3]);
}

#[test]
fn normals_emission_and_sides() {
    let imported = import(json!({
        "normalTexture": {"index": 0, "scale": 0.5},
        "emissiveFactor": [1.0, 0.5, 0.0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4.0}}
    }));
    let MaterialDesc::Surface {
        normal_map,
        normal_scale,
        emission,
        emission_strength,
        emission_sides,
        one_sided,
        ..
    } = wrapper(&imported)
    else {
        panic!()
    };
    let look = image(&imported, normal_map.as_ref().unwrap());
    assert_eq!(look, ("picture.png", ImageEncoding::Linear, ImageChannel::Color, 1.0));
    assert_eq!((*normal_scale, *emission_strength, *one_sided), (0.5, 4.0, false));
    assert_eq!(*emission, Some(ColorDesc::Solid([1.0, 0.5, 0.0])));
    assert_eq!(*emission_sides, LightSides::Front);
    // What shines is light enough.
    assert_eq!(imported.desc.background, zrak_scene::desc::BackgroundDesc::default());

    let textured = json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                          "doubleSided": true});
    let imported = import(textured);
    let MaterialDesc::Surface { emission_sides, .. } = wrapper(&imported) else { panic!() };
    assert_eq!(*emission_sides, LightSides::Both);
    assert_ne!(imported.desc.background, zrak_scene::desc::BackgroundDesc::default());
}

#[test]
fn alpha_modes() {
    let factor = |a: f64, mode: &str| {
        json!({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, a],
               "baseColorTexture": {"index": 0}}, "alphaMode": mode})
    };
    let imported = import(factor(0.5, "OPAQUE"));
    assert_eq!(imported.desc.materials.len(), 1);
    for (mode, cutoff) in [("BLEND", None), ("MASK", Some(0.5))] {
        let imported = import(factor(0.75, mode));
        let MaterialDesc::Surface { alpha, alpha_cutoff, .. } = wrapper(&imported) else {
            panic!()
        };
        assert_eq!(channel(&imported, alpha.as_ref().unwrap()), (ImageChannel::A, 0.75));
        assert_eq!(*alpha_cutoff, cutoff);
    }
    Builder::with_material(json!({"alphaMode": "HALF"})).import_warned(&["HALF"]);
}

#[test]
fn backs_can_be_culled() {
    let options = ImportOptions { cull_back_faces: true, ..ImportOptions::default() };
    for (double_sided, expected) in [(false, true), (true, false)] {
        let file = Builder::with_material(json!({"doubleSided": double_sided}));
        let imported = file.import_with(&options).unwrap();
        let is_culled = imported
            .desc
            .materials
            .values()
            .any(|material| matches!(material, MaterialDesc::Surface { one_sided: true, .. }));
        assert_eq!(is_culled, expected);
    }
}

#[test]
fn vertex_colors_multiply() {
    let mut file = Builder::with_material(json!({"alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 0.25]}}));
    let colors = file.floats(&[[1.0, 0.0, 0.0, 0.5]; 3]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let imported = file.import_clean();
    let ColorDesc::Texture(product) = &surface_of(&imported).base_color else { panic!() };
    let TextureDesc::Multiply { a, b: ColorDesc::Texture(b) } = &imported.desc.textures[product]
    else {
        panic!()
    };
    assert_eq!(*a, ColorDesc::Solid([0.5; 3]));
    let vertices = TextureDesc::VertexColor { channel: ImageChannel::Color };
    assert_eq!(imported.desc.textures[b], vertices);
    let MaterialDesc::Surface { alpha: Some(ScalarDesc::Texture(alpha)), .. } = wrapper(&imported)
    else {
        panic!()
    };
    let TextureDesc::Multiply { a, b: ColorDesc::Texture(b) } = &imported.desc.textures[alpha]
    else {
        panic!()
    };
    assert_eq!(*a, ColorDesc::Solid([0.25; 3]));
    assert_eq!(imported.desc.textures[b], TextureDesc::VertexColor { channel: ImageChannel::A });
}

fn with_extension(name: &str, extension: Value) -> Value {
    json!({"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.5},
           "extensions": {format!("KHR_materials_{name}"): extension}})
}

#[test]
fn layers_become_those_of_openpbr() {
    let imported = import(with_extension("ior", json!({"ior": 1.33})));
    assert_eq!(surface_of(&imported).specular_ior, 1.33);

    let coat = json!({"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0},
                      "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": {"index": 0}});
    let imported = import(with_extension("clearcoat", coat));
    let surface = surface_of(&imported);
    assert_eq!(channel(&imported, &surface.coat_weight), (ImageChannel::R, 0.5));
    assert_eq!(channel(&imported, &surface.coat_roughness), (ImageChannel::G, 0.25));
    assert_eq!(surface.coat_ior, 1.5);

    let sheen = json!({"sheenColorFactor": [0.5, 0.25, 0.0], "sheenRoughnessFactor": 0.75});
    let imported = import(with_extension("sheen", sheen));
    let surface = surface_of(&imported);
    assert_eq!(surface.fuzz_weight, ScalarDesc::Value(0.5));
    assert_eq!(surface.fuzz_color, ColorDesc::Solid([1.0, 0.5, 0.0]));
    assert_eq!(surface.fuzz_roughness, ScalarDesc::Value(0.75));

    let specular = json!({"specularFactor": 0.5, "specularTexture": {"index": 0},
                          "specularColorFactor": [1.0, 0.5, 0.0]});
    let imported = import(with_extension("specular", specular));
    let surface = surface_of(&imported);
    assert_eq!(channel(&imported, &surface.specular_weight), (ImageChannel::A, 0.5));
    assert_eq!(surface.specular_color, ColorDesc::Solid([1.0, 0.5, 0.0]));
    // Twice the 4% of glass.
    let specular = json!({"specularColorFactor": [2.0, 1.0, 0.0]});
    let imported = import(with_extension("specular", specular));
    let surface = surface_of(&imported);
    let root = (surface.specular_ior - 1.0) / (surface.specular_ior + 1.0);
    assert!((root * root - 0.08).abs() < 1e-12);
    assert_eq!(surface.specular_color, ColorDesc::Solid([1.0, 0.5, 0.0]));
}

#[test]
fn films_and_brushes() {
    let film = json!({"iridescenceFactor": 0.5, "iridescenceIor": 1.8,
                      "iridescenceThicknessMaximum": 600.0});
    let imported = import(with_extension("iridescence", film));
    let surface = surface_of(&imported);
    assert_eq!(surface.thin_film_weight, ScalarDesc::Value(0.5));
    assert_eq!(
        (&surface.thin_film_thickness, surface.thin_film_ior),
        (&ScalarDesc::Value(0.6), 1.8)
    );
    let film = json!({"iridescenceFactor": 1.0, "iridescenceThicknessMinimum": 200.0,
                      "iridescenceThicknessTexture": {"index": 0}});
    let imported = import(with_extension("iridescence", film));
    let ScalarDesc::Texture(name) = &surface_of(&imported).thin_film_thickness else { panic!() };
    let TextureDesc::Mix { a, b, amount } = &imported.desc.textures[name] else { panic!() };
    assert_eq!((a, b), (&ColorDesc::Solid([0.2; 3]), &ColorDesc::Solid([0.4; 3])));
    assert_eq!(channel(&imported, amount), (ImageChannel::G, 1.0));

    let imported = import(with_extension("anisotropy", json!({"anisotropyStrength": 0.6})));
    let surface = surface_of(&imported);
    let ScalarDesc::Value(r) = surface.specular_roughness else { panic!() };
    let ScalarDesc::Value(k) = surface.specular_roughness_anisotropy else { panic!() };
    // OpenPBR's alphas of these are glTF's: a = 0.25 across, 0.25 + 0.75 * 0.36 = 0.52 along.
    let along = r * r * (2.0 / (1.0 + (1.0 - k) * (1.0 - k))).sqrt();
    assert!((along - 0.52).abs() < 1e-12 && ((1.0 - k) * along - 0.25).abs() < 1e-12);
}

#[test]
fn glass_is_thin_or_holds_a_medium() {
    let glass = |volume: Value| {
        let mut material = with_extension("transmission", json!({"transmissionFactor": 1.0}));
        material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 0.5, 0.5, 1.0]);
        if !volume.is_null() {
            material["extensions"]["KHR_materials_volume"] = volume;
        }
        import(material)
    };
    for volume in [Value::Null, json!({"thicknessFactor": 0.0, "attenuationDistance": 1.0})] {
        let imported = glass(volume);
        let surface = surface_of(&imported);
        assert_eq!(surface.transmission_weight, ScalarDesc::Value(1.0));
        assert_eq!(surface.transmission_color, ColorDesc::Solid([1.0, 0.5, 0.5]));
        assert!(surface.geometry_thin_walled && imported.desc.media.is_empty());
    }
    let imported = glass(json!({"thicknessFactor": 1.0}));
    assert!(!surface_of(&imported).geometry_thin_walled && imported.desc.media.is_empty());
    let imported = glass(json!({"thicknessFactor": 1.0, "attenuationDistance": 2.0,
                                "attenuationColor": [1.0, 0.25, 0.5]}));
    let MaterialDesc::Surface { medium: Some(medium), .. } = wrapper(&imported) else { panic!() };
    let MediumDesc { sigma_a, sigma_s, .. } = imported.desc.media[medium.inside.as_ref().unwrap()];
    assert_eq!(sigma_s, [0.0; 3]);
    for (sigma, color) in sigma_a.iter().zip([1.0, 0.25, 0.5]) {
        assert!(((-2.0 * sigma).exp() - color).abs() < 1e-12);
    }
}

#[test]
fn unlit_surfaces_shine_and_scatter_nothing() {
    let imported = import(with_extension("unlit", json!({})));
    let MaterialDesc::Surface { base, emission, .. } = wrapper(&imported) else { panic!() };
    assert_eq!(*emission, Some(ColorDesc::Solid([1.0; 3])));
    let black = MaterialDesc::Lambertian { color: ColorDesc::Solid([0.0; 3]) };
    assert_eq!(imported.desc.materials[base], black);
}

#[test]
fn specular_glossiness_is_approximated() {
    for (specular, metalness) in [([0.04; 3], 0.0), ([0.9, 0.6, 0.3], 1.0)] {
        let material = json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0.2, 0.3, 0.4, 1.0], "specularFactor": specular,
            "glossinessFactor": 0.75}}});
        let imported = Builder::with_material(material).import_warned(&["archived"]);
        let surface = surface_of(&imported);
        assert_eq!(surface.specular_roughness, ScalarDesc::Value(0.25));
        assert_eq!(surface.base_metalness, ScalarDesc::Value(metalness));
        let expected = if metalness == 1.0 { specular } else { [0.2, 0.3, 0.4] };
        assert_eq!(surface.base_color, ColorDesc::Solid(expected));
        if metalness == 0.0 {
            assert!((surface.specular_ior - 1.5).abs() < 1e-12);
        }
    }
}

#[test]
fn what_cannot_be_said_is_warned_of() {
    for (name, extension, part) in [
        ("dispersion", json!({"dispersion": 0.1}), "no dispersion"),
        ("ior", json!({"ior": 0.0}), "taken as 1.5"),
        ("anisotropy", json!({"anisotropyStrength": 0.5, "anisotropyRotation": 1.0}), "rotation"),
        (
            "clearcoat",
            json!({"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}),
            "coat",
        ),
    ] {
        Builder::with_material(with_extension(name, extension)).import_warned(&[part]);
    }
}

#[test]
fn pictures_inside_the_file_become_assets() {
    use base64::Engine as _;
    let textured = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    let mut file = Builder::with_material(textured.clone());
    let view = file.view(PNG);
    let data = format!("data:image/png;base64,{}", base64::prelude::BASE64_STANDARD.encode(PNG));
    for (picture, name) in [
        (json!({"bufferView": view, "mimeType": "image/png"}), "image 0.png"),
        (json!({"uri": data, "name": "brick/wall.png"}), "brick_wall.png"),
    ] {
        file.json["images"] = json!([picture]);
        let imported = file.import_clean();
        assert_eq!(imported.assets.len(), 1);
        assert_eq!(&*imported.assets[name], PNG);
        let ColorDesc::Texture(texture) = &surface_of(&imported).base_color else { panic!() };
        assert_eq!(image(&imported, texture).0, format!("embedded:{name}"));
    }
}

#[test]
fn pictures_that_cannot_be_read_are_left_out() {
    let textured = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    for (list, entry, part) in [
        ("images", json!({"uri": "a.ktx2"}), "KTX"),
        ("images", json!({"uri": "data:image/webp;base64,UklGRg=="}), "image/webp"),
        ("images", json!({}), "neither"),
        ("textures", json!({}), "no picture"),
        ("textures", json!({"extensions": {"KHR_texture_basisu": {"source": 0}}}), "KTX2"),
        ("textures", json!({"extensions": {"EXT_texture_webp": {"source": 0}}}), "WebP"),
    ] {
        let mut file = Builder::with_material(textured.clone());
        file.json[list][0] = entry;
        let imported = file.import_warned(&[part]);
        assert_eq!(surface_of(&imported).base_color, ColorDesc::Solid([1.0; 3]));
    }
    // A picture that can be read beside one that cannot.
    let mut file = Builder::with_material(textured);
    file.json["textures"][0]["extensions"] = json!({"EXT_texture_webp": {"source": 7}});
    file.import_clean();
}
