//! What is written is read as it was: in the world, whatever the names.

use std::collections::BTreeMap;
use std::path::Path;

use zrak_scene::builtin;
use zrak_scene::desc::{
    BackgroundDesc, CameraDesc, ColorDesc, CurveForm, LightSides, MaterialDesc, MeshDesc,
    ObjectDesc, ScalarDesc, SceneDesc, TextureDesc, TransformStep,
};
use zrak_scene::lower::{Embedded, Transform};
use zrak_scene::validate::validate;

use super::Folder;
use crate::{ExportOptions, Exported, ImportOptions, Imported, export, import};

/// Writes a scene, and reads it again.
fn again(desc: &SceneDesc, base: &Path, options: &ExportOptions) -> (Exported, Imported, Folder) {
    let exported = export(desc, base, &Embedded::default(), options).unwrap();
    let folder = Folder::new(&[("scene.pbrt", &exported.text)]);
    std::fs::create_dir_all(folder.path(&options.folder)).unwrap();
    for (name, bytes) in &exported.files {
        std::fs::write(folder.path(name), bytes).unwrap();
    }
    let imported = import(&folder.path("scene.pbrt"), &ImportOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{}", exported.text));
    assert!(validate(&imported.desc).is_empty());
    (exported, imported, folder)
}

/// A scene without names: what is where in the world, and what it is made of.
#[derive(Debug, Default, PartialEq)]
struct Plain {
    camera: String,
    lights: Vec<String>,
    objects: Vec<String>,
}

/// Few enough digits that rounding, and maps of several steps, do not matter.
fn rounded(text: &str) -> String {
    let mut out = String::new();
    let mut number = String::new();
    let flush = |number: &mut String, out: &mut String| {
        match number.parse::<f64>() {
            Ok(x) if number.contains('.') || number.contains('e') => {
                let x = if x.abs() < 1e-5 { 0.0 } else { x };
                out.push_str(&format!("{x:.4e}"));
            }
            _ => out.push_str(number),
        }
        number.clear();
    };
    for c in text.chars() {
        let starts = number.is_empty() && (c.is_ascii_digit() || c == '-');
        let goes_on = !number.is_empty()
            && (c.is_ascii_digit() || c == '.' || c == 'e' || (c == '-' && number.ends_with('e')));
        if starts || goes_on {
            number.push(c);
        } else {
            flush(&mut number, &mut out);
            out.push(c);
        }
    }
    flush(&mut number, &mut out);
    out
}

struct Flat<'a> {
    desc: &'a SceneDesc,
    objects: Vec<String>,
}

