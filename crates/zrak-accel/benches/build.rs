//! Time to build trees of both widths. Run with `cargo bench -p zrak-accel`.

mod scenes;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use zrak_accel::build_trees;

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("build_trees");
    group.sample_size(10);
    for (name, n) in [
        ("soup", 500),
        ("soup", 4_000),
        ("soup", 10_000),
        ("terrain", 10_000),
        ("soup", 1_000_000),
        ("terrain", 1_000_000),
    ] {
        let Some(prims) = scenes::by_name(name, n) else { continue };
        group.throughput(Throughput::Elements(prims.len() as u64));
        group.bench_with_input(BenchmarkId::new(name, n), &prims, |b, prims| {
            b.iter(|| build_trees(prims));
        });
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
