//! Builds the trees over a procedural scene and prints time, sizes and quality:
//! `cargo run --release -p zrak-accel --example build_trees -- terrain 1000000`.
//!
//! Under `/usr/bin/time -v` it shows the memory that a build needs.

#[path = "../benches/scenes/mod.rs"]
mod scenes;

use std::time::Instant;

use zrak_accel::{BuildOptions, build_trees_with, sah_cost};

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let prims = match &args[..] {
        [_, name, n] => n.parse().ok().and_then(|n| scenes::by_name(name, n)),
        _ => None,
    };
    let Some(prims) = prims else {
        eprintln!("usage: build_trees (terrain|soup) NUMBER-OF-TRIANGLES");
        std::process::exit(2);
    };
    let n = prims.len();
    let start = Instant::now();
    let trees = build_trees_with(prims, &BuildOptions::default());
    let time_s = start.elapsed().as_secs_f64();
    let (n2, n8) = (trees.nodes2.len(), trees.nodes8.len());
    println!("{n} triangles in {time_s:.3} s");
    println!("binary: {n2} nodes, {} MB, cost {:.3}", n2 * 64 / 1_000_000, sah_cost(&trees.nodes2));
    println!(
        "wide:   {n8} nodes, {} MB, cost {:.3}",
        n8 * 256 / 1_000_000,
        sah_cost(&trees.nodes8)
    );
}
