//! What a render took: a summary for people, a line of JSON for scripts.

use std::path::PathBuf;

use serde::Serialize;
use zrak::{RenderOptions, RenderOutput, Scene};

use super::RenderArgs;
use crate::failure::Failure;
use crate::terminal;
use crate::text::{Align, count, duration, mega_per_s, number, table};

/// A finished or stopped render and its times from the start of the process.
pub(super) struct Report<'a> {
    pub(super) scene: &'a Scene,
    pub(super) output: &'a RenderOutput,
    pub(super) options: &'a RenderOptions,
    /// Reading and lowering the scene, from the start of the process.
    pub(super) build_s: f64,
    /// Encoding and writing.
    pub(super) write_s: f64,
    pub(super) total_s: f64,
    /// What was written.
    pub(super) outputs: &'a [PathBuf],
}

/// The line of JSON.
#[derive(Serialize)]
struct Json<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    /// Samples per pixel of the picture.
    spp: u32,
    /// Samples per pixel that were asked for.
    spp_requested: u32,
    complete: bool,
    seed: u64,
    max_depth: u32,
    backend: &'a str,
    device: &'a str,
    /// Of the processor; none when the GPU rendered.
    threads: Option<usize>,
    gpu_failure: Option<&'a str>,
    times: Times,
    samples: u64,
    msamples_per_s: f64,
    rays: u64,
    mrays_per_s: f64,
    outputs: Vec<String>,
    version: &'a str,
}

/// In seconds.
#[derive(Serialize)]
struct Times {
    build_s: f64,
    compile_s: f64,
    upload_s: f64,
    render_s: f64,
    download_s: f64,
    write_s: f64,
    /// From the start of the process to the first picture.
    first_picture_s: Option<f64>,
    /// From the start of the process.
    total_s: f64,
}

impl Report<'_> {
    /// Shows it the way that was asked for.
    pub(super) fn show(&self, args: &RenderArgs) -> Result<(), Failure> {
        if args.json {
            return terminal::print_json(&self.json());
        }
        if !args.quiet && self.output.n_samples > 0 {
            terminal::note(self.summary().trim_end());
        }
        Ok(())
    }

    /// What to say after Ctrl-C.
    pub(super) fn interrupted(&self) -> String {
        match self.output.n_samples {
            0 => "interrupted before the first pass was finished: nothing was written".to_owned(),
            n => {
                let asked = self.scene.desc.render.samples_per_pixel;
                format!("interrupted: the picture has {n} of {asked} samples per pixel")
            }
        }
    }

    fn n_samples(&self) -> u64 {
        u64::from(self.output.n_samples) * self.output.film.region.n_pixels() as u64
    }

    fn json(&self) -> Json<'_> {
        let (desc, output) = (&self.scene.desc, self.output);
        let (n_rays, render_s) = (output.film.n_rays(), output.times.render_s);
        let is_cpu = output.backend.name == "cpu";
        Json {
            scene: &desc.name,
            width: desc.camera.width,
            height: desc.camera.height,
            spp: output.n_samples,
            spp_requested: desc.render.samples_per_pixel,
            complete: output.n_samples == desc.render.samples_per_pixel,
            seed: desc.render.seed,
            max_depth: desc.render.max_depth,
            backend: output.backend.name,
            device: &output.backend.device,
            threads: is_cpu.then(|| zrak::n_threads(self.options.threads)),
            gpu_failure: output.gpu_failure.as_deref(),
            times: Times {
                build_s: self.build_s,
                compile_s: output.times.compile_s,
                upload_s: output.times.upload_s,
                render_s,
                download_s: output.times.download_s,
                write_s: self.write_s,
                first_picture_s: output.first_pass_s.map(|s| self.build_s + s),
                total_s: self.total_s,
            },
            samples: self.n_samples(),
            msamples_per_s: mega_per_s(self.n_samples(), render_s),
            rays: n_rays,
            mrays_per_s: mega_per_s(n_rays, render_s),
            outputs: self.outputs.iter().map(|path| path.display().to_string()).collect(),
            version: zrak::VERSION,
        }
    }

    fn summary(&self) -> String {
        let (desc, output) = (&self.scene.desc, self.output);
        let times = output.times;
        let speed = format!(
            "{} Msamples/s, {} Mrays/s",
            number(mega_per_s(self.n_samples(), times.render_s)),
            number(mega_per_s(output.film.n_rays(), times.render_s))
        );
        let first = output.first_pass_s.map_or_else(String::new, |s| {
            format!("first picture after {}", duration(self.build_s + s))
        });
        let lines = [
            ("build", self.build_s, "reading the scene, building its tree".to_owned()),
            ("compile", times.compile_s, String::new()),
            ("upload", times.upload_s, String::new()),
            ("render", times.render_s, speed),
            ("download", times.download_s, String::new()),
            ("write", self.write_s, String::new()),
            ("total", self.total_s, first),
        ];
        let rows: Vec<Vec<String>> = lines
            .into_iter()
            // What a backend does not do is not worth a line.
            .filter(|(_, seconds, _)| *seconds > 0.0)
            .map(|(name, seconds, remark)| vec![format!("  {name}"), duration(seconds), remark])
            .collect();
        let mut out = format!(
            "{}: {}x{} pixels, {} per pixel, on {}\n",
            desc.name,
            desc.camera.width,
            desc.camera.height,
            count(output.n_samples as usize, "sample"),
            output.backend.device
        );
        out += &table(&[Align::Left, Align::Right, Align::Left], &rows);
        for path in self.outputs {
            out += &format!("wrote {}\n", path.display());
        }
        out
    }
}
