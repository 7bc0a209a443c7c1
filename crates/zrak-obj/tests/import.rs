//! OBJ files with their materials, good and bad.

use std::path::{Path, PathBuf};

use zrak_obj::{ImportOptions, Imported, import};
use zrak_scene::desc::{
    ColorDesc, ImageChannel, MappingDesc, MaterialDesc, MeshDesc, ObjectDesc, PrincipledDesc,
    ScalarDesc, TextureDesc, WrapMode,
};
use zrak_scene::validate::validate;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n";

struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, text) in files {
            let path = folder.path(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn import(&self, name: &str) -> Result<Imported, String> {
        import(&self.path(name), &ImportOptions::default()).map_err(|e| e.to_string())
    }
}

/// A square of the material `m` that an MTL file describes.
fn with_mtl(mtl: &str) -> Imported {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl m\nf 1/1 2/1 3/1 4/1\n");
    let folder = Folder::new(&[("a.obj", &obj), ("a.mtl", &format!("newmtl m\n{mtl}"))]);
    let imported = folder.import("a.obj").unwrap();
    assert_eq!(validate(&imported.desc), [], "{mtl}");
    imported
}

fn principled(imported: &Imported, name: &str) -> PrincipledDesc {
    match &imported.desc.materials[name] {
        MaterialDesc::Principled { surface } => *surface.clone(),
        MaterialDesc::Surface { base, .. } => principled(imported, base),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_scene_is_made_of_a_mesh() {
    let folder = Folder::new(&[("b.obj", &format!("{SQUARE}f 1 2 3 4\n"))]);
    let Imported { desc, base_dir, warnings } = folder.import("b.obj").unwrap();
    assert_eq!((validate(&desc), warnings), (vec![], vec![]));
    assert_eq!((desc.name.as_str(), base_dir.as_path()), ("b", folder.0.path()));
    assert_eq!(desc.camera.look_at, [0.5, 0.5, 0.0]);
    assert_eq!(desc.background, zrak_scene::defaults::default_background());
    let [ObjectDesc::Mesh { mesh, material, group_materials, .. }] = &desc.objects[..] else {
        panic!("{:?}", desc.objects)
    };
    assert_eq!((mesh.as_str(), material.as_str(), group_materials.len()), ("b", "default", 0));
    let MeshDesc::Loaded(mesh) = &desc.meshes["b"] else { panic!() };
    assert_eq!(mesh.triangles.len(), 2);
}

#[test]
fn packed_files_are_read_and_bombs_are_not() {
    use std::io::Write;
    let pack = |text: &[u8]| {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        packed.write_all(text).unwrap();
        packed.finish().unwrap()
    };
    let folder = Folder::new(&[("m.mtl", "newmtl m\nKd 1 0 0\n")]);
    let obj = format!("mtllib m.mtl\n{SQUARE}usemtl m\nf 1 2 3\n");
    std::fs::write(folder.path("c.obj.gz"), pack(obj.as_bytes())).unwrap();
    let imported = folder.import("c.obj.gz").unwrap();
    assert_eq!(imported.desc.name, "c");
    assert_eq!(principled(&imported, "m").base_color, ColorDesc::Solid([1.0, 0.0, 0.0]));
    for name in ["bomb.obj", "bomb.mtl"] {
        std::fs::write(folder.path(name), pack(&vec![b'\n'; 20_000_000])).unwrap();
    }
    std::fs::write(folder.path("d.obj"), obj.replace("m.mtl", "bomb.mtl")).unwrap();
    let options = ImportOptions { max_bytes: 1_000_000, ..ImportOptions::default() };
    for name in ["bomb.obj", "d.obj"] {
        let error = import(&folder.path(name), &options).unwrap_err().to_string();
        assert!(error.contains("larger than the limit"), "{error}");
    }
}

#[test]
fn every_group_has_its_material() {
    let obj = format!(
        "{SQUARE}mtllib a.mtl none.mtl\nmtllib sub/my materials.mtl\nf 1 2 3\nusemtl red\nf 1 2 3\n\
         usemtl blue paint\nf 1 2 3\nusemtl red\nf 1 3 4\nusemtl nothing\nf 1 2 4\n"
    );
    let folder = Folder::new(&[
        ("x.obj", &obj),
        ("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl red\nKd 0 1 0\nnewmtl unused\n"),
        ("sub/my materials.mtl", "newmtl blue paint\nKd 0 0 1\nmap_Ke -s 1 1 1 my lamp.png\n"),
    ]);
    let imported = folder.import("x.obj").unwrap();
    assert_eq!(validate(&imported.desc), []);
    let [ObjectDesc::Mesh { material, group_materials, .. }] = &imported.desc.objects[..] else {
        panic!()
    };
    assert_eq!(material, "default");
    assert_eq!(group_materials, &["default", "red", "blue paint", "default"]);
    assert_eq!(principled(&imported, "red").base_color, ColorDesc::Solid([1.0, 0.0, 0.0]));
    assert!(!imported.desc.materials.contains_key("unused"));
    let TextureDesc::Image { path, .. } = &imported.desc.textures["my lamp.png"] else { panic!() };
    assert_eq!(path, "sub/my lamp.png");
    let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    for words in [
        "x.obj:6: there is no file `none.mtl`",
        "a.mtl:3: another material `red` came before",
        "x.obj:15: there is no material `nothing`",
    ] {
        assert!(warnings.iter().any(|w| w.contains(words)), "{warnings:?} lack {words:?}");
    }
    assert_eq!(warnings.len(), 3);
}

#[test]
fn phong_materials_become_principled_ones() {
    let of = |mtl: &str| principled(&with_mtl(mtl), "m");
    let matte = of("Kd 0.5 0.25 0\nillum 1\nKs 1 1 1\n");
    assert_eq!(matte.base_color, ColorDesc::Solid([0.5, 0.25, 0.0]));
    assert_eq!(matte.specular_weight, ScalarDesc::Value(0.0));
    assert_eq!(of("Kd 0.5\n").specular_weight, ScalarDesc::Value(0.0));
    let glossy = of("Kd 0.5 0.5 0.5\nKs 0.5 0.25 0.5\nNs 998\nNi 1.33\nillum 2\n");
    assert_eq!(glossy.specular_weight, ScalarDesc::Value(0.5));
    assert_eq!(glossy.specular_color, ColorDesc::Solid([1.0, 0.5, 1.0]));
    assert_eq!(glossy.specular_ior, 1.33);
    // alpha^2 = 2 / 1000, and roughness^2 = alpha.
    let ScalarDesc::Value(roughness) = glossy.specular_roughness else { panic!() };
    assert!((roughness.powi(4) - 0.002).abs() < 1e-12);
    let mirror = of("Kd 0 0 0\nKs 0.9 0.8 0.7\nNs 1000\nillum 3\n");
    assert_eq!(mirror.base_metalness, ScalarDesc::Value(1.0));
    assert_eq!(mirror.base_color, ColorDesc::Solid([0.9, 0.8, 0.7]));
    assert_eq!(mirror.specular_roughness, ScalarDesc::Value(0.0));
    let glass = of("Kd 0 0 0\nKs 1 1 1\nTf 0.9 1 0.9\nNi 1.5\nNs 1000\nillum 7\n");
    assert_eq!(glass.transmission_weight, ScalarDesc::Value(1.0));
    assert_eq!(glass.transmission_color, ColorDesc::Solid([0.9, 1.0, 0.9]));
    assert_eq!(of("illum 4\nd 0.25\n").transmission_weight, ScalarDesc::Value(0.75));
    // Some exporters write this for everything.
    assert_eq!(of("illum 4\nTf 1 1 1\nNi 1\n").transmission_weight, ScalarDesc::Value(0.0));
    // Numbers out of their range.
    let wild = of("Kd 2 -1 1e30\nKs 9 9 9\nNs -5\nNi 1e30\nTr 7\nillum 99\n");
    assert_eq!(wild.base_color, ColorDesc::Solid([1.0, 0.0, 1.0]));
}

#[test]
fn the_pbr_extension_is_read() {
    let p = principled(
        &with_mtl("Kd 1 1 1\nPr 0.5\nPm 1\nPs 0.25\nPc 0.75\nPcr 0.1\naniso 0.6\nKs 0 0 0\n"),
        "m",
    );
    let value = ScalarDesc::Value;
    assert_eq!(p.specular_roughness, value(0.5));
    assert_eq!(p.base_metalness, value(1.0));
    assert_eq!(p.fuzz_weight, value(0.25));
    assert_eq!((p.coat_weight, p.coat_roughness), (value(0.75), value(0.1)));
    assert_eq!(p.specular_roughness_anisotropy, value(0.6));
    assert_eq!(p.specular_weight, value(1.0));
    let imported = with_mtl("map_Pr r.png\nPm 0.5\nmap_Pm -imfchan b orm.png\nnorm -bm 2 n.png\n");
    let p = principled(&imported, "m");
    assert_eq!(p.specular_roughness, ScalarDesc::Texture("r.png".to_owned()));
    let TextureDesc::Image { channel, scale, .. } = &imported.desc.textures["orm.png"] else {
        panic!()
    };
    assert_eq!((*channel, *scale), (ImageChannel::B, 0.5));
    let MaterialDesc::Surface { normal_map, normal_scale, .. } = &imported.desc.materials["m"]
    else {
        panic!()
    };
    assert_eq!((normal_map.as_deref(), *normal_scale), (Some("n.png"), 2.0));
}

#[test]
fn maps_have_options() {
    let imported = with_mtl(
        "Kd 0.5 0.5 0.5\nmap_Kd -clamp on -s 2 3 1 -o 0.5 -blendu off -mm 0 2 my texture.png\n\
         map_d my texture.png\nbump -bm 2 -imfchan l C:\\work\\bump.png\nKe 2 1 0\n",
    );
    let textures = &imported.desc.textures;
    let p = principled(&imported, "m");
    let ColorDesc::Texture(name) = &p.base_color else { panic!() };
    let TextureDesc::Multiply { a, b } = &textures[name] else { panic!() };
    assert_eq!(
        (a, b),
        (&ColorDesc::Texture("my texture.png".to_owned()), &ColorDesc::Solid([0.5; 3]))
    );
    let TextureDesc::Image { path, wrap_u, scale, mapping, .. } = &textures["my texture.png"]
    else {
        panic!()
    };
    assert_eq!((path.as_str(), *wrap_u, *scale), ("my texture.png", WrapMode::Clamp, 2.0));
    let matrix = [[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]];
    assert_eq!(*mapping, MappingDesc::UvAffine { matrix });
    let MaterialDesc::Surface { emission, alpha, bump, .. } = &imported.desc.materials["m"] else {
        panic!()
    };
    assert_eq!(*emission, Some(ColorDesc::Solid([2.0, 1.0, 0.0])));
    let Some(ScalarDesc::Texture(alpha)) = alpha else { panic!() };
    let TextureDesc::Image { channel, .. } = &textures[alpha] else { panic!() };
    assert_eq!(*channel, ImageChannel::A);
    let Some(ScalarDesc::Texture(bump)) = bump else { panic!() };
    let TextureDesc::Image { path, scale, .. } = &textures[bump] else { panic!() };
    assert_eq!(path, "C:/work/bump.png");
    assert!((scale - 2.0 * 1e-3 * 2.0_f64.sqrt()).abs() < 1e-9, "{scale}");
    // What emits is the light.
    assert_ne!(imported.desc.background, zrak_scene::defaults::default_background());
}

#[test]
fn colors_of_vertices_are_the_base_color() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
    let folder = Folder::new(&[("a.obj", text)]);
    let imported = folder.import("a.obj").unwrap();
    let p = principled(&imported, "default");
    assert_eq!(p.base_color, ColorDesc::Texture("vertex colors".to_owned()));
    assert_eq!(validate(&imported.desc), []);
}

#[test]
fn what_is_left_out_is_said() {
    let imported = with_mtl(
        "Ka 1 1 1\nKd spectral a.rfl\nmap_Ns a.png\ndisp a.png\ndisp b.png\nfoo 1\nillum 77\n\
         map_Kd -t 1 1 1 -imfchan z a.png\nmap_Ks -mm 0.5 1 a.png\nanisor 0.5\n",
    );
    let lines: Vec<usize> = imported.warnings.iter().map(|w| w.line).collect();
    assert_eq!(lines, [3, 4, 5, 7, 8, 9, 11, 10], "{:#?}", imported.warnings);
}

#[test]
fn what_is_wrong_is_shown_at_its_place() {
    let mtl = |text: &str| {
        let obj = format!("mtllib a.mtl\n{SQUARE}usemtl m\nf 1 2 3\n");
        Folder::new(&[("a.obj", &obj), ("a.mtl", text)]).import("a.obj").unwrap_err()
    };
    let obj = |text: &str| Folder::new(&[("a.obj", text)]).import("a.obj").unwrap_err();
    for (message, words) in [
        (mtl("Kd 1 1 1\n"), "a.mtl:1:1"),
        (mtl("Kd 1 1 1\n"), "`Kd` comes before any `newmtl`"),
        (mtl("newmtl m\n  Kd 1 x 1\n"), "a.mtl:2:8"),
        (mtl("newmtl m\nKd 1 nan 1\n"), "`nan` is not a finite number"),
        (mtl("newmtl m\nKd 1 1\n"), "a number is missing here"),
        (mtl("newmtl m\nNs\n"), "a number is missing here"),
        (mtl("newmtl m\nmap_Kd -s 1 1 1\n"), "the name of a picture is missing here"),
        (mtl("newmtl m\nbump -bm x a.png\n"), "`x` is not a finite number"),
        (obj(&format!("{SQUARE}f 1 2 9\n")), "a.obj:6:7"),
        (obj(&format!("{SQUARE}f 1 2 9\n")), "6 | f 1 2 9\n"),
        (obj(&format!("{SQUARE}f 1 2 9\n")), "there is no 9 of the vertices"),
        (obj(&format!("mtllib ../b.mtl\n{SQUARE}f 1 2 3\n")), "outside of the scene's folder"),
        (obj(&format!("mtllib /etc/passwd\n{SQUARE}f 1 2 3\n")), "outside of the scene's folder"),
        (obj(""), "the file has no vertices"),
    ] {
        assert!(message.contains(words), "{message}\ndoes not say {words:?}");
    }
    let error = import(Path::new("none.obj"), &ImportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("cannot read none.obj"), "{error}");
}
