//! `zrak scenes` and `zrak convert`.

use crate::harness::Folder;

fn names(folder: &Folder) -> Vec<String> {
    let json = folder.ok("scenes --json").json();
    let scenes = json.as_array().unwrap().iter();
    scenes.map(|scene| scene["name"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn scenes_are_listed() {
    let folder = Folder::new();
    let names = names(&folder);
    assert!(names.len() >= 10);
    let table = folder.ok("scenes").stdout;
    assert_eq!(table.lines().count(), names.len() + 1);
    assert!(names.iter().all(|name| table.contains(name.as_str())), "{table}");
}

#[test]
fn an_exported_scene_is_the_same_scene() {
    let folder = Folder::new();
    for name in names(&folder) {
        folder.ok(&format!("export {name} -o scene.toml --spp 2"));
        folder.ok(&format!("render {name} --height 20 --spp 2 -q -o a.pfm"));
        folder.ok("render ./scene.toml --height 20 -q -o b.pfm");
        assert!(folder.read("a.pfm") == folder.read("b.pfm"), "{name}");
        // And written again it is the same file.
        let again = folder.ok("export scene.toml -o -").stdout;
        assert!(again.as_bytes() == folder.read("scene.toml"), "{name}");
    }
}

#[test]
fn an_export_takes_overrides_and_replaces_whole_files() {
    let folder = Folder::new();
    folder.write("cover.toml", "old");
    let ended = folder.ok("export cover -o cover.toml --width 100 --spp 7 --seed 5");
    assert_eq!((ended.stdout.as_str(), ended.stderr.as_str()), ("", ""));
    let text = String::from_utf8(folder.read("cover.toml")).unwrap();
    for line in ["width = 100", "height = 56", "samples_per_pixel = 7", "seed = 5"] {
        assert!(text.lines().any(|found| found == line), "{line} is not in {text}");
    }
    assert_eq!(folder.list(), ["cover.toml"]);
    folder.fails("export cover -o none/cover.toml", 4, &["none/cover.toml", "folder"]);
    folder.fails("export nothing", 3, &["there is no built-in scene 'nothing'"]);
}

#[test]
fn a_built_in_scene_goes_before_a_file_of_its_name() {
    let folder = Folder::new();
    folder.write("quads", "not a scene");
    folder.ok("export quads");
    folder.fails("export ./quads", 3, &["error", "./quads"]);
}