impl Flat<'_> {
    fn texture(&self, name: &str) -> String {
        let map = |steps: &[TransformStep]| format!("{:?}", Transform::of_steps(steps).rows);
        match &self.desc.textures[name] {
            TextureDesc::Mix { a, b, amount } => {
                format!("mix({}, {}, {})", self.color(a), self.color(b), self.scalar(amount))
            }
            TextureDesc::Multiply { a, b } => {
                format!("product({}, {})", self.color(a), self.color(b))
            }
            TextureDesc::UvChecker { even, odd, mapping } => {
                format!("checks({}, {}, {mapping:?})", self.color(even), self.color(odd))
            }
            TextureDesc::Dots { inside, outside, mapping } => {
                format!("dots({}, {}, {mapping:?})", self.color(inside), self.color(outside))
            }
            TextureDesc::Checker { scale, even, odd } => format!(
                "placed({}, cubes(1.0, {}, {}))",
                map(&[TransformStep::Scale(zrak_scene::desc::ScaleDesc::Uniform(*scale))]),
                self.color(even),
                self.color(odd)
            ),
            TextureDesc::Placed { texture, transform } => {
                let ColorDesc::Texture(inner) = texture else { return self.color(texture) };
                let whole = Transform::of_steps(transform);
                let inside = match &self.desc.textures[inner] {
                    TextureDesc::Checker { even, odd, .. } => {
                        format!("cubes(1.0, {}, {})", self.color(even), self.color(odd))
                    }
                    other => format!("{other:?}"),
                };
                format!("placed({:?}, {inside})", whole.rows)
            }
            // Where the file is, and how its numbers are said to be meant.
            TextureDesc::Image { filter, wrap_u, channel, scale, invert, mapping, .. } => {
                format!("image({filter:?} {wrap_u:?} {channel:?} {scale:?} {invert} {mapping:?})")
            }
            other => format!("{other:?}"),
        }
    }

    fn color(&self, color: &ColorDesc) -> String {
        match color {
            ColorDesc::Solid(color) => format!("{color:?}"),
            ColorDesc::Texture(name) => self.texture(name),
        }
    }

    fn scalar(&self, scalar: &ScalarDesc) -> String {
        match scalar {
            ScalarDesc::Value(x) => format!("{x:?}"),
            ScalarDesc::Texture(name) => self.texture(name),
        }
    }

    fn material(&self, name: &str) -> String {
        let mut material = self.desc.materials[name].clone();
        // Lights of their own are surfaces that shine and reflect nothing.
        if let MaterialDesc::DiffuseLight { color, sides } = &material {
            return format!(
                "surface(Lambertian [0.0, 0.0, 0.0], {} 1.0 {sides:?})",
                self.color(color)
            );
        }
        if let MaterialDesc::Surface {
            base,
            emission,
            emission_strength,
            emission_sides,
            alpha,
            bump,
            normal_map,
            medium,
            ..
        } = &material
        {
            let mut out = format!("surface({}", self.material(base));
            if let Some(emission) = emission {
                out +=
                    &format!(", {} {emission_strength:?} {emission_sides:?}", self.color(emission));
            }
            if let Some(alpha) = alpha {
                out += &format!(", alpha {}", self.scalar(alpha));
            }
            if let Some(bump) = bump {
                out += &format!(", bump {}", self.scalar(bump));
            }
            if let Some(medium) = medium {
                let of = |name: &Option<String>| name.as_ref().map(|name| &self.desc.media[name]);
                out += &format!(", media {:?} {:?}", of(&medium.inside), of(&medium.outside));
            }
            return format!("{out}, {})", normal_map.is_some());
        }
        if let MaterialDesc::Mix { materials: [a, b], amount } = &material {
            return format!(
                "mix({}, {}, {})",
                self.material(a),
                self.material(b),
                self.scalar(amount)
            );
        }
        // Textures by what they are.
        let mut names = BTreeMap::new();
        for (i, color) in colors_of(&mut material).into_iter().enumerate() {
            names.insert(format!("texture {i}"), self.color(color));
            *color = [0.0; 3].into();
        }
        format!("{material:?} {names:?}")
    }

    /// An object as points of the world that have to stay, and its material.
    fn object(&mut self, object: &ObjectDesc, outer: &Transform) {
        let at = |steps: &[TransformStep]| Transform::of_steps(steps).then(outer);
        let (shape, material) = match object {
            ObjectDesc::Sphere {
                center,
                center_end,
                radius,
                z_min,
                z_max,
                phi_max_deg,
                material,
                transform,
            } => {
                let map = at(transform);
                let place = |c: [f64; 3]| {
                    // A whole sphere is the same however it is turned.
                    let rows = match map.uniform_scale() {
                        Some(s) if z_min.or(*z_max).or(*phi_max_deg).is_none() => {
                            format!("{:?}", s * radius)
                        }
                        _ => {
                            let moved = Transform::of_steps(&[TransformStep::Translate(c)]);
                            format!("{:?} {radius:?}", moved.then(&map).rows)
                        }
                    };
                    format!("{:?} {rows}", map.point(c))
                };
                let end = center_end.map(place);
                (
                    format!(
                        "sphere {} {end:?} {z_min:?} {z_max:?} {phi_max_deg:?}",
                        place(*center)
                    ),
                    material,
                )
            }
            ObjectDesc::Quad { corner, u, v, material, transform } => {
                let sum = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|i| a[i] + b[i]);
                let (a, b) = (sum(corner, u), sum(corner, v));
                let points = [*corner, a, b, sum(&a, v)].map(|p| at(transform).point(p));
                (format!("patch {points:?}"), material)
            }
            ObjectDesc::Triangle { vertices, material, transform, .. } => {
                (format!("mesh {:?}", vertices.map(|p| at(transform).point(p))), material)
            }
            ObjectDesc::Mesh { mesh, material, transform, flip, .. } => {
                let map = at(transform);
                let points: Vec<[f64; 3]> = match self.desc.meshes[mesh].inlined() {
                    MeshDesc::Patches { positions, patches, .. } => {
                        let corners = patches.into_iter().flatten();
                        let points: Vec<[f64; 3]> = corners
                            .map(|v| map.point(positions[v as usize].map(f64::from)))
                            .collect();
                        self.objects.push(rounded(&format!(
                            "patch {points:?} {}",
                            self.material(material)
                        )));
                        return;
                    }
                    MeshDesc::Inline { positions, triangles, .. } => {
                        let corners = triangles.into_iter().flatten();
                        corners.map(|v| map.point(positions[v as usize].map(f64::from))).collect()
                    }
                    other => panic!("{other:?}"),
                };
                let flip = if *flip { "flipped " } else { "" };
                (format!("mesh {flip}{points:?}"), material)
            }
            ObjectDesc::Disk { material, transform, .. }
            | ObjectDesc::Cylinder { material, transform, .. }
            | ObjectDesc::Curve { material, transform, .. } => {
                let mut plain = object.clone();
                if let ObjectDesc::Disk { material, transform, .. }
                | ObjectDesc::Cylinder { material, transform, .. }
                | ObjectDesc::Curve { material, transform, .. } = &mut plain
                {
                    (*material, *transform) = (String::new(), Vec::new());
                }
                (format!("{plain:?} {:?}", at(transform).rows), material)
            }
            ObjectDesc::Group { objects, transform } => {
                let map = at(transform);
                objects.iter().for_each(|object| self.object(object, &map));
                return;
            }
            ObjectDesc::Instance { prototype, transform, transform_end } => {
                let map = at(transform);
                if let Some(end) = transform_end {
                    let first = self.objects.len();
                    for object in &self.desc.prototypes[prototype] {
                        self.object(object, &map);
                    }
                    for moving in &mut self.objects[first..] {
                        *moving += &rounded(&format!(" to {:?}", at(end).rows));
                    }
                    return;
                }
                let desc = self.desc;
                desc.prototypes[prototype].iter().for_each(|object| self.object(object, &map));
                return;
            }
            // Boxes and fogs become other things.
            ObjectDesc::Box { material, .. } | ObjectDesc::Medium { material, .. } => {
                (format!("{object:?}"), material)
            }
        };
        let line = format!("{shape} {}", self.material(material));
        self.objects.push(rounded(&line));
    }
}

