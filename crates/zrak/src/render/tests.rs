//! What happens when a GPU is missing or fails, with a made-up GPU.

use zrak_core::math::Color;

use super::*;
use crate::ErrorKind;

/// A GPU that renders two passes of one sample and then fails, if it is there at all.
struct Flaky {
    name: &'static str,
    n_passes_left: u32,
}

impl Backend for Flaky {
    fn info(&self) -> BackendInfo {
        BackendInfo { name: self.name, device: format!("made-up {}", self.name) }
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        if self.n_passes_left == 0 {
            return Err(BackendError::new(BackendErrorKind::Failed, "CUDA_ERROR_ECC"));
        }
        self.n_passes_left -= 1;
        for pixel in &mut film.pixels {
            pixel.add_sample(Color::new(samples.first as f32, 0.0, 1.0), 1);
        }
        control.count_samples(film.region.n_pixels() as u64);
        Ok(1)
    }

    fn times(&self) -> Times {
        Times { render_s: 1.0, upload_s: 0.5, ..Times::default() }
    }
}

fn run(
    choice: BackendChoice,
    gpu: Result<u32, BackendErrorKind>,
) -> (Result<RenderOutput, Error>, Vec<String>) {
    let open = |kind| -> Result<Box<dyn Backend + Send>, BackendError> {
        match (kind, gpu) {
            (Kind::Cpu | Kind::Hybrid, _) => {
                Ok(Box::new(Flaky { name: "cpu", n_passes_left: 100 }))
            }
            (Kind::Cuda, Ok(n_passes_left)) => Ok(Box::new(Flaky { name: "cuda", n_passes_left })),
            (Kind::Cuda, Err(kind)) => Err(BackendError::new(kind, "no NVIDIA driver")),
        }
    };
    let mut notices = Vec::new();
    let region = Region::whole(3, 2);
    let mut note = |line: &str| notices.push(line.to_owned());
    let output = render_with(open, region, 5, choice, &Control::default(), &mut note);
    (output, notices)
}

#[test]
fn auto_takes_the_gpu_if_there_is_one() {
    let (output, notices) = run(BackendChoice::Auto, Ok(100));
    let output = output.unwrap();
    assert_eq!((output.backend.name, output.n_samples), ("cuda", 5));
    assert_eq!(notices, ["rendering on made-up cuda"]);
    assert!(output.first_pass_s.unwrap() <= output.total_s);
}

#[test]
fn auto_takes_the_processor_if_there_is_no_gpu() {
    let (output, notices) = run(BackendChoice::Auto, Err(BackendErrorKind::Unavailable));
    assert_eq!(output.unwrap().backend.name, "cpu");
    assert_eq!(notices, ["no GPU: no NVIDIA driver; rendering on made-up cpu"]);
    let (output, notices) = run(BackendChoice::Auto, Err(BackendErrorKind::InvalidOption));
    assert_eq!(output.unwrap_err().kind(), ErrorKind::InvalidOption);
    assert!(notices.is_empty());
}

#[test]
fn auto_goes_on_where_the_gpu_failed_to_the_same_film() {
    let (output, notices) = run(BackendChoice::Auto, Ok(2));
    let output = output.unwrap();
    assert_eq!((output.backend.name, output.n_samples), ("cpu", 5));
    assert_eq!(output.gpu_failure.as_deref(), Some("CUDA_ERROR_ECC"));
    assert_eq!((output.times.render_s, output.times.upload_s), (2.0, 1.0));
    let expected = "the GPU failed after 2 of 5 samples per pixel: CUDA_ERROR_ECC; going on on \
                    made-up cpu";
    assert_eq!(notices, ["rendering on made-up cuda", expected]);
    assert_eq!(output.film, run(BackendChoice::Cpu, Ok(0)).0.unwrap().film);
}

#[test]
fn a_gpu_that_was_asked_for_is_not_replaced() {
    let (output, _) = run(BackendChoice::Cuda, Err(BackendErrorKind::Unavailable));
    let error = output.unwrap_err();
    assert_eq!(
        (error.kind(), error.to_string().as_str()),
        (ErrorKind::Backend, "no NVIDIA driver")
    );
    assert!(error.finished().is_none());

    let error = run(BackendChoice::Cuda, Ok(2)).0.unwrap_err();
    assert_eq!(error.finished().unwrap().n_samples, 2);
    assert_eq!(error.finished().unwrap().film.pixels[0].n_samples, 2);
}
