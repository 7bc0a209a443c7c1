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
    ObjectDesc::Sphere { center: [0.0; 3], center_end, radius: 1.0, material, transform }
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
