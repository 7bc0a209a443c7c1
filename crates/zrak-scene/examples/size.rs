//! What a scene file takes once it is lowered: seconds, bytes of each array, and the largest amount of
//! memory on the way (on Linux).
//!
//! ```sh
//! cargo run --release -p zrak-scene --example size -- /tmp/large/large.toml
//! ```

use std::time::Instant;

use zrak_scene::file;
use zrak_scene::lower::{LowerOptions, lower};

fn main() {
    let path = std::env::args().nth(1).expect("the path of a scene file");
    let loaded = file::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let start = Instant::now();
    let arena = lower(&loaded.desc, &LowerOptions::new(&loaded.base_dir))
        .unwrap_or_else(|problems| panic!("{problems:?}"));
    println!("lowered in {:.2} s", start.elapsed().as_secs_f64());
    let view = arena.view();
    println!("{} triangles, {} instances", view.mesh_triangles.len(), view.instances.len());
    let n = view.mesh_triangles.len().max(1) as f64;
    for (name, size) in arena.sizes().into_iter().filter(|(_, size)| *size > 0) {
        println!("{name:>16} {size:>13} B {:8.2} B per triangle", size as f64 / n);
    }
    let total = arena.bytes().len();
    println!("{:>16} {total:>13} B {:8.2} B per triangle", "arena", total as f64 / n);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    for line in status.lines().filter(|l| l.starts_with("VmHWM") || l.starts_with("VmRSS")) {
        println!("{line}");
    }
}
