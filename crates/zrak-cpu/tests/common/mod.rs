//! What the tests of whole renders share.

// Each test program uses a part of it.
#![allow(dead_code, unreachable_pub)]

pub mod scenes;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use zrak_cpu::{CpuBackend, Tree};
use zrak_render::{Backend, Control, Film, Region, SampleRange};
use zrak_scene::arena::SceneArena;
use zrak_scene::desc::SceneDesc;
use zrak_scene::lower::{LowerOptions, lower};

/// Root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The scene, ready to render.
pub fn arena(desc: &SceneDesc) -> Arc<SceneArena> {
    arena_in(desc, &root())
}

/// The scene, ready to render, with the files that it names in a folder.
pub fn arena_in(desc: &SceneDesc, folder: &Path) -> Arc<SceneArena> {
    match lower(desc, &LowerOptions::new(folder)) {
        Ok(arena) => Arc::new(arena),
        Err(problems) => panic!("{problems:?}"),
    }
}

/// The whole picture.
pub fn whole(scene: &SceneArena) -> Region {
    let camera = &scene.globals().camera;
    Region::whole(camera.width, camera.height)
}

/// Renders samples of a region, in as many passes as the backend likes.
pub fn render_part(backend: &mut CpuBackend, region: Region, samples: SampleRange) -> Film {
    let mut all = Film::new(region);
    let mut done = 0;
    while done < samples.count {
        let mut pass = Film::new(region);
        let rest = SampleRange { first: samples.first + done, count: samples.count - done };
        let n = backend.render(&mut pass, rest, &Control::default()).unwrap();
        assert!(n >= 1 && n <= rest.count, "{n} of {rest:?}");
        all.merge(&pass);
        done += n;
    }
    all
}

/// Renders samples 0 to `n_samples` of the whole picture.
pub fn render(scene: &Arc<SceneArena>, n_threads: usize, tree: Tree, n_samples: u32) -> Film {
    let mut backend = CpuBackend::new(Arc::clone(scene), Some(n_threads), tree).unwrap();
    let samples = SampleRange { first: 0, count: n_samples };
    render_part(&mut backend, whole(scene), samples)
}

/// A file of the repository as an array of `f32`, from NumPy's format: version 1, little-endian, C order.
pub fn read_npy(path: &str, shape: [usize; 3]) -> Vec<f32> {
    let bytes = std::fs::read(root().join(path)).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00", "{path}");
    let data = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..data]).unwrap();
    let [h, w, c] = shape;
    for part in ["'<f4'".to_owned(), "False".to_owned(), format!("({h}, {w}, {c})")] {
        assert!(header.contains(&part), "{path}: no {part} in {header}");
    }
    let values: Vec<f32> =
        bytes[data..].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(values.len(), h * w * c, "{path}");
    values
}

/// Mean and standard error of the mean of independent values.
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}
