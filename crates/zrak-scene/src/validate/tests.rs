//! One good scene, spoilt in one way at a time.

use super::{KeyPath, validate};
use crate::builtin;
use crate::desc::*;

/// A scene with a bit of everything.
fn good() -> SceneDesc {
    crate::file::parse(
        r#"
        format = 1
        name = "good"
        camera = { look_from = [0, 0, 9], look_at = [0, 0, 0], vfov_deg = 40, width = 8, height = 8 }

        [textures]
        inner = { kind = "checker", scale = 1, even = [0, 0, 0], odd = [1, 1, 1] }
        outer = { kind = "checker", scale = 1, even = "inner", odd = [1, 1, 1] }
        noise = { kind = "noise", scale = 1 }
        image = { kind = "image", path = "builtin:earth.png" }
        bright = { kind = "solid", color = [9, 9, 9] }

        [materials]
        matte = { kind = "lambertian", color = "outer" }
        metal = { kind = "metal", color = [1, 1, 1], fuzz = 0.5 }
        glass = { kind = "dielectric", ior = 1.5 }
        smoke = { kind = "isotropic", color = [1, 1, 1] }
        light = { kind = "diffuse_light", color = "bright" }

        [[objects]]
        kind = "sphere"
        center = [0, 0, 0]
        radius = 1
        material = "glass"

        [[objects]]
        kind = "quad"
        corner = [0, 0, 0]
        u = [1, 0, 0]
        v = [0, 1, 0]
        material = "light"

        [[objects]]
        kind = "triangle"
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        material = "matte"

        [[objects]]
        kind = "box"
        min = [0, 0, 0]
        max = [1, 1, 1]
        material = "metal"

        [[objects]]
        kind = "medium"
        boundary = { kind = "sphere", center = [0, 0, 0], radius = 1 }
        density = 1
        material = "smoke"

        [[objects]]
        kind = "group"
        objects = [{ kind = "sphere", center = [0, 0, 0], radius = 1, material = "glass" }]
        "#,
        "good.toml",
    )
    .unwrap()
}

/// Spoils the scene and checks the path and a part of the text of every problem, in order.
#[track_caller]
fn check(spoil: impl FnOnce(&mut SceneDesc), expected: &[(&str, &str)]) {
    let mut scene = good();
    spoil(&mut scene);
    let problems = validate(&scene);
    assert_eq!(problems.len(), expected.len(), "{problems:#?}");
    for (problem, (path, text)) in problems.iter().zip(expected) {
        assert_eq!(problem.path.to_string(), *path, "{problem}");
        assert!(problem.to_string().contains(text), "no {text:?} in: {problem}");
    }
}

/// The same for one object, which replaces the first.
#[track_caller]
fn check_object(object: &str, expected: &[(&str, &str)]) {
    check(|scene| scene.objects[0] = object_of(object), expected);
}

/// An object from the inside of an inline table.
fn object_of(fields: &str) -> ObjectDesc {
    let table: toml::Table = toml::from_str(&format!("object = {{ {fields} }}")).unwrap();
    table["object"].clone().try_into().unwrap()
}

fn material(scene: &mut SceneDesc, material: MaterialDesc) {
    scene.materials.insert("metal".to_owned(), material);
}

#[test]
fn built_in_scenes_have_no_problems() {
    for builtin in builtin::all() {
        assert_eq!(validate(&(builtin.build)()), [], "{}", builtin.name);
    }
}

#[test]
fn an_empty_scene_is_allowed() {
    check(|scene| scene.objects.clear(), &[]);
}

#[test]
fn format() {
    check(|scene| scene.format = 2, &[("format", "this zrak reads 1")]);
}

#[test]
fn camera_view() {
    check(|s| s.camera.look_at = [0.0, 0.0, 9.0], &[("camera.look_at", "same point")]);
    check(
        |s| [s.camera.look_from, s.camera.look_at] = [[1e8, 0.0, 0.0], [1e8 + 1.0, 0.0, 0.0]],
        &[("camera.look_at", "same point")],
    );
    check(|s| s.camera.vup = [0.0, 0.0, -3.0], &[("camera.vup", "parallel")]);
    check(|s| s.camera.vup = [0.0; 3], &[("camera.vup", "no length")]);
    check(|s| s.camera.look_from[1] = f64::NAN, &[("camera.look_from[1]", "not NaN")]);
    check(|s| s.camera.look_from[0] = 1e13, &[("camera.look_from[0]", "1e12")]);
}

