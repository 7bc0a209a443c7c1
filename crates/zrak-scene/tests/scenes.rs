//! Every scene file and every example of the guide can be read and has no problems.

use std::path::{Path, PathBuf};

use zrak_scene::file;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The scene files in a folder, by name.
fn scene_files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths
}

#[test]
fn every_scene_file_is_good_and_says_what_it_is() {
    let paths = [scene_files("scenes"), scene_files("scenes/reference")].concat();
    assert!(paths.len() >= 6, "{paths:?}");
    for path in paths {
        let scene = file::read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.source.text.starts_with("# "), "{}: no comment", path.display());
        // What is written from it is the same scene.
        let written = file::write_string(&scene.desc);
        assert_eq!(file::parse(&written, "written").unwrap(), scene.desc);
    }
}

#[test]
fn the_references_have_the_right_size() {
    for (name, n_objects) in [("cornell", 8), ("cover", 486), ("cover_fuzz", 486)] {
        let scene = file::read(root().join(format!("scenes/reference/{name}.toml"))).unwrap().desc;
        assert_eq!([scene.camera.width, scene.camera.height], [128, 128]);
        assert_eq!((scene.objects.len(), scene.render.max_depth), (n_objects, 50), "{name}");
    }
    // Those that `make.py` makes, each with its picture.
    let small =
        ["bumps", "glass", "holes", "instances", "lamps", "layers", "media", "metals", "textures"];
    for name in small {
        let scene = file::read(root().join(format!("scenes/reference/{name}.toml"))).unwrap().desc;
        assert_eq!([scene.camera.width, scene.camera.height], [64, 64], "{name}");
        assert_eq!(scene.render.max_depth, 50, "{name}");
    }
}

/// The TOML blocks of a page.
fn toml_blocks(page: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(page).unwrap().replace("\r\n", "\n");
    let blocks = text.split("```toml\n").skip(1);
    blocks.map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// The pages of a folder of the documentation.
fn pages(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    paths.sort();
    paths
}

#[test]
fn the_guides_examples_are_good() {
    let format = root().join("docs/scene-format.md");
    let blocks = toml_blocks(&format);
    assert!(blocks.len() >= 5);
    // A fragment is an addition to the format's first example, which is a whole scene.
    let whole = blocks[0].clone();
    let guide = pages("docs/guide");
    assert!(guide.len() >= 5, "{guide:?}");
    for page in [vec![format], guide].concat() {
        for block in toml_blocks(&page) {
            let is_whole = block.contains("format = 1");
            let text = if is_whole { block } else { insert(&whole, &block) };
            if let Err(error) = file::parse(&text, &page.display().to_string()) {
                panic!("{error}\n\nin this example:\n\n{text}");
            }
        }
    }
}

/// A whole scene with a fragment in it: the lines of a section go into the scene's section of that
/// name, if it has one, and replace its lines with the same keys.
fn insert(whole: &str, fragment: &str) -> String {
    let mut scene: toml::Table = whole.parse().unwrap();
    let added: toml::Table = fragment.parse().unwrap_or_else(|e| panic!("{e}\n{fragment}"));
    for (key, value) in added {
        match (scene.get_mut(&key), value) {
            (Some(toml::Value::Table(there)), toml::Value::Table(more)) if key != "background" => {
                there.extend(more);
            }
            (Some(toml::Value::Array(there)), toml::Value::Array(more)) => there.extend(more),
            (_, value) => {
                scene.insert(key, value);
            }
        }
    }
    scene.to_string()
}
