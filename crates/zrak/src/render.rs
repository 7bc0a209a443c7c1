//! Rendering on the backend of choice, and on the processor if the GPU fails.

use std::sync::Arc;
use std::time::Instant;

use zrak_image::Metadata;
use zrak_render::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, Region, Rendered,
    SampleRange, Times,
};
use zrak_scene::arena::SceneArena;
use zrak_scene::desc::SceneDesc;

use crate::backends::{Kind, open};
use crate::{BackendChoice, Error, RenderOptions, memory};

/// A finished or stopped render.
#[derive(Clone, Debug)]
pub struct RenderOutput {
    /// The sums of the samples, the same on every backend.
    pub film: Film,
    /// Samples of each pixel: fewer than were asked for if the render was stopped.
    pub n_samples: u32,
    /// What it was rendered on; the last, if one failed on the way.
    pub backend: BackendInfo,
    /// Where the time went; of all backends, if one failed on the way.
    pub times: Times,
    /// From the call to the end of the first pass, when there is a picture; in seconds.
    pub first_pass_s: Option<f64>,
    /// From the call to the end, in seconds.
    pub total_s: f64,
    /// Why the GPU gave up on the way, in the driver's words, if others went on for it.
    pub gpu_failure: Option<String>,
}

impl RenderOutput {
    /// What a picture file should say of this render of a scene.
    #[must_use]
    pub fn metadata(&self, desc: &SceneDesc) -> Metadata {
        Metadata {
            scene: desc.name.clone(),
            seed: desc.render.seed,
            samples_per_pixel: self.n_samples,
            backend: self.backend.name.to_owned(),
            device: self.backend.device.clone(),
            version: crate::VERSION.to_owned(),
            render_time_s: self.total_s,
        }
    }
}

/// Renders `n_samples` samples of each pixel of a scene, or fewer if `control` is stopped.
///
/// `notices` gets lines for a person: what is rendered on and why, and what failed on the way. With
/// [`BackendChoice::Auto`], a GPU that cannot be had or that fails is replaced by the processor,
/// which goes on from the last finished pass.
///
/// # Errors
/// If the picture does not fit the memory, or the backend cannot start or go on; then
/// [`Error::finished`] has the passes that were finished.
pub fn render(
    arena: Arc<SceneArena>,
    n_samples: u32,
    options: &RenderOptions,
    control: &Control,
    notices: &mut dyn FnMut(&str),
) -> Result<RenderOutput, Error> {
    let camera = arena.globals().camera;
    memory::check(camera.width, camera.height)?;
    let region = Region::whole(camera.width, camera.height);
    let open = |kind| open(kind, Arc::clone(&arena), options);
    render_with(open, region, n_samples, options.backend, control, notices)
}

/// [`render`] on backends that come from anywhere.
fn render_with(
    open: impl Fn(Kind) -> Result<Box<dyn Backend + Send>, BackendError>,
    region: Region,
    n_samples: u32,
    choice: BackendChoice,
    control: &Control,
    notices: &mut dyn FnMut(&str),
) -> Result<RenderOutput, Error> {
    let start = Instant::now();
    let first = match choice {
        BackendChoice::Cpu => open(Kind::Cpu)?,
        BackendChoice::Cuda => open(Kind::Cuda)?,
        BackendChoice::Hybrid => open(Kind::Hybrid)?,
        BackendChoice::Auto => match open(Kind::Cuda) {
            // Asking for what no device can do is a mistake, not a missing GPU.
            Err(error) if error.kind() == BackendErrorKind::InvalidOption => {
                return Err(error.into());
            }
            Err(error) => {
                let cpu = open(Kind::Cpu)?;
                notices(&format!("no GPU: {error}; rendering on {}", cpu.info().device));
                return Run::new(cpu, start).finish(empty(region), n_samples, control);
            }
            Ok(gpu) => gpu,
        },
    };
    notices(&format!("rendering on {}", first.info().device));
    let is_cpu = first.info().name == "cpu";
    let mut run = Run::new(first, start);
    let interrupted = match zrak_render::render(&mut run, empty(region), n_samples, control) {
        Ok(rendered) => return Ok(run.output(rendered)),
        Err(interrupted) => *interrupted,
    };
    if is_cpu || choice != BackendChoice::Auto {
        let finished = run.output(interrupted.finished);
        return Err(Error::from(interrupted.error).with_finished(finished));
    }

    // The GPU failed: the processor goes on from the last finished pass.
    let cpu = match open(Kind::Cpu) {
        Ok(cpu) => cpu,
        Err(error) => {
            return Err(Error::from(error).with_finished(run.output(interrupted.finished)));
        }
    };
    let (why, n_done) = (interrupted.error, interrupted.finished.n_samples);
    notices(&format!(
        "the GPU failed after {n_done} of {n_samples} samples per pixel: {why}; going on on {}",
        cpu.info().device
    ));
    let before = run.times();
    let next = Run { backend: cpu, gpu_failure: Some(why.to_string()), before, ..run };
    next.finish(interrupted.finished, n_samples, control)
}

fn empty(region: Region) -> Rendered {
    Rendered { film: Film::new(region), n_samples: 0 }
}

/// A backend whose passes are watched.
struct Run {
    backend: Box<dyn Backend + Send>,
    start: Instant,
    first_pass_s: Option<f64>,
    /// Times of a backend that failed before.
    before: Times,
    gpu_failure: Option<String>,
}

impl Run {
    fn new(backend: Box<dyn Backend + Send>, start: Instant) -> Self {
        Self { backend, start, first_pass_s: None, before: Times::default(), gpu_failure: None }
    }

    /// Renders what is missing.
    fn finish(
        mut self,
        done: Rendered,
        n_samples: u32,
        control: &Control,
    ) -> Result<RenderOutput, Error> {
        match zrak_render::render(&mut self, done, n_samples, control) {
            Ok(rendered) => Ok(self.output(rendered)),
            Err(interrupted) => {
                let finished = self.output(interrupted.finished);
                Err(Error::from(interrupted.error).with_finished(finished))
            }
        }
    }

    fn output(&self, Rendered { film, n_samples }: Rendered) -> RenderOutput {
        RenderOutput {
            film,
            n_samples,
            backend: self.info(),
            times: self.times(),
            first_pass_s: self.first_pass_s,
            total_s: self.start.elapsed().as_secs_f64(),
            gpu_failure: self.gpu_failure.clone().or_else(|| {
                let failures = self.backend.failures();
                (!failures.is_empty()).then(|| failures.join("; "))
            }),
        }
    }
}

impl Backend for Run {
    fn info(&self) -> BackendInfo {
        self.backend.info()
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        let n_done = self.backend.render(film, samples, control)?;
        if n_done > 0 && self.first_pass_s.is_none() {
            self.first_pass_s = Some(self.start.elapsed().as_secs_f64());
        }
        Ok(n_done)
    }

    fn times(&self) -> Times {
        self.before.plus(&self.backend.times())
    }
}

#[cfg(test)]
mod tests;