/// The colours of a material.
fn colors_of(material: &mut MaterialDesc) -> Vec<&mut ColorDesc> {
    use zrak_scene::desc::ConductorDesc::Reflectance;
    match material {
        MaterialDesc::Lambertian { color }
        | MaterialDesc::Metal { color, .. }
        | MaterialDesc::Isotropic { color }
        | MaterialDesc::CoatedDiffuse { color, .. } => vec![color],
        MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
            vec![reflectance, transmittance]
        }
        MaterialDesc::Conductor { metal: Reflectance { reflectance }, .. }
        | MaterialDesc::CoatedConductor { metal: Reflectance { reflectance }, .. } => {
            vec![reflectance]
        }
        _ => Vec::new(),
    }
}

fn plain(desc: &SceneDesc) -> Plain {
    let mut flat = Flat { desc, objects: Vec::new() };
    desc.objects.iter().for_each(|object| flat.object(object, &Transform::IDENTITY));
    let mut objects = flat.objects;
    objects.sort();
    let c = &desc.camera;
    let unit = |v: [f64; 3]| crate::maths::unit(v).unwrap();
    let view = unit(crate::maths::sub(c.look_at, c.look_from));
    let right = unit(crate::maths::cross(view, c.vup));
    let lens = c.focus_distance * (c.defocus_angle_deg / 2.0).to_radians().tan();
    let camera = format!(
        "{:?} {view:?} {right:?} {:?} {:?} {} {} {lens:?} {:?} {} {:?}",
        c.look_from,
        c.vfov_deg,
        c.projection,
        c.width,
        c.height,
        if lens > 0.0 { c.focus_distance } else { 1.0 },
        c.flip_x,
        c.medium.as_ref().map(|m| &desc.media[m])
    );
    let mut lights: Vec<String> = desc.lights.iter().map(|l| rounded(&format!("{l:?}"))).collect();
    lights.push(match &desc.background {
        BackgroundDesc::Image { mapping, strength, tint, transform, .. } => {
            let tint = tint.map(|x| x * strength);
            rounded(&format!("{mapping:?} {tint:?} {:?}", Transform::of_steps(transform).rows))
        }
        other => rounded(&format!("{other:?}")),
    });
    Plain { camera: rounded(&camera), lights, objects }
}

