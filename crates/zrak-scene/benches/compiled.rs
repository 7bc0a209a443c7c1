//! Time to open a compiled scene of about a gigabyte, most of it trees, that lies in the page cache. Run
//! with `cargo bench -p zrak-scene`.

use std::collections::BTreeMap;
use std::sync::Arc;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use zrak_mesh::TriangleMesh;
use zrak_scene::compiled::CompiledScene;
use zrak_scene::desc::{ColorDesc, MaterialDesc, MeshDesc, ObjectDesc, SceneDesc};
use zrak_scene::lower::{LowerOptions, lower};

/// Squares along each side of the terrain.
const SIDE: u32 = 2000;

/// Hills of 2 SIDE^2 triangles.
fn terrain() -> SceneDesc {
    let at = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|k| f64::from(k) / f64::from(SIDE) * 20.0 - 10.0);
        let y = libm::sin(3.0 * x) * libm::cos(2.0 * z) + 0.1 * libm::sin(31.0 * x + 17.0 * z);
        [x, y, z].map(|x| x as f32)
    };
    let row = SIDE + 1;
    let mesh = TriangleMesh {
        positions: (0..row * row).map(|v| at(v % row, v / row)).collect(),
        triangles: (0..SIDE * SIDE)
            .map(|square| square / SIDE * row + square % SIDE)
            .flat_map(|v| [[v, v + row, v + 1], [v + 1, v + row, v + row + 1]])
            .collect(),
        ..TriangleMesh::default()
    };
    let material = MaterialDesc::Lambertian { color: ColorDesc::Solid([0.5; 3]) };
    let object = ObjectDesc::Mesh {
        mesh: "terrain".to_owned(),
        material: "grey".to_owned(),
        group_materials: Vec::new(),
        flip: false,
        transform: Vec::new(),
    };
    SceneDesc {
        name: "terrain".to_owned(),
        meshes: BTreeMap::from([("terrain".to_owned(), MeshDesc::Loaded(Arc::new(mesh)))]),
        materials: BTreeMap::from([("grey".to_owned(), material)]),
        objects: vec![object],
        ..SceneDesc::default()
    }
}

fn open(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let path = folder.path().join("terrain.zscene");
    let desc = terrain();
    let arena = lower(&desc, &LowerOptions::new("")).expect("the scene is good");
    let size = arena.bytes().len();
    CompiledScene::new(&desc, arena).write_file(&path).expect("there is room on the disk");
    let mut group = c.benchmark_group("compiled");
    group.sample_size(10).throughput(Throughput::Bytes(size as u64));
    group.bench_function("open", |b| b.iter(|| CompiledScene::open(&path).expect("it is good")));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    group.bench_function("open on one thread", |b| {
        b.iter(|| pool.install(|| CompiledScene::open(&path).expect("it is good")));
    });
    group.bench_function("read", |b| {
        b.iter(|| {
            let bytes = std::fs::read(&path).expect("it is there");
            CompiledScene::parse(&bytes, "").expect("it is good")
        });
    });
}

criterion_group!(benches, open);
criterion_main!(benches);
