//! Ctrl-C.
#![cfg(unix)]

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::harness::{Ended, Folder, ended};

/// Sends a signal to a run after a while, and waits for its end.
fn interrupted(folder: &Folder, args: &str, signal: &str, after: Duration) -> (Ended, Duration) {
    let mut command = folder.command(args);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(after);
    let pid = child.id().to_string();
    assert!(Command::new("kill").args([signal, &pid]).status().unwrap().success());
    let sent = Instant::now();
    let ended = ended(child.wait_with_output().unwrap());
    (ended, sent.elapsed())
}

#[test]
fn the_finished_passes_are_written() {
    let folder = Folder::new();
    for signal in ["-INT", "-TERM"] {
        let args = "render quads --width 32 --spp 16000000 -o x.png --json";
        let (ended, took) = interrupted(&folder, args, signal, Duration::from_secs(3));
        let json = ended.json();
        let spp = json["spp"].as_u64().unwrap();
        assert!((1..16_000_000).contains(&spp), "{json}");
        let words = format!("interrupted: the picture has {spp} of 16000000 samples per pixel");
        ended.check(130, &[&words]);
        assert_eq!((&json["complete"], &json["outputs"][0]), (&false.into(), &"x.png".into()));
        assert_eq!(folder.list(), ["x.png"]);
        assert!(took < Duration::from_secs(10), "{took:?}");
        // It is the picture of that many samples.
        if spp < 3000 {
            folder.ok(&format!("render quads --width 32 --spp {spp} -q -o y.png"));
            folder.ok("compare x.png y.png --identical");
        }
        std::fs::remove_file(folder.path("x.png")).unwrap();
    }
}

#[test]
fn nothing_is_written_before_the_first_pass_is_finished() {
    let folder = Folder::new();
    let args = "render final --width 1200 --tree brute-force --threads 1 --backend cpu";
    let (ended, took) = interrupted(&folder, args, "-INT", Duration::from_secs(2));
    ended.check(130, &["interrupted before the first pass was finished: nothing was written"]);
    assert_eq!(folder.list(), [""; 0]);
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn a_benchmark_reports_what_it_has() {
    let folder = Folder::new();
    let args = "bench quads --resolutions 8x8,3000x3000 --spp 10000 --backends cpu --runs 1 \
                --max-time 1e9 --json";
    let (ended, _) = interrupted(&folder, args, "-INT", Duration::from_secs(4));
    ended.check(130, &["interrupted: the points that were finished are reported"]);
    assert_eq!(ended.json()["points"].as_array().unwrap().len(), 1);
}
