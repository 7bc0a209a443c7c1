//! What is wrong in a file is shown at its place, and nothing in it does harm.

use std::io::Write;
use std::path::Path;

use proptest::prelude::*;
use zrak_scene::validate::validate;

use super::{Folder, HEAD, TRIANGLE};
use crate::{ImportOptions, import};

/// Files that must be refused: what stands after the head, the words of the error, and the text that the
/// caret stands at, which must be in the file once.
const IN_WORLD: &[(&str, &str, &str)] = &[
    // Grammar.
    ("WorldBegun", "did you mean `WorldBegin`?", "WorldBegun"),
    ("Frobnicate 1 2", "unknown directive", "Frobnicate"),
    ("]", "a directive must stand here", "]"),
    ("\"a string\"", "a directive must stand here", "\"a string\""),
    ("WorldBegin # again", "begun already", "WorldBegin # again"),
    ("Shape \"sphere\" \"flaot radius\" 1", "did you mean `float`?", "\"flaot radius\""),
    ("Shape \"sphere\" \"radius\" 1", "a parameter is \"type name\"", "\"radius\""),
    ("Shape \"sphere\" \"float radius\" [1", "the bracket is not closed", "[1"),
    ("Shape \"sphere\" \"float radius\" [", "the bracket is not closed", "["),
    ("Shape \"sphere\" \"float radius\"", "but the file ends", "\"float radius\""),
    ("Shape \"sphere\" \"float radius\" \"one\"", "a number must stand here", "\"one\""),
    ("Shape \"sphere\" \"float radius\" [1 2x]", "not a number", "2x"),
    ("Shape \"sphere\" \"float radius\" nan", "not a number", "nan"),
    ("Shape \"sphere\" \"float radius\" 1e999", "not a number", "1e999"),
    ("Shape \"sphere\" \"float radius\" [1 2]", "must be one number", "\"float radius\""),
    ("Shape \"sphere", "the string has no end", "\"sphere"),
    ("Shape sphere", "in quotes", "sphere"),
    ("Translate 1 2", "but the file ends", "Translate"),
    ("Translate 1 2 x", "a number must stand here", "x"),
    ("Translate [1 2 3 4]", "there must be 3 numbers", "4"),
    ("AttributeEnd", "there is no AttributeBegin before this", "AttributeEnd"),
    ("AttributeBegin", "AttributeBegin has no end", "AttributeBegin"),
    ("AttributeBegin TransformEnd", "AttributeBegin is closed by TransformEnd", "TransformEnd"),
    ("ActiveTransform Both", "StartTime, EndTime or All", "Both"),
    // Maps.
    ("Scale 1 0 1", "flattens space", "Scale"),
    ("Rotate 10 0 0 0", "no direction", "Rotate"),
    ("LookAt 0 0 0 0 0 0 0 1 0 # here", "no direction", "LookAt 0 0 0 0"),
    ("LookAt 0 0 0 0 1 0 0 1 0 # here", "up is along it", "LookAt 0 0 0 0"),
    ("Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", "not affine", "Transform ["),
    // Names.
    ("NamedMaterial \"gold\"", "there is no material \"gold\"", "\"gold\""),
    (
        "MakeNamedMaterial \"goId\" \"string type\" \"diffuse\" NamedMaterial \"gold\"",
        "did you mean \"goId\"?",
        "\"gold\"",
    ),
    (
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \
         MakeNamedMaterial \"a\" # again\n\"string type\" \"diffuse\"",
        "already a material \"a\"",
        "\"a\" # again",
    ),
    ("MakeNamedMaterial \"a\" \"rgb reflectance\" [1 1 1]", "no \"string type\"", "\"a\""),
    ("Material \"difuse\"", "did you mean \"diffuse\"?", "\"difuse\""),
    (
        "Material \"diffuse\" \"texture reflectance\" \"a\"",
        "no spectrum texture \"a\"",
        "\"texture reflectance\"",
    ),
    ("Shape \"sphere\" \"texture alpha\" \"a\"", "no float texture \"a\"", "\"texture alpha\""),
    (
        "Texture \"a\" \"spectrum\" \"scale\" \"texture tex\" \"b\"",
        "no spectrum texture \"b\"",
        "\"texture tex\"",
    ),
    ("Texture \"a\" \"colour\" \"constant\"", "of \"colour\"", "\"colour\""),
    ("Texture \"a\" \"spectrum\" \"imagemop\"", "did you mean \"imagemap\"?", "\"imagemop\""),
    ("Texture \"a\" \"spectrum\" \"imagemap\"", "needs a \"string filename\"", "\"imagemap\""),
    (
        "Texture \"a\" \"float\" \"constant\" Texture \"a\" # again\n\"float\" \"constant\"",
        "already a float texture",
        "\"a\" # again",
    ),
    ("ObjectBegin \"a\" ObjectBegin \"b\"", "cannot be defined within", "\"b\""),
    ("ObjectBegin \"a\"", "has no end", "ObjectBegin"),
    ("ObjectEnd", "there is no ObjectBegin", "ObjectEnd"),
    ("ObjectInstance \"a\"", "there is no object \"a\"", "\"a\""),
    ("ObjectBegin \"a\" ObjectInstance \"b\" ObjectEnd", "cannot be placed within", "\"b\""),
    ("MediumInterface \"fog\" \"\"", "there is no medium \"fog\"", "\"fog\""),
    ("MakeNamedMedium \"fog\" \"float g\" 0", "no \"string type\"", "\"fog\""),
    (
        "MakeNamedMedium \"fog\" \"string type\" \"homogenous\"",
        "did you mean \"homogeneous\"?",
        "\"string type\"",
    ),
    (
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"string preset\" \"Wholmilk\"",
        "did you mean \"Wholemilk\"?",
        "\"string preset\"",
    ),
    (
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" 1",
        "between -1 and 1",
        "\"float g\"",
    ),
    ("ColorSpace \"srbg\"", "did you mean \"srgb\"?", "\"srbg\""),
    ("Attribute \"shapes\" \"float radius\" 1", "did you mean \"shape\"?", "\"shapes\""),
    ("Option \"bool forcedifuse\" true", "did you mean \"forcediffuse\"?", "\"bool forcedifuse\""),
    // Materials.
    ("Material \"dielectric\" \"float eta\" 0", "must be from 0.001", "\"float eta\""),
    ("Material \"dielectric\" \"rgb eta\" [1 1 1]", "index of refraction", "\"rgb eta\""),
    (
        "Material \"diffuse\" \"rgb reflectance\" [1 1]",
        "must have three numbers",
        "\"rgb reflectance\"",
    ),
    (
        "Material \"diffuse\" \"blackbody reflectance\" 3000",
        "cannot be a light",
        "\"blackbody reflectance\"",
    ),
    (
        "Material \"diffuse\" \"rgb reflectance\" [1 1 1] \"string displacement",
        "no end",
        "\"string displacement",
    ),
    (
        "Material \"conductor\" \"spectrum eta\" [400 1 300 2] \"spectrum k\" [400 1]",
        "must increase",
        "\"spectrum eta\"",
    ),
    (
        "Material \"conductor\" \"spectrum eta\" \"metal-Ag-etta\"",
        "did you mean \"metal-Ag-eta\"?",
        "\"spectrum eta\"",
    ),
    (
        "Material \"conductor\" \"rgb eta\" [1 1 1] \"rgb reflectance\" [1 1 1]",
        "leave out one",
        "\"rgb reflectance\"",
    ),
    (
        "Material \"coateddiffuse\" \"float thickness\" -1",
        "`thickness` must be",
        "\"float thickness\"",
    ),
    ("Material \"mix\" \"string materials\" [\"a\"]", "two `materials`", "\"mix\""),
    (
        "Material \"mix\" \"string materials\" [\"a\" \"b\"]",
        "there is no material",
        "\"string materials\"",
    ),
    (
        "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]",
        "made of itself",
        "\"a\" \"string type\"",
    ),
    // Shapes.
    ("Shape \"spheer\"", "unknown shape \"spheer\"", "\"spheer\""),
    ("Shape \"sphere\" \"float radius\" -1", "`radius` must be more than 0", "Shape"),
    ("Shape \"sphere\" \"float radius\" 1e13", "-1e12, 1e12", "Shape"),
    ("Translate 0 1e20 0 Shape \"sphere\"", "-1e12, 1e12", "Shape"),
    (
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]",
        "corner beyond",
        "\"trianglemesh\"",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 -2]",
        "no index",
        "\"integer indices\"",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1]",
        "no multiple of 3",
        "\"trianglemesh\"",
    ),
    ("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]", "no multiple of 3", "\"point3 P\""),
    ("Shape \"trianglemesh\" \"point3 P\" []", "needs", "\"trianglemesh\""),
    ("Shape \"trianglemesh\" \"integer indices\" [0 1 2]", "needs vertices", "\"trianglemesh\""),
    (
        "Shape \"trianglemesh\" \"point3 P\" [0 0 1e39 1 0 0 0 1 0]",
        "not finite",
        "\"trianglemesh\"",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1]",
        "3 vertices but 1 normals",
        "\"trianglemesh\"",
    ),
    ("Shape \"plymesh\"", "needs a \"string filename\"", "\"plymesh\""),
    ("Shape \"plymesh\" \"string filename\" \"none.ply\"", "cannot read", "\"plymesh\""),
    (
        "Shape \"plymesh\" \"string filename\" \"../a.ply\"",
        "outside of the scene's folder",
        "\"plymesh\"",
    ),
    // Lights.
    ("LightSource \"lamp\"", "unknown light \"lamp\"", "\"lamp\""),
    ("LightSource \"spot\" \"float coneangle\" 200", "`coneangle` must be", "\"float coneangle\""),
    ("LightSource \"distant\" \"point3 to\" [0 0 0]", "no direction", "\"distant\""),
    ("LightSource \"point\" \"blackbody I\" 0", "no temperature", "\"blackbody I\""),
    ("LightSource \"point\" \"rgb I\" [1e12 1 1]", "from 0 to 1e9", "LightSource"),
    ("AreaLightSource \"difuse\"", "did you mean \"diffuse\"?", "\"difuse\""),
    (
        "LightSource \"infinite\" \"string filename\" \"a.exr\" \"rgb L\" [1 1 1]",
        "leave out one",
        "\"string filename\"",
    ),
    // Files.
    ("Include \"/etc/passwd\"", "outside of the scene's folder", "\"/etc/passwd\""),
    ("Include \"scene.pbrt\"", "includes itself", "\"scene.pbrt\""),
    ("Include \"none.pbrt\"", "cannot read", "\"none.pbrt\""),
    ("Include \"\"", "not a file", "\"\""),
];

