//! Whole files, good and bad.

mod bad_input;
mod pictures;
mod round_trip;

use std::path::{Path, PathBuf};

use zrak_scene::desc::{
    BackgroundDesc, ColorDesc, ConductorDesc, CurveForm, LightDesc, LightSides, MaterialDesc,
    MeshDesc, ObjectDesc, ProjectionDesc, ScalarDesc, TextureDesc,
};
use zrak_scene::validate::validate;

use crate::{ImportOptions, Imported, import, import_from_memory};

/// A folder with a scene in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, text) in files {
            std::fs::write(folder.path(name), text).unwrap();
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

const HEAD: &str = "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n\
                    Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nWorldBegin\n";

fn read(world: &str) -> Imported {
    let folder = Folder::new(&[("scene.pbrt", &format!("{HEAD}{world}"))]);
    let imported = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap();
    let problems = validate(&imported.desc);
    assert!(problems.is_empty(), "{problems:?}");
    imported
}

#[track_caller]
fn refused(text: &str, words: &str) {
    let folder = Folder::new(&[("scene.pbrt", text)]);
    let error = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap_err();
    let shown = error.to_string();
    assert!(shown.contains(words), "{shown} does not say {words}");
    assert!(error.line_column().is_some(), "{shown} has no place");
}

#[test]
fn files_in_memory_are_read_as_those_in_a_folder() {
    let mut files = std::collections::BTreeMap::new();
    let mut put = |name: &str, bytes: &[u8]| files.insert(PathBuf::from(name), bytes.to_vec());
    put("scene.pbrt", format!("{HEAD}Include \"geometry/all.pbrt\"").as_bytes());
    let world = "Material \"conductor\" \"spectrum eta\" \"a/../Au.eta.spd\" \
                 \"spectrum k\" \"./Au.eta.spd\"\nShape \"plymesh\" \"string filename\" \"t.ply\"";
    put("geometry/all.pbrt", world.as_bytes());
    put("Au.eta.spd", b"300 1.5\n800 0.2\n");
    put(
        "t.ply",
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
          property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
          0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    );
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    // On disk, what does not exist has no parent.
    std::fs::create_dir(folder.path().join("a")).unwrap();
    let options = ImportOptions::default();
    let on_disk = import(&folder.path().join("scene.pbrt"), &options).unwrap();
    let path = Path::new("scene.pbrt");
    let in_memory = import_from_memory(path, files.clone(), &options).unwrap();
    assert_eq!(in_memory.desc, on_disk.desc);
    assert_eq!(in_memory.desc.meshes.len(), 1);
    for name in ["t.ply", "Au.eta.spd", "geometry/all.pbrt", "scene.pbrt"] {
        let mut fewer = files.clone();
        fewer.remove(Path::new(name));
        let error = import_from_memory(path, fewer, &options).unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    }
}

#[test]
fn files_that_include_each_other_many_times_end_at_the_limit() {
    // 2^60 times in all, and each file is a few bytes.
    let mut files = std::collections::BTreeMap::new();
    for i in 0..60 {
        let next = format!("Include \"{}.pbrt\" ", i + 1);
        files.insert(PathBuf::from(format!("{i}.pbrt")), next.repeat(2).into_bytes());
    }
    files.insert(PathBuf::from("60.pbrt"), b"Identity".to_vec());
    let options = ImportOptions { max_bytes: 1 << 24, ..ImportOptions::default() };
    let error = import_from_memory(Path::new("0.pbrt"), files, &options).unwrap_err().to_string();
    assert!(error.contains("limit"), "{error}");
}

