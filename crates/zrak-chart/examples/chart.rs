//! Draws a chart of made-up numbers, to look at: `cargo run -p zrak-chart --example chart -- DIR`
//! writes `chart.svg`, `chart.png` and `chart-linear.png` to the folder DIR.

use std::path::PathBuf;

use zrak_chart::{Chart, Series};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_default());
    let series = |(idx, name): (usize, &str)| Series {
        name: name.to_owned(),
        points: (0..9)
            .map(|i| (f64::from(16 << i), 3.0 * 8f64.powi(idx as i32) / (1.0 + 0.5f64.powi(i - 2))))
            .collect(),
    };
    let names = ["1 thread", "16 threads, AVX2", "One H200", "Two H200"];
    let mut chart = Chart {
        title: "Throughput on the One Weekend cover (made-up numbers)".into(),
        x_label: "Samples per pixel".into(),
        y_label: "Throughput [Msamples/s]".into(),
        series: names.into_iter().enumerate().map(series).collect(),
        log_x: true,
        log_y: true,
    };
    chart.write_svg(&folder.join("chart.svg"))?;
    chart.write_png(&folder.join("chart.png"))?;
    (chart.log_x, chart.log_y) = (false, false);
    chart.write_png(&folder.join("chart-linear.png"))?;
    Ok(())
}
