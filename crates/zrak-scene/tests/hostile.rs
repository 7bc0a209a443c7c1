//! What a scene file must not be able to do: lead to a panic, out of its folder, or round in circles.

use std::path::Path;

use zrak_scene::file::parse;
use zrak_scene::lower::{LowerOptions, MissingTextures, lower, lower_with_warnings};

const HEAD: &str = "format = 1\nname = 'hostile'\n\
    camera = { look_from = [0, 0, 9], look_at = [0, 0, 0], vfov_deg = 40, width = 2, height = 2 }\n";

/// What is said about a scene with these lines.
fn said(lines: &str) -> String {
    match parse(&format!("{HEAD}{lines}"), "hostile.toml") {
        Ok(_) => String::from("nothing"),
        Err(error) => {
            assert!(error.line_column().is_some(), "{error} has no place");
            error.to_string()
        }
    }
}

#[test]
fn meshes_that_are_none_are_refused() {
    let square = "positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles = [[0, 1, 2]]";
    let corners = |p: &str, t: &str| format!("positions = [{p}], triangles = [{t}]");
    let good = "[0, 0, 0], [1, 0, 0], [0, 1, 0]";
    for (fields, words) in [
        (square.to_owned(), "nothing"),
        (corners(good, "[0, 1, 3]"), "corner beyond the 3 positions"),
        (corners(good, "[0, 1, -1]"), "-1"),
        (corners(good, "[0, 1, 4294967295]"), "corner beyond"),
        (corners(good, "[0, 1]"), "3"),
        (corners("[0, 0], [1, 0, 0]", "[0, 1, 0]"), "3"),
        (corners("[0, 0, nan], [1, 0, 0], [0, 1, 0]", "[0, 1, 2]"), "numbers must lie in"),
        (corners("[0, 0, inf], [1, 0, 0], [0, 1, 0]", "[0, 1, 2]"), "numbers must lie in"),
        (corners("[0, 0, 1e39], [1, 0, 0], [0, 1, 0]", "[0, 1, 2]"), "numbers must lie in"),
        (corners("", ""), "no triangles"),
        (corners(good, ""), "no triangles"),
        (format!("{square}, normals = [[0, 0, 1]]"), "one entry for each of the 3 positions"),
        (format!("{square}, uvs = [[0, 0], [1, 1]]"), "one entry for each of the 3 positions"),
        (format!("{square}, colors = [[0, 0, 0, 1]]"), "one entry for each of the 3 positions"),
        (format!("{square}, normals = [[0, 0, nan], [0, 0, 1], [0, 0, 1]]"), "numbers must lie"),
    ] {
        let text = format!("[meshes]\nm = {{ kind = 'inline', {fields} }}\n");
        let said = said(&text);
        assert!(said.contains(words), "{fields}: {said}");
    }
}

#[test]
fn nothing_contains_itself() {
    let instance = |of: &str| format!("{{ kind = 'instance', prototype = '{of}' }}");
    let prototype = |name: &str, of: &str| format!("{name} = [{}]\n", instance(of));
    let group = format!("a = [{{ kind = 'group', objects = [{}] }}]\n", instance("a"));
    let mix = |name: &str, of: &str| {
        format!("{name} = {{ kind = 'mix', materials = ['{of}', 'grey'], amount = 0.5 }}\n")
    };
    let checker = |name: &str, of: &str| {
        format!("{name} = {{ kind = 'checker', scale = 1, even = '{of}', odd = [1, 1, 1] }}\n")
    };
    let grey = "grey = { kind = 'lambertian', color = [0.5, 0.5, 0.5] }\n";
    for text in [
        format!("[prototypes]\n{}", prototype("a", "a")),
        format!("[prototypes]\n{}{}", prototype("a", "b"), prototype("b", "a")),
        format!("[prototypes]\n{group}"),
        format!("[materials]\n{grey}{}", mix("a", "a")),
        format!("[materials]\n{grey}{}{}", mix("a", "b"), mix("b", "a")),
        format!("[textures]\n{}", checker("a", "a")),
        format!("[textures]\n{}{}", checker("a", "b"), checker("b", "a")),
    ] {
        let said = said(&text);
        assert!(
            said.contains("contains itself") || said.contains("made of itself"),
            "{text}: {said}"
        );
    }
}

