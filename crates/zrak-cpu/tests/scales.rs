//! The size of a scene and its place do not matter: the Cornell box is as bright as a pea as it is as
//! a mountain.

mod common;

use std::sync::Arc;

use common::scenes::placed;
use common::{arena, mean_and_error, render_part, whole};
use zrak_cpu::{CpuBackend, Tree};
use zrak_render::SampleRange;
use zrak_scene::builtin;
use zrak_scene::desc::{ColorDesc, MaterialDesc, SceneDesc};

/// Mean of all channels of the picture, and its standard error.
fn brightness(desc: &SceneDesc) -> (f64, f64) {
    let scene = arena(desc);
    let mut backend = CpuBackend::new(Arc::clone(&scene), None, Tree::Wide).unwrap();
    let batches: Vec<f64> = (0..24)
        .map(|batch| {
            let samples = SampleRange { first: batch * 4, count: 4 };
            let film = render_part(&mut backend, whole(&scene), samples);
            let sums = film.pixels.iter().flat_map(|p| p.mean().to_array().map(f64::from));
            sums.sum::<f64>() / (3 * film.pixels.len()) as f64
        })
        .collect();
    mean_and_error(&batches)
}

fn check(name: &str) {
    let mut desc = (builtin::find(name).unwrap().build)();
    (desc.camera.width, desc.camera.height) = (48, 48);
    // A larger light, for less noise.
    for material in desc.materials.values_mut() {
        if let MaterialDesc::DiffuseLight { color: ColorDesc::Solid(color), .. } = material {
            *color = [4.0; 3];
        }
    }
    desc.background = zrak_scene::desc::BackgroundDesc::Constant { color: [0.5; 3] };
    let mut results = Vec::new();
    // The box is 555 wide.
    for (i, size) in [1e-3, 1.0, 1e3, 1e5].into_iter().enumerate() {
        for away in [0.0, 20.0] {
            let size = size / 555.0;
            let shift = [away * 555.0 * size, -away * 200.0 * size, away * 300.0 * size];
            let mut desc = placed(desc.clone(), size, shift);
            desc.render.seed = i as u64 * 2 + u64::from(away > 0.0);
            results.push((size, away, brightness(&desc)));
        }
    }
    let (_, _, (mean, error)) = results[2];
    for (size, away, (other_mean, other_error)) in &results {
        let z = (other_mean - mean) / error.hypot(*other_error);
        assert!(z.abs() < 4.0, "{name} of size {size}, {away} away: z = {z}, {results:?}");
        assert!(*other_error < 0.01 * mean, "too noisy to tell: {results:?}");
    }
}

#[test]
fn cornell_box() {
    check("cornell-box");
}

#[test]
fn cornell_smoke() {
    check("cornell-smoke");
}
