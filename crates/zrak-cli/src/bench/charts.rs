//! The measurements as charts: times and speed-ups over the size of the picture.

use std::path::Path;

use zrak::image::Error;
use zrak_chart::{Chart, Series};

use super::measure::{Point, Results};
use super::tables::speedup;
use super::{BenchBackend, Setup};
use crate::terminal;

/// Writes time.svg, time.png, speedup.svg and speedup.png.
pub(super) fn write(
    dir: &Path,
    setup: &Setup,
    backends: &[BenchBackend],
    results: &Results,
) -> Result<(), Error> {
    let points = &results.points;
    let times = chart(setup, "Total time", "Time from start to finish [s]", points);
    draw(times, dir, "time", backends, points, |point| Some(point.total_s))?;
    let others: Vec<_> =
        backends.iter().copied().filter(|backend| *backend != BenchBackend::Cpu1).collect();
    let speedups = chart(setup, "Speed-up", "Times as fast as one thread", points);
    let factor = |point: &Point| speedup(points, point.backend, point.size());
    draw(speedups, dir, "speedup", &others, points, factor)
}

/// A chart without lines.
fn chart(setup: &Setup, what: &str, y_label: &str, points: &[Point]) -> Chart {
    let x_label = if are_square(points) { "Width and height [pixels]" } else { "Pixels" };
    Chart {
        title: format!("{what}: {}, {} samples per pixel", setup.scene, setup.spp),
        x_label: x_label.to_owned(),
        y_label: y_label.to_owned(),
        series: Vec::new(),
        log_x: true,
        log_y: true,
    }
}

/// Draws a value of the points of each backend, if there are any.
fn draw(
    mut chart: Chart,
    dir: &Path,
    name: &str,
    backends: &[BenchBackend],
    points: &[Point],
    value: impl Fn(&Point) -> Option<f64>,
) -> Result<(), Error> {
    let are_square = are_square(points);
    let x = |point: &Point| {
        let [width, height] = point.size().map(f64::from);
        if are_square { width } else { width * height }
    };
    for backend in backends {
        let of_backend = points.iter().filter(|point| point.backend == *backend);
        let mut points: Vec<_> =
            of_backend.filter_map(|point| Some((x(point), value(point)?))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if !points.is_empty() {
            chart.series.push(Series { name: backend.title(), points });
        }
    }
    if chart.series.is_empty() {
        terminal::note(&format!("{name}.svg and {name}.png are left out: nothing to draw"));
        return Ok(());
    }
    chart.write_svg(&dir.join(format!("{name}.svg")))?;
    chart.write_png(&dir.join(format!("{name}.png")))
}

fn are_square(points: &[Point]) -> bool {
    points.iter().all(|point| point.width == point.height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::measure::made_up;

    #[test]
    fn speedups_are_drawn_only_where_one_thread_was_measured() {
        let points = vec![
            made_up(BenchBackend::Cpu1, 100, 2.0),
            made_up(BenchBackend::Cpu, 100, 1.0),
            made_up(BenchBackend::Cpu, 200, 4.0),
        ];
        assert_eq!(speedup(&points, BenchBackend::Cpu, [100, 100]), Some(2.0));
        assert_eq!(speedup(&points, BenchBackend::Cpu, [200, 200]), None);
    }
}
