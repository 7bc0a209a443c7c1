//! Time to build trees. Run with `cargo bench -p zrak-accel`.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use zrak_accel::build_trees;
use zrak_core::math::{Bounds, Vec3, pcg3d, unit_f32, vec3};
use zrak_core::scene::{PrimKind, PrimRef};

/// Small boxes, uniform in the unit cube.
fn boxes(n: u32) -> Vec<(PrimRef, Bounds)> {
    (0..n)
        .map(|i| {
            let [x, y, z] = pcg3d([i, 1, 2]).map(unit_f32);
            let center = vec3(x, y, z);
            let half = Vec3::splat(0.005);
            let bounds = Bounds { lo: center - half, hi: center + half };
            (PrimRef::new(PrimKind::Sphere, i), bounds)
        })
        .collect()
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("build_trees");
    group.sample_size(10);
    for n in [500, 10_000, 100_000] {
        let prims = boxes(n);
        group.throughput(Throughput::Elements(u64::from(n)));
        group.bench_with_input(BenchmarkId::from_parameter(n), &prims, |b, prims| {
            b.iter(|| build_trees(prims));
        });
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
