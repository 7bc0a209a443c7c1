//! The devices there are.

use cudarc::driver::sys::CUdevice_attribute as Attribute;
use zrak_render::BackendError;

use crate::driver::{Device, device_count};

/// A CUDA device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Number to choose it by.
    pub ordinal: u32,
    /// Name, as the driver gives it.
    pub name: String,
    /// Compute capability, major and minor.
    pub compute_capability: (i32, i32),
    /// Memory in bytes.
    pub memory_bytes: u64,
    /// Streaming multiprocessors.
    pub n_multiprocessors: u32,
}

impl DeviceInfo {
    pub(crate) fn of(ordinal: u32, device: Device) -> Result<Self, BackendError> {
        let major = device.attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)?;
        let minor = device.attribute(Attribute::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)?;
        let n = device.attribute(Attribute::CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT)?;
        Ok(Self {
            ordinal,
            name: device.name()?,
            compute_capability: (major, minor),
            memory_bytes: device.total_memory()?,
            n_multiprocessors: u32::try_from(n).unwrap_or(0),
        })
    }
}

/// Number of CUDA devices.
///
/// # Errors
/// If there is no driver, in words that say so.
pub fn n_devices() -> Result<u32, BackendError> {
    device_count()
}

/// All CUDA devices; none if there is a driver without a device.
///
/// # Errors
/// If there is no driver, in words that say so.
pub fn devices() -> Result<Vec<DeviceInfo>, BackendError> {
    (0..device_count()?).map(|ordinal| DeviceInfo::of(ordinal, Device::get(ordinal)?)).collect()
}