/// The same for whole files.
const WHOLE: &[(&str, &str, &str)] = &[
    ("Shape \"sphere\"", "must come after WorldBegin", "Shape"),
    ("LightSource \"point\"", "must come after WorldBegin", "LightSource"),
    ("Camera \"perspective\"", "no WorldBegin", "Camera"),
    ("WorldBegin", "no Camera", "WorldBegin"),
    ("Camera \"fisheye\"\nWorldBegin", "unknown camera", "\"fisheye\""),
    ("Camera \"perspective\" \"float fov\" 180\nWorldBegin", "`fov` must be", "\"float fov\""),
    ("Camera \"perspective\" \"float shutteropen\" 2\nWorldBegin", "before it opens", "Camera"),
    ("Camera \"realistic\"\nWorldBegin", "\"string lensfile\"", "Camera"),
    ("Film \"rgb\" \"integer xresolution\" 0", "from 1 to 65536", "\"integer xresolution\""),
    ("Film \"rgb\" \"integer xresolution\" 1.5", "a whole number", "\"integer xresolution\""),
    ("Film \"rgb\" \"float cropwindow\" [0.5 0.5 0 1]", "no size", "\"float cropwindow\""),
    ("Film \"rgb\" \"float cropwindow\" [0 1]", "must be left, right", "\"float cropwindow\""),
    ("Film \"rgb\" \"float iso\" 0", "`iso` must be", "\"float iso\""),
    ("Film \"color\"", "unknown film", "\"color\""),
    ("Integrator \"pathtracer\"", "unknown integrator", "\"pathtracer\""),
    ("PixelFilter \"gausian\"", "did you mean \"gaussian\"?", "\"gausian\""),
    ("Camera \"perspective\" Scale 1 0 1", "flattens space", "Scale"),
];