#[test]
fn what_files_grow_to_counts_towards_the_limit() {
    let square = "\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]";
    for (world, n_times, words) in [
        ("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ".to_owned(), 30_000, "limit"),
        (
            format!(
                "Shape \"loopsubdiv\" \"integer levels\" 10 {square} \"integer indices\" [0 1 2]"
            ),
            1,
            "too many",
        ),
    ] {
        let text = format!("{HEAD}{}", world.repeat(n_times)).into_bytes();
        let path = Path::new("scene.pbrt");
        let options =
            ImportOptions { max_bytes: (1 << 20) + text.len() as u64, allow_external: false };
        let files = std::collections::BTreeMap::from([(path.to_owned(), text)]);
        let error = import_from_memory(path, files, &options).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

const TRIANGLE: &str = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

#[test]
fn cameras_are_left_handed_and_fov_is_on_the_shorter_side() {
    let desc = read(TRIANGLE).desc;
    let camera = &desc.camera;
    assert_eq!((camera.width, camera.height), (200, 100));
    assert_eq!(camera.look_from, [0.0, 0.0, 5.0]);
    assert!((camera.vfov_deg - 40.0).abs() < 1e-9);
    // pbrt's x axis points to the left of a right-handed viewer.
    assert!(camera.flip_x);
    let tall = HEAD.replace("200", "50").replace("Camera", "Scale -1 1 1 Camera");
    let folder = Folder::new(&[("s.pbrt", &tall)]);
    let desc = import(&folder.path("s.pbrt"), &ImportOptions::default()).unwrap().desc;
    assert!(!desc.camera.flip_x);
    let half_width = (20.0_f64.to_radians().tan()) * 1.0;
    let expected = 2.0 * (half_width * 2.0).atan().to_degrees();
    assert!((desc.camera.vfov_deg - expected).abs() < 1e-9, "{}", desc.camera.vfov_deg);
}

#[test]
fn crops_and_projections() {
    let text = "Camera \"orthographic\" \"float screenwindow\" [-2 2 -1 1]\n\
                Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 \
                \"float cropwindow\" [0.25 0.5 0 1] \"string filename\" \"a.png\"\nWorldBegin\n";
    let folder = Folder::new(&[("s.pbrt", text)]);
    let imported = import(&folder.path("s.pbrt"), &ImportOptions::default()).unwrap();
    let camera = &imported.desc.camera;
    assert_eq!((camera.width, camera.height), (50, 100));
    assert_eq!(camera.window, [0.25, 0.5, 0.0, 1.0]);
    assert_eq!(camera.projection, ProjectionDesc::Orthographic { height: 2.0 });
    assert_eq!(imported.filename.as_deref(), Some("a.png"));
}

#[test]
fn attributes_are_forgotten_and_transforms_pile_up() {
    let desc = read(
        "AttributeBegin\n Translate 1 2 3\n Scale 2 2 2\n Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\n\
         Shape \"sphere\" \"float radius\" 2\nAttributeEnd\nShape \"sphere\"\n",
    )
    .desc;
    let [
        ObjectDesc::Sphere { radius, transform, material, .. },
        ObjectDesc::Sphere { transform: none, material: default, .. },
    ] = &desc.objects[..]
    else {
        panic!("{:?}", desc.objects)
    };
    // The first step turns the texture.
    assert_eq!((*radius, none.len(), default.as_str()), (2.0, 1, "default"));
    let zrak_scene::desc::TransformStep::Matrix(m) = transform[1] else { panic!() };
    assert_eq!(m, [[2.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 2.0], [0.0, 0.0, 2.0, 3.0]]);
    let color = ColorDesc::Solid([0.1, 0.2, 0.3]);
    assert_eq!(desc.materials[material], MaterialDesc::Lambertian { color });
}

#[test]
fn lights_shine_as_much_as_they_say() {
    let desc = read(
        "LightSource \"point\" \"point3 from\" [1 2 3] \"rgb I\" [4 5 6] \"float scale\" 2\n\
         LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [3 3 3]\n\
         LightSource \"spot\" \"point3 to\" [0 0 1] \"float coneangle\" 20\n\
         LightSource \"infinite\" \"blackbody L\" 6500 \"float scale\" 3\n\
         AreaLightSource \"diffuse\" \"rgb L\" [7 8 9] \"bool twosided\" true\nShape \"disk\"\n",
    )
    .desc;
    assert_eq!(
        desc.lights[0],
        LightDesc::Point { position: [1.0, 2.0, 3.0], intensity: [8.0, 10.0, 12.0] }
    );
    let LightDesc::Distant { direction, irradiance } = &desc.lights[1] else { panic!() };
    assert_eq!((*direction, *irradiance), ([0.0, -1.0, 0.0], [3.0; 3]));
    let LightDesc::Spot { falloff_start_deg, .. } = &desc.lights[2] else { panic!() };
    assert_eq!(*falloff_start_deg, 15.0);
    // A black body is normalised to a luminance of 1.
    let BackgroundDesc::Constant { color: [r, g, b] } = desc.background else { panic!() };
    assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 3.0).abs() < 1e-3);
    let ObjectDesc::Disk { material, .. } = &desc.objects[0] else { panic!() };
    let MaterialDesc::Surface { emission, emission_sides, .. } = &desc.materials[material] else {
        panic!()
    };
    assert_eq!(*emission, Some(ColorDesc::Solid([7.0, 8.0, 9.0])));
    assert_eq!(*emission_sides, LightSides::Both);
}

