use proptest::collection::{btree_map, vec};
use proptest::option;
use proptest::prelude::*;

use crate::builtin;
use crate::desc::*;
use crate::file::{parse, parse_tree, to_desc, write_string};

/// Reads without asking whether the scene makes sense.
fn read_back(text: &str) -> SceneDesc {
    let origin = "written.toml";
    parse_tree(text, origin).and_then(|tree| to_desc(tree, text, origin)).unwrap()
}

#[test]
fn built_in_scenes_come_back() {
    for builtin in builtin::all() {
        let scene = (builtin.build)();
        assert_eq!(parse(&write_string(&scene), builtin.name).unwrap(), scene);
    }
}

#[test]
fn numbers_are_short_and_exact() {
    let check = |x: f64, expected: &str| {
        let mut scene = (builtin::find("quads").unwrap().build)();
        scene.camera.vfov_deg = x;
        let text = write_string(&scene);
        assert!(text.contains(&format!("vfov_deg = {expected}\n")), "{expected}: {text}");
        assert_eq!(read_back(&text).camera.vfov_deg.to_bits(), x.to_bits());
    };
    check(40.0, "40");
    check(-0.0, "-0.0");
    check(0.1, "0.1");
    check(1e-300, "1e-300");
    check(1e300, "1e300");
    check(1e15, "1000000000000000.0");
    check(f64::MIN_POSITIVE / 4.0, "5.562684646268003e-309");
    check(123_456_789.125, "123456789.125");
}

#[test]
fn the_export_is_pleasant() {
    let text = write_string(&(builtin::find("cornell-box").unwrap().build)());
    let expected = r#"# A scene for zrak; docs/scene-format.md explains the format.

format = 1
name = "cornell-box"
description = "The Cornell box with two boxes"

[camera]
look_from = [278, 278, -800]
look_at = [278, 278, 0]
vup = [0, 1, 0]
vfov_deg = 40
width = 400
height = 400
defocus_angle_deg = 0
focus_distance = 10
shutter_open_s = 0
shutter_close_s = 1

[render]
samples_per_pixel = 200
max_depth = 50
seed = 0

[background]
kind = "constant"
color = [0, 0, 0]

[materials]
green = { kind = "lambertian", color = [0.12, 0.45, 0.15] }
light = { kind = "diffuse_light", color = [15, 15, 15], sides = "both" }
red = { kind = "lambertian", color = [0.65, 0.05, 0.05] }
white = { kind = "lambertian", color = [0.73, 0.73, 0.73] }

[[objects]]
kind = "quad"
corner = [555, 0, 0]
u = [0, 555, 0]
v = [0, 0, 555]
material = "green"
"#;
    assert!(text.starts_with(expected), "{text}");
    assert!(text.contains("transform = [{ rotate_y_deg = 15 }, { translate = [265, 0, 295] }]\n"));
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        (-1000..1000_i32).prop_map(f64::from),
        -10.0..10.0,
        Just(-0.0),
    ]
}

fn triple() -> impl Strategy<Value = Triple> {
    [number(), number(), number()]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z_0-9-]{1,8}", any::<String>(), Just("a \"b\"\n\\\t\u{7f}\u{0}é".to_owned())]
}

fn color() -> impl Strategy<Value = ColorDesc> {
    prop_oneof![triple().prop_map(ColorDesc::Solid), name().prop_map(ColorDesc::Texture)]
}

fn texture() -> impl Strategy<Value = TextureDesc> {
    let pattern = prop::sample::select(vec![
        NoisePattern::Noise,
        NoisePattern::Turbulence,
        NoisePattern::Marble,
    ]);
    let filter = prop::sample::select(vec![ImageFilter::Bilinear, ImageFilter::Nearest]);
    prop_oneof![
        triple().prop_map(|color| TextureDesc::Solid { color }),
        (number(), color(), color()).prop_map(|(scale, even, odd)| TextureDesc::Checker {
            scale,
            even,
            odd
        }),
        (number(), pattern, any::<u32>(), any::<u32>(), triple(), triple()).prop_map(
            |(scale, pattern, octaves, seed, low, high)| TextureDesc::Noise {
                scale,
                pattern,
                octaves,
                seed,
                low,
                high
            }
        ),
        (name(), filter).prop_map(|(path, filter)| TextureDesc::image(path, filter)),
    ]
}

fn material() -> impl Strategy<Value = MaterialDesc> {
    let fresnel = prop::sample::select(vec![FresnelDesc::Exact, FresnelDesc::Schlick]);
    let sides = prop::sample::select(vec![LightSides::Both, LightSides::Front]);
    prop_oneof![
        color().prop_map(|color| MaterialDesc::Lambertian { color }),
        (color(), number()).prop_map(|(color, fuzz)| MaterialDesc::Metal { color, fuzz }),
        (number(), fresnel).prop_map(|(ior, fresnel)| MaterialDesc::Dielectric { ior, fresnel }),
        color().prop_map(|color| MaterialDesc::Isotropic { color }),
        (color(), sides).prop_map(|(color, sides)| MaterialDesc::DiffuseLight { color, sides }),
    ]
}