#[test]
fn camera_lens_and_shutter() {
    for bad in [0.0, 180.0, -1.0] {
        check(|s| s.camera.vfov_deg = bad, &[("camera.vfov_deg", "between 0 and 180")]);
    }
    check(|s| s.camera.vfov_deg = f64::INFINITY, &[("camera.vfov_deg", "finite")]);
    check(|s| s.camera.defocus_angle_deg = 180.0, &[("camera.defocus_angle_deg", "pinhole")]);
    check(|s| s.camera.focus_distance = 0.0, &[("camera.focus_distance", "more than 0")]);
    check(|s| s.camera.shutter_open_s = 2.0, &[("camera.shutter_close_s", "before it opens")]);
    check(|s| s.camera.shutter_open_s = 1.0, &[]);
}

#[test]
fn picture_size() {
    let size = |width, height, expected: &[(&str, &str)]| {
        check(|s| [s.camera.width, s.camera.height] = [width, height], expected);
    };
    size(1, 1, &[]);
    size(65_536, 4096, &[]);
    size(16_384, 16_384, &[]);
    size(0, 0, &[("camera.width", "from 1 to 65536"), ("camera.height", "is 0")]);
    size(100_000, 1, &[("camera.width", "is 100000")]);
    size(65_536, 4097, &[("camera.width", "too large")]);
}

#[test]
fn sampling() {
    check(|s| s.render.samples_per_pixel = 0, &[("render.samples_per_pixel", "is 0")]);
    check(|s| s.render.samples_per_pixel = 1 << 24, &[]);
    check(|s| s.render.samples_per_pixel += 1 << 24, &[("render.samples_per_pixel", "16777216")]);
    check(|s| s.render.max_depth = 0, &[("render.max_depth", "is 0")]);
    check(|s| s.render.max_depth = 65_536, &[("render.max_depth", "65535")]);
}

#[test]
fn background() {
    let gradient = |bottom| BackgroundDesc::Gradient { bottom, top: [1.0; 3] };
    check(|s| s.background = gradient([0.0, -0.5, 0.0]), &[("background.bottom[1]", "-0.5")]);
    check(|s| s.background = gradient([1e10, 1.0, 1.0]), &[("background.bottom[0]", "1e9")]);
}

#[test]
fn materials() {
    let solid = ColorDesc::Solid;
    let metal = |color, fuzz| MaterialDesc::Metal { color: solid(color), fuzz };
    check(|s| material(s, metal([1.0; 3], 1.5)), &[("materials.metal.fuzz", "is 1.5")]);
    check(
        |s| material(s, metal([1.0, 1.1, 0.0], 0.0)),
        &[("materials.metal.color[1]", "at most 1")],
    );
    check(
        |s| material(s, metal([f64::NAN, 0.0, -1.0], 0.0)),
        &[("materials.metal.color[0]", "not NaN"), ("materials.metal.color[2]", "not -1")],
    );
    let dielectric = |ior| MaterialDesc::Dielectric { ior, fresnel: FresnelDesc::Exact };
    check(|s| material(s, dielectric(0.0)), &[("materials.metal.ior", "more than 0")]);
    check(|s| material(s, dielectric(0.6667)), &[]);
    let principled =
        |surface: PrincipledDesc| MaterialDesc::Principled { surface: Box::new(surface) };
    check(|s| material(s, principled(PrincipledDesc::default())), &[]);
    let bad = PrincipledDesc {
        base_color: solid([1.5, 0.0, 0.0]),
        specular_roughness: (-0.1).into(),
        coat_weight: 2.0.into(),
        coat_ior: 0.9,
        specular_ior: 0.0,
        thin_film_thickness: f64::NAN.into(),
        fuzz_roughness: ScalarDesc::Texture("nowhere".to_owned()),
        ..PrincipledDesc::default()
    };
    check(
        |s| material(s, principled(bad)),
        &[
            ("materials.metal.surface.specular_roughness", "from 0 to 1"),
            ("materials.metal.surface.coat_weight", "from 0 to 1"),
            ("materials.metal.surface.fuzz_roughness", "nowhere"),
            ("materials.metal.surface.thin_film_thickness", "finite"),
            ("materials.metal.surface.specular_ior", "at least 0.01"),
            ("materials.metal.surface.coat_ior", "at least 1"),
            ("materials.metal.surface.base_color[0]", "at most 1"),
        ],
    );
    let light = |color| MaterialDesc::DiffuseLight { color: solid(color), sides: LightSides::Both };
    check(|s| material(s, light([1e9, 5.0, 0.0])), &[]);
    check(
        |s| material(s, light([1e10, 5.0, -1.0])),
        &[("materials.metal.color[0]", "1e9"), ("materials.metal.color[2]", "not -1")],
    );
}

