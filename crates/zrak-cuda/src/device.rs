//! The devices there are.

use zrak_render::{BackendError, BackendErrorKind};

/// A CUDA device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Number to choose it by.
    pub ordinal: u32,
    /// Name, as the driver gives it.
    pub name: String,
    /// Compute capability.
    pub compute_capability: (i32, i32),
    /// Memory in bytes.
    pub memory_bytes: u64,
    /// Streaming multiprocessors.
    pub n_multiprocessors: u32,
}

/// All CUDA devices; none if there is a driver without a device.
///
/// # Errors
/// If there is no driver, in words that say so.
pub fn devices() -> Result<Vec<DeviceInfo>, BackendError> {
    Err(BackendError::new(BackendErrorKind::Unavailable, "no NVIDIA driver"))
}
