//! Textures, pictures, lights made of them, and what has facts of its own.

use zrak_image::{Format, Picture, Transfer, encode};
use zrak_scene::desc::{
    BackgroundDesc, ColorDesc, ConductorDesc, ImageChannel, ImageEncoding, ImageFilter, LightDesc,
    MappingDesc, MaterialDesc, ObjectDesc, ScalarDesc, TextureDesc, WrapMode,
};
use zrak_scene::validate::validate;

use super::{Folder, HEAD, read};
use crate::{ImportOptions, Imported, import};

/// A picture of two by two texels, the upper left of which is as bright as `value`, the others black.
fn picture(format: Format, value: f32) -> Vec<u8> {
    let mut pixels = vec![[0.0; 3]; 4];
    pixels[0] = [value; 3];
    let picture = Picture { width: 2, height: 2, pixels };
    encode(format, &picture, None, Transfer::Srgb).unwrap()
}

/// Reads a scene beside which are `a.png` and `a.exr`.
fn with_pictures(head: &str, world: &str) -> Imported {
    let folder = Folder::new(&[("scene.pbrt", &format!("{head}{world}"))]);
    std::fs::write(folder.path("a.png"), picture(Format::Png, 1.0)).unwrap();
    std::fs::write(folder.path("a.exr"), picture(Format::Exr, 8.0)).unwrap();
    let imported = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap();
    let problems = validate(&imported.desc);
    assert!(problems.is_empty(), "{problems:?}");
    imported
}