#[track_caller]
fn is_the_same(desc: &SceneDesc, base: &Path) {
    let (exported, imported, _folder) = again(desc, base, &ExportOptions::default());
    let (before, after) = (plain(desc), plain(&imported.desc));
    assert_eq!(before.camera, after.camera);
    assert_eq!(before.lights, after.lights);
    assert_eq!(before.objects.len(), after.objects.len(), "{}", exported.text);
    for (a, b) in before.objects.iter().zip(&after.objects) {
        assert_eq!(a, b, "{}", exported.text);
    }
    assert!(exported.warnings.is_empty(), "{:?}", exported.warnings);
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    let (a, b) = (&desc.render, &imported.desc.render);
    assert_eq!(
        (a.samples_per_pixel, a.max_depth, a.seed),
        (b.samples_per_pixel, b.max_depth, b.seed)
    );
}

/// Scenes of zrak's own, with their folders: those built in and those in the repository.
fn scenes() -> Vec<(String, SceneDesc, std::path::PathBuf)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut all: Vec<_> = builtin::all()
        .iter()
        .map(|scene| (scene.name.to_owned(), (scene.build)(), folder.clone()))
        .collect();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let desc = zrak_scene::file::read(&path).unwrap().desc;
            all.push((
                path.file_name().unwrap().to_string_lossy().into_owned(),
                desc,
                folder.clone(),
            ));
        }
    }
    all
}

#[test]
fn every_scene_is_written_and_read_and_from_then_on_stays_as_it_is() {
    for (name, desc, base) in scenes() {
        let options = ExportOptions::default();
        let (first, once, folder) = again(&desc, &base, &options);
        // What is lost is lost at once, and said.
        let (second, twice, _) = again(&once.desc, folder.0.path(), &options);
        let (a, b) = (plain(&once.desc), plain(&twice.desc));
        assert_eq!(a.camera, b.camera, "{name}");
        assert_eq!(a.lights, b.lights, "{name}");
        for (a, b) in a.objects.iter().zip(&b.objects) {
            assert_eq!(a, b, "{name}");
        }
        assert_eq!(a.objects.len(), b.objects.len(), "{name}");
        let camera =
            |desc: &SceneDesc| plain(&SceneDesc { objects: Vec::new(), ..desc.clone() }).camera;
        assert_eq!(camera(&desc), camera(&once.desc), "{name}");
        assert!(
            second.warnings.len() <= first.warnings.len().max(1),
            "{name}: {:?}",
            second.warnings
        );
    }
}

