use crate::error::SceneErrorKind;
use crate::file::{parse, read};

/// A good scene of which the tests spoil one line.
const GOOD: &str = r#"format = 1
name = "test"

[camera]
look_from = [0, 0, 5]
look_at = [0, 0, 0]
vfov_deg = 40
width = 40
height = 30

[textures]
squares = { kind = "checker", scale = 1, even = [0, 0, 0], odd = [1, 1, 1] }

[materials]
ground = { kind = "lambertian", color = "squares" }
smoke = { kind = "isotropic", color = [1, 1, 1] }

[[objects]]
kind = "sphere"
center = [0, 0, 0]
radius = 1
material = "ground"
transform = [{ rotate_y_deg = 15 }, { scale = 2 }]

[[objects]]
kind = "medium"
boundary = { kind = "box", min = [0, 0, 0], max = [1, 1, 1] }
density = 0.5
material = "smoke"
"#;

/// Replaces `old` by `new` and checks the error's place and that it contains each of `expected`.
#[track_caller]
fn check(old: &str, new: &str, line_column: (usize, usize), expected: &[&str]) {
    assert!(GOOD.contains(old), "{old}");
    let text = GOOD.replacen(old, new, 1);
    let error = parse(&text, "test.toml").unwrap_err();
    let shown = error.to_string();
    assert_eq!(error.line_column(), Some(line_column), "{shown}");
    let (line, column) = line_column;
    for expected in expected.iter().chain([&format!("test.toml:{line}:{column}").as_str()]) {
        assert!(shown.contains(expected), "no {expected:?} in:\n{shown}");
    }
}

#[test]
fn the_good_scene_is_good() {
    parse(GOOD, "test.toml").unwrap();
}

#[test]
fn an_error_looks_like_this() {
    let text = GOOD.replace("radius = 1", "radus = 1").replace("density = 0.5", "density = \"x\"");
    let error = parse(&text, "test.toml").unwrap_err();
    let expected = r#"error: unknown field `radus`, did you mean `radius`?
  --> test.toml:21:1
   |
21 | radus = 1
   | ^^^^^ objects[0]
   |
   = help: the fields here are `kind`, `center`, `center_end`, `radius`, `z_min`, `z_max`, `phi_max_deg`, `material` and `transform`

error: invalid type: string "x", expected a number
  --> test.toml:28:11
   |
28 | density = "x"
   |           ^^^ objects[1].density
   |
   = help: Extinction coefficient: mean number of collisions per world unit"#;
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.kind(), SceneErrorKind::Invalid);
    assert!(error.styled().contains("\u{1b}["));
}

#[test]
fn syntax() {
    check("vfov_deg = 40", "vfov_deg = ", (7, 12), &["https://toml.io"]);
    check("width = 40", "width = 40\nwidth = 41", (9, 1), &["duplicate key"]);
    check("[camera]", "[camera", (4, 8), &["error"]);
    let error = parse("format = 1\nname = 'x", "x").unwrap_err();
    assert_eq!(error.kind(), SceneErrorKind::Syntax);
}

#[test]
fn fields() {
    check("look_at =", "lookat =", (6, 1), &["did you mean `look_at`?"]);
    check("width = 40\n", "", (4, 1), &["missing field `width`", "a whole number"]);
    check("name = \"test\"\n", "", (1, 1), &["missing field `name`"]);
    check("radius = 1\n", "", (18, 1), &["missing field `radius`"]);
    check("[textures]", "[texturs]", (11, 2), &["did you mean `textures`?"]);
    check("squares = { kind", "squares = { color = 1, kind", (12, 13), &["`color`"]);
}

#[test]
fn types() {
    check("look_from = [0, 0, 5]", "look_from = [0, 5]", (5, 13), &["an array of 3 numbers"]);
    check("look_from = [0, 0, 5]", "look_from = [0, 'a', 5]", (5, 17), &["expected a number"]);
    check("look_from = [0, 0, 5]", "look_from = 5", (5, 13), &["an array of 3 numbers"]);
    check("width = 40", "width = 40.5", (8, 9), &["expected a whole number"]);
    check("width = 40", "width = -40", (8, 9), &["out of range", "4294967295"]);
    check("vfov_deg = 40", "vfov_deg = 1e400", (7, 12), &["too large"]);
    check("vfov_deg = 40", "vfov_deg = 99999999999999999999", (7, 12), &["out of range"]);
    check("vfov_deg = 40", "vfov_deg = 1979-05-27", (7, 12), &["date, expected a number"]);
    check("color = \"squares\"", "color = 1", (15, 41), &["an array of 3 numbers or a string"]);
    check("[camera]", "[[camera]]", (4, 1), &["array, expected a table"]);
}

#[test]
fn kinds() {
    check("\"sphere\"", "\"shpere\"", (19, 8), &["did you mean `sphere`?"]);
    check("\"sphere\"", "\"teapot\"", (19, 8), &["expected `sphere`, `quad`, `triangle`"]);
    check("kind = \"sphere\"\n", "", (18, 1), &["missing field `kind`"]);
    check("\"lambertian\"", "\"lambert\"", (15, 19), &["unknown kind `lambert`, did you mean"]);
    check(
        "kind = \"box\"",
        "kind = \"quad\"",
        (27, 21),
        &["unknown kind `quad`", "closed convex boundary: a sphere or a box"],
    );
    check("rotate_y_deg", "rotate_y", (23, 16), &["did you mean `rotate_y_deg`?"]);
    check("{ scale = 2 }", "{ }", (23, 37), &["expected exactly one of `translate`"]);
}

