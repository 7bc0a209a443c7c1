//! Builds the trees over a procedural scene and prints time, sizes and quality:
//! `cargo run --release -p zrak-accel --example build_trees -- terrain 1000000`.

#[path = "../benches/scenes/mod.rs"]
mod scenes;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    for n in args[2].split(',') {
        let prims = scenes::by_name(&args[1], n.parse().unwrap()).unwrap();
        let start = std::time::Instant::now();
        let trees = zrak_accel::build_trees(&prims);
        let time = start.elapsed().as_secs_f64();
        println!(
            "{} {} {:.4} s, nodes {} {}, sah {:.5} {:.5}",
            args[1],
            prims.len(),
            time,
            trees.nodes2.len(),
            trees.nodes8.len(),
            zrak_accel::sah_cost(&trees.nodes2),
            zrak_accel::sah_cost(&trees.nodes8)
        );
    }
}
