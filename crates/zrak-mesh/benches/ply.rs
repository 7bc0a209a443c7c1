//! How fast meshes are read.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use zrak_mesh::{Limits, TriangleMesh, ply};

/// A grid of `n` x `n` cells.
fn grid(n: u32) -> TriangleMesh {
    let point = |i: u32| [(i % (n + 1)) as f32, (i / (n + 1)) as f32, ((i * 7919) % 13) as f32];
    let cell = |i: u32| {
        let a = i % n + i / n * (n + 1);
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    TriangleMesh {
        positions: (0..(n + 1) * (n + 1)).map(point).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..TriangleMesh::default()
    }
}

fn read(c: &mut Criterion) {
    let mut bytes = Vec::new();
    ply::write(&mut bytes, &grid(708)).expect("writing to memory");
    let mut group = c.benchmark_group("ply");
    group.throughput(Throughput::Bytes(bytes.len() as u64)).sample_size(20);
    group.bench_function("binary, 1 M triangles", |b| {
        b.iter(|| ply::parse(&bytes, &Limits::default()));
    });
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);
