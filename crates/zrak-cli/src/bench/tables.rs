//! The measurements for people.

use std::fmt::Write;

use super::measure::{Point, Results};
use super::{BenchBackend, Setup};
use crate::text::{Align, count, duration, number, table};

/// All tables.
pub(super) fn tables(setup: &Setup, backends: &[BenchBackend], results: &Results) -> String {
    let Setup { scene, spp, runs, cpu, .. } = setup;
    let runs = count(*runs as usize, "run");
    let mut out = format!("\n{scene}, {spp} spp, median of {runs}, on {cpu}");
    if let Some(gpu) = setup.gpu.as_ref().filter(|_| backends.contains(&BenchBackend::Cuda)) {
        // Writing to a string cannot fail.
        let _ = write!(out, " and {gpu}");
    }
    out += "\n\nTotal time from start to finish, and how much faster than one thread:\n\n";
    out += &totals(backends, &results.points);
    if !results.blocks.is_empty() {
        let [width, height] = results.blocks[0].size();
        let _ = write!(out, "\nBlock shapes on the GPU at {width}x{height}:\n\n");
        out += &blocks(&results.blocks);
    }
    out
}

fn totals(backends: &[BenchBackend], points: &[Point]) -> String {
    let mut title = vec!["size".to_owned()];
    for backend in backends {
        title.push(backend.title());
        if *backend != BenchBackend::Cpu1 {
            title.push(String::new());
        }
        title.push("Msamples/s".to_owned());
    }
    let mut sizes: Vec<[u32; 2]> = points.iter().map(Point::size).collect();
    sizes.dedup();
    let mut rows = vec![title];
    for size in sizes {
        let mut row = vec![format!("{}x{}", size[0], size[1])];
        for &backend in backends {
            let point = find(points, backend, size);
            row.push(point.map_or("-".to_owned(), |point| duration(point.total_s)));
            if backend != BenchBackend::Cpu1 {
                let speedup = speedup(points, backend, size);
                row.push(speedup.map_or(String::new(), |factor| format!("x {}", number(factor))));
            }
            row.push(point.map_or("-".to_owned(), |point| number(point.msamples_per_s)));
        }
        rows.push(row);
    }
    let aligns = vec![Align::Right; rows[0].len()];
    table(&aligns, &rows)
}

fn blocks(points: &[Point]) -> String {
    let title = ["block", "threads", "total", "render", "Msamples/s", "Mrays/s"];
    let row = |point: &Point| {
        let [x, y] = point.block.unwrap_or_default();
        vec![
            format!("{x}x{y}"),
            (x * y).to_string(),
            duration(point.total_s),
            duration(point.render_s),
            number(point.msamples_per_s),
            number(point.mrays_per_s),
        ]
    };
    let title = title.map(str::to_owned).to_vec();
    let rows: Vec<_> = std::iter::once(title).chain(points.iter().map(row)).collect();
    table(&[Align::Right; 6], &rows)
}

/// The point of a backend and size.
pub(super) fn find(points: &[Point], backend: BenchBackend, size: [u32; 2]) -> Option<&Point> {
    points.iter().find(|point| point.backend == backend && point.size() == size)
}

/// How much faster than one thread a backend is, if both were measured.
pub(super) fn speedup(points: &[Point], backend: BenchBackend, size: [u32; 2]) -> Option<f64> {
    let one_thread = find(points, BenchBackend::Cpu1, size)?;
    Some(one_thread.total_s / find(points, backend, size)?.total_s)
}