#[test]
fn textures() {
    fn insert(name: &'static str, texture: TextureDesc) -> impl FnOnce(&mut SceneDesc) {
        move |scene| drop(scene.textures.insert(name.to_owned(), texture))
    }
    let checker = |scale, even: &str| {
        let even = ColorDesc::Texture(even.to_owned());
        TextureDesc::Checker { scale, even, odd: ColorDesc::Solid([1.0; 3]) }
    };
    let noise = |scale, octaves, high| {
        let pattern = NoisePattern::Noise;
        TextureDesc::Noise { scale, pattern, octaves, seed: 0, low: [0.0; 3], high }
    };
    check(insert("outer", checker(0.0, "inner")), &[("textures.outer.scale", "more than 0")]);
    check(insert("outer", checker(1.0, "iner")), &[("textures.outer.even", "mean `inner`?")]);
    check(insert("noise", noise(-1.0, 7, [1.0; 3])), &[("textures.noise.scale", "more than 0")]);
    check(insert("noise", noise(1.0, 17, [1.0; 3])), &[("textures.noise.octaves", "is 17")]);
    check(
        insert("noise", noise(1.0, 7, [-1.0; 3])),
        &[
            ("textures.noise.high[0]", "-1"),
            ("textures.noise.high[1]", "-1"),
            ("textures.noise.high[2]", "-1"),
        ],
    );
    let image = TextureDesc::image(String::new(), ImageFilter::Nearest);
    check(insert("image", image), &[("textures.image.path", "empty")]);
    // What only lights use may be bright; what reflects may not, however deep it is nested.
    let too_bright = TextureDesc::Solid { color: [1.0, 1.0, 1.5] };
    check(insert("noise", too_bright.clone()), &[]);
    check(insert("inner", too_bright), &[("textures.inner.color[2]", "is 1.5")]);
}

#[test]
fn texture_nesting() {
    fn chain(scene: &mut SceneDesc, len: usize, last: &str) {
        let name = |i: usize| format!("t{i}");
        for i in 0..len {
            let even = ColorDesc::Texture(if i + 1 == len { last.to_owned() } else { name(i + 1) });
            // Both squares the same: the number of ways down doubles on each level.
            let texture = TextureDesc::Checker { scale: 1.0, odd: even.clone(), even };
            scene.textures.insert(name(i), texture);
        }
    }
    check(|s| chain(s, 15, "bright"), &[]);
    check(|s| chain(s, 16, "bright"), &[("textures.t0", "more than 16 deep")]);
    check(|s| chain(s, 1, "t0"), &[("textures.t0.even", "contains itself")]);
    check(
        |s| chain(s, 3, "t0"),
        &[
            ("textures.t0.even", "`t0` contains itself"),
            ("textures.t1.even", "`t1` contains itself"),
            ("textures.t2.even", "`t2` contains itself"),
        ],
    );
    // A long circle, and a way into a circle, end as well.
    let mut scene = good();
    chain(&mut scene, 40, "t20");
    assert_eq!(validate(&scene).len(), 40);
}

#[test]
fn names() {
    let sphere = "kind = 'sphere', center = [0, 0, 0], radius = 1";
    let at = "objects[0].material";
    check_object(&format!("{sphere}, material = 'glas'"), &[(at, "did you mean `glass`?")]);
    check_object(&format!("{sphere}, material = 'x'"), &[(at, "are `glass`, `light`, `matte`")]);
    check_object(&format!("{sphere}, material = 'smoke'"), &[(at, "for media, not surfaces")]);
    let mut scene = good();
    scene.materials.clear();
    assert!(validate(&scene)[0].to_string().contains("the scene has no materials"));
}