#[test]
fn meaning() {
    check("radius = 1", "radius = -1", (21, 10), &["more than 0", "1/ior", "objects[0].radius"]);
    check("\"ground\"\ntrans", "\"grund\"\ntrans", (22, 12), &["did you mean `ground`?"]);
    check("\"squares\" }", "\"sky\" }", (15, 41), &["unknown texture `sky`", "are `squares`"]);
    check("odd = [1, 1, 1]", "odd = [1, 1, 2]", (12, 73), &["at most 1", "diffuse_light"]);
    check("vfov_deg = 40", "vfov_deg = nan", (7, 12), &["finite number, not NaN"]);
    check("max = [1, 1, 1]", "max = [1, 1, -1]", (27, 51), &["along z"]);
    check("scale = 2 }", "scale = 0 }", (23, 47), &["a factor of `scale` is 0"]);
    // A value that the text leaves out: the nearest thing around it.
    check("look_from = [0, 0, 5]", "look_from = [0, 5, 0]", (4, 1), &["`vup` is parallel"]);
}

#[test]
fn another_format() {
    let error = parse("format = 7\nwhatever = {}\n", "new.toml").unwrap_err();
    assert_eq!(error.kind(), SceneErrorKind::UnsupportedFormat);
    assert_eq!(error.problems().count(), 1);
    assert!(error.to_string().contains("this zrak reads 1"));
}

#[test]
fn many_problems_are_counted() {
    let objects =
        "[[objects]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0\nmaterial = \"x\"\n";
    let text = format!("{GOOD}{}", objects.repeat(20));
    let error = parse(&text, "x").unwrap_err();
    assert_eq!(error.problems().count(), 10);
    assert!(error.to_string().ends_with("error: 30 more problems in this file"), "{error}");
}

#[test]
fn empty_text() {
    let shown = parse("", "empty.toml").unwrap_err().to_string();
    assert!(shown.contains("missing field `camera`"), "{shown}");
    assert!(shown.contains("empty.toml:1:1"), "{shown}");
}

#[test]
fn columns_count_characters() {
    let text = GOOD.replace("name = \"test\"", "name = \"тест\"\n\"füß\" = 1");
    assert_eq!(parse(&text, "x").unwrap_err().line_column(), Some((3, 1)));
    let text = GOOD.replace("{ kind = \"lambertian\"", "{ 'é' = 1, x = 1, kind = \"lambertian\"");
    let error = parse(&text, "x").unwrap_err();
    assert!(error.to_string().contains("x:15:21"), "{error}");
}

#[test]
fn long_lines_and_names_are_cut() {
    let long = "x".repeat(1_000_000);
    let shown = parse(&format!("{GOOD}\n{long} = 1"), "x").unwrap_err().to_string();
    assert!(shown.len() < 5000, "{}", shown.len());
    let shown = parse(&format!("{long} = 1\n{GOOD}"), "x").unwrap_err().to_string();
    assert!(shown.len() < 5000 && shown.contains("x:1:1"), "{}", shown.len());
}

#[test]
fn marks_and_ends_of_other_systems() {
    let text = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    assert_eq!(parse(&text, "x").unwrap(), parse(GOOD, "x").unwrap());
    let error = parse(&text.replace("radius = 1", "radius = 0"), "x").unwrap_err();
    assert_eq!(error.line_column(), Some((21, 10)));
    assert!(!error.to_string().contains('\r'));
}

#[test]
fn files() {
    let folder = tempfile::tempdir().unwrap();
    let fails = |name: &str, kind: SceneErrorKind, expected: &str| {
        let error = read(folder.path().join(name)).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(expected), "{error}");
        assert!(error.to_string().contains(name), "{error}");
    };
    fails("missing.toml", SceneErrorKind::Io, "no such scene file");
    fails("", SceneErrorKind::Io, "this is a folder");
    std::fs::write(folder.path().join("latin1.toml"), b"format = 1\nname = '\xe9'\n").unwrap();
    fails("latin1.toml", SceneErrorKind::Encoding, "line 2");
    // A sparse file takes no space.
    let large = std::fs::File::create(folder.path().join("large.toml")).unwrap();
    large.set_len((256 << 20) + 1).unwrap();
    fails("large.toml", SceneErrorKind::TooLarge, "256 MiB");

    let path = folder.path().join("good.toml");
    std::fs::write(&path, GOOD).unwrap();
    let scene = read(&path).unwrap();
    assert_eq!(scene.base_dir, folder.path());
    assert_eq!(scene.desc, parse(GOOD, "").unwrap());
    assert_eq!(scene.source.text, GOOD);
}

#[test]
fn later_problems_have_places_too() {
    use crate::validate::{KeyPath, Problem};
    let source = crate::file::Source { origin: "t.toml".to_owned(), text: GOOD.to_owned() };
    let path = KeyPath::default().join("textures").join("squares").join("scale");
    let error = source.error(vec![Problem { path, message: "no".to_owned(), help: None }]);
    assert_eq!(error.line_column(), Some((12, 39)));
}
