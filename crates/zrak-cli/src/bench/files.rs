//! The measurements for other programs: bench.csv and bench.json.

use std::fmt::Write;
use std::path::Path;

use serde::Serialize;
use zrak::image::{Error, replace_file};

use super::Setup;
use super::measure::Results;

#[derive(Serialize)]
struct Json<'a> {
    setup: &'a Setup,
    #[serde(flatten)]
    results: &'a Results,
}

/// Everything in one line of JSON.
pub(super) fn json(setup: &Setup, results: &Results) -> String {
    // Numbers and text with names that are text: this cannot fail.
    serde_json::to_string(&Json { setup, results }).unwrap_or_default()
}

/// Writes bench.csv and bench.json.
pub(super) fn write(dir: &Path, setup: &Setup, results: &Results) -> Result<(), Error> {
    replace_file(&dir.join("bench.csv"), csv(setup, results).as_bytes())?;
    replace_file(&dir.join("bench.json"), (json(setup, results) + "\n").as_bytes())
}

/// A line for each point; times in seconds.
fn csv(setup: &Setup, results: &Results) -> String {
    let mut out = "scene,backend,block,width,height,spp,runs,build_s,compile_s,upload_s,render_s,\
                   download_s,total_s,msamples_per_s,rays,mrays_per_s\n"
        .to_owned();
    let scene = format!("\"{}\"", setup.scene.replace('"', "\"\""));
    for point in results.points.iter().chain(&results.blocks) {
        let block = point.block.map_or_else(String::new, |[x, y]| format!("{x}x{y}"));
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{scene},{},{block},{},{},{},{},{:.6},{:.6},{:.6},{:.6},{:.6},{:.6},{:.6},{},{:.6}",
            point.backend.name(),
            point.width,
            point.height,
            setup.spp,
            setup.runs,
            point.build_s,
            point.compile_s,
            point.upload_s,
            point.render_s,
            point.download_s,
            point.total_s,
            point.msamples_per_s,
            point.rays,
            point.mrays_per_s
        );
    }
    out
}
