//! Line charts of benchmark results, as SVG and as PNG, from one [`Chart`].
//!
//! The drawing is `kuva`'s: pure Rust, with its own DejaVu Sans for the PNG, so that a chart
//! looks the same on a machine without fonts. It is a crate apart from zrak-image because of that
//! dependency's size; nothing that renders needs it.

#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Arc;

use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LegendEntry, LegendPosition, LegendShape};
use kuva::prelude::{Layout, LinePlot, Plot, ScatterPlot, TickFormat};
use zrak_image::{Error, ErrorKind, replace_file};

/// A chart of lines with markers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// What the chart shows, above it.
    pub title: String,
    /// The quantity along x, with its unit.
    pub x_label: String,
    /// The quantity along y, with its unit.
    pub y_label: String,
    /// The lines, in the order of the legend.
    pub series: Vec<Series>,
    /// Whether the x axis is logarithmic; then every x has to be positive.
    pub log_x: bool,
    /// Whether the y axis is logarithmic; then every y has to be positive.
    pub log_y: bool,
}

/// One line of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points (x, y), joined in the given order.
    pub points: Vec<(f64, f64)>,
}

/// Size of the drawing, in the pixels of the SVG.
const WIDTH_PX: f64 = 960.0;
const HEIGHT_PX: f64 = 560.0;
/// PNG pixels per SVG pixel, for dense screens and print.
const PNG_SCALE: f32 = 2.0;

/// The colours of Okabe and Ito (2008), told apart with any kind of colour vision; without their
/// yellow, which is too pale for a line on white.
const COLOURS: [&str; 7] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
/// As many markers as are told apart at a glance, and prime to the number of colours: series
/// share both only after 35.
const MARKERS: [MarkerShape; 5] = [
    MarkerShape::Circle,
    MarkerShape::Square,
    MarkerShape::Triangle,
    MarkerShape::Diamond,
    MarkerShape::TriangleDown,
];

impl Chart {
    /// Writes the chart as an SVG, replacing the file whole or not at all.
    pub fn write_svg(&self, path: &Path) -> Result<(), Error> {
        self.check(path)?;
        let (plots, layout) = self.draw();
        replace_file(path, without_counter(&kuva::render_to_svg(plots, layout)).as_bytes())
    }

    /// Writes the chart as a PNG of twice the SVG's pixels, replacing the file whole or not at
    /// all.
    pub fn write_png(&self, path: &Path) -> Result<(), Error> {
        self.check(path)?;
        let (plots, layout) = self.draw();
        let png = kuva::render_to_raster(plots, layout, PNG_SCALE)
            .map_err(|cause| self.cannot_draw(path, &cause))?;
        replace_file(path, &png)
    }

    /// Fails for points that have no place on the axes.
    fn check(&self, path: &Path) -> Result<(), Error> {
        if self.series.iter().all(|series| series.points.is_empty()) {
            return Err(self.cannot_draw(path, "it has no points; give it a measurement"));
        }
        for series in &self.series {
            for &(x, y) in &series.points {
                let point = format!("point ({x}, {y}) of '{}'", series.name);
                if !x.is_finite() || !y.is_finite() {
                    return Err(self.cannot_draw(path, &format!("{point} is not finite")));
                }
                if (self.log_x && x <= 0.0) || (self.log_y && y <= 0.0) {
                    let cause = format!("{point} has no place on a logarithmic axis");
                    return Err(self.cannot_draw(path, &cause));
                }
            }
        }
        Ok(())
    }

    fn cannot_draw(&self, path: &Path, cause: &str) -> Error {
        Error::new(
            ErrorKind::InvalidInput,
            format!("cannot draw the chart '{}' to '{}': {cause}", self.title, path.display()),
        )
    }

    fn draw(&self) -> (Vec<Plot>, Layout) {
        let mut plots: Vec<Plot> = Vec::new();
        let mut legend = Vec::new();
        for (series_idx, series) in self.series.iter().enumerate() {
            let colour = COLOURS[series_idx % COLOURS.len()];
            let marker = MARKERS[series_idx % MARKERS.len()];
            let points = || series.points.iter().copied();
            let line =
                LinePlot::new().with_data(points()).with_color(colour).with_stroke_width(2.0);
            let markers =
                ScatterPlot::new().with_data(points()).with_color(colour).with_marker(marker);
            plots.push(line.into());
            plots.push(markers.with_size(4.5).into());
            legend.push(LegendEntry {
                label: series.name.clone(),
                color: colour.to_owned(),
                shape: LegendShape::Marker(marker),
                dasharray: None,
            });
        }
        let mut layout = Layout::auto_from_plots(&plots)
            .with_width(WIDTH_PX)
            .with_height(HEIGHT_PX)
            .with_title(self.title.as_str())
            .with_x_label(self.x_label.as_str())
            .with_y_label(self.y_label.as_str())
            .with_legend_entries(legend)
            .with_legend_position(LegendPosition::OutsideRightTop)
            .with_tick_format(TickFormat::Custom(Arc::new(tick_label)));
        if self.log_x {
            layout = layout.with_log_x();
        }
        if self.log_y {
            layout = layout.with_log_y();
        }
        (plots, layout)
    }
}

/// A tick's value in plain digits, or in powers of ten where those would be too many.
fn tick_label(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude != 0.0 && !(1e-4..1e7).contains(&magnitude) {
        return format!("{value:e}");
    }
    // Ten decimals hide the rounding of sums such as 0.1 + 0.2.
    let text = format!("{value:.10}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The SVG with kuva's count of the charts drawn so far taken out of its ids, so that a chart is
/// the same file each time.
fn without_counter(svg: &str) -> String {
    const ID: &str = "kuva-clip-";
    let mut parts = svg.split(ID);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text += "plot-area";
        text += part.trim_start_matches(|c: char| c.is_ascii_digit());
    }
    text
}
