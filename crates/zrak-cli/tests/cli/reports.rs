//! `zrak devices`, `selftest` and `bench`.

use crate::harness::Folder;

#[test]
fn devices_are_listed_with_the_reason_for_those_that_are_not() {
    let folder = Folder::new();
    let text = folder.ok("devices").stdout;
    assert!(text.contains("cpu ") && text.contains("thread") && text.contains("cuda    none: "));
    let json = folder.ok("devices --json").json();
    assert!(json["cpu"]["threads"].as_u64().unwrap() >= 1);
    assert!(!json["cpu"]["instruction_set"].as_str().unwrap().is_empty());
    assert_eq!(json["cuda"].as_array().unwrap().len(), 0);
    assert!(!json["no_cuda"].as_str().unwrap().is_empty());
}

#[test]
fn all_backends_render_the_same_pictures() {
    let folder = Folder::new();
    let text = folder.ok("selftest --quick").stdout;
    for words in ["final", "brute force", "cuda: not tested: ", "the same, to the last bit"] {
        assert!(text.contains(words), "'{words}' is not in {text}");
    }
    assert!(!text.contains("DIFFERENT"), "{text}");
    let json = folder.ok("selftest --quick --backend cpu --json").json();
    assert_eq!(json["ok"], true);
    assert!(json["pictures"].as_u64().unwrap() >= 50);
}

#[test]
fn a_benchmark_makes_tables_files_and_charts() {
    let folder = Folder::new();
    let ended = folder.ok("bench quads --resolutions 8x8,16x16 --spp 2 --runs 3 --out results");
    for words in ["CPU, 1 thread", "8x8", "16x16", "Msamples/s", "median of 3 runs"] {
        assert!(ended.stdout.contains(words), "'{words}' is not in {ended:?}");
    }
    assert!(ended.stderr.contains("cuda is left out: "), "{ended:?}");

    let csv = String::from_utf8(folder.read("results/bench.csv")).unwrap();
    let n_columns = csv.lines().next().unwrap().split(',').count();
    assert_eq!(csv.lines().count(), 5);
    assert!(csv.lines().all(|line| line.split(',').count() == n_columns), "{csv}");
    let json: serde_json::Value =
        serde_json::from_slice(&folder.read("results/bench.json")).unwrap();
    assert_eq!((&json["setup"]["scene"], &json["setup"]["spp"]), (&"quads".into(), &2.into()));
    assert!(json["setup"]["date"].as_str().unwrap().ends_with('Z'));
    assert_eq!(json["points"].as_array().unwrap().len(), 4);
    for chart in ["time", "speedup"] {
        assert!(folder.read(&format!("results/{chart}.svg")).starts_with(b"<"));
        assert!(folder.read(&format!("results/{chart}.png")).starts_with(b"\x89PNG"));
    }
}

#[test]
fn a_benchmark_leaves_out_what_would_take_too_long() {
    let folder = Folder::new();
    let args = "bench quads --resolutions 8x8,2000x2000 --spp 50 --runs 1 --max-time 1 --json";
    let ended = folder.ok(&format!("{args} --backends cpu1"));
    assert!(ended.stderr.contains("2000x2000 cpu1 is left out: about"), "{ended:?}");
    let json = ended.json();
    assert_eq!(json["points"].as_array().unwrap().len(), 1);
    assert_eq!(json["skipped"].as_array().unwrap().len(), 1);
}

#[test]
fn a_benchmark_checks_its_input_first() {
    let folder = Folder::new();
    folder.write("file", "");
    for (args, code, words) in [
        ("bench --resolutions 0x10", 2, "--resolutions"),
        ("bench --resolutions 10,20", 2, "such as 16x16"),
        ("bench --resolutions 70000x1", 2, "'--width'"),
        ("bench --spp 0", 2, "'--spp'"),
        ("bench --runs 0", 2, "--runs"),
        ("bench --backends gpu", 2, "cpu1, cpu, cuda"),
        ("bench --blocks 64x64", 2, "at most 1024 threads"),
        ("bench nothing", 3, "'nothing'"),
        ("bench --out file", 4, "file"),
    ] {
        folder.fails(args, code, &["error:", words]);
    }
}
