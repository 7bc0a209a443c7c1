//! Materials and textures as they arrive in the arena.

use zrak_core::math::Vec3;
use zrak_core::scene::{MaterialKind, TextureKind};
use zrak_core::textures::TextureContext;
use zrak_core::textures::{PATTERN_MARBLE, TEXELS_SRGB8};

use super::{arena, scene};
use crate::desc::{
    ColorDesc, FresnelDesc, ImageFilter, MaterialDesc, NoisePattern, ObjectDesc, TextureDesc,
};
use crate::lower::{Assets, LowerOptions, lower};

fn sphere(material: &str) -> ObjectDesc {
    let (center_end, material, transform) = (None, material.to_owned(), Vec::new());
    ObjectDesc::Sphere {
        center: [0.0; 3],
        center_end,
        radius: 1.0,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material,
        transform,
    }
}

fn texture(name: &str) -> ColorDesc {
    ColorDesc::Texture(name.to_owned())
}

#[test]
fn each_sphere_gets_its_material() {
    let mut desc = scene(vec![sphere("a"), sphere("b"), sphere("c"), sphere("m")]);
    let solid = |x: f64| ColorDesc::Solid([x, 0.0, 1.0]);
    for (name, material) in [
        ("a", MaterialDesc::Metal { color: solid(0.25), fuzz: 0.5 }),
        ("b", MaterialDesc::Dielectric { ior: 1.25, fresnel: FresnelDesc::Schlick }),
        ("c", MaterialDesc::Lambertian { color: solid(0.75) }),
    ] {
        desc.materials.insert(name.to_owned(), material);
    }
    let arena = arena(&desc);
    let view = arena.view();
    let material = |i: u32| view.spheres.get(i).material;
    assert_eq!(material(0).kind(), Some(MaterialKind::Metal));
    let metal = view.metals.get(material(0).index());
    assert_eq!((metal.fuzz, metal.reflectance.solid.to_array()), (0.5, [0.25, 0.0, 1.0]));
    assert_eq!(material(1).kind(), Some(MaterialKind::Dielectric));
    assert_eq!(view.dielectrics.get(material(1).index()).ior, 1.25);
    let albedo = |i: u32| view.lambertians.get(material(i).index()).albedo.solid.r;
    assert_eq!((albedo(2), albedo(3)), (0.75, 0.5));
}

#[test]
fn nested_textures_are_lowered_once_and_inner_first() {
    let mut desc = scene(vec![sphere("m")]);
    let checker = |even: &str, odd: &str| TextureDesc::Checker {
        scale: 0.5,
        even: texture(even),
        odd: texture(odd),
    };
    for (name, description) in [
        // Their names sort against the order in which they need each other.
        ("a", checker("b", "c")),
        ("b", checker("c", "d")),
        ("c", checker("d", "d")),
        ("d", TextureDesc::Solid { color: [0.1, 0.2, 0.3] }),
        (
            "n",
            TextureDesc::Noise {
                scale: 4.0,
                pattern: NoisePattern::Marble,
                octaves: 3,
                seed: 9,
                low: [0.0; 3],
                high: [1.0; 3],
            },
        ),
    ] {
        desc.textures.insert(name.to_owned(), description);
    }
    desc.materials.insert("m".to_owned(), MaterialDesc::Lambertian { color: texture("a") });
    desc.materials.insert("z".to_owned(), MaterialDesc::Lambertian { color: texture("n") });
    let arena = arena(&desc);
    let view = arena.view();
    assert_eq!(view.checkers.len(), 3);
    assert_eq!(view.checkers.get(0).inv_scale, 2.0);
    let albedo = (0..view.lambertians.len())
        .map(|i| view.lambertians.get(i).albedo)
        .find(|albedo| albedo.texture.kind() == Some(TextureKind::Checker))
        .unwrap();
    for x in [-3.3, 0.1, 0.7, 1.2] {
        let color = albedo.evaluate(&view, &TextureContext::in_space(Vec3::splat(x)));
        assert_eq!(color.to_array(), [0.1, 0.2, 0.3]);
    }
    let noise = view.noises.get(0);
    assert_eq!((noise.pattern, noise.octaves, noise.seed), (PATTERN_MARBLE, 3, 9));
    assert_eq!(noise.scale, 4.0);
}

#[test]
fn the_built_in_map_is_there_and_decodes() {
    assert_eq!(Assets::builtin_name("builtin:earth.png"), Some("earth.png"));
    assert_eq!(Assets::builtin_name("earth.png"), None);
    assert!(Assets::names().any(|name| name == "earth.png"));
    let mut desc = scene(vec![sphere("m")]);
    let path = "builtin:earth.png".to_owned();
    let image = TextureDesc::image(path, ImageFilter::Bilinear);
    desc.textures.insert("earth".to_owned(), image);
    desc.materials.insert("m".to_owned(), MaterialDesc::Lambertian { color: texture("earth") });
    let arena = arena(&desc);
    let view = arena.view();
    let image = view.images.get(0);
    assert_eq!((image.format, image.bilinear), (TEXELS_SRGB8, 1));
    assert_eq!((view.texels.len(), view.srgb_table.len()), (image.width * image.height, 256));
    // sRGB codes decode to linear values: black, white, and the middle.
    let table = |i| view.srgb_table.get(i);
    assert_eq!((table(0), table(255)), (0.0, 1.0));
    assert!((table(128) - 0.215_860_5).abs() < 1e-6, "{}", table(128));
}

