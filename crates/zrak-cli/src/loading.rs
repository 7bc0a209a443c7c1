//! What a person sees on a terminal while a scene is being loaded: a line that says what is being done.
//! A thread of its own reads the counter, as for renders.

use std::io::{IsTerminal, stderr};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use zrak::{LoadProgress, LoadStage};

use crate::{terminal, text};

/// How often the line changes. What takes less time is not worth a line.
const PERIOD: Duration = Duration::from_millis(100);

/// Shows how far the loading of a scene is until it is dropped.
pub(crate) struct Loading {
    bar: Option<ProgressBar>,
    is_quiet: bool,
    ticker: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Loading {
    /// Watches a counter; shows nothing if it is to be quiet, or nobody looks.
    pub(crate) fn start(progress: &LoadProgress, is_quiet: bool) -> Self {
        if is_quiet || !stderr().is_terminal() {
            return Self { bar: None, is_quiet, ticker: None };
        }
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        // The template is a constant that indicatif accepts; its default would do as well.
        let style = ProgressStyle::with_template("{spinner} {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        let (stop, stopped) = channel();
        let (watched, shown) = (progress.clone(), bar.clone());
        let thread = std::thread::Builder::new().spawn(move || watch(&watched, &shown, &stopped));
        // Without a thread to spare there is nothing to see, but the scene is loaded.
        Self { bar: Some(bar), is_quiet, ticker: thread.ok().map(|thread| (stop, thread)) }
    }

    /// Says something above the line, unless it is to be quiet.
    pub(crate) fn note(&self, line: &str) {
        match &self.bar {
            _ if self.is_quiet => {}
            Some(bar) => bar.suspend(|| terminal::note(line)),
            None => terminal::note(line),
        }
    }
}

impl Drop for Loading {
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

fn watch(progress: &LoadProgress, bar: &ProgressBar, stopped: &Receiver<()>) {
    while stopped.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
        let state = progress.state();
        bar.set_message(message(state.stage, state.n_done, state.n_total));
        bar.tick();
    }
}

fn message(stage: LoadStage, n_done: u64, n_total: u64) -> String {
    let of = if n_total > 0 { format!("{n_done} of {n_total}") } else { n_done.to_string() };
    match stage {
        LoadStage::Reading if n_done == 0 => "reading".to_owned(),
        LoadStage::Reading => format!("reading: {}", text::bytes(n_done)),
        LoadStage::Objects if n_total == 0 => "placing objects".to_owned(),
        LoadStage::Objects => format!("placing objects: {of} meshes"),
        LoadStage::Images => format!("reading images: {of}"),
        LoadStage::Trees => {
            format!("building trees: {:.0} %", 100.0 * n_done as f64 / n_total.max(1) as f64)
        }
        _ => "checking".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_named() {
        for (stage, n_done, n_total, expected) in [
            (LoadStage::Reading, 0, 0, "reading"),
            (LoadStage::Reading, 3 << 20, 0, "reading: 3.00 MiB"),
            (LoadStage::Objects, 2, 7, "placing objects: 2 of 7 meshes"),
            (LoadStage::Objects, 0, 0, "placing objects"),
            (LoadStage::Images, 1, 4, "reading images: 1 of 4"),
            (LoadStage::Trees, 250, 1000, "building trees: 25 %"),
            (LoadStage::Packing, 0, 0, "checking"),
        ] {
            assert_eq!(message(stage, n_done, n_total), expected);
        }
    }
}
