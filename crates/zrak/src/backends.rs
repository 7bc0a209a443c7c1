//! The choice of a backend.
//!
//! To add a backend: 1. a variant of [`BackendChoice`], its name, and what it takes from
//! [`RenderOptions`]; 2. its arm in [`open`].

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use zrak_cpu::{CpuBackend, Tree};
use zrak_cuda::{CudaBackend, CudaOptions};
use zrak_render::{Backend, BackendError, BackendErrorKind, Team};
use zrak_scene::arena::SceneArena;

/// What to render on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BackendChoice {
    /// The GPU if it can be had, otherwise the processor.
    #[default]
    Auto,
    /// The processor.
    Cpu,
    /// CUDA devices, or an error.
    Cuda,
    /// CUDA devices and the processor together, or an error.
    Hybrid,
}

impl BackendChoice {
    /// All choices.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Cpu, Self::Cuda, Self::Hybrid];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
            Self::Hybrid => "hybrid",
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
#[error("there is no backend '{0}'; there are auto, cpu, cuda and hybrid")]
pub struct UnknownBackend(String);

impl FromStr for BackendChoice {
    type Err = UnknownBackend;

    fn from_str(name: &str) -> Result<Self, UnknownBackend> {
        let found = Self::ALL.into_iter().find(|choice| choice.name() == name);
        found.ok_or_else(|| UnknownBackend(name.to_owned()))
    }
}

/// A choice among the CUDA devices of a machine, of which those with numbers below 64 can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Devices(u64);

impl Devices {
    /// All that there are.
    pub const ALL: Self = Self(u64::MAX);

    /// The device with this number, counted from 0; none if it is above 63.
    #[must_use]
    pub const fn one(device: u32) -> Self {
        Self(if device < 64 { 1 << device } else { 0 })
    }

    /// The chosen ones of a machine with `n_devices`.
    ///
    /// # Errors
    /// If one is chosen that is not there, or none is.
    fn of(self, n_devices: u32) -> Result<Vec<u32>, BackendError> {
        if self == Self::ALL && n_devices > 0 {
            return Ok((0..n_devices.min(64)).collect());
        }
        let chosen: Vec<u32> = (0..64).filter(|i| self.0 >> i & 1 != 0).collect();
        match chosen.iter().find(|i| **i >= n_devices) {
            None if !chosen.is_empty() => Ok(chosen),
            _ => {
                let message = match n_devices {
                    0 => "the driver finds no NVIDIA GPU".to_owned(),
                    n => format!("there is no device {self}; there are {n}, counted from 0"),
                };
                Err(BackendError::new(BackendErrorKind::Unavailable, message))
            }
        }
    }
}

impl fmt::Display for Devices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::ALL {
            return f.write_str("all");
        }
        let chosen: Vec<String> =
            (0..64).filter(|i| self.0 >> i & 1 != 0).map(|i: u32| i.to_string()).collect();
        f.write_str(&chosen.join(","))
    }
}

impl FromStr for Devices {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self::ALL);
        }
        let mut chosen = 0;
        for number in text.split(',') {
            match number.trim().parse::<u32>() {
                Ok(i) if i < 64 => chosen |= 1_u64 << i,
                _ => {
                    let help = "numbers from 0 to 63 with commas between them, or 'all'";
                    return Err(format!("'{number}' is no device; {help}"));
                }
            }
        }
        Ok(Self(chosen))
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
    /// The CUDA devices.
    pub devices: Devices,
    /// Threads of a CUDA block along x and y.
    pub block: [u32; 2],
}

impl Default for RenderOptions {
    fn default() -> Self {
        let CudaOptions { device, block, .. } = CudaOptions::default();
        let (backend, tree) = (BackendChoice::Auto, Tree::default());
        Self { backend, threads: None, tree, devices: Devices::one(device), block }
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

/// The kinds of backend that a choice leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Cpu,
    Cuda,
    Hybrid,
}

/// Brings the scene to a backend.
pub(crate) fn open(
    kind: Kind,
    arena: Arc<SceneArena>,
    options: &RenderOptions,
) -> Result<Box<dyn Backend + Send>, BackendError> {
    let cpu = |threads| CpuBackend::new(Arc::clone(&arena), threads, options.tree);
    let mut members = match kind {
        Kind::Cpu => return Ok(Box::new(cpu(options.threads)?)),
        Kind::Cuda | Kind::Hybrid => open_cuda(&arena, options)?,
    };
    if kind == Kind::Hybrid {
        // Each GPU keeps a thread busy with waiting for it.
        let left = n_threads(None).saturating_sub(members.len()).max(1);
        members.push(Box::new(cpu(Some(options.threads.unwrap_or(left)))?));
    }
    match members.pop() {
        Some(only) if members.is_empty() => Ok(only),
        last => Ok(Box::new(Team::new(members.into_iter().chain(last).collect())?)),
    }
}

/// Brings the scene to all chosen CUDA devices at the same time.
fn open_cuda(
    arena: &Arc<SceneArena>,
    options: &RenderOptions,
) -> Result<Vec<Box<dyn Backend + Send>>, BackendError> {
    let devices = options.devices.of(zrak_cuda::n_devices()?)?;
    let open = |device: u32| {
        let cuda = CudaOptions { device, block: options.block, ..CudaOptions::default() };
        CudaBackend::new(Arc::clone(arena), &cuda)
    };
    if let [device] = devices[..] {
        return Ok(vec![Box::new(open(device)?)]);
    }
    std::thread::scope(|scope| {
        let threads: Vec<_> = devices.iter().map(|device| scope.spawn(|| open(*device))).collect();
        threads
            .into_iter()
            .map(|thread| match thread.join() {
                Ok(backend) => backend.map(|b| Box::new(b) as Box<dyn Backend + Send>),
                Err(panic) => std::panic::resume_unwind(panic),
            })
            .collect()
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
        assert!(error.to_string().contains("auto, cpu, cuda and hybrid"), "{error}");
    }

    #[test]
    fn devices_are_chosen_by_number() {
        for (text, chosen) in [("0", vec![0]), ("2,0", vec![0, 2]), ("all", vec![0, 1, 2])] {
            let devices: Devices = text.parse().unwrap();
            assert_eq!(devices.of(3).unwrap(), chosen);
            assert_eq!(devices.to_string().parse(), Ok(devices));
        }
        for text in ["", "-1", "64", "one", "0,,1", "0;1"] {
            assert!(text.parse::<Devices>().is_err(), "{text}");
        }
        let error = "1,3".parse::<Devices>().unwrap().of(3).unwrap_err();
        assert!(error.to_string().contains("no device 1,3; there are 3"), "{error}");
        assert!(Devices::ALL.of(0).unwrap_err().to_string().contains("no NVIDIA GPU"));
    }

    #[test]
    fn the_processor_says_what_it_uses() {
        assert_ne!(cpu_instruction_set(), "unknown");
        assert_eq!(n_threads(Some(3)), 3);
        assert!(n_threads(None) >= 1);
    }
}
