//! What a person sees while a picture is being rendered.
//!
//! On a terminal it is a bar; in a log it is a line now and then. A thread of its own reads the
//! number of samples, so that rendering knows nothing of it.

use std::io::{IsTerminal, stderr};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use zrak::Control;

use crate::{terminal, text};

/// How often the bar moves.
const BAR_PERIOD: Duration = Duration::from_millis(100);
/// How often a log gets a line.
const LOG_PERIOD: Duration = Duration::from_secs(20);

/// Shows how far a render is until it is dropped.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    is_quiet: bool,
    ticker: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Watches a render of `spp` samples for each of `n_pixels` pixels.
    pub(crate) fn start(control: &Arc<Control>, n_pixels: u64, spp: u32, is_quiet: bool) -> Self {
        if is_quiet {
            return Self { bar: None, is_quiet, ticker: None };
        }
        let bar = stderr().is_terminal().then(|| {
            let draw = ProgressDrawTarget::stderr();
            let bar = ProgressBar::with_draw_target(Some(n_pixels * u64::from(spp)), draw);
            // The template is a constant that indicatif accepts; its default would do as well.
            let style = ProgressStyle::with_template("{wide_bar} {percent:>3} %  {msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        let (stop, stopped) = channel();
        let watch = Watch { control: Arc::clone(control), bar: bar.clone(), n_pixels, spp };
        let thread = std::thread::Builder::new().spawn(move || watch.run(&stopped));
        // Without a thread to spare there is no progress to see, but there is a picture.
        Self { bar, is_quiet, ticker: thread.ok().map(|thread| (stop, thread)) }
    }

    /// Says something above the bar.
    pub(crate) fn note(&self, line: &str) {
        match &self.bar {
            _ if self.is_quiet => {}
            Some(bar) => bar.suspend(|| terminal::note(line)),
            None => terminal::note(line),
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.ticker.take() {
            drop(stop);
            // It cannot panic, and if it did there would be nothing to do about it here.
            let _ = thread.join();
        }
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// What the thread knows.
struct Watch {
    control: Arc<Control>,
    bar: Option<ProgressBar>,
    n_pixels: u64,
    spp: u32,
}

impl Watch {
    fn run(&self, stopped: &Receiver<()>) {
        let period = if self.bar.is_some() { BAR_PERIOD } else { LOG_PERIOD };
        // The rate counts from the first samples on: what comes before is not rendering.
        let mut first: Option<(Instant, u64)> = None;
        while stopped.recv_timeout(period) == Err(RecvTimeoutError::Timeout) {
            // A pass that failed on the GPU is counted again on the processor.
            let n_total = self.n_pixels * u64::from(self.spp);
            let n_samples = self.control.n_samples().min(n_total);
            if n_samples > 0 && first.is_none() {
                first = Some((Instant::now(), n_samples));
            }
            let rate = first.map_or(0.0, |(since, n_first)| {
                let elapsed_s = since.elapsed().as_secs_f64();
                if elapsed_s > 0.0 { (n_samples - n_first) as f64 / elapsed_s } else { 0.0 }
            });
            let message = self.message(n_samples, rate);
            match &self.bar {
                Some(bar) => {
                    bar.set_position(n_samples);
                    bar.set_message(message);
                }
                // Before the first samples there is nothing to say, only to draw.
                None if n_samples == 0 => {}
                None => {
                    let percent = 100.0 * n_samples as f64 / n_total as f64;
                    terminal::note(&format!("{percent:.0} %  {message}"));
                }
            }
        }
    }

    fn message(&self, n_samples: u64, samples_per_s: f64) -> String {
        let spp_done = n_samples as f64 / self.n_pixels as f64;
        let mut message = format!("{spp_done:.1}/{} spp", self.spp);
        if samples_per_s > 0.0 {
            let n_left = self.n_pixels as f64 * f64::from(self.spp) - n_samples as f64;
            message += &format!(
                "  {} Msamples/s  {} left",
                text::number(samples_per_s / 1e6),
                text::remaining(n_left / samples_per_s)
            );
        }
        message
    }
}