#[test]
fn every_texture_has_its_parameters() {
    let imported = with_pictures(
        HEAD,
        "Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n\
         Texture \"f\" \"float\" \"constant\" \"float value\" 0.25\n\
         Texture \"scale\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"texture scale\" \"f\"\n\
         Texture \"mix\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"rgb tex2\" [1 0 0] \"texture amount\" \"f\"\n\
         Texture \"bilerp\" \"float\" \"bilerp\" \"float v00\" .1 \"float v11\" .9\n\
         Texture \"check\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"float vdelta\" .5\n\
         Translate 1 0 0\n\
         Texture \"cubes\" \"float\" \"checkerboard\" \"integer dimension\" 3\n\
         Texture \"planar\" \"spectrum\" \"dots\" \"string mapping\" \"planar\" \"vector3 v1\" [0 0 2] \
         \"float udelta\" .5\n\
         Texture \"ball\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"string mapping\" \"spherical\" \
         \"string wrap\" \"clamp\" \"string filter\" \"point\" \"float scale\" 2 \"string encoding\" \"linear\"\n\
         Texture \"not\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"bool invert\" true \"float scale\" .25\n\
         Texture \"fbm\" \"float\" \"fbm\" \"integer octaves\" 3 \"float roughness\" .4\n\
         Texture \"wrinkled\" \"float\" \"wrinkled\"\nTexture \"windy\" \"float\" \"windy\"\n",
    );
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    let textures = &imported.desc.textures;
    let named = |name: &str| ColorDesc::Texture(name.to_owned());
    assert_eq!(textures["spectrum:c"], TextureDesc::Solid { color: [0.1, 0.2, 0.3] });
    assert_eq!(
        textures["spectrum:scale"],
        TextureDesc::Multiply { a: named("spectrum:c"), b: named("float:f") }
    );
    let amount = ScalarDesc::Texture("float:f".to_owned());
    let mix = TextureDesc::Mix { a: named("spectrum:c"), b: [1.0, 0.0, 0.0].into(), amount };
    assert_eq!(textures["spectrum:mix"], mix);
    let corners = [[0.1; 3], [1.0; 3], [0.0; 3], [0.9; 3]];
    assert_eq!(textures["float:bilerp"], TextureDesc::Bilerp { corners, mapping: MappingDesc::Uv });
    let TextureDesc::UvChecker { even, odd, mapping } = &textures["spectrum:check"] else {
        panic!()
    };
    assert_eq!((even, odd), (&[1.0; 3].into(), &[0.0; 3].into()));
    let matrix = [[4.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
    assert_eq!(*mapping, MappingDesc::UvAffine { matrix });
    assert!(
        matches!(&textures["float:cubes"], TextureDesc::Placed { transform, .. } if transform.len() == 1)
    );
    let TextureDesc::Dots { mapping: MappingDesc::Planar { matrix }, .. } =
        &textures["spectrum:planar"]
    else {
        panic!()
    };
    // In the texture's space, which is moved by 1 along x.
    assert_eq!(*matrix, [[0.0, 0.0, 2.0, 0.5], [0.0, 1.0, 0.0, 0.0]]);
    let TextureDesc::Image { filter, wrap_u, wrap_v, encoding, scale, mapping, .. } =
        &textures["spectrum:ball"]
    else {
        panic!()
    };
    assert_eq!((filter, scale), (&ImageFilter::Nearest, &2.0));
    assert_eq!(
        (wrap_u, wrap_v, encoding),
        (&WrapMode::Clamp, &WrapMode::Clamp, &ImageEncoding::Linear)
    );
    assert!(matches!(mapping, MappingDesc::Spherical { transform } if transform.len() == 1));
    // 1 - s x = (1 - s) 1 + s (1 - x).
    let TextureDesc::Mix { a, b: ColorDesc::Texture(inner), amount } = &textures["float:not"]
    else {
        panic!()
    };
    assert_eq!((a, amount), (&[1.0; 3].into(), &ScalarDesc::Value(0.25)));
    assert!(matches!(&textures[inner], TextureDesc::Image { invert: true, scale: 1.0, .. }));
    let TextureDesc::Placed { texture: ColorDesc::Texture(inner), .. } = &textures["float:fbm"]
    else {
        panic!()
    };
    assert!(matches!(&textures[inner], TextureDesc::Fractal { octaves: 3, roughness: 0.4, .. }));
}

#[test]
fn nearest_textures_are_warned_about_once_each() {
    let imported = read(
        "Texture \"d\" \"float\" \"directionmix\" \"vector3 dir\" [0 1 0]\n\
         Texture \"m\" \"spectrum\" \"marble\" \"float variation\" .3\n\
         Texture \"p\" \"spectrum\" \"ptex\" \"string filename\" \"x.ptx\"\n",
    );
    let lines: Vec<usize> = imported.warnings.iter().map(|w| w.line).collect();
    assert_eq!(lines, [5, 6, 7], "{:?}", imported.warnings);
}

#[test]
fn textures_are_for_every_parameter() {
    let desc = read(
        "Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n\
         Texture \"f\" \"float\" \"constant\" \"float value\" 0.25\n\
         Material \"coatedconductor\" \"texture reflectance\" \"c\" \"texture interface.roughness\" \"f\" \
         \"texture conductor.uroughness\" \"f\" \"texture thickness\" \"f\" \"texture albedo\" \"c\" \
         \"texture g\" \"f\" \"texture displacement\" \"f\"\nShape \"sphere\" \"texture alpha\" \"f\"\n",
    )
    .desc;
    let ObjectDesc::Sphere { material, .. } = &desc.objects[0] else { panic!() };
    let MaterialDesc::Surface { base, alpha, bump, .. } = &desc.materials[material] else {
        panic!()
    };
    let f = ScalarDesc::Texture("float:f".to_owned());
    assert_eq!((alpha.as_ref(), bump.as_ref()), (Some(&f), Some(&f)));
    let MaterialDesc::CoatedConductor { metal, metal_roughness, coat } = &desc.materials[base]
    else {
        panic!()
    };
    let c = ColorDesc::Texture("spectrum:c".to_owned());
    assert_eq!(*metal, ConductorDesc::Reflectance { reflectance: c });
    assert_eq!((&metal_roughness.u, &coat.roughness.u), (&f, &f));
    // Those that must be plain are those of constant textures.
    assert_eq!((coat.thickness, coat.albedo, coat.g), (0.25, [0.1, 0.2, 0.3], 0.25));
}

#[test]
fn names_may_come_later() {
    let desc = read(
        "NamedMaterial \"later\"\nShape \"sphere\" \"float alpha\" .5\nObjectInstance \"thing\"\n\
         Material \"diffuse\" \"texture reflectance\" \"paint\"\nMediumInterface \"fog\" \"\"\nShape \"disk\"\n\
         MakeNamedMaterial \"later\" \"string type\" \"dielectric\" \"texture displacement\" \"h\"\n\
         Texture \"h\" \"float\" \"fbm\"\nTexture \"paint\" \"spectrum\" \"constant\"\n\
         MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nObjectBegin \"thing\"\nShape \"sphere\"\nObjectEnd\n",
    )
    .desc;
    let ObjectDesc::Sphere { material, .. } = &desc.objects[0] else { panic!() };
    let MaterialDesc::Surface { base, bump: Some(_), alpha: Some(_), .. } =
        &desc.materials[material]
    else {
        panic!("{:?}", desc.materials[material])
    };
    assert!(matches!(desc.materials[base], MaterialDesc::Dielectric { .. }));
}

#[test]
fn numbers_are_the_alpha_of_pictures_that_have_one() {
    let folder = Folder::new(&[(
        "scene.pbrt",
        &format!("{HEAD}Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"a.png\"\n"),
    )]);
    // One white texel, half there, with stored (not packed) data.
    let png = {
        let chunk = |kind: &[u8], data: &[u8]| {
            let mut crc = flate2::Crc::new();
            crc.update(kind);
            crc.update(data);
            let length = (data.len() as u32).to_be_bytes();
            [&length[..], kind, data, &crc.sum().to_be_bytes()].concat()
        };
        let head = [0, 0, 0, 1, 0, 0, 0, 1, 8, 6, 0, 0, 0];
        let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        std::io::Write::write_all(&mut zlib, &[0, 255, 255, 255, 128]).unwrap();
        let data = zlib.finish().unwrap();
        [
            b"\x89PNG\r\n\x1a\n".to_vec(),
            chunk(b"IHDR", &head),
            chunk(b"IDAT", &data),
            chunk(b"IEND", &[]),
        ]
        .concat()
    };
    std::fs::write(folder.path("a.png"), png).unwrap();
    let desc = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap().desc;
    let TextureDesc::Image { channel, .. } = &desc.textures["float:a"] else { panic!() };
    assert_eq!(*channel, ImageChannel::A);
}

#[test]
fn pictures_shine() {
    let imported = with_pictures(
        HEAD,
        "AreaLightSource \"diffuse\" \"string filename\" \"a.exr\" \"float scale\" 3 \"bool twosided\" true\n\
         Shape \"disk\"\n\
         AreaLightSource \"diffuse\" \"string filename\" \"a.exr\" \"float power\" 10\nShape \"disk\"\n\
         LightSource \"infinite\" \"string filename\" \"a.exr\" \"float illuminance\" 5\n",
    );
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    let desc = &imported.desc;
    let emission = |i: usize| {
        let ObjectDesc::Disk { material, .. } = &desc.objects[i] else { panic!() };
        let MaterialDesc::Surface {
            emission: Some(ColorDesc::Texture(name)),
            emission_strength,
            ..
        } = &desc.materials[material]
        else {
            panic!()
        };
        let TextureDesc::Image { wrap_u: WrapMode::Clamp, .. } = &desc.textures[name] else {
            panic!()
        };
        *emission_strength
    };
    assert_eq!(emission(0), 3.0);
    // The disk's area is pi, and the picture's mean is 8 / 4.
    let pi = std::f64::consts::PI;
    assert!((emission(1) * 2.0 * pi * pi / 10.0 - 1.0).abs() < 1e-4, "{}", emission(1));
    let BackgroundDesc::Image { tint, .. } = &desc.background else { panic!() };
    // The upper left of the four texels' middles is where z is 1 - r^2 with r = 1 - (1 - 2/2) = 1: 0.
    assert!(tint.iter().all(|x| x.is_finite()));
}

#[test]
fn illuminance_is_that_of_the_upper_half() {
    let folder = Folder::new(&[(
        "scene.pbrt",
        &format!(
            "{HEAD}LightSource \"infinite\" \"string filename\" \"even.exr\" \"float illuminance\" 6\n"
        ),
    )]);
    let even = Picture { width: 64, height: 64, pixels: vec![[2.0; 3]; 64 * 64] };
    let bytes = encode(Format::Exr, &even, None, Transfer::Srgb).unwrap();
    std::fs::write(folder.path("even.exr"), bytes).unwrap();
    let desc = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap().desc;
    let BackgroundDesc::Image { tint, .. } = &desc.background else { panic!() };
    // pbrt's sum over the hemisphere's texels weighs each as 2 pi over all texels: half of the integral.
    let expected = 6.0 / (0.5 * std::f64::consts::PI * 2.0);
    assert!((tint[1] / expected - 1.0).abs() < 2e-3, "{tint:?} {expected}");
}

#[test]
fn power_is_spread_over_the_area() {
    let desc = read(
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"float power\" 100\nScale 2 2 2\nShape \"sphere\" \
         \"float radius\" .5\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" \
         [0 1 2 2 1 3]\nLightSource \"point\" \"rgb I\" [2 2 2] \"float scale\" 3 \"float power\" 4\n",
    )
    .desc;
    let strength = |i: usize| {
        let (ObjectDesc::Sphere { material, .. } | ObjectDesc::Mesh { material, .. }) =
            &desc.objects[i]
        else {
            panic!()
        };
        let MaterialDesc::Surface { emission_strength, .. } = &desc.materials[material] else {
            panic!()
        };
        *emission_strength
    };
    let pi = std::f64::consts::PI;
    assert!((strength(0) - 100.0 / (pi * 4.0 * pi)).abs() < 1e-9);
    // As pbrt has it, each of the triangles has the whole power; each has an area of 2.
    assert!((strength(1) - 100.0 / (pi * 2.0)).abs() < 1e-9);
    let LightDesc::Point { intensity, .. } = &desc.lights[0] else { panic!() };
    assert!((intensity[0] - 2.0 * 3.0 * 4.0 / (4.0 * pi)).abs() < 1e-12);
}

#[test]
fn what_does_not_shine_in_pbrt_does_not_shine() {
    let imported = read(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nMaterial \"interface\"\nShape \"sphere\"\n\
         Material \"diffuse\"\nObjectBegin \"a\"\nShape \"sphere\"\nObjectEnd\nAttributeEnd\nObjectInstance \"a\"\n",
    );
    let shining = |m: &MaterialDesc| matches!(m, MaterialDesc::Surface { emission: Some(_), .. });
    assert!(!imported.desc.materials.values().any(shining));
    assert_eq!(imported.warnings.len(), 2, "{:?}", imported.warnings);
}

#[test]
fn exposure_is_the_shutters_time_and_the_films_speed() {
    let head = "Camera \"perspective\" \"float shutteropen\" 0 \"float shutterclose\" 0.5\n\
                Film \"rgb\" \"float iso\" 400\nWorldBegin\n";
    let desc = with_pictures(head, "LightSource \"infinite\" \"rgb L\" [1 2 3]\n").desc;
    assert_eq!(desc.background, BackgroundDesc::Constant { color: [2.0, 4.0, 6.0] });
}

#[test]
fn even_infinite_lights_add_up() {
    let desc = read(
        "LightSource \"infinite\" \"rgb L\" [1 2 3]\nLightSource \"infinite\" \"rgb L\" [1 0 0] \"float scale\" 2\n",
    )
    .desc;
    assert_eq!(desc.background, BackgroundDesc::Constant { color: [3.0, 2.0, 3.0] });
}

#[test]
fn media_and_metals_are_known_by_name() {
    let desc = read(
        "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"string preset\" \"Wholemilk\" \"float scale\" 10\n\
         Material \"conductor\" \"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" \"metal-Al-k\"\nShape \"sphere\"\n\
         Material \"conductor\"\nShape \"sphere\"\n",
    )
    .desc;
    assert_eq!(desc.media["milk"].sigma_s, [25.5, 32.1, 37.7]);
    let reflectance = |i: usize| {
        let ObjectDesc::Sphere { material, .. } = &desc.objects[i] else { panic!() };
        let MaterialDesc::Conductor { metal: ConductorDesc::Index { eta, k }, .. } =
            &desc.materials[material]
        else {
            panic!()
        };
        [0, 1, 2].map(|c| {
            let (n, k) = (eta[c], k[c]);
            ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
        })
    };
    // Aluminium is nearly white, at 0.91 to 0.93; copper, the metal of those that do not say, is red.
    let aluminium = reflectance(0);
    assert!(aluminium.iter().all(|r| (r - 0.92).abs() < 0.015), "{aluminium:?}");
    let copper = reflectance(1);
    assert!(copper[0] > 0.93 && (copper[1] - 0.64).abs() < 0.06 && copper[2] < 0.58, "{copper:?}");
}

#[test]
fn lenses_are_thin_ones_of_their_focal_length() {
    let head = "Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 20 \
                \"float focusdistance\" 1e6\n\
                Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 400 \"float diagonal\" 50\nWorldBegin\n";
    // f = 100 mm.
    let lens = "# a thin lens\n100 0 1.5 20\n0 0 1.5 20 # the stop\n-100 50 1 20\n";
    let folder = Folder::new(&[("scene.pbrt", head), ("lens.dat", lens)]);
    let camera = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap().desc.camera;
    // The film is 30 by 40 mm.
    let expected = 2.0 * (20.0_f64 / 100.0).atan().to_degrees();
    assert!((camera.vfov_deg - expected).abs() < 1e-3, "{} {expected}", camera.vfov_deg);
    let radius = camera.focus_distance * (camera.defocus_angle_deg / 2.0).to_radians().tan();
    assert!((radius - 0.01).abs() < 1e-6, "{radius}");
}
