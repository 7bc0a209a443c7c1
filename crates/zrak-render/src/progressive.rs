//! The progressive loop: pass after pass until all samples are there.

use crate::{Backend, BackendError, Control, Film, SampleRange};

/// A film to which every pixel has the same number of samples.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The sums.
    pub film: Film,
    /// Samples of each pixel.
    pub n_samples: u32,
}

/// A backend failed on the way.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
pub struct Interrupted {
    /// Why.
    pub error: BackendError,
    /// The passes that were finished before: another backend can go on from here.
    pub finished: Rendered,
}

/// Adds samples to `start` until each pixel has `n_samples`, or the render is stopped.
///
/// # Errors
/// If the backend fails; what was finished before is not lost.
pub fn render(
    backend: &mut dyn Backend,
    start: Rendered,
    n_samples: u32,
    control: &Control,
) -> Result<Rendered, Box<Interrupted>> {
    let mut done = start;
    // A pass that is stopped or fails spoils its film, so finished passes are kept apart.
    let mut pass = Film::new(done.film.region);
    let mut pass_is_clear = true;
    while done.n_samples < n_samples && !control.is_stopped() {
        if !pass_is_clear {
            pass.clear();
        }
        let range = SampleRange { first: done.n_samples, count: n_samples - done.n_samples };
        match backend.render(&mut pass, range, control) {
            Ok(0) => break,
            Ok(n) if done.n_samples == 0 => {
                // The first pass is the film.
                std::mem::swap(&mut done.film, &mut pass);
                done.n_samples = n;
            }
            Ok(n) => {
                done.film.merge(&pass);
                done.n_samples += n;
                pass_is_clear = false;
            }
            Err(error) => return Err(Box::new(Interrupted { error, finished: done })),
        }
    }
    Ok(done)
}