#[test]
fn missing_pictures_are_problems_with_their_place() {
    for path in ["no-such-file.png", "builtin:moon.png"] {
        let mut desc = scene(vec![sphere("m")]);
        let image = TextureDesc::image(path, ImageFilter::Nearest);
        desc.textures.insert("t".to_owned(), image);
        desc.materials.insert("m".to_owned(), MaterialDesc::Lambertian { color: texture("t") });
        let problems = match lower(&desc, &LowerOptions::new(env!("CARGO_MANIFEST_DIR"))) {
            Ok(_) => panic!("{path} exists"),
            Err(problems) => problems,
        };
        assert_eq!(problems.len(), 1);
        assert_eq!(problems[0].path.to_string(), "textures.t.path");
    }
}

#[test]
fn invalid_descriptions_are_not_lowered() {
    let desc = scene(vec![sphere("no such material")]);
    assert!(lower(&desc, &LowerOptions::new(".")).is_err());
}

#[test]
fn every_parameter_of_the_principled_surface_arrives_where_it_belongs() {
    use crate::desc::{PrincipledDesc, ScalarDesc};
    let value = |n: u8| ScalarDesc::Value(f64::from(n) / 64.0);
    let color = |n: u8| ColorDesc::Solid([f64::from(n) / 64.0, 0.5, 0.0]);
    let surface = PrincipledDesc {
        base_weight: value(1),
        base_color: color(2),
        base_metalness: value(3),
        base_diffuse_roughness: value(4),
        specular_weight: value(5),
        specular_color: color(6),
        specular_roughness: value(7),
        specular_roughness_anisotropy: value(8),
        specular_ior: 1.25,
        transmission_weight: value(9),
        transmission_color: color(10),
        subsurface_weight: value(11),
        subsurface_color: color(12),
        coat_weight: value(13),
        coat_color: color(14),
        coat_roughness: value(15),
        coat_roughness_anisotropy: value(16),
        coat_ior: 1.375,
        coat_darkening: value(17),
        fuzz_weight: value(18),
        fuzz_color: color(19),
        fuzz_roughness: value(20),
        thin_film_weight: value(21),
        thin_film_thickness: ScalarDesc::Texture("t".to_owned()),
        thin_film_ior: 1.5,
        geometry_thin_walled: true,
    };
    let mut desc = scene(vec![sphere("m")]);
    desc.textures.insert("t".to_owned(), TextureDesc::Solid { color: [22.0 / 64.0, 0.0, 0.0] });
    let principled = |surface| MaterialDesc::Principled { surface: Box::new(surface) };
    desc.materials.insert("m".to_owned(), principled(surface));
    let arena = arena(&desc);
    let view = arena.view();
    assert_eq!(view.spheres.get(0).material.kind(), Some(MaterialKind::Principled));
    let p = view.principleds.get(0).evaluate(&view, &TextureContext::in_space(Vec3::ZERO));
    let shares = [
        (p.base_weight, 1),
        (p.base_color.r, 2),
        (p.base_metalness, 3),
        (p.base_diffuse_roughness, 4),
        (p.specular_weight, 5),
        (p.specular_color.r, 6),
        (p.specular_roughness, 7),
        (p.specular_roughness_anisotropy, 8),
        (p.transmission_weight, 9),
        (p.transmission_color.r, 10),
        (p.subsurface_weight, 11),
        (p.subsurface_color.r, 12),
        (p.coat_weight, 13),
        (p.coat_color.r, 14),
        (p.coat_roughness, 15),
        (p.coat_roughness_anisotropy, 16),
        (p.coat_darkening, 17),
        (p.fuzz_weight, 18),
        (p.fuzz_color.r, 19),
        (p.fuzz_roughness, 20),
        (p.thin_film_weight, 21),
        (p.thin_film_thickness, 22),
    ];
    for (share, n) in shares {
        assert_eq!(share, f32::from(n as u8) / 64.0, "parameter {n}");
    }
    assert_eq!((p.specular_ior, p.coat_ior, p.thin_film_ior), (1.25, 1.375, 1.5));
    assert!(p.geometry_thin_walled);
    // The files' defaults are the specification's, and of a layer that is not there nothing is read.
    desc.materials.insert("m".to_owned(), principled(PrincipledDesc::default()));
    let arena = super::arena(&desc);
    let view = arena.view();
    let p = view.principleds.get(0).evaluate(&view, &TextureContext::in_space(Vec3::ZERO));
    assert_eq!((p.base_color.g, p.specular_roughness, p.specular_ior), (0.8, 0.3, 1.5));
    assert_eq!((p.coat_weight, p.fuzz_weight, p.transmission_weight), (0.0, 0.0, 0.0));
}
