//! The measurements.

use std::time::Instant;

use serde::Serialize;
use zrak::{Control, RenderOptions};

use super::{BenchArgs, BenchBackend};
use crate::args::Block;
use crate::failure::Failure;
use crate::overrides::Overrides;
use crate::terminal;
use crate::text::{count, duration, mega_per_s};

/// All that was measured.
#[derive(Default, Serialize)]
pub(super) struct Results {
    /// Backends over sizes.
    pub(super) points: Vec<Point>,
    /// Block shapes at the largest size.
    pub(super) blocks: Vec<Point>,
    /// What was left out and why.
    pub(super) skipped: Vec<String>,
    /// Why measuring ended early.
    #[serde(skip)]
    pub(super) failure: Option<Failure>,
}

/// The run of median total time.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub(super) backend: BenchBackend,
    pub(super) width: u32,
    pub(super) height: u32,
    /// On the GPU.
    pub(super) block: Option<[u32; 2]>,
    pub(super) build_s: f64,
    pub(super) compile_s: f64,
    pub(super) upload_s: f64,
    pub(super) render_s: f64,
    pub(super) download_s: f64,
    /// From start to finish.
    pub(super) total_s: f64,
    pub(super) msamples_per_s: f64,
    pub(super) rays: u64,
    pub(super) mrays_per_s: f64,
}

impl Point {
    pub(super) fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    fn n_pixels(&self) -> f64 {
        f64::from(self.width) * f64::from(self.height)
    }
}

/// What a point changes in the scene.
pub(super) fn overrides(args: &BenchArgs, [width, height]: [u32; 2]) -> Overrides {
    let (width, height, spp) = (Some(width), Some(height), Some(args.spp));
    Overrides { width, height, spp, ..Overrides::default() }
}

/// Measures all points, until it is stopped or a backend fails.
pub(super) fn measure(args: &BenchArgs, backends: &[BenchBackend], control: &Control) -> Results {
    let mut results = Results::default();
    let block = Block::default();
    for &size in &args.resolutions {
        for &backend in backends {
            let estimate = estimate_s(&results.points, backend, size);
            if estimate.is_some_and(|seconds| seconds > args.max_time) {
                skip(&mut results, backend, size, estimate.unwrap_or_default());
                continue;
            }
            match median(args, backend, block, size, control) {
                Ok(Some(point)) => results.points.push(point),
                Ok(None) => return results,
                Err(failure) => return Results { failure: Some(failure), ..results },
            }
        }
    }
    // The largest picture that the GPU rendered.
    let largest = results
        .points
        .iter()
        .filter(|point| point.backend == BenchBackend::Cuda)
        .max_by(|a, b| a.n_pixels().total_cmp(&b.n_pixels()))
        .map(Point::size);
    let Some(size) = largest else { return results };
    for &block in &args.blocks {
        match median(args, BenchBackend::Cuda, block, size, control) {
            Ok(Some(point)) => results.blocks.push(point),
            Ok(None) => return results,
            Err(failure) => return Results { failure: Some(failure), ..results },
        }
    }
    results
}

/// Time of a point by the last one of its backend: tracing is proportional to the number of pixels.
fn estimate_s(points: &[Point], backend: BenchBackend, [width, height]: [u32; 2]) -> Option<f64> {
    let last = points.iter().rfind(|point| point.backend == backend)?;
    let times_as_many = f64::from(width) * f64::from(height) / last.n_pixels();
    Some(last.total_s + last.render_s * (times_as_many - 1.0))
}

fn skip(results: &mut Results, backend: BenchBackend, [width, height]: [u32; 2], estimate_s: f64) {
    let line = format!(
        "{width}x{height} {} is left out: about {} a run, more than --max-time",
        backend.name(),
        duration(estimate_s)
    );
    terminal::note(&line);
    results.skipped.push(line);
}

/// The median of several runs; nothing if they were stopped.
fn median(
    args: &BenchArgs,
    backend: BenchBackend,
    block: Block,
    size: [u32; 2],
    control: &Control,
) -> Result<Option<Point>, Failure> {
    let mut runs = Vec::new();
    for _ in 0..args.runs {
        match run(args, backend, block, size, control)? {
            Some(point) => runs.push(point),
            None => return Ok(None),
        }
    }
    runs.sort_by(|a: &Point, b| a.total_s.total_cmp(&b.total_s));
    let point = runs.swap_remove((runs.len() - 1) / 2);
    let shape = point.block.map_or_else(String::new, |[x, y]| format!(", blocks of {x}x{y}"));
    terminal::note(&format!(
        "{}x{} {}{shape}: {} (median of {})",
        point.width,
        point.height,
        backend.name(),
        duration(point.total_s),
        count(args.runs as usize, "run")
    ));
    Ok(Some(point))
}

/// One run from start to finish.
fn run(
    args: &BenchArgs,
    backend: BenchBackend,
    block: Block,
    size: [u32; 2],
    control: &Control,
) -> Result<Option<Point>, Failure> {
    let options: RenderOptions = backend.options(args.device, block);
    let start = Instant::now();
    let mut scene = zrak::load_scene(&args.scene)?;
    overrides(args, size).apply(&mut scene.desc)?;
    let arena = scene.lower()?;
    let build_s = start.elapsed().as_secs_f64();
    let output = zrak::render(arena, args.spp, &options, control, &mut |_| {})?;
    let total_s = start.elapsed().as_secs_f64();
    if output.n_samples < args.spp {
        return Ok(None);
    }
    let [width, height] = size;
    let (n_rays, times) = (output.film.n_rays(), output.times);
    let n_samples = u64::from(width) * u64::from(height) * u64::from(args.spp);
    Ok(Some(Point {
        backend,
        width,
        height,
        block: (backend == BenchBackend::Cuda).then_some(block.0),
        build_s,
        compile_s: times.compile_s,
        upload_s: times.upload_s,
        render_s: times.render_s,
        download_s: times.download_s,
        total_s,
        msamples_per_s: mega_per_s(n_samples, times.render_s),
        rays: n_rays,
        mrays_per_s: mega_per_s(n_rays, times.render_s),
    }))
}

#[cfg(test)]
pub(super) fn made_up(backend: BenchBackend, side: u32, total_s: f64) -> Point {
    Point {
        backend,
        width: side,
        height: side,
        block: (backend == BenchBackend::Cuda).then_some([16, 16]),
        build_s: 0.1,
        compile_s: 0.0,
        upload_s: 0.0,
        render_s: total_s - 0.1,
        download_s: 0.0,
        total_s,
        msamples_per_s: 1.0,
        rays: 1000,
        mrays_per_s: 3.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_grow_with_the_pixels() {
        let points = [made_up(BenchBackend::Cpu1, 100, 2.0), made_up(BenchBackend::Cpu, 100, 1.0)];
        assert_eq!(estimate_s(&points, BenchBackend::Cpu1, [300, 200]), Some(11.5));
        assert_eq!(estimate_s(&points, BenchBackend::Cuda, [300, 200]), None);
    }
}
