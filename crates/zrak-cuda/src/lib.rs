//! The NVIDIA backend: the committed kernels, on the CUDA driver, which is loaded at run time.

mod backend;
mod device;
mod driver;
mod kernels;

pub use backend::{CudaBackend, CudaOptions};
pub use device::{DeviceInfo, devices, n_devices};
