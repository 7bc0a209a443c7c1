//! The driver: what is used of it, with owners for what it hands out and errors in its own words.
//!
//! All `unsafe` of this crate is here, but for the one launch in `backend.rs`. The driver library is loaded at the first call; everything
//! goes through [`Context::new`] or [`device_count`], which find out first whether it exists.

#![allow(unsafe_code)]

use std::ffi::{CString, c_int, c_uint, c_void};
use std::marker::PhantomData;

use bytemuck::Pod;
use cudarc::driver::result::{self, DriverError};
use cudarc::driver::sys;
use zrak_render::{BackendError, BackendErrorKind};

type Result<T> = std::result::Result<T, BackendError>;

/// The driver's own words for what went wrong while it was asked for `what`.
fn failed(what: &str) -> impl Fn(DriverError) -> BackendError {
    move |error| {
        let kind = match error.0 {
            sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY => BackendErrorKind::OutOfMemory,
            sys::CUresult::CUDA_ERROR_NO_DEVICE | sys::CUresult::CUDA_ERROR_INVALID_DEVICE => {
                BackendErrorKind::Unavailable
            }
            _ => BackendErrorKind::Failed,
        };
        let words = error.error_string().map_or("unknown error".into(), |s| s.to_string_lossy());
        let name = error.error_name().map_or("unknown".into(), |s| s.to_string_lossy());
        BackendError::new(kind, format!("CUDA could not {what}: {words} ({name})"))
    }
}

/// Loads the driver.
fn init() -> Result<()> {
    // SAFETY: tries to open the driver library, which runs no code of ours.
    if !unsafe { sys::is_culib_present() } {
        let message = "no NVIDIA driver (libcuda) is installed";
        return Err(BackendError::new(BackendErrorKind::Unavailable, message));
    }
    result::init().map_err(failed("start the driver"))
}

/// Number of devices.
pub(crate) fn device_count() -> Result<u32> {
    init()?;
    let n = result::device::get_count().map_err(failed("count the devices"))?;
    Ok(u32::try_from(n).unwrap_or(0))
}

/// A device, before anything is done with it.
#[derive(Clone, Copy)]
pub(crate) struct Device(sys::CUdevice);

impl Device {
    pub(crate) fn get(ordinal: u32) -> Result<Self> {
        let n = device_count()?;
        if ordinal >= n {
            let message = match n {
                0 => "the driver finds no NVIDIA GPU".to_owned(),
                n => format!("there is no device {ordinal}; there are {n}, counted from 0"),
            };
            return Err(BackendError::new(BackendErrorKind::Unavailable, message));
        }
        let device = result::device::get(ordinal as c_int);
        device.map(Self).map_err(failed("open the device"))
    }

    pub(crate) fn name(self) -> Result<String> {
        result::device::get_name(self.0).map_err(failed("name the device"))
    }

    pub(crate) fn total_memory(self) -> Result<u64> {
        // SAFETY: the device comes from the driver.
        let bytes = unsafe { result::device::total_mem(self.0) };
        bytes.map(|b| b as u64).map_err(failed("tell the device's memory"))
    }

    pub(crate) fn attribute(self, attribute: sys::CUdevice_attribute) -> Result<i32> {
        // SAFETY: the device comes from the driver.
        unsafe { result::device::get_attribute(self.0, attribute) }
            .map_err(failed("tell an attribute of the device"))
    }
}

/// The device's primary context, current on this thread while it is used.
pub(crate) struct Context {
    device: sys::CUdevice,
    context: sys::CUcontext,
}

// SAFETY: the driver lets any thread use a context, and what lives in it, that has made it current, which
// the backend does at the start of each of its calls; owners are unique, so two threads never use one at
// the same time.
unsafe impl Send for Context {}
// SAFETY: as above.
unsafe impl Send for Module {}
// SAFETY: as above; the memory is the process's.
unsafe impl<T: Pod + Send> Send for PinnedBuffer<T> {}

impl Context {
    pub(crate) fn new(device: Device) -> Result<Self> {
        // SAFETY: the device comes from the driver.
        let context = unsafe { result::primary_ctx::retain(device.0) }
            .map_err(failed("make a context on the device"))?;
        let context = Self { device: device.0, context };
        context.make_current()?;
        Ok(context)
    }

    /// Everything else here works on the context that is current.
    pub(crate) fn make_current(&self) -> Result<()> {
        // SAFETY: the context is retained until `self` is dropped.
        unsafe { result::ctx::set_current(self.context) }.map_err(failed("use the context"))
    }

