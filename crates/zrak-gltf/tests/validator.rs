//! What is written, judged by Khronos' validator. Not run by default, as it needs node and the npm
//! package `gltf-validator`:
//!
//! ```text
//! npm install --prefix DIR gltf-validator
//! ZRAK_GLTF_VALIDATOR=DIR cargo test -p zrak-gltf --test validator -- --ignored
//! ```

mod builder;
#[path = "rich/mod.rs"]
mod rich;

use std::path::Path;
use std::process::Command;

use zrak_gltf::Assets;
use zrak_scene::builtin;
use zrak_scene::desc::SceneDesc;

#[test]
#[ignore = "needs node and the npm package gltf-validator"]
fn the_validator_finds_no_fault() {
    let packages = std::env::var("ZRAK_GLTF_VALIDATOR").expect("ZRAK_GLTF_VALIDATOR is set");
    let dir = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    let mut add = |name: &str, desc: &SceneDesc, assets: &Assets| {
        let path = dir.path().join(format!("{name}.glb"));
        zrak_gltf::write_glb(desc, Path::new(""), assets, &path).unwrap();
        files.push(path);
    };
    for builtin::Builtin { name, build, .. } in builtin::all() {
        add(name, &build(), &Assets::new());
    }
    let rich = rich::rich().import_clean();
    add("rich", &rich.desc, &rich.assets);
    // What the tests read is to be good glTF too.
    let path = dir.path().join("rich_input.glb");
    std::fs::write(&path, rich::rich().glb()).unwrap();
    files.push(path);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/validate.cjs");
    let status = Command::new("node")
        .arg(script)
        .args(&files)
        .env("NODE_PATH", Path::new(&packages).join("node_modules"))
        .status()
        .expect("node runs");
    assert!(status.success());
}
