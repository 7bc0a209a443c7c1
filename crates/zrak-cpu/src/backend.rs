//! Tiles over threads.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;
use zrak_core::accel::{Accel, BruteForce, Bvh2, Bvh8};
use zrak_core::accessor::Array;
use zrak_core::scene::{PrimKind, PrimRef};
use zrak_render::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, Region, SampleRange, Times,
};
use zrak_scene::arena::SceneArena;

use crate::tile::{Simd, render_tile};

/// Pixels along the side of a tile: small enough to share out evenly, large enough to be worth it.
const TILE_SIZE: u32 = 16;
/// How long a pass should take. What is between passes, done by one thread, must not count beside it;
/// stopping is prompt all the same, but loses the pass under way.
const PASS_S: f64 = 1.0;
/// Most threads that make sense to ask for.
const MAX_THREADS: usize = 4096;

/// How the closest hit is found. The picture is the same; only the time differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tree {
    /// Eight-wide tree.
    #[default]
    Wide,
    /// Binary tree, as on the GPU.
    Binary,
    /// Every primitive is tested.
    BruteForce,
}

/// Renders on the processor.
pub struct CpuBackend {
    scene: Arc<SceneArena>,
    pool: Option<rayon::ThreadPool>,
    n_threads: usize,
    tree: Tree,
    simd: Simd,
    prims: Vec<PrimRef>,
    render_s: f64,
    /// Measured speed, in samples of single pixels per second.
    samples_per_s: Option<f64>,
}

impl CpuBackend {
    /// Backend for a scene on this many threads; all cores for `None`. One thread is the calling one.
    ///
    /// # Errors
    /// If the number of threads is 0 or absurd, or they cannot be started.
    pub fn new(
        scene: Arc<SceneArena>,
        n_threads: Option<usize>,
        tree: Tree,
    ) -> Result<Self, BackendError> {
        let n_threads = match n_threads {
            Some(n) => n,
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };
        if n_threads == 0 || n_threads > MAX_THREADS {
            return Err(BackendError::new(
                BackendErrorKind::InvalidOption,
                format!("{n_threads} threads: choose from 1 to {MAX_THREADS}"),
            ));
        }
        let pool = if n_threads == 1 {
            None
        } else {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build();
            Some(pool.map_err(|e| {
                let message = format!("cannot start {n_threads} threads: {e}");
                BackendError::new(BackendErrorKind::Failed, message)
            })?)
        };
        let prims = match tree {
            Tree::BruteForce => leaves(&scene),
            Tree::Wide | Tree::Binary => Vec::new(),
        };
        let simd = Simd::detect();
        let samples_per_s = None;
        Ok(Self { scene, pool, n_threads, tree, simd, prims, render_s: 0.0, samples_per_s })
    }

    fn pass(
        &self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
        accel: impl Accel + Send + Sync,
    ) -> bool {
        let scene = self.scene.view();
        let tiles: Vec<Region> = film.region.tiles(TILE_SIZE).collect();
        let film = Mutex::new(film);
        let render = |tile: &Region| {
            if control.is_stopped() {
                return;
            }
            let pixels = render_tile(self.simd, &scene, accel, *tile, samples);
            control.count_samples(tile.n_pixels() as u64 * u64::from(samples.count));
            // Held for the copy of one tile only.
            let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
            film.merge(&Film { region: *tile, pixels });
        };
        match &self.pool {
            Some(pool) => pool.install(|| tiles.par_iter().with_max_len(1).for_each(render)),
            None => tiles.iter().for_each(render),
        }
        !control.is_stopped()
    }
}

/// All primitives of the world's tree.
fn leaves(scene: &SceneArena) -> Vec<PrimRef> {
    let nodes = scene.view().nodes2;
    let mut leaves = Vec::new();
    let mut links = vec![PrimRef::new(PrimKind::Node, 0)];
    while let Some(link) = links.pop() {
        if link.is_node() {
            let children = nodes.get(link.index()).children;
            links.extend(children.into_iter().filter(|child| *child != PrimRef::NONE));
        } else {
            leaves.push(link);
        }
    }
    leaves
}

impl Backend for CpuBackend {
    fn info(&self) -> BackendInfo {
        let threads = if self.n_threads == 1 { "thread" } else { "threads" };
        let device = format!("{} {threads}, {}", self.n_threads, self.simd.name());
        BackendInfo { name: "cpu", device }
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        let n_pixels = film.region.n_pixels() as f64;
        let count = match self.samples_per_s {
            Some(speed) => (speed * PASS_S / n_pixels).clamp(1.0, f64::from(samples.count)) as u32,
            None => 1,
        };
        let samples = SampleRange { first: samples.first, count };
        let start = Instant::now();
        let view = self.scene.view();
        let complete = match self.tree {
            Tree::Wide => self.pass(film, samples, control, Bvh8 { nodes: view.nodes8 }),
            Tree::Binary => self.pass(film, samples, control, Bvh2 { nodes: view.nodes2 }),
            Tree::BruteForce => {
                let prims = Array::new(&self.prims);
                self.pass(film, samples, control, BruteForce { prims })
            }
        };
        let time_s = start.elapsed().as_secs_f64();
        self.render_s += time_s;
        self.samples_per_s = Some(n_pixels * f64::from(count) / time_s.max(1e-9));
        Ok(if complete { count } else { 0 })
    }

    fn times(&self) -> Times {
        Times { render_s: self.render_s, ..Times::default() }
    }
}
