//! `zrak render` when all goes well.

use crate::harness::Folder;

#[test]
fn a_scene_becomes_a_picture_with_a_summary() {
    let folder = Folder::new();
    let ended = folder.ok("render quads --width 20 --spp 3 --threads 2");
    assert_eq!(folder.list(), ["quads.png"]);
    for words in
        ["no GPU: ", "; rendering on 2 threads", "quads: 20x20 pixels, 3 samples per pixel"]
    {
        assert!(ended.stderr.contains(words), "{ended:?}");
    }
    for words in ["build", "Msamples/s", "Mrays/s", "first picture after", "wrote quads.png"] {
        assert!(ended.stderr.contains(words), "{ended:?}");
    }
    assert_eq!(ended.stdout, "");
}

#[test]
fn quiet_is_quiet() {
    let folder = Folder::new();
    let ended = folder.ok("render quads --width 8 --spp 1 --quiet");
    assert_eq!((ended.stdout.as_str(), ended.stderr.as_str()), ("", ""));
}

#[test]
fn every_format_holds_the_same_picture() {
    let folder = Folder::new();
    folder.ok(
        "render cornell-box --width 24 --spp 8 -q -o a.pfm -o a.exr -o a.hdr -o a.png -o a.jpg \
         -o b.jpeg",
    );
    folder.ok("compare a.pfm a.exr --identical");
    folder.ok("compare a.jpg b.jpeg --identical");
    // HDR has 8 bits of mantissa; the others clamp to [0, 1], and the lamp is brighter.
    folder.ok("compare a.pfm a.hdr --max-rmse 0.05");
    folder.ok("compare a.png a.jpg --max-rmse 0.1");
    folder.fails("compare a.pfm a.png --identical", 1, &["not identical"]);
    let png = folder.read("a.png");
    let has = |words: &[u8]| png.windows(words.len()).any(|window| window == words);
    assert!(has(b"cornell-box") && has(b"samplesPerPixel\x008"));
}

#[test]
fn json_says_everything_in_one_line() {
    let folder = Folder::new();
    let ended = folder.ok(
        "render earth --width 32 --spp 2 --seed 0xff --max-depth 7 --json -b cpu -j 2 -o x.pfm",
    );
    let json = ended.json();
    for (key, value) in [
        ("scene", "\"earth\""),
        ("width", "32"),
        ("height", "18"),
        ("spp", "2"),
        ("seed", "255"),
        ("max_depth", "7"),
        ("backend", "\"cpu\""),
        ("threads", "2"),
        ("samples", "1152"),
        ("outputs", "[\"x.pfm\"]"),
        ("complete", "true"),
        ("version", concat!("\"", env!("CARGO_PKG_VERSION"), "\"")),
    ] {
        assert_eq!(json[key].to_string(), value, "{key}");
    }
    for key in ["msamples_per_s", "mrays_per_s", "rays"] {
        assert!(json[key].as_f64().unwrap() > 0.0, "{key}");
    }
    let times = &json["times"];
    let time = |key: &str| times[key].as_f64().unwrap();
    for key in ["build_s", "compile_s", "upload_s", "render_s", "download_s", "write_s"] {
        assert!((0.0..=time("total_s")).contains(&time(key)), "{key}");
    }
    assert!(time("first_picture_s") <= time("total_s"));
}

#[test]
fn threads_and_trees_do_not_change_the_picture() {
    let folder = Folder::new();
    let render = |options: &str| {
        folder.ok(&format!("render final --width 40 --spp 3 -q -b cpu -o x.pfm {options}"));
        folder.read("x.pfm")
    };
    let reference = render("--threads 1");
    for options in ["--threads 4", "", "--tree binary", "--tree brute-force"] {
        assert!(render(options) == reference, "{options}");
    }
    assert!(render("--seed 1") != reference);
    assert!(render("--max-depth 3") != reference);
}

#[test]
fn one_side_keeps_the_aspect_ratio_and_both_do_not() {
    let folder = Folder::new();
    for (options, width, height) in
        [("--width 64", 64, 36), ("--height 9", 16, 9), ("--width 5 --height 7", 5, 7)]
    {
        let json = folder.ok(&format!("render cover --spp 1 --json {options}")).json();
        assert_eq!((json["width"].as_u64(), json["height"].as_u64()), (Some(width), Some(height)));
    }
}

#[test]
fn the_transfer_curve_is_a_choice() {
    let folder = Folder::new();
    folder.ok("render quads --width 16 --spp 1 -q -o a.png");
    folder.ok("render quads --width 16 --spp 1 -q -o b.png --transfer gamma2");
    folder.fails("compare a.png b.png --identical", 1, &[]);
}

#[test]
fn a_scene_file_is_rendered_with_its_images() {
    let folder = Folder::new();
    folder.ok("render earth --width 32 --spp 1 -q -o map.png");
    let scene = folder.ok("export earth --width 32 --spp 2").stdout;
    folder.write("mine.toml", scene.replace("builtin:earth.png", "map.png"));
    folder.ok("render mine.toml -q -o x.pfm");
    // Also from another folder, and after being exported to another folder.
    std::fs::create_dir(folder.path("sub")).unwrap();
    folder.ok("export mine.toml -o sub/copy.toml");
    folder.ok("render sub/copy.toml -q -o y.pfm");
    folder.ok("compare x.pfm y.pfm --identical");
    // In the same folder, paths stay as they are.
    folder.ok("export mine.toml -o twin.toml");
    assert!(String::from_utf8(folder.read("twin.toml")).unwrap().contains("\"map.png\""));
}