    /// Free and total bytes.
    pub(crate) fn memory(&self) -> Result<(u64, u64)> {
        let (free, total) = result::mem_get_info().map_err(failed("tell the free memory"))?;
        Ok((free as u64, total as u64))
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: retained in `new`, released once. An error here means that the device is gone.
        let _ = unsafe { result::primary_ctx::release(self.device) };
    }
}

/// Compiled kernels.
pub(crate) struct Module(sys::CUmodule);

impl Module {
    /// Compiles PTX for the device, with at most `max_registers` for a thread (0: no limit). The
    /// driver keeps the result in its cache.
    pub(crate) fn compile(ptx: &str, max_registers: u32) -> Result<Self> {
        let what = "compile the kernels";
        let source = CString::new(ptx).map_err(|_| {
            BackendError::new(BackendErrorKind::Failed, "the embedded kernels hold a zero byte")
        })?;
        let mut log = vec![0_u8; 16 << 10];
        let mut options = vec![
            sys::CUjit_option::CU_JIT_ERROR_LOG_BUFFER,
            sys::CUjit_option::CU_JIT_ERROR_LOG_BUFFER_SIZE_BYTES,
        ];
        let mut values = vec![log.as_mut_ptr().cast::<c_void>(), log.len() as *mut c_void];
        if max_registers > 0 {
            options.push(sys::CUjit_option::CU_JIT_MAX_REGISTERS);
            values.push(max_registers as usize as *mut c_void);
        }
        let mut module = std::ptr::null_mut();
        // SAFETY: the source is zero-terminated; options and values are of one length and of the
        // kinds that the driver documents; the log outlives the call.
        let status = unsafe {
            sys::cuModuleLoadDataEx(
                &raw mut module,
                source.as_ptr().cast(),
                options.len() as c_uint,
                options.as_mut_ptr(),
                values.as_mut_ptr(),
            )
        };
        status.result().map(|()| Self(module)).map_err(|error| {
            let end = log.iter().position(|&b| b == 0).unwrap_or(log.len());
            let log = String::from_utf8_lossy(&log[..end]);
            let error = failed(what)(error);
            BackendError::new(error.kind(), format!("{error}\n{}", log.trim()).trim().to_owned())
        })
    }

    pub(crate) fn function(&self, name: &str) -> Result<Function<'_>> {
        let c_name = CString::new(name).unwrap_or_default();
        // SAFETY: the module is loaded.
        let function = unsafe { result::module::get_function(self.0, c_name) };
        let function = function.map_err(failed(&format!("find the kernel {name}")))?;
        Ok(Function { function, module: PhantomData })
    }
}

impl Drop for Module {
    fn drop(&mut self) {
        // SAFETY: loaded in `compile`, unloaded once.
        let _ = unsafe { result::module::unload(self.0) };
    }
}

/// A kernel.
#[derive(Clone, Copy)]
pub(crate) struct Function<'a> {
    function: sys::CUfunction,
    module: PhantomData<&'a Module>,
}

impl Function<'_> {
    pub(crate) fn attribute(&self, attribute: sys::CUfunction_attribute) -> Result<i32> {
        // SAFETY: the function's module is loaded.
        unsafe { result::function::get_function_attribute(self.function, attribute) }
            .map_err(failed("tell an attribute of the kernel"))
    }

    /// Starts the kernel; it runs after what was started before.
    ///
    /// # Safety
    /// The arguments are those that the kernel takes, by number, order, type and meaning; device
    /// memory that they point to stays until the kernel has ended.
    pub(crate) unsafe fn launch(
        &self,
        grid: [u32; 2],
        block: [u32; 2],
        arguments: &mut [*mut c_void],
    ) -> Result<()> {
        // SAFETY: by this function's contract.
        unsafe {
            result::launch_kernel(
                self.function,
                (grid[0], grid[1], 1),
                (block[0], block[1], 1),
                0,
                result::stream::null(),
                arguments,
            )
        }
        .map_err(failed("start the kernel"))
    }
}

/// Device memory for records.
pub(crate) struct DeviceBuffer<T> {
    pointer: sys::CUdeviceptr,
    len: usize,
    records: PhantomData<T>,
}

impl<T: Pod> DeviceBuffer<T> {
    /// Memory for `len` records, not yet written; at least one byte.
    pub(crate) fn new(len: usize) -> Result<Self> {
        let size = (len * size_of::<T>()).max(1);
        // SAFETY: the memory is written before it is read: by `upload` or `clear`.
        let pointer = unsafe { result::malloc_sync(size) }
            .map_err(failed(&format!("take {} MiB of memory", size >> 20)))?;
        Ok(Self { pointer, len, records: PhantomData })
    }