#[test]
fn materials_and_textures() {
    let desc = read(
        "MakeNamedMaterial \"gold\" \"string type\" \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \
         \"spectrum k\" \"metal-Au-k\" \"float roughness\" 0.25\n\
         MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n\
         MakeNamedMaterial \"both\" \"string type\" \"mix\" \"string materials\" [\"gold\" \"glass\"] \
         \"float amount\" 0.3\nNamedMaterial \"both\"\nShape \"sphere\" \"float alpha\" 0.5\n\
         Material \"coateddiffuse\" \"float roughness\" 0.1 \"bool remaproughness\" false\n\
         Shape \"sphere\"\n",
    )
    .desc;
    let MaterialDesc::Conductor { metal, roughness } = &desc.materials["named:gold"] else {
        panic!()
    };
    assert!(matches!(metal, ConductorDesc::Index { eta, .. } if eta[2] > 1.0));
    assert_eq!(roughness.u, ScalarDesc::Value(0.25));
    assert_eq!(roughness.map, zrak_scene::desc::RoughnessMap::Sqrt);
    let MaterialDesc::Dielectric { ior, .. } = desc.materials["named:glass"] else { panic!() };
    assert!((ior - 1.5167).abs() < 1e-9);
    let ObjectDesc::Sphere { material, .. } = &desc.objects[0] else { panic!() };
    let MaterialDesc::Surface { base, alpha, .. } = &desc.materials[material] else { panic!() };
    assert_eq!((base.as_str(), alpha), ("named:both", &Some(ScalarDesc::Value(0.5))));
    let ObjectDesc::Sphere { material, .. } = &desc.objects[1] else { panic!() };
    let MaterialDesc::CoatedDiffuse { coat, .. } = &desc.materials[material] else { panic!() };
    assert_eq!(coat.roughness.map, zrak_scene::desc::RoughnessMap::Alpha);
}

#[test]
fn textures_are_described_where_they_cannot_be_rendered_yet() {
    let world = "Texture \"a\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"rgb tex1\" [1 0 0]\n\
                 Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5\n";
    let folder = Folder::new(&[("s.pbrt", &format!("{HEAD}{world}"))]);
    let desc = import(&folder.path("s.pbrt"), &ImportOptions::default()).unwrap().desc;
    let TextureDesc::Multiply { a, b } = &desc.textures["spectrum:b"] else { panic!() };
    assert_eq!(*a, ColorDesc::Texture("spectrum:a".to_owned()));
    assert_eq!(*b, ColorDesc::Solid([0.5; 3]));
}

#[test]
fn objects_are_placed_and_move() {
    let desc = read(&format!(
        "ObjectBegin \"thing\"\n{TRIANGLE}Shape \"sphere\"\nObjectEnd\n\
         AttributeBegin\nTranslate 1 0 0\nObjectInstance \"thing\"\nAttributeEnd\n\
         ActiveTransform EndTime\nTranslate 0 1 0\nActiveTransform All\nShape \"sphere\"\n"
    ))
    .desc;
    assert_eq!(desc.prototypes["thing"].len(), 2);
    let [
        ObjectDesc::Instance { prototype, transform_end: None, .. },
        ObjectDesc::Instance { transform_end: Some(_), .. },
    ] = &desc.objects[..]
    else {
        panic!("{:?}", desc.objects)
    };
    assert_eq!(prototype, "thing");
}

#[test]
fn media_bound_by_surfaces() {
    let desc = read(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 2 3] \
         \"rgb sigma_a\" [0 0 1] \"float scale\" 2 \"float g\" 0.5\n\
         Material \"interface\"\nMediumInterface \"fog\" \"\"\nShape \"sphere\"\n\
         MediumInterface \"fog\"\nShape \"sphere\"\n",
    )
    .desc;
    assert_eq!(desc.media["fog"].sigma_s, [2.0, 4.0, 6.0]);
    let ObjectDesc::Sphere { material, .. } = &desc.objects[0] else { panic!() };
    let MaterialDesc::Surface { medium: Some(medium), .. } = &desc.materials[material] else {
        panic!()
    };
    assert_eq!((medium.inside.as_deref(), medium.outside.as_deref()), (Some("fog"), None));
    // The same medium on both sides is no boundary.
    let ObjectDesc::Sphere { material, .. } = &desc.objects[1] else { panic!() };
    assert_eq!(desc.materials[material], MaterialDesc::Interface);
}

