//! Where pictures cannot be written, and where nobody reads.

use crate::harness::{Folder, ended};

#[test]
fn places_that_cannot_be_written_to_are_found_before_rendering() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("sub.png")).unwrap();
    folder.write("file", "");
    // So long a render that the test would not end.
    let render = "render final --spp 10000000 -q -o good.pfm -o";
    for (output, words) in [
        ("none/x.png", "create its folder first"),
        ("file/x.png", "create its folder first"),
        ("sub.png", "it is a folder"),
        ("x.gif", ".png, .jpg, .jpeg, .hdr, .exr, .pfm"),
        ("x", "names no picture format"),
        #[cfg(target_os = "linux")]
        ("/dev/full/x.png", "create its folder first"),
        #[cfg(target_os = "linux")]
        ("/proc/x.png", "cannot write '/proc/x.png'"),
    ] {
        folder.fails(&format!("{render} {output}"), 4, &["error: ", output, words]);
    }
    assert_eq!(folder.list(), ["file", "sub.png"]);
}

/// A limit on the size of files stands in for a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_costs_neither_the_old_picture_nor_the_other_ones() {
    let folder = Folder::new();
    folder.write("old.pfm", "old");
    let ended = folder.shell(
        "trap '' XFSZ; ulimit -f 32; zrak render quads --width 64 --spp 1 -o old.pfm -o small.jpg",
    );
    ended.check(4, &["error: cannot write 'old.pfm'", "the file there before is unchanged"]);
    assert!(ended.stderr.contains("wrote small.jpg"), "{ended:?}");
    assert_eq!(folder.read("old.pfm"), b"old");
    assert_eq!(folder.list(), ["old.pfm", "small.jpg"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let folder = Folder::new();
    for args in ["scenes", "export final", "render quads --width 4 --spp 1 --json"] {
        let ended = folder.shell(&format!("zrak {args} > /dev/full"));
        ended.check(4, &["error: cannot write to the standard output: No space left"]);
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = Folder::new();
    for args in [
        "scenes",
        "export final",
        "man",
        "completions bash",
        "devices",
        "render quads --width 4 --spp 1 --json --quiet",
    ] {
        let mut command = folder.command(args);
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let ended = ended(command.stdout(writer).output().unwrap());
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{args}");
    }
    // stderr may be left, too, and the picture is written all the same.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = folder.command("render quads --width 4 --spp 1 -o x.png");
    assert!(command.stderr(writer).status().unwrap().success());
    assert!(folder.path("x.png").is_file());
}

#[cfg(unix)]
#[test]
fn closed_outputs_are_no_error() {
    let folder = Folder::new();
    assert_eq!(folder.shell("zrak scenes >&-").code, Some(0));
    assert_eq!(folder.shell("zrak render quads --width 4 --spp 1 -o x.png >&- 2>&-").code, Some(0));
    assert_eq!(folder.shell("zrak scenes | head -1").stdout.lines().count(), 1);
}