    /// Memory with a copy of these records.
    pub(crate) fn upload(records: &[T]) -> Result<Self> {
        let buffer = Self::new(records.len())?;
        if !records.is_empty() {
            // SAFETY: the memory is large enough and not in use.
            unsafe { result::memcpy_htod_sync(buffer.pointer, records) }
                .map_err(failed("copy the scene to the device"))?;
        }
        Ok(buffer)
    }

    /// Sets every byte to zero, after what was started before.
    pub(crate) fn clear(&mut self) -> Result<()> {
        // SAFETY: the memory is that large.
        unsafe {
            result::memset_d8_async(
                self.pointer,
                0,
                self.len * size_of::<T>(),
                result::stream::null(),
            )
        }
        .map_err(failed("clear memory"))
    }

    pub(crate) fn pointer(&self) -> sys::CUdeviceptr {
        self.pointer
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }
}

impl<T> Drop for DeviceBuffer<T> {
    fn drop(&mut self) {
        // SAFETY: allocated in `new`, freed once.
        let _ = unsafe { result::free_sync(self.pointer) };
    }
}

/// Host memory that the device can write to at full speed.
pub(crate) struct PinnedBuffer<T> {
    pointer: *mut T,
    len: usize,
}

impl<T: Pod> PinnedBuffer<T> {
    pub(crate) fn new(len: usize) -> Result<Self> {
        // SAFETY: plain page-locked memory, cached by the processor; it is cleared before use.
        let pointer = unsafe { result::malloc_host(len * size_of::<T>(), 0) }
            .map_err(failed("take page-locked memory"))?
            .cast::<T>();
        // SAFETY: just allocated for `len` records; all zero is a valid `Pod`.
        unsafe { pointer.write_bytes(0, len) };
        Ok(Self { pointer, len })
    }

    /// Starts to copy records `first` to `first + count` of `source` to the front of this memory,
    /// after what was started before.
    pub(crate) fn start_download(
        &mut self,
        source: &DeviceBuffer<T>,
        first: usize,
        count: usize,
    ) -> Result<()> {
        assert!(count <= self.len && first + count <= source.len, "download out of bounds");
        // SAFETY: both ranges are in bounds, and `&mut self` keeps others from reading until
        // `records` is called, which the caller does after waiting for an event.
        unsafe {
            result::memcpy_dtoh_async(
                std::slice::from_raw_parts_mut(self.pointer, count),
                source.pointer + (first * size_of::<T>()) as u64,
                result::stream::null(),
            )
        }
        .map_err(failed("copy the film from the device"))
    }

    /// The first `count` records. A download into them must have ended.
    pub(crate) fn records(&self, count: usize) -> &[T] {
        assert!(count <= self.len, "more records than there are");
        // SAFETY: initialised in `new`, and any bytes are a valid `Pod`.
        unsafe { std::slice::from_raw_parts(self.pointer, count) }
    }
}

impl<T> Drop for PinnedBuffer<T> {
    fn drop(&mut self) {
        // SAFETY: allocated in `new`, freed once.
        let _ = unsafe { result::free_host(self.pointer.cast()) };
    }
}

/// A point in the sequence of what the device does.
pub(crate) struct Event(sys::CUevent);

impl Event {
    /// The point after everything that was started so far.
    pub(crate) fn record() -> Result<Self> {
        let event = result::event::create(sys::CUevent_flags::CU_EVENT_DEFAULT)
            .map_err(failed("make an event"))?;
        let event = Self(event);
        // SAFETY: the event was just made; the stream is the default one.
        unsafe { result::event::record(event.0, result::stream::null()) }
            .map_err(failed("record an event"))?;
        Ok(event)
    }

    /// Waits until the device gets there. Here errors of earlier kernels show.
    pub(crate) fn wait(&self) -> Result<()> {
        // SAFETY: the event was recorded.
        unsafe { result::event::synchronize(self.0) }.map_err(failed("render"))
    }

    /// Seconds from an earlier event to this one, both of which were waited for.
    pub(crate) fn seconds_since(&self, earlier: &Self) -> Result<f64> {
        // SAFETY: both events were recorded.
        let ms = unsafe { result::event::elapsed(earlier.0, self.0) };
        ms.map(|ms| f64::from(ms) * 1e-3).map_err(failed("tell the time"))
    }
}

impl Drop for Event {
    fn drop(&mut self) {
        // SAFETY: made in `record`, destroyed once.
        let _ = unsafe { result::event::destroy(self.0) };
    }
}