#[test]
fn what_pbrt_can_say_comes_back_the_same() {
    let text = r#"
        format = 1
        name = "all"
        camera = { look_from = [1, 2, 9], look_at = [0, 1, 0], vfov_deg = 35, width = 160, height = 90, defocus_angle_deg = 0.5, focus_distance = 7 }
        render = { samples_per_pixel = 12, max_depth = 9, seed = 3 }
        background = { kind = "constant", color = [0.1, 0.2, 0.3] }
        [textures]
        plain = { kind = "solid", color = [0.2, 0.4, 0.6] }
        check = { kind = "uv_checker", even = "plain", odd = [1, 0, 0], mapping = { kind = "uv_affine", matrix = [[4, 0, 0.5], [0, 2, 0]] } }
        cubes = { kind = "checker", scale = 0.5, even = [0.9, 0.9, 0.9], odd = "plain" }
        mixed = { kind = "mix", a = "check", b = [0, 1, 0], amount = 0.25 }
        half = { kind = "multiply", a = "mixed", b = [0.5, 0.5, 0.5] }
        blend = { kind = "bilerp", corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }
        picture = { kind = "image", path = "builtin:earth.png", wrap_v = "repeat", filter = "trilinear", scale = 0.5 }
        [materials]
        white = { kind = "lambertian", color = "half" }
        boxes = { kind = "lambertian", color = "cubes" }
        globe = { kind = "lambertian", color = "picture" }
        blended = { kind = "lambertian", color = "blend" }
        glass = { kind = "dielectric", ior = 1.4 }
        frosted = { kind = "rough_dielectric", ior = 1.5, roughness = { u = 0.2, map = "sqrt" } }
        pane = { kind = "thin_dielectric", ior = 1.5 }
        gold = { kind = "conductor", metal = { kind = "index", eta = [0.14, 0.37, 1.4], k = [4.0, 2.4, 1.6] }, roughness = { u = 0.1, v = 0.3, map = "alpha" } }
        red = { kind = "conductor", metal = { kind = "reflectance", reflectance = [0.9, 0.1, 0.1] } , roughness = { u = 0.0, map = "sqrt" } }
        leaf = { kind = "diffuse_transmission", reflectance = [0.2, 0.3, 0.1], transmittance = [0.1, 0.2, 0.3] }
        coated = { kind = "coated_diffuse", color = [0.5, 0.1, 0.1], coat = { ior = 1.6, thickness = 0.02, albedo = [0.1, 0.1, 0.2], g = 0.3, roughness = { u = 0.1, map = "sqrt" } } }
        plated = { kind = "coated_conductor", metal = { kind = "index", eta = [0.14, 0.37, 1.4], k = [4.0, 2.4, 1.6] }, metal_roughness = { u = 0.3, map = "sqrt" }, coat = { roughness = { u = 0.1, map = "sqrt" } } }
        both = { kind = "mix", materials = ["glass", "gold"], amount = 0.3 }
        hole = { kind = "interface" }
        lamp = { kind = "surface", base = "white", emission = [4, 5, 6], emission_sides = "front" }
        thin = { kind = "surface", base = "gold", alpha = 0.5 }
        misty = { kind = "surface", base = "hole", medium = { inside = "fog" } }
        [media]
        fog = { sigma_a = [0.1, 0.2, 0.3], sigma_s = [1, 2, 3], g = 0.4 }
        [meshes]
        tent = { kind = "inline", positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.5, 1]], triangles = [[0, 1, 3], [1, 2, 3]], uvs = [[0, 0], [1, 0], [0, 1], [1, 1]] }
        sail = { kind = "patches", positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], patches = [[0, 1, 2, 3]] }
        [[lights]]
        kind = "point"
        position = [1, 2, 3]
        intensity = [4, 5, 6]
        [[lights]]
        kind = "distant"
        direction = [0, -1, 0.5]
        irradiance = [1, 2, 3]
        [prototypes]
        pair = [{ kind = "sphere", center = [0, 0, 0], radius = 0.5, material = "gold" }, { kind = "disk", radius = 1, height = 0.2, inner_radius = 0.1, phi_max_deg = 200, material = "white" }]
        shining = [{ kind = "sphere", center = [0, 0, 0], radius = 0.5, material = "lamp" }]
        nested = [{ kind = "instance", prototype = "pair", transform = [{ translate = [0, 3, 0] }] }]
        [[objects]]
        kind = "group"
        transform = [{ rotate_y_deg = 30 }, { translate = [1, 0, 0] }]
        objects = [
          { kind = "sphere", center = [0, 1, 0], radius = 0.5, material = "glass" },
          { kind = "sphere", center = [0, 1, 0], radius = 0.5, z_max = 0.2, phi_max_deg = 300, material = "pane" },
          { kind = "sphere", center = [0, 1, 0], radius = 0.5, transform = [{ scale = [1, 2, 3] }], material = "globe" },
          { kind = "quad", corner = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], material = "boxes" },
          { kind = "triangle", vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material = "blended" },
          { kind = "cylinder", radius = 0.3, z_min = -1, z_max = 2, material = "frosted" },
          { kind = "mesh", mesh = "tent", material = "leaf", flip = true },
          { kind = "mesh", mesh = "sail", material = "coated" },
          { kind = "curve", points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 1, 0]], widths = [0.1, 0.2], form = "cylinder", material = "red" },
          { kind = "disk", radius = 1, material = "plated" },
          { kind = "disk", radius = 2, material = "both" },
          { kind = "disk", radius = 3, material = "lamp" },
          { kind = "disk", radius = 4, material = "thin" },
          { kind = "sphere", center = [0, 0, 0], radius = 9, material = "misty" },
          { kind = "instance", prototype = "pair", transform = [{ scale = [-1, 1, 1] }] },
          { kind = "instance", prototype = "shining" },
          { kind = "instance", prototype = "nested" },
        ]
        [[objects]]
        kind = "instance"
        prototype = "pair"
        transform = [{ translate = [1, 0, 0] }]
        transform_end = [{ translate = [2, 0, 0] }]
    "#;
    let folder = Folder::new(&[("all.toml", text)]);
    let desc = zrak_scene::file::read(folder.path("all.toml"))
        .unwrap_or_else(|error| panic!("{error}"))
        .desc;
    is_the_same(&desc, folder.0.path());
}