/// A scene with one mesh.
fn mesh_scene(mesh: &str) -> String {
    format!(
        "{HEAD}[materials]\ngrey = {{ kind = 'lambertian', color = [0.5, 0.5, 0.5] }}\n\
         [meshes]\nm = {{ {mesh} }}\n[[objects]]\nkind = 'mesh'\nmesh = 'm'\nmaterial = 'grey'\n"
    )
}

#[test]
fn triangles_without_an_area_do_no_harm() {
    let mesh = "kind = 'inline', positions = [[0, 0, 0], [1, 0, 0], [2, 0, 0]], \
                triangles = [[0, 1, 2], [0, 0, 0], [1, 1, 2]], normals = [[0, 0, 0], [0, 0, 1], [0, 0, 1]]";
    let desc = parse(&mesh_scene(mesh), "flat.toml").unwrap();
    assert!(lower(&desc, &LowerOptions::new("")).is_ok());
}

/// A scene with one picture.
fn picture_scene(path: &str) -> String {
    format!(
        "{HEAD}[textures]\nt = {{ kind = 'image', path = '{path}' }}\n\
         [materials]\nm = {{ kind = 'lambertian', color = 't' }}\n\
         [[objects]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n"
    )
}

#[test]
fn files_stay_in_the_scenes_folder() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("scene");
    std::fs::create_dir_all(folder.join("textures")).unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let pfm = [b"PF\n1 1\n-1\n".as_slice(), &[0; 12]].concat();
    for place in [root.path(), &folder, &folder.join("textures")] {
        std::fs::write(place.join("a.ply"), ply).unwrap();
        std::fs::write(place.join("a.pfm"), &pfm).unwrap();
    }
    let mut outside = vec!["../a".to_owned(), "textures/../../a".to_owned()];
    outside.push(root.path().join("a").to_str().unwrap().replace('\\', "/"));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(root.path(), folder.join("link")).unwrap();
        outside.push("link/a".to_owned());
    }
    let inside = ["a", "./a", "textures/a", "textures/../a"].map(str::to_owned);
    let scenes = |path: &str| {
        let ply = mesh_scene(&format!("kind = 'file', path = '{path}.ply'"));
        [ply, picture_scene(&format!("{path}.pfm"))].map(|text| parse(&text, "a.toml").unwrap())
    };
    let strict = LowerOptions::new(&folder);
    let lax = LowerOptions { allow_external: true, ..strict.clone() };
    for path in inside {
        for desc in scenes(&path) {
            assert!(lower(&desc, &strict).is_ok(), "{path} is inside");
        }
    }
    for path in outside {
        for desc in scenes(&path) {
            let Err(problems) = lower(&desc, &strict) else { panic!("{path} was read") };
            let said = problems[0].to_string();
            assert!(said.contains("outside of the scene's folder"), "{said}");
            assert!(lower(&desc, &lax).is_ok(), "{path} is allowed");
        }
    }
}

#[test]
fn missing_files_are_errors_unless_pictures_may_be_missing() {
    let folder = tempfile::tempdir().unwrap();
    // There, but no picture.
    std::fs::write(folder.path().join("text.png"), "not a picture").unwrap();
    std::fs::create_dir(folder.path().join("folder.png")).unwrap();
    let strict = LowerOptions::new(folder.path());
    let lax = LowerOptions { missing_textures: MissingTextures::Warn, ..strict.clone() };
    for path in ["none.png", "folder.png", "builtin:moon.png", "embedded:none", "text.png"] {
        let desc = parse(&picture_scene(path), "a.toml").unwrap();
        let Err(problems) = lower(&desc, &strict) else { panic!("{path} was read") };
        assert_eq!(problems[0].path.to_string(), "textures.t.path");
        if path != "text.png" {
            let warnings = lower_with_warnings(&desc, &lax).expect("it is a warning").warnings;
            assert_eq!(warnings.len(), 1, "{path}");
        }
    }
    let desc = parse(&mesh_scene("kind = 'file', path = 'none.ply'"), "a.toml").unwrap();
    for options in [&strict, &lax] {
        let Err(problems) = lower(&desc, options) else { panic!("there is no such mesh") };
        assert!(problems[0].to_string().contains("none.ply"), "{}", problems[0]);
    }
}

#[test]
fn pipes_and_folders_are_no_meshes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    let desc = parse(&mesh_scene("kind = 'file', path = 'src'"), "a.toml").unwrap();
    let Err(problems) = lower(&desc, &LowerOptions::new(path)) else { panic!("it is a folder") };
    assert!(problems[0].to_string().contains("not a file"), "{}", problems[0]);
}
