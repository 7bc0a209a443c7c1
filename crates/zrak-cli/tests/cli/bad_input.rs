//! What is wrong with the command line or the scene is said in words that help.

use crate::harness::Folder;

/// A small scene with a texture from the file `image`.
fn scene_with_image(folder: &Folder, image: &str) -> String {
    let scene = folder.ok("export earth --width 16 --spp 1").stdout;
    scene.replace("builtin:earth.png", image)
}

#[test]
fn scenes_that_are_not_there() {
    let folder = Folder::new();
    folder.fails("render none.toml", 3, &["error: there is no such scene file", "none.toml"]);
    folder.fails(
        "render fianl",
        3,
        &["error: there is no built-in scene 'fianl'; did you mean 'final'? run `zrak scenes`"],
    );
    folder.fails("render teapot", 3, &["'teapot'; run `zrak scenes` for a list"]);
    folder.fails("render .", 3, &["error:"]);
    folder.fails("render ../", 3, &["this is a folder, not a scene file"]);
    assert_eq!(folder.list(), [""; 0]);
}

#[test]
fn scenes_that_are_wrong_are_shown_at_their_place() {
    let folder = Folder::new();
    folder.write("bad.toml", "format = 1\nname = \"bad\"\n[camera\n");
    folder.fails("render bad.toml", 3, &["error:", "bad.toml:3:", "[camera", "^", "not TOML"]);

    let scene = folder.ok("export quads").stdout;
    let wrong = scene.replacen("material = \"", "material = \"x", 1);
    folder.write("material.toml", &wrong);
    let line = wrong.lines().position(|line| line.contains("material = \"x")).unwrap() + 1;
    folder.fails(
        "render material.toml",
        3,
        &["error:", &format!("material.toml:{line}:"), "^", "did you mean"],
    );
    folder.write("binary.toml", [0xff, 0xfe, 0]);
    folder.fails("render binary.toml", 3, &["UTF-8"]);
    assert!(!folder.list().iter().any(|name| name.ends_with(".png")));
}

#[test]
fn images_that_cannot_be_read_are_shown_at_their_place() {
    let folder = Folder::new();
    folder.ok("render quads --width 16 --spp 1 -q -o whole.png");
    let png = folder.read("whole.png");
    folder.write("cut.png", &png[..png.len() / 2]);
    folder.write("huge.pfm", "PF\n60000 60000\n-1.0\n");
    for (image, words) in [
        ("none.png", "No such file"),
        ("cut.png", "damaged or incomplete"),
        ("huge.pfm", "the limit is 16384x16384"),
        ("builtin:mars.png", "earth.png"),
        (".", "it is a folder"),
    ] {
        folder.write("scene.toml", scene_with_image(&folder, image));
        folder.fails("render scene.toml", 3, &["error:", "scene.toml:", "^", image, words]);
    }
}

#[test]
fn sizes_and_samples_name_their_option() {
    let folder = Folder::new();
    for (options, words) in [
        ("--width 0 --height 0", "'--width': width must be from 1 to 65536 pixels, is 0"),
        ("--width 0 --height 0", "'--height': height must be from 1"),
        ("--height 0", "'--height'"),
        ("--width 100000 --height 100000", "'--width': width must be from 1 to 65536 pixels"),
        ("--width 60000 --height 60000", "60000 x 60000 = 3600000000 pixels is too large"),
        ("--height 65000", "'--height', from which the width follows,"),
        ("--spp 0", "'--spp': samples per pixel must be from 1 to 16777216, is 0"),
        ("--spp 99999999", "'--spp'"),
        ("--spp 99999999999", "'--spp <N>'"),
        ("--spp -3", "'--spp <N>'"),
        ("--max-depth 0", "'--max-depth': max depth must be from 1"),
        ("--seed 1e3", "'--seed <N>'"),
        ("--seed 18446744073709551616", "2^64 - 1"),
    ] {
        folder.fails(&format!("render cover {options}"), 2, &["error: invalid value", words]);
    }
    assert_eq!(folder.list(), [""; 0]);
}

#[test]
fn backend_options_are_checked() {
    let folder = Folder::new();
    for (options, words) in [
        ("--block 33x32", "at most 1024 threads, and 33 x 32 = 1056"),
        ("--block 16", "such as 16x16"),
        ("--block 0x16", "at least 1"),
        ("--threads 0", "at least 1 thread"),
        ("--threads many", "'--threads <N>'"),
        ("--threads 100000", "100000 threads"),
        ("--backend gpu", "auto, cpu, cuda"),
        ("--device -1", "error:"),
        ("--transfer linear", "srgb, gamma2"),
        ("--no-such-option", "error:"),
    ] {
        folder.fails(&format!("render quads --width 4 {options}"), 2, &["error:", words]);
    }
    folder.fails("", 2, &["Usage:"]);
    folder.fails("rendre quads", 2, &["render"]);
}

#[test]
fn a_gpu_that_is_not_there_is_an_error_only_if_it_was_asked_for() {
    let folder = Folder::new();
    let render = "render quads --width 4 --spp 1";
    folder.fails(&format!("{render} --backend cuda"), 5, &["error: ", "`--backend auto`"]);
    assert_eq!(folder.list(), [""; 0]);
    let ended = folder.ok(render);
    assert!(ended.stderr.contains("no GPU: "), "{ended:?}");
    folder.fails("selftest --quick --backend cuda", 5, &["error: "]);
    folder.fails("bench --backends cuda", 5, &["error: "]);
}
