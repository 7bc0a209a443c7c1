//! How fast meshes are read.

use std::fmt::Write;

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use zrak_mesh::{Limits, TriangleMesh, obj, ply};

/// A grid of `n` x `n` cells.
fn grid(n: u32) -> TriangleMesh {
    let point = |i: u32| {
        let wave = |k: f32| (i as f32 * k).sin() / 7.0;
        [(i % (n + 1)) as f32 + wave(0.3), (i / (n + 1)) as f32 + wave(0.7), wave(0.1)]
    };
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

/// The same bytes in the other order.
fn swapped(bytes: &[u8], mesh: &TriangleMesh) -> Vec<u8> {
    let end = b"end_header\n";
    let body = bytes.windows(end.len()).position(|w| w == end).expect("a header") + end.len();
    let header = String::from_utf8_lossy(&bytes[..body]).replace("little", "big");
    let mut out = header.into_bytes();
    out.extend(mesh.positions.iter().flatten().flat_map(|x| x.to_be_bytes()));
    for triangle in &mesh.triangles {
        out.push(3);
        out.extend(triangle.iter().flat_map(|v| v.to_be_bytes()));
    }
    out
}

/// Every two triangles as a quad.
fn quads(mesh: &TriangleMesh) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float \
         y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len() / 2
    )
    .into_bytes();
    out.extend(mesh.positions.iter().flatten().flat_map(|x| x.to_le_bytes()));
    for pair in mesh.triangles.chunks_exact(2) {
        out.push(4);
        let [a, b, c] = pair[0];
        out.extend([a, b, c, pair[1][2]].iter().flat_map(|v| v.to_le_bytes()));
    }
    out
}

fn text(mesh: &TriangleMesh) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty \
         float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    );
    for [x, y, z] in &mesh.positions {
        writeln!(out, "{x} {y} {z}").expect("writing to memory");
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "3 {a} {b} {c}").expect("writing to memory");
    }
    out.into_bytes()
}

fn obj_text(mesh: &TriangleMesh) -> Vec<u8> {
    let mut out = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(out, "v {x} {y} {z}\nvt {x:.4} {y:.4}\nvn 0 0 1").expect("writing to memory");
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|v| v + 1)) {
        writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").expect("writing to memory");
    }
    out.into_bytes()
}

fn read(c: &mut Criterion) {
    let mut group = c.benchmark_group("read");
    group.sample_size(10);
    let mut ply = |name: &str, bytes: &[u8]| {
        time(&mut group, name, bytes, |bytes| {
            ply::parse(bytes, &Limits::default()).expect("it is good");
        });
    };
    for n in [708, 1225] {
        let mesh = grid(n);
        let name = if n == 708 { "1 M triangles" } else { "3 M triangles" };
        let mut bytes = Vec::new();
        ply::write(&mut bytes, &mesh).expect("writing to memory");
        ply(&format!("binary PLY, {name}"), &bytes);
        if n == 708 {
            ply("binary PLY, other order", &swapped(&bytes, &mesh));
            ply("binary PLY, quads", &quads(&mesh));
            ply("text PLY", &text(&mesh));
        }
    }
    time(&mut group, "OBJ", &obj_text(&grid(708)), |bytes| {
        obj::parse(bytes, &Limits::default()).expect("it is good");
    });
}

fn time(
    group: &mut BenchmarkGroup<'_, criterion::measurement::WallTime>,
    name: &str,
    bytes: &[u8],
    read: impl Fn(&[u8]),
) {
    group.throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function(name, |b| b.iter(|| read(bytes)));
}

criterion_group!(benches, read);
criterion_main!(benches);