#[test]
fn files_include_files_and_meshes() {
    let files = [
        (
            "scene.pbrt",
            format!("{HEAD}Include \"more.pbrt\"\nImport \"more.pbrt\"\nShape \"sphere\"\n"),
        ),
        (
            "more.pbrt",
            "Translate 0 0 1\nShape \"plymesh\" \"string filename\" \"t.ply\"\n".to_owned(),
        ),
        (
            "t.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
             0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
                .to_owned(),
        ),
    ];
    let files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (*n, t.as_str())).collect();
    let folder = Folder::new(&files);
    let desc = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap().desc;
    assert_eq!(desc.objects.len(), 3);
    assert!(
        desc.meshes.values().all(|m| matches!(m, MeshDesc::Loaded(m) if m.triangles.len() == 1))
    );
    let ObjectDesc::Sphere { transform, .. } = &desc.objects[2] else { panic!() };
    // What an import changes is forgotten, what an include changes is not.
    let zrak_scene::desc::TransformStep::Matrix(m) = transform[1] else { panic!() };
    assert_eq!(m[2][3], 1.0);
}

/// The point of a curve of Bezier segments at `u` of a segment.
fn on_curve(points: &[[f64; 3]], segment: usize, u: f64) -> [f64; 3] {
    let w = [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)];
    [0, 1, 2].map(|i| (0..4).map(|k| w[k] * points[3 * segment + k][i]).sum())
}

fn curve(parameters: &str) -> ObjectDesc {
    read(&format!("Shape \"curve\" {parameters}\n")).desc.objects.remove(0)
}