#[test]
fn spheres() {
    let sphere = |fields: &str, expected: &[(&str, &str)]| {
        check_object(&format!("kind = 'sphere', material = 'glass', {fields}"), expected);
    };
    sphere("center = [0, 0, 0], radius = 0", &[("objects[0].radius", "more than 0")]);
    sphere("center = [0, 0, 0], radius = -1", &[("objects[0].radius", "hollow sphere")]);
    sphere(
        "center = [0, nan, 0], radius = inf",
        &[("objects[0].center[1]", "NaN"), ("objects[0].radius", "finite")],
    );
    sphere(
        "center = [0, 0, 0], center_end = [0, 0, 1e300], radius = 1",
        &[("objects[0].center_end[2]", "1e300")],
    );
    sphere("center = [1e12, 0, 0], radius = 1e12", &[("objects[0]", "reaches further")]);
}

#[test]
fn flat_shapes() {
    let shape = |fields: &str, expected: &[(&str, &str)]| {
        check_object(&format!("material = 'glass', {fields}"), expected);
    };
    let quad = "kind = 'quad', corner = [0, 0, 0]";
    for edges in ["u = [1, 2, 3], v = [-2, -4, -6]", "u = [0, 0, 0], v = [1, 0, 0]"] {
        shape(&format!("{quad}, {edges}"), &[("objects[0].u", "no area")]);
    }
    let triangle = |vertices: &str, expected: &[(&str, &str)]| {
        shape(&format!("kind = 'triangle', vertices = [{vertices}]"), expected);
    };
    triangle("[0, 0, 0], [1, 1, 1], [2, 2, 2]", &[("objects[0].vertices", "no area")]);
    triangle("[0, 0, 0], [0, 0, 0], [2, 2, 2]", &[("objects[0].vertices", "no area")]);
    triangle("[0, 0, 0], [0, 1, 0], [inf, 2, 2]", &[("objects[0].vertices[2][0]", "inf")]);
    let uv = "uv = [[0, 0], [0, nan], [1, 1]]";
    let vertices = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
    shape(&format!("kind = 'triangle', {vertices}, {uv}"), &[("objects[0].uv[1][1]", "NaN")]);
    shape("kind = 'box', min = [0, 0, 0], max = [1, 0, 1]", &[("objects[0].max", "along y")]);
}

#[test]
fn media() {
    let medium = |fields: &str, expected: &[(&str, &str)]| {
        check_object(&format!("kind = 'medium', {fields}"), expected);
    };
    let ball = "boundary = { kind = 'sphere', center = [0, 0, 0], radius = 1 }";
    medium(&format!("{ball}, density = 1, material = 'smoke'"), &[]);
    medium(&format!("{ball}, density = 0, material = 'smoke'"), &[("objects[0].density", "more")]);
    medium(
        &format!("{ball}, density = 1, material = 'glass'"),
        &[("objects[0].material", "needs an `isotropic` material")],
    );
    let bad = "boundary = { kind = 'sphere', center = [0, 0, 0], radius = 0 }";
    medium(
        &format!("{bad}, density = 1, material = 'smoke'"),
        &[("objects[0].boundary.radius", "more than 0")],
    );
    let bad = "boundary = { kind = 'box', min = [1, 0, 0], max = [0, 1, 1] }";
    medium(
        &format!("{bad}, density = 1, material = 'smoke'"),
        &[("objects[0].boundary.max", "along x")],
    );
}

#[test]
fn transforms() {
    let transform = |steps: &str, expected: &[(&str, &str)]| {
        let sphere = "kind = 'sphere', center = [0, 0, 0], radius = 1, material = 'glass'";
        check_object(&format!("{sphere}, transform = [{steps}]"), expected);
    };
    transform("{ rotate_x_deg = 3 }, { scale = [1, -2, 3] }, { translate = [1, 2, 3] }", &[]);
    transform("{ scale = 0 }", &[("objects[0].transform[0].scale", "is 0")]);
    transform("{ scale = 2 }, { scale = [1, 0, 1] }", &[("objects[0].transform[1].scale", "is 0")]);
    transform(
        "{ rotate = { axis = [0, 0, 0], angle_deg = 5 } }",
        &[("objects[0].transform[0].rotate.axis", "no length")],
    );
    transform("{ rotate_y_deg = nan }", &[("objects[0].transform[0].rotate_y_deg", "finite")]);
    transform(
        "{ matrix = [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]] }",
        &[("objects[0].transform[0].matrix", "no inverse")],
    );
    transform(
        "{ matrix = [[1, 0, 0, 0], [0, nan, 0, 0], [0, 0, 1, 0]] }",
        &[("objects[0].transform[0].matrix[1][1]", "NaN")],
    );
    transform("{ scale = 1e-8 }, { scale = 1e-8 }", &[("objects[0].transform", "1e-12")]);
    transform("{ translate = [1e12, 0, 0] }", &[("objects[0]", "reaches further")]);
}