/// Says what is not as it should be.
fn is_refused(text: &str, words: &str, caret: &str) -> Result<(), String> {
    let folder = Folder::new(&[("scene.pbrt", text)]);
    let error = match import(&folder.path("scene.pbrt"), &ImportOptions::default()) {
        Ok(_) => return Err(format!("{text}\nis read, and should be refused: {words}")),
        Err(error) => error,
    };
    let shown = error.to_string();
    if !shown.contains(words) {
        return Err(format!("{shown}\ndoes not say: {words}"));
    }
    let Some((line, column)) = error.line_column() else {
        return Err(format!("{shown}\nhas no place"));
    };
    let before: usize = text.split('\n').take(line - 1).map(|l| l.len() + 1).sum();
    if text[before + column - 1..].starts_with(caret) {
        return Ok(());
    }
    Err(format!("{shown}\nis not at: {caret}"))
}

#[test]
fn what_is_wrong_is_shown_at_its_place() {
    let in_world = IN_WORLD.iter().map(|(world, w, c)| is_refused(&format!("{HEAD}{world}"), w, c));
    let whole = WHOLE.iter().map(|(text, words, caret)| is_refused(text, words, caret));
    let wrong: Vec<String> = in_world.chain(whole).filter_map(Result::err).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn problems_of_the_whole_scene_are_shown_together_and_in_the_file_that_has_them() {
    let bad = "\nShape \"sphere\" \"float radius\" 1e13\nShape \"sphere\" \"float radius\" 2e13\n";
    let scene = format!("{HEAD}Include \"bad.pbrt\"\n");
    let folder = Folder::new(&[("scene.pbrt", &scene), ("bad.pbrt", bad)]);
    let error = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap_err();
    let shown = error.to_string();
    assert!(shown.contains("bad.pbrt:2:1") && shown.contains("bad.pbrt:3:1"), "{shown}");
}

#[test]
fn imports_end_where_they_end() {
    // What an import's last directive makes, it makes under the import's own state.
    let scene = format!("{HEAD}Import \"more.pbrt\"\nShape \"sphere\"\n");
    let more = "Translate 0 0 7\nShape \"sphere\"";
    let folder = Folder::new(&[("scene.pbrt", &scene), ("more.pbrt", more)]);
    let desc = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap().desc;
    let far = |i: usize| format!("{:?}", desc.objects[i]).contains("7.0");
    assert!(far(0) && !far(1), "{:?}", desc.objects);
    for (more, words) in [
        ("AttributeBegin", "not all that it begins has an end"),
        ("AttributeEnd", "there is no AttributeBegin"),
        ("ObjectBegin \"a\"", "not all that it begins"),
    ] {
        let scene = format!("{HEAD}AttributeBegin\nImport \"more.pbrt\"\nAttributeEnd\n");
        let folder = Folder::new(&[("scene.pbrt", &scene), ("more.pbrt", more)]);
        let error = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn includes_in_a_circle_and_too_deep_are_refused() {
    let first = format!("{HEAD}Include \"b.pbrt\"\n");
    let folder = Folder::new(&[
        ("a.pbrt", &first),
        ("b.pbrt", "Include \"c.pbrt\""),
        ("c.pbrt", "\nInclude \"b.pbrt\""),
    ]);
    let error = import(&folder.path("a.pbrt"), &ImportOptions::default()).unwrap_err();
    let shown = error.to_string();
    assert!(shown.contains("includes itself") && shown.contains("c.pbrt:2:9"), "{shown}");

    let names: Vec<String> = (0..100).map(|i| format!("{i}.pbrt")).collect();
    let texts: Vec<String> = (1..=100)
        .map(|i| {
            if i == 1 {
                format!("{HEAD}Include \"1.pbrt\"")
            } else {
                format!("Include \"{i}.pbrt\"")
            }
        })
        .collect();
    let files: Vec<(&str, &str)> =
        names.iter().zip(&texts).map(|(n, t)| (n.as_str(), t.as_str())).collect();
    let folder = Folder::new(&files);
    let error = import(&folder.path("0.pbrt"), &ImportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("more than 64 deep"), "{error}");
}

#[test]
fn nesting_is_bounded() {
    for begin in ["AttributeBegin\n", "TransformBegin\n"] {
        let text = format!("{HEAD}{}", begin.repeat(100_000));
        let folder = Folder::new(&[("scene.pbrt", &text)]);
        let error = import(&folder.path("scene.pbrt"), &ImportOptions::default()).unwrap_err();
        assert!(error.to_string().contains("nested more than"), "{error}");
    }
    let many: String = (0..300).map(|i| format!(" \"float p{i}\" 1")).collect();
    is_refused(
        &format!("{HEAD}Attribute \"shape\"{many}"),
        "more than 256 attributes",
        "\"shape\"",
    )
    .unwrap();
    // One of a name counts, however often it is set.
    let often = "Attribute \"shape\" \"float radius\" 2\n".repeat(50_000);
    let desc = super::read(&format!("{often}Shape \"sphere\"")).desc;
    assert!(format!("{:?}", desc.objects[0]).contains("radius: 2.0"));
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn limits_hold() {
    let folder = Folder::new(&[("scene.pbrt", &format!("{HEAD}{}", "# much\n".repeat(10_000)))]);
    let options = ImportOptions { max_bytes: 10_000, ..ImportOptions::default() };
    let error = import(&folder.path("scene.pbrt"), &options).unwrap_err().to_string();
    assert!(error.contains("larger than the limit"), "{error}");
    let error = import(Path::new("none.pbrt"), &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("there is no such scene file"), "{error}");
}

#[test]
fn packed_files_are_read_and_bombs_are_not() {
    let folder = Folder::new(&[("scene.pbrt", &format!("{HEAD}Include \"more.pbrt.gz\"\n"))]);
    std::fs::write(folder.path("more.pbrt.gz"), gzip(TRIANGLE.as_bytes())).unwrap();
    let path = folder.path("scene.pbrt");
    let desc = import(&path, &ImportOptions::default()).unwrap().desc;
    assert_eq!(desc.objects.len(), 1);

    std::fs::write(folder.path("more.pbrt.gz"), gzip(&vec![b' '; 64 << 20])).unwrap();
    let options = ImportOptions { max_bytes: 1 << 20, ..ImportOptions::default() };
    let shown = import(&path, &options).unwrap_err().to_string();
    assert!(shown.contains("larger than the limit") && shown.contains("scene.pbrt:5:9"), "{shown}");

    // All files together count, so a file cannot be included over and over.
    let scene = format!("{HEAD}{}", "Include \"more.pbrt.gz\"\n".repeat(20));
    std::fs::write(&path, scene).unwrap();
    std::fs::write(folder.path("more.pbrt.gz"), gzip(&vec![b' '; 100 << 10])).unwrap();
    let shown = import(&path, &options).unwrap_err().to_string();
    assert!(shown.contains("larger than the limit"), "{shown}");

    std::fs::write(folder.path("more.pbrt.gz"), &gzip(TRIANGLE.as_bytes())[..20]).unwrap();
    let shown = import(&path, &ImportOptions::default()).unwrap_err().to_string();
    assert!(shown.contains("damaged"), "{shown}");
    std::fs::write(folder.path("more.pbrt.gz"), b"\xff\xfe\xfd").unwrap();
    let shown = import(&path, &ImportOptions::default()).unwrap_err().to_string();
    assert!(shown.contains("not UTF-8"), "{shown}");
}

#[test]
fn a_link_out_of_the_folder_is_refused() {
    #[cfg(unix)]
    {
        let elsewhere = Folder::new(&[("a.pbrt", "# nothing")]);
        let scene = format!("{HEAD}Include \"a.pbrt\"\n");
        let folder = Folder::new(&[("scene.pbrt", &scene)]);
        std::os::unix::fs::symlink(elsewhere.path("a.pbrt"), folder.path("a.pbrt")).unwrap();
        let path = folder.path("scene.pbrt");
        let error = import(&path, &ImportOptions::default()).unwrap_err().to_string();
        assert!(error.contains("outside of the scene's folder"), "{error}");
        let options = ImportOptions { allow_external: true, ..ImportOptions::default() };
        assert!(import(&path, &options).is_ok());
    }
}

proptest! {
    /// Whatever is in a file, reading it ends, without a panic.
    #[test]
    fn damaged_files_do_no_harm(at in any::<prop::sample::Index>(), cut in 0_usize..40, junk in "[ -~\n]{0,12}") {
        let text = format!(
            "{HEAD}Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 3\nAttributeBegin\nRotate 3 1 2 3\n\
             Material \"conductor\" \"texture roughness\" \"t\" \"spectrum eta\" [400 1 500 2]\n\
             {TRIANGLE}AreaLightSource \"diffuse\" \"blackbody L\" 3000\nShape \"loopsubdiv\" \
             \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2] \"integer levels\" 1\nAttributeEnd\n"
        );
        let at = at.index(text.len());
        let end = (at + cut).min(text.len());
        let damaged = format!("{}{junk}{}", &text[..at], &text[end..]);
        let folder = Folder::new(&[("scene.pbrt", &damaged)]);
        if let Ok(imported) = import(&folder.path("scene.pbrt"), &ImportOptions::default()) {
            // What is read can be rendered.
            prop_assert!(validate(&imported.desc).is_empty());
        }
    }
}