#[test]
fn curves_of_every_basis_are_the_same_curves_in_bezier_segments() {
    let p = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [3.0, 2.0, -1.0], [4.0, 0.0, 1.0], [6.0, 1.0, 1.0]];
    let text = |n: usize| -> String {
        p[..n].iter().flatten().map(|x| format!("{x} ")).collect::<String>()
    };
    let sum = |range: std::ops::Range<usize>, weights: &[f64]| {
        [0, 1, 2].map(|i| p[range.clone()].iter().zip(weights).map(|(p, w)| p[i] * w).sum::<f64>())
    };
    // Basis, degree, points, segments, and the blending weights of a segment.
    type Weights = fn(f64) -> Vec<f64>;
    let cases: [(&str, usize, usize, usize, Weights); 4] = [
        ("bezier", 3, 4, 1, |u| {
            let v = 1.0 - u;
            vec![v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u]
        }),
        ("bezier", 2, 5, 2, |u| vec![(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u]),
        ("bspline", 3, 5, 2, |u| {
            let [u2, u3] = [u * u, u * u * u];
            vec![
                (1.0 - 3.0 * u + 3.0 * u2 - u3) / 6.0,
                (3.0 * u3 - 6.0 * u2 + 4.0) / 6.0,
                (-3.0 * u3 + 3.0 * u2 + 3.0 * u + 1.0) / 6.0,
                u3 / 6.0,
            ]
        }),
        ("bspline", 2, 5, 3, |u| {
            vec![0.5 * (1.0 - u) * (1.0 - u), 0.5 + u * (1.0 - u), 0.5 * u * u]
        }),
    ];
    for (basis, degree, n, n_segments, weights) in cases {
        let object = curve(&format!(
            "\"string basis\" \"{basis}\" \"integer degree\" {degree} \"point3 P\" [{}]",
            text(n)
        ));
        let ObjectDesc::Curve { points, widths, form, .. } = object else { panic!() };
        assert_eq!((points.len(), widths, form), (3 * n_segments + 1, [1.0; 2], CurveForm::Flat));
        for segment in 0..n_segments {
            let first = if basis == "bezier" { segment * degree } else { segment };
            for u in [0.0, 0.2, 0.7, 1.0] {
                let exact = sum(first..first + degree + 1, &weights(u));
                let there = on_curve(&points, segment, u);
                let off = (0..3).map(|i| (exact[i] - there[i]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-12, "{basis} {degree}, {segment} {u}: {there:?}, not {exact:?}");
            }
        }
    }
}

#[test]
fn curves_have_forms_widths_and_normals() {
    let p = "\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]";
    let ObjectDesc::Curve { widths, form, normals, .. } = curve(&format!(
        "{p} \"string type\" \"ribbon\" \"normal N\" [0 0 1 0 1 0] \"float width\" 0.5 \
         \"float width1\" 0.25 \"integer splitdepth\" 2"
    )) else {
        panic!()
    };
    assert_eq!((widths, form), ([0.5, 0.25], CurveForm::Ribbon));
    assert_eq!(normals, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    // Nothing to see is not an error.
    for nothing in
        ["\"point3 P\" [1 1 1 1 1 1 1 1 1 1 1 1]".to_owned(), format!("{p} \"float width\" 0")]
    {
        let imported = read(&format!("Shape \"curve\" {nothing}\n{TRIANGLE}"));
        assert_eq!((imported.desc.objects.len(), imported.warnings.len()), (1, 1));
    }
    let shape = |text: &str| format!("{HEAD}Shape \"curve\" {text}\n");
    for (text, words) in [
        (format!("{p} \"string type\" \"round\""), "unknown type"),
        (format!("{p} \"string basis\" \"hermite\""), "unknown basis"),
        (format!("{p} \"integer degree\" 4"), "degree 2 or 3"),
        (format!("{p} \"integer degree\" 2"), "control points"),
        (format!("{p} \"string type\" \"ribbon\""), "2 normals"),
        (format!("{p} \"string type\" \"ribbon\" \"normal N\" [0 0 1 0 0 0]"), "zero"),
        (format!("{p} \"float width\" -1"), "negative"),
        ("\"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 0 0]".to_owned(), "at least 4"),
        (String::new(), "needs control points"),
    ] {
        refused(&shape(&text), words);
    }
}

#[test]
fn parts_of_spheres_and_patches_are_read_as_they_are() {
    let imported = read(
        "Shape \"sphere\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" -9 \"float phimax\" 90\n\
         Shape \"sphere\" \"float zmin\" 1 \"float zmax\" 1\n\
         Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1 2 2 2 3 3 5] \
         \"integer indices\" [0 1 2 3 1 3 4 5]\n",
    );
    assert_eq!(imported.warnings.len(), 1, "{:?}", imported.warnings);
    let ObjectDesc::Sphere { radius, z_min, z_max, phi_max_deg, .. } = imported.desc.objects[0]
    else {
        panic!()
    };
    assert_eq!((radius, z_min, z_max, phi_max_deg), (2.0, None, Some(1.0), Some(90.0)));
    let ObjectDesc::Mesh { mesh, .. } = &imported.desc.objects[1] else { panic!() };
    let MeshDesc::Patches { positions, patches, .. } = &imported.desc.meshes[mesh] else {
        panic!()
    };
    assert_eq!((positions.len(), patches), (6, &vec![[0, 1, 2, 3], [1, 3, 4, 5]]));
    refused(&format!("{HEAD}Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0]\n"), "indices");
    refused(
        &format!(
            "{HEAD}Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0] \"integer indices\" [0 1 2 3]\n"
        ),
        "four indices",
    );
}

#[test]
fn what_has_no_effect_is_warned_about() {
    let imported =
        read("Shape \"sphere\" \"float raduis\" 3\nMaterial \"hair\"\nShape \"sphere\"\n");
    let shown: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(shown.len(), 2, "{shown:?}");
    assert!(shown[0].contains("scene.pbrt:5: parameter \"raduis\" is not used here"), "{shown:?}");
    assert!(shown[1].contains(":6: material \"hair\" is rendered as"), "{shown:?}");
}

#[test]
fn files_that_include_each_other_are_refused() {
    let files = [("a.pbrt", "Include \"b.pbrt\""), ("b.pbrt", "Import \"./a.pbrt\"")];
    let files = files.map(|(name, text)| (PathBuf::from(name), text.as_bytes().to_vec()));
    let options = ImportOptions::default();
    let error = import_from_memory(Path::new("a.pbrt"), files.into(), &options).unwrap_err();
    assert!(error.to_string().contains("includes itself"), "{error}");
}
