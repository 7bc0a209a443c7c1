//! Time of the hot paths on one processor thread: the closest hit by kind of ray and tree, and whole
//! samples. Run with `cargo bench -p zrak-cpu`.

use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use zrak_core::accel::{Accel, Bvh2, Bvh8};
use zrak_core::math::{dot, square_to_uniform_sphere};
use zrak_core::ray::Ray;
use zrak_core::sampler::{BounceDim, Sampler};
use zrak_core::scene::{PrimKind, SceneView};
use zrak_core::shapes::surface_interaction;
use zrak_cpu::{CpuBackend, Tree};
use zrak_render::{Backend, Control, Film, Region, SampleRange};
use zrak_scene::arena::SceneArena;
use zrak_scene::lower::{LowerOptions, lower};

const SIDE: u32 = 128;

fn scene(name: &str) -> Arc<SceneArena> {
    let builtin = zrak_scene::builtin::find(name).expect("the scene is built in");
    let mut desc = (builtin.build)();
    (desc.camera.width, desc.camera.height) = (SIDE, SIDE);
    Arc::new(lower(&desc, &LowerOptions::new(Path::new("."))).expect("built-in scenes are valid"))
}

/// Camera rays, and rays that leave the surfaces which those meet into random directions.
fn rays(scene: &SceneView) -> [(&'static str, Vec<(Ray, Sampler)>); 2] {
    let accel = Bvh8 { nodes: scene.nodes8 };
    let mut primary = Vec::new();
    let mut diffuse = Vec::new();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let mut sampler = Sampler::new(0, x, y, 0);
            let ray = scene.globals.camera.ray(x, y, &sampler);
            primary.push((ray, sampler));
            let Some(hit) = accel.closest_hit(scene, &ray, &sampler, f32::INFINITY) else {
                continue;
            };
            if hit.prim.kind() == Some(PrimKind::Medium) {
                continue;
            }
            let surface = surface_interaction(scene, &hit, &ray);
            let n = if surface.is_front(ray.d) { surface.n } else { -surface.n };
            let u = sampler.at_bounce(BounceDim::DirectionU);
            let v = sampler.at_bounce(BounceDim::DirectionV);
            let w = square_to_uniform_sphere(u, v);
            let w = if dot(w, n) < 0.0 { -w } else { w };
            sampler.next_bounce();
            diffuse.push((surface.spawn(w.normalized(), ray.time), sampler));
        }
    }
    [("primary", primary), ("diffuse", diffuse)]
}

fn closest_hit(c: &mut Criterion) {
    for name in ["cover", "final"] {
        let arena = scene(name);
        let view = arena.view();
        let mut group = c.benchmark_group(format!("closest_hit/{name}"));
        for (kind, rays) in rays(&view) {
            group.throughput(Throughput::Elements(rays.len() as u64));
            let trace = |accel: &dyn Fn(&Ray, &Sampler) -> bool| {
                rays.iter().filter(|(ray, sampler)| accel(ray, sampler)).count()
            };
            group.bench_function(format!("{kind}/bvh2"), |b| {
                let accel = Bvh2 { nodes: view.nodes2 };
                b.iter(|| {
                    trace(&|r, s| {
                        accel.closest_hit(black_box(&view), r, s, f32::INFINITY).is_some()
                    })
                });
            });
            group.bench_function(format!("{kind}/bvh8"), |b| {
                let accel = Bvh8 { nodes: view.nodes8 };
                b.iter(|| {
                    trace(&|r, s| {
                        accel.closest_hit(black_box(&view), r, s, f32::INFINITY).is_some()
                    })
                });
            });
        }
    }
}

fn samples(c: &mut Criterion) {
    let mut group = c.benchmark_group("samples");
    group.throughput(Throughput::Elements(u64::from(SIDE * SIDE)));
    for name in ["cover", "cornell-box", "cornell-smoke", "final"] {
        let mut backend =
            CpuBackend::new(scene(name), Some(1), Tree::Wide).expect("one thread can be had");
        let mut film = Film::new(Region::whole(SIDE, SIDE));
        let mut first = 0;
        group.bench_function(name, |b| {
            b.iter(|| {
                let samples = SampleRange { first, count: 1 };
                backend.render(&mut film, samples, &Control::default()).expect("it renders");
                first += 1;
            });
        });
    }
}

criterion_group!(benches, closest_hit, samples);
criterion_main!(benches);