#[test]
fn cameras_come_back_the_same() {
    use zrak_scene::desc::ProjectionDesc::{EqualArea, Equirectangular, Orthographic, Perspective};
    for projection in [Perspective, Orthographic { height: 3.0 }, Equirectangular, EqualArea] {
        for (flip_x, width, height) in [(false, 90, 160), (true, 160, 90), (false, 100, 100)] {
            let camera = CameraDesc {
                look_from: [1.0, 2.0, 3.0],
                look_at: [0.5, 0.0, -1.0],
                vup: [0.1, 1.0, 0.0],
                vfov_deg: 50.0,
                projection,
                flip_x,
                width,
                height,
                shutter_close_s: 0.25,
                ..CameraDesc::default()
            };
            let mut desc = SceneDesc { camera, ..SceneDesc::default() };
            desc.background = BackgroundDesc::Constant { color: [1.0, 2.0, 3.0] };
            if projection != Perspective {
                // Not looked at.
                desc.camera.vfov_deg =
                    again(&desc, Path::new("."), &ExportOptions::default()).1.desc.camera.vfov_deg;
            }
            is_the_same(&desc, Path::new("."));
        }
    }
}

#[test]
fn windows_show_the_same_part_of_the_view() {
    let mut desc = SceneDesc::default();
    desc.camera.window = [0.5, 0.75, 0.25, 0.5];
    let (exported, imported, _) = again(&desc, Path::new("."), &ExportOptions::default());
    assert!(exported.text.contains("screenwindow"), "{}", exported.text);
    // Corners of the picture as tangents: the same, however the whole view is cut.
    let corners = |c: &CameraDesc| {
        let [x0, x1, y0, y1] = c.window;
        let half = (c.vfov_deg / 2.0).to_radians().tan();
        let aspect = (f64::from(c.width) / (x1 - x0)) / (f64::from(c.height) / (y1 - y0));
        [x0, x1]
            .map(|x| half * aspect * (2.0 * x - 1.0))
            .into_iter()
            .chain([y0, y1].map(|y| half * (1.0 - 2.0 * y)))
    };
    for (a, b) in corners(&desc.camera).zip(corners(&imported.desc.camera)) {
        assert!((a - b).abs() < 1e-9, "{:?} {:?}", desc.camera, imported.desc.camera);
    }
}