#[test]
fn parts_of_spheres() {
    let sphere = "kind = 'sphere', center = [0, 5, 0], radius = 2, material = 'glass'";
    check_object(&format!("{sphere}, z_min = -1, z_max = 0.5, phi_max_deg = 90"), &[]);
    check_object(&format!("{sphere}, z_min = -9, z_max = 9, center_end = [1, 5, 0]"), &[]);
    for (part, key, words) in [
        ("z_min = 2", "z_min", "less than `radius`"),
        ("z_max = -2", "z_max", "more than"),
        ("z_min = 1, z_max = 1", "z_max", "more than"),
        ("phi_max_deg = 0", "phi_max_deg", "more than 0"),
        ("phi_max_deg = 361", "phi_max_deg", "360"),
        ("z_min = nan", "z_min", "finite"),
    ] {
        check_object(&format!("{sphere}, {part}"), &[(&format!("objects[0].{key}"), words)]);
    }
}

#[test]
fn curves() {
    let points = "points = [[0, 0, 0], [1, 0, 0], [2, 1, 0], [3, 0, 0]]";
    let curve = |rest: &str| format!("kind = 'curve', material = 'glass', {rest}");
    check_object(&curve(&format!("{points}, widths = [0.1, 0]")), &[]);
    let ribbon = format!("{points}, widths = [1, 1], form = 'ribbon'");
    check_object(&curve(&format!("{ribbon}, normals = [[0, 0, 1], [0, 1, 0]]")), &[]);
    for (rest, key, words) in [
        ("points = [], widths = [1, 1]".to_owned(), "points", "4, 7"),
        (
            "points = [[0, 0, 0], [1, 1, 1], [2, 2, 2]], widths = [1, 1]".to_owned(),
            "points",
            "4, 7",
        ),
        (
            "points = [[1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]], widths = [1, 1]".to_owned(),
            "points",
            "no length",
        ),
        (format!("{points}, widths = [0, 0]"), "widths", "not both 0"),
        (format!("{points}, widths = [-1, 2]"), "widths", "not be negative"),
        (format!("{points}, widths = [inf, 2]"), "widths[0]", "must lie in"),
        (format!("{points}, widths = [1, 1], normals = [[0, 0, 1]]"), "normals", "only ribbons"),
        (ribbon.clone(), "normals", "2 normals"),
        (format!("{ribbon}, normals = [[0, 0, 1], [0, 0, 0]]"), "normals[1]", "no direction"),
    ] {
        check_object(&curve(&rest), &[(&format!("objects[0].{key}"), words)]);
    }
}

#[test]
fn groups() {
    let sphere = "kind = 'sphere', center = [0, 0, 0], radius = 1, material = 'glass'";
    // Harmless steps that together are not.
    let inner = format!("{{ {sphere}, transform = [{{ scale = 1e-8 }}] }}");
    check_object(
        &format!("kind = 'group', objects = [{inner}], transform = [{{ scale = 1e-8 }}]"),
        &[("objects[0].objects[0].transform", "groups around")],
    );
    // A degenerate group is said once, not for each member.
    check_object(
        &format!("kind = 'group', objects = [{{ {sphere} }}], transform = [{{ scale = 0 }}]"),
        &[("objects[0].transform[0].scale", "is 0")],
    );
    let nested = |n_groups: usize| {
        let mut object = object_of(sphere);
        for _ in 0..n_groups {
            object = ObjectDesc::Group { objects: vec![object], transform: Vec::new() };
        }
        object
    };
    check(|s| s.objects[0] = nested(64), &[]);
    let mut path = KeyPath::default().join("objects").join(0);
    for _ in 0..64 {
        path = path.join("objects").join(0);
    }
    check(|s| s.objects[0] = nested(65), &[(&path.to_string(), "more than 64 deep")]);
}
