//! `zrak compile`, and rendering what it made.

use crate::harness::Folder;

#[test]
fn a_compiled_scene_renders_the_same_bytes() {
    let folder = Folder::new();
    let picture = "--spp 3 --width 40 -q -b cpu";
    for scene in ["everything", "workshop", "cornell-smoke"] {
        let ended = folder.ok(&format!("compile {scene} -o a.zscene --json"));
        let json = ended.json();
        assert_eq!((&json["scene"], &json["output"]), (&scene.into(), &"a.zscene".into()));
        assert_eq!(json["bytes"], folder.read("a.zscene").len());
        assert!(json["arrays"]["nodes8"].as_u64().unwrap() >= 256, "{json}");
        folder.ok(&format!("render {scene} {picture} -o a.pfm"));
        folder.ok(&format!("render a.zscene {picture} -o b.pfm"));
        assert!(folder.read("a.pfm") == folder.read("b.pfm"), "{scene}");
        folder.ok(&format!("render {scene} {picture} --seed 9 --max-depth 3 -o a.pfm"));
        folder.ok(&format!("render a.zscene {picture} --seed 9 --max-depth 3 -o c.pfm"));
        assert!(folder.read("a.pfm") == folder.read("c.pfm"), "{scene}");
        assert!(folder.read("b.pfm") != folder.read("c.pfm"), "{scene}");
    }
}

#[test]
fn what_is_compiled_has_the_options_in_it() {
    let folder = Folder::new();
    let ended = folder.ok("compile quads --width 24 --spp 2 --seed 0x77 -o quads.zscene");
    assert!(ended.stderr.contains("wrote quads.zscene (") && ended.stdout.is_empty(), "{ended:?}");
    let json = folder.ok("render quads.zscene --json -q -b cpu").json();
    assert_eq!(
        (&json["scene"], &json["width"], &json["spp"]),
        (&"quads".into(), &24.into(), &2.into())
    );
    assert_eq!(json["seed"], 0x77);
    assert_eq!(folder.list(), ["quads.png", "quads.zscene"]);
    // Compiled again, also in its own place, it is the same file.
    let file = folder.read("quads.zscene");
    folder.ok("compile quads.zscene -o quads.zscene -q");
    assert!(folder.read("quads.zscene") == file);
}

#[test]
fn what_cannot_be_compiled_or_opened_is_explained() {
    let folder = Folder::new();
    folder.fails("compile quads -o quads.png", 2, &["error:", "--output", "end in .zscene"]);
    folder.fails("compile quads", 2, &["--output"]);
    folder.fails("compile nothing -o a.zscene", 3, &["'nothing'"]);
    folder.fails("compile quads -o none/a.zscene", 4, &["create its folder first"]);
    folder.fails("compile quads --width 0 -o a.zscene", 2, &["'--width'"]);
    assert_eq!(folder.list(), [""; 0]);

    folder.ok("compile quads -o a.zscene -q");
    folder.fails("export a.zscene", 3, &["a compiled scene cannot be converted"]);
    let good = folder.read("a.zscene");
    let mut bad = good.clone();
    *bad.last_mut().unwrap() ^= 1;
    folder.write("bad.zscene", &bad);
    let help = "compile the scene again";
    let words = ["error: the compiled scene is damaged: its bytes are not", "bad.zscene", help];
    folder.fails("render bad.zscene", 3, &words);
    folder.write("bad.zscene", &good[..good.len() - 256]);
    folder.fails("render bad.zscene", 3, &["damaged: it has", help]);
    folder.write("bad.zscene", "");
    folder.fails("render bad.zscene", 3, &["not a compiled scene", "zrak compile SCENE"]);
    folder.write("bad.zscene", "format = 1\n");
    folder.fails("render bad.zscene", 3, &["not a compiled scene"]);
    std::fs::create_dir(folder.path("dir.zscene")).unwrap();
    folder.fails("render dir.zscene", 3, &["a folder"]);
    folder.fails("render none.zscene", 3, &["no such file"]);
    folder.fails("compile quads -o dir.zscene", 4, &["it is a folder"]);
}