fn step() -> impl Strategy<Value = TransformStep> {
    let row = || [number(), number(), number(), number()];
    prop_oneof![
        triple().prop_map(TransformStep::Translate),
        (triple(), number())
            .prop_map(|(axis, angle_deg)| TransformStep::Rotate { axis, angle_deg }),
        number().prop_map(TransformStep::RotateXDeg),
        number().prop_map(TransformStep::RotateYDeg),
        number().prop_map(TransformStep::RotateZDeg),
        number().prop_map(|factor| TransformStep::Scale(ScaleDesc::Uniform(factor))),
        triple().prop_map(|factors| TransformStep::Scale(ScaleDesc::PerAxis(factors))),
        [row(), row(), row()].prop_map(TransformStep::Matrix),
    ]
}

fn transform() -> impl Strategy<Value = Vec<TransformStep>> {
    vec(step(), 0..3)
}

fn boundary() -> impl Strategy<Value = BoundaryDesc> {
    prop_oneof![
        (triple(), option::of(triple()), number(), transform()).prop_map(
            |(center, center_end, radius, transform)| BoundaryDesc::Sphere {
                center,
                center_end,
                radius,
                transform
            }
        ),
        (triple(), triple(), transform()).prop_map(|(min, max, transform)| BoundaryDesc::Box {
            min,
            max,
            transform
        }),
    ]
}

fn object() -> impl Strategy<Value = ObjectDesc> {
    let uv = || [number(), number()];
    let shape = prop_oneof![
        (
            (triple(), option::of(triple()), number()),
            [option::of(number()), option::of(number()), option::of(number())],
            name(),
            transform()
        )
            .prop_map(|((center, center_end, radius), part, material, transform)| {
                let [z_min, z_max, phi_max_deg] = part;
                ObjectDesc::Sphere {
                    center,
                    center_end,
                    radius,
                    z_min,
                    z_max,
                    phi_max_deg,
                    material,
                    transform,
                }
            }),
        (
            vec(triple(), 0..5),
            [number(), number()],
            prop_oneof![Just(CurveForm::Flat), Just(CurveForm::Cylinder), Just(CurveForm::Ribbon)],
            vec(triple(), 0..3),
            name(),
            transform()
        )
            .prop_map(|(points, widths, form, normals, material, transform)| {
                ObjectDesc::Curve { points, widths, form, normals, material, transform }
            }),
        (triple(), triple(), triple(), name(), transform()).prop_map(
            |(corner, u, v, material, transform)| ObjectDesc::Quad {
                corner,
                u,
                v,
                material,
                transform
            }
        ),
        ([triple(), triple(), triple()], [uv(), uv(), uv()], name(), transform()).prop_map(
            |(vertices, uv, material, transform)| ObjectDesc::Triangle {
                vertices,
                uv,
                material,
                transform
            }
        ),
        (triple(), triple(), name(), transform()).prop_map(|(min, max, material, transform)| {
            ObjectDesc::Box { min, max, material, transform }
        }),
        (boundary(), number(), name(), transform()).prop_map(
            |(boundary, density, material, transform)| ObjectDesc::Medium {
                boundary,
                density,
                material,
                transform
            }
        ),
    ];
    shape.prop_recursive(4, 16, 3, |member| {
        (vec(member, 0..3), transform())
            .prop_map(|(objects, transform)| ObjectDesc::Group { objects, transform })
    })
}

prop_compose! {
    fn camera()(
        [look_from, look_at, vup] in [triple(), triple(), triple()],
        [vfov_deg, defocus_angle_deg, focus_distance, shutter_open_s, shutter_close_s]
            in [number(), number(), number(), number(), number()],
        [width, height] in any::<[u32; 2]>(),
    ) -> CameraDesc {
        CameraDesc {
            look_from, look_at, vup, vfov_deg, width, height,
            defocus_angle_deg, focus_distance, shutter_open_s, shutter_close_s,
            ..CameraDesc::default()
        }
    }
}

prop_compose! {
    fn scene()(
        name in any::<String>(),
        description in any::<String>(),
        camera in camera(),
        (samples_per_pixel, max_depth, seed) in any::<(u32, u32, u64)>(),
        background in prop_oneof![
            triple().prop_map(|color| BackgroundDesc::Constant { color }),
            (triple(), triple()).prop_map(|(bottom, top)| BackgroundDesc::Gradient { bottom, top }),
        ],
        textures in btree_map(name(), texture(), 0..4),
        materials in btree_map(name(), material(), 0..4),
        objects in vec(object(), 0..4),
    ) -> SceneDesc {
        let rr_depth = max_depth / 2;
        let render = RenderDesc { samples_per_pixel, max_depth, rr_depth, seed };
        SceneDesc { format: 1, name, description, camera, render, background, textures, materials, objects, ..SceneDesc::default() }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_reads_back(scene in scene()) {
        let text = write_string(&scene);
        let back = read_back(&text);
        prop_assert_eq!(&back, &scene, "{}", text);
        // Equality of descriptions does not see the sign of zero; a second text does.
        prop_assert_eq!(write_string(&back), text);
    }
}
