//! How far the loading of a scene is, for whoever shows it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// What is being done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadStage {
    /// Reading the scene's own files; counted are their bytes, of which nobody knows how many there
    /// will be.
    #[default]
    Reading,
    /// Reading and placing objects and meshes; counted are meshes.
    Objects,
    /// Reading images; counted are images.
    Images,
    /// Building trees; counted are thousandths of all primitives.
    Trees,
    /// Laying everything out, and checking it.
    Packing,
}

impl LoadStage {
    const ALL: [Self; 5] = [Self::Reading, Self::Objects, Self::Images, Self::Trees, Self::Packing];
}

/// A counter that loading moves on and another thread reads. Clones are the same counter.
#[derive(Clone, Debug, Default)]
pub struct LoadProgress(Arc<Counters>);

#[derive(Debug, Default)]
struct Counters {
    stage: AtomicU32,
    n_done: AtomicU64,
    n_total: AtomicU64,
}

/// A moment of loading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadState {
    /// What is being done.
    pub stage: LoadStage,
    /// How much of it is done, in the stage's unit.
    pub n_done: u64,
    /// How much there is to do; 0 if nobody knows.
    pub n_total: u64,
}

impl LoadProgress {
    /// A stage begins; `n_total` is 0 if nobody knows.
    pub fn begin(&self, stage: LoadStage, n_total: u64) {
        self.0.n_done.store(0, Ordering::Relaxed);
        self.0.n_total.store(n_total, Ordering::Relaxed);
        self.0.stage.store(stage as u32, Ordering::Relaxed);
    }

    /// So much more is done.
    pub fn add(&self, n: u64) {
        self.0.n_done.fetch_add(n, Ordering::Relaxed);
    }

    /// So much is done in all.
    pub fn set(&self, n_done: u64) {
        self.0.n_done.store(n_done, Ordering::Relaxed);
    }

    /// How far it is. At the turn from one stage to the next, the numbers may be those of either.
    #[must_use]
    pub fn state(&self) -> LoadState {
        let stage = self.0.stage.load(Ordering::Relaxed) as usize;
        LoadState {
            stage: LoadStage::ALL.get(stage).copied().unwrap_or_default(),
            n_done: self.0.n_done.load(Ordering::Relaxed),
            n_total: self.0.n_total.load(Ordering::Relaxed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_count_together() {
        let progress = LoadProgress::default();
        assert_eq!(progress.state().stage, LoadStage::Reading);
        for (i, stage) in LoadStage::ALL.into_iter().enumerate() {
            let loader = progress.clone();
            loader.begin(stage, 10);
            loader.add(i as u64);
            assert_eq!(progress.state(), LoadState { stage, n_done: i as u64, n_total: 10 });
        }
    }
}
