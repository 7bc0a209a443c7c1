//! The choice of a backend.
//!
//! To add a backend: 1. a variant of [`BackendChoice`], its name, and what it takes from
//! [`RenderOptions`]; 2. its arm in [`open`].

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use zrak_cpu::{CpuBackend, Tree};
use zrak_cuda::{CudaBackend, CudaOptions};
use zrak_render::{Backend, BackendError};
use zrak_scene::arena::SceneArena;

/// What to render on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BackendChoice {
    /// The GPU if it can be had, otherwise the processor.
    #[default]
    Auto,
    /// The processor.
    Cpu,
    /// A CUDA device, or an error.
    Cuda,
}

impl BackendChoice {
    /// All choices.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Cpu, Self::Cuda];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
        }
    }
}

impl fmt::Display for BackendChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A name that is no [`BackendChoice`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no backend '{0}'; there are auto, cpu and cuda")]
pub struct UnknownBackend(String);

impl FromStr for BackendChoice {
    type Err = UnknownBackend;

    fn from_str(name: &str) -> Result<Self, UnknownBackend> {
        let found = Self::ALL.into_iter().find(|choice| choice.name() == name);
        found.ok_or_else(|| UnknownBackend(name.to_owned()))
    }
}

/// How to render. None of it changes the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// What to render on.
    pub backend: BackendChoice,
    /// Threads of the processor; all cores for `None`.
    pub threads: Option<usize>,
    /// How the processor finds the closest hit.
    pub tree: Tree,
    /// Number of the CUDA device.
    pub device: u32,
    /// Threads of a CUDA block along x and y.
    pub block: [u32; 2],
}

impl Default for RenderOptions {
    fn default() -> Self {
        let CudaOptions { device, block, .. } = CudaOptions::default();
        let (backend, tree) = (BackendChoice::Auto, Tree::default());
        Self { backend, threads: None, tree, device, block }
    }
}

/// How many threads the processor backend renders on with this option.
#[must_use]
pub fn n_threads(threads: Option<usize>) -> usize {
    threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
}

/// The vector instructions that the processor backend uses on this machine, such as `AVX2`.
#[must_use]
pub fn cpu_instruction_set() -> &'static str {
    zrak_cpu::instruction_set()
}

/// The two kinds of backend that a choice leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Cpu,
    Cuda,
}

/// Brings the scene to a backend.
pub(crate) fn open(
    kind: Kind,
    arena: Arc<SceneArena>,
    options: &RenderOptions,
) -> Result<Box<dyn Backend>, BackendError> {
    Ok(match kind {
        Kind::Cpu => Box::new(CpuBackend::new(arena, options.threads, options.tree)?),
        Kind::Cuda => {
            let RenderOptions { device, block, .. } = *options;
            let cuda = CudaOptions { device, block, ..CudaOptions::default() };
            Box::new(CudaBackend::new(arena, &cuda)?)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        for choice in BackendChoice::ALL {
            assert_eq!(choice.to_string().parse(), Ok(choice));
        }
        let error = "gpu".parse::<BackendChoice>().unwrap_err();
        assert!(error.to_string().contains("auto, cpu and cuda"), "{error}");
    }

    #[test]
    fn the_processor_says_what_it_uses() {
        assert_ne!(cpu_instruction_set(), "unknown");
        assert_eq!(n_threads(Some(3)), 3);
        assert!(n_threads(None) >= 1);
    }
}