#[test]
fn meshes_are_beside_the_scene_if_they_are_large() {
    let mesh = zrak_mesh::TriangleMesh {
        positions: vec![[0.0, 0.1, 0.2], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]; 100],
        ..zrak_mesh::TriangleMesh::default()
    };
    let mut desc = SceneDesc::default();
    desc.materials.insert("m".to_owned(), MaterialDesc::Lambertian { color: [0.5; 3].into() });
    desc.meshes.insert("a / \"b\"".to_owned(), MeshDesc::Loaded(mesh.into()));
    let object = ObjectDesc::Mesh {
        mesh: "a / \"b\"".to_owned(),
        material: "m".to_owned(),
        group_materials: Vec::new(),
        flip: false,
        transform: Vec::new(),
    };
    desc.objects = vec![object.clone(), object];
    let (exported, imported, _) = again(&desc, Path::new("."), &ExportOptions::default());
    assert_eq!(exported.files.len(), 1);
    assert_eq!(exported.files[0].0, "files/a----b-.ply");
    assert_eq!(plain(&desc), plain(&imported.desc));
    let options = ExportOptions { max_inline: 100, ..ExportOptions::default() };
    let (exported, imported, _) = again(&desc, Path::new("."), &options);
    assert!(exported.files.is_empty());
    assert_eq!(plain(&desc), plain(&imported.desc));
}

#[test]
fn pictures_of_lights_and_names_of_any_letters_come_back() {
    let mut desc = SceneDesc::default();
    let name = "\"a\\b\"\n# c";
    desc.textures.insert(
        name.to_owned(),
        TextureDesc::image("builtin:earth.png", zrak_scene::desc::ImageFilter::Bilinear),
    );
    desc.materials.insert("black".to_owned(), MaterialDesc::Lambertian { color: [0.0; 3].into() });
    let mut lamp = MaterialDesc::surface("black");
    if let MaterialDesc::Surface { emission, emission_strength, emission_sides, .. } = &mut lamp {
        *emission = Some(ColorDesc::Texture(name.to_owned()));
        (*emission_strength, *emission_sides) = (3.0, LightSides::Front);
    }
    desc.materials.insert(name.to_owned(), lamp);
    desc.objects.push(ObjectDesc::Curve {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0], [3.0, 1.0, 0.0]],
        widths: [0.1, 0.1],
        form: CurveForm::Flat,
        normals: Vec::new(),
        material: name.to_owned(),
        transform: Vec::new(),
    });
    let (exported, imported, _) = again(&desc, Path::new("."), &ExportOptions::default());
    assert_eq!(exported.files[0].0, "files/earth.png");
    let shines = |m: &MaterialDesc| {
        matches!(m, MaterialDesc::Surface { emission: Some(ColorDesc::Texture(_)), emission_strength, .. }
            if *emission_strength == 3.0)
    };
    assert!(imported.desc.materials.values().any(shines));
}

#[test]
fn a_scene_with_problems_is_not_written() {
    let mut desc = SceneDesc::default();
    desc.camera.width = 0;
    let error = export(&desc, Path::new("."), &Embedded::default(), &ExportOptions::default());
    assert!(error.unwrap_err().to_string().contains("`width` must be"));
}
