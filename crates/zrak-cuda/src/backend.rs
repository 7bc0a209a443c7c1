//! Rendering on one device.
//!
//! The scene goes to the device once. A pass is a row of launches, each short enough not to hold
//! the device (and a display on it) for long; they add to a film in device memory, which comes
//! back at the end of the pass.

use std::ffi::c_void;
use std::sync::Arc;
use std::time::Instant;

use cudarc::driver::sys::CUfunction_attribute as FunctionAttribute;
use zrak_core::film::PixelSum;
use zrak_core::launch::RenderParams;
use zrak_render::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, Region, SampleRange, Times,
};
use zrak_scene::arena::SceneArena;

use crate::device::DeviceInfo;
use crate::driver::{Context, Device, DeviceBuffer, Event, Module, PinnedBuffer};
use crate::kernels::{self, RenderKernel};

/// How long one launch should take.
const LAUNCH_S: f64 = 0.08;
/// How long a pass should take: after each, the film comes back, so a lost device costs no more.
const PASS_S: f64 = 1.5;
/// Samples of the first launch, when the speed is not known yet.
const FIRST_LAUNCH_SAMPLES: f64 = 1.0e6;
/// Pixels that come back in one copy; two are on their way at a time.
const DOWNLOAD_PIXELS: usize = 1 << 16;

/// Choices of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CudaOptions {
    /// Number of the device.
    pub device: u32,
    /// Threads of a block along x and y.
    pub block: [u32; 2],
    /// Most registers that a thread may use; none for the best known number.
    pub max_registers: Option<u32>,
}

impl Default for CudaOptions {
    fn default() -> Self {
        Self { device: 0, block: [8, 8], max_registers: None }
    }
}

/// Renders on a CUDA device.
pub struct CudaBackend {
    // Dropped in this order: what lives in the context before it.
    arena: DeviceBuffer<u8>,
    film: Option<DeviceBuffer<PixelSum>>,
    staging: [PinnedBuffer<PixelSum>; 2],
    module: Module,
    kernel: RenderKernel,
    context: Context,
    scene: Arc<SceneArena>,
    block: [u32; 2],
    info: BackendInfo,
    times: Times,
    /// Measured speed, in samples of single pixels per second.
    samples_per_s: Option<f64>,
}

impl CudaBackend {
    /// Compiles the kernels for the device and brings the scene to it.
    ///
    /// # Errors
    /// If there is no such device, an option is out of range, or the driver refuses; with its own
    /// words.
    pub fn new(scene: Arc<SceneArena>, options: &CudaOptions) -> Result<Self, BackendError> {
        let device = Device::get(options.device)?;
        let properties = DeviceInfo::of(options.device, device)?;
        if properties.compute_capability < kernels::MIN_COMPUTE_CAPABILITY {
            let (major, minor) = properties.compute_capability;
            let message = format!(
                "device {} ({}) has compute capability {major}.{minor}, and 7.5 is the least",
                options.device, properties.name
            );
            return Err(BackendError::new(BackendErrorKind::Unavailable, message));
        }
        let mut times = Times::default();
        let start = Instant::now();
        let context = Context::new(device)?;
        let kernel = kernels::render_kernel(&scene.view().kinds_in_use());
        let max_registers = options.max_registers.unwrap_or(kernel.max_registers);
        let module = Module::compile(kernels::PTX, max_registers)?;
        let max_threads = module
            .function(kernel.name)?
            .attribute(FunctionAttribute::CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK)?;
        check_block(options.block, u32::try_from(max_threads).unwrap_or(1))?;
        times.compile_s = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let size = scene.bytes().len() as u64;
        let (free, _) = context.memory()?;
        if size > free {
            return Err(out_of_memory("the scene", size, free));
        }
        let arena = DeviceBuffer::upload(scene.bytes())?;
        let staging = [PinnedBuffer::new(DOWNLOAD_PIXELS)?, PinnedBuffer::new(DOWNLOAD_PIXELS)?];
        times.upload_s = start.elapsed().as_secs_f64();
        let info = BackendInfo { name: "cuda", device: properties.name };
        let block = options.block;
        Ok(Self {
            arena,
            film: None,
            staging,
            module,
            kernel,
            context,
            scene,
            block,
            info,
            times,
            samples_per_s: None,
        })
    }

    /// Adds samples to the film on the device, in launches of bounded length. Returns how many
    /// samples all pixels have got; 0 if it was stopped before they have one.
    fn launch_all(
        &mut self,
        region: Region,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        let n_pixels = region.n_pixels() as f64;
        let mut n_done = 0;
        let mut pass_s = 0.0;
        while n_done < samples.count && pass_s < PASS_S {
            let budget = self.samples_per_s.map_or(FIRST_LAUNCH_SAMPLES, |speed| speed * LAUNCH_S);
            let left = samples.count - n_done;
            let n = ((budget / n_pixels) as u32).clamp(1, left);
            // Bands of rows, if even one sample of all pixels takes too long.
            let rows = ((budget / f64::from(n) / f64::from(region.width)) as u32).max(1);
            let mut y = 0;
            while y < region.height {
                if control.is_stopped() {
                    return Ok(0);
                }
                let height = rows.min(region.height - y);
                let band = Region { y: region.y + y, height, ..region };
                let first = samples.first + n_done;
                let first_pixel = y as usize * region.width as usize;
                let time_s = self.launch(band, first_pixel, SampleRange { first, count: n })?;
                let n_samples = band.n_pixels() as f64 * f64::from(n);
                // Launch overhead makes small ones look slow; look at those that filled the device.
                if time_s > 1e-3 || self.samples_per_s.is_none() {
                    self.samples_per_s = Some(n_samples / time_s.max(1e-6));
                }
                control.count_samples(n_samples as u64);
                pass_s += time_s;
                y += height;
            }
            n_done += n;
        }
        self.times.render_s += pass_s;
        Ok(n_done)
    }

    /// One launch; returns its time in seconds.
    fn launch(
        &self,
        band: Region,
        first_pixel: usize,
        samples: SampleRange,
    ) -> Result<f64, BackendError> {
        let Some(film) = &self.film else { return Ok(0.0) };
        assert!(first_pixel + band.n_pixels() <= film.len(), "band outside of the film");
        let mut params = RenderParams {
            globals: *self.scene.globals(),
            spans: *self.scene.spans(),
            x: band.x,
            y: band.y,
            width: band.width,
            height: band.height,
            first_sample: samples.first,
            n_samples: samples.count,
        };
        let mut arena = self.arena.pointer();
        let mut pixels = film.pointer() + (first_pixel * size_of::<PixelSum>()) as u64;
        let mut arguments: [*mut c_void; 3] =
            [(&raw mut arena).cast(), (&raw mut pixels).cast(), (&raw mut params).cast()];
        let grid = [band.width.div_ceil(self.block[0]), band.height.div_ceil(self.block[1])];
        let kernel = self.module.function(self.kernel.name)?;
        let start = Event::record()?;
        #[allow(unsafe_code)]
        // SAFETY: these are the arguments of the kernel: the uploaded arena, which was checked when it
        // was packed and has only the kernel's kinds, the band's part of the film (asserted above),
        // and the parameters of both.
        unsafe {
            kernel.launch(grid, self.block, &mut arguments)?;
        }
        let end = Event::record()?;
        end.wait()?;
        end.seconds_since(&start)
    }

    /// Adds the film on the device to `film`: one piece is copied while the one before is added.
    fn download(&mut self, film: &mut Film) -> Result<(), BackendError> {
        let Some(source) = &self.film else { return Ok(()) };
        let pieces: Vec<(usize, usize)> = (0..film.pixels.len())
            .step_by(DOWNLOAD_PIXELS)
            .map(|first| (first, DOWNLOAD_PIXELS.min(film.pixels.len() - first)))
            .collect();
        let mut in_flight: Option<(usize, usize, usize, Event)> = None;
        for (i, &(first, count)) in pieces.iter().enumerate() {
            let slot = i % 2;
            self.staging[slot].start_download(source, first, count)?;
            let done = Event::record()?;
            if let Some((slot, first, count, done)) = in_flight.take() {
                done.wait()?;
                add(&mut film.pixels[first..first + count], self.staging[slot].records(count));
            }
            in_flight = Some((slot, first, count, done));
        }
        if let Some((slot, first, count, done)) = in_flight {
            done.wait()?;
            add(&mut film.pixels[first..first + count], self.staging[slot].records(count));
        }
        Ok(())
    }
}

impl Drop for CudaBackend {
    fn drop(&mut self) {
        // What is given back next belongs to this context, and another may be current by now. A device
        // that is gone has nothing to be given back.
        let _ = self.context.make_current();
    }
}

fn add(pixels: &mut [PixelSum], others: &[PixelSum]) {
    for (sum, other) in pixels.iter_mut().zip(others) {
        sum.merge(other);
    }
}

fn check_block(block: [u32; 2], max_threads: u32) -> Result<(), BackendError> {
    let n = u64::from(block[0]) * u64::from(block[1]);
    if n == 0 || n > u64::from(max_threads) {
        let message = format!(
            "blocks of {}x{} threads: a block may have 1 to {max_threads} threads on this device",
            block[0], block[1]
        );
        return Err(BackendError::new(BackendErrorKind::InvalidOption, message));
    }
    Ok(())
}

fn out_of_memory(what: &str, needed: u64, free: u64) -> BackendError {
    let message = format!(
        "{what} needs {} MiB of memory on the device, and {} MiB are free",
        needed.div_ceil(1 << 20),
        free >> 20
    );
    BackendError::new(BackendErrorKind::OutOfMemory, message)
}

impl Backend for CudaBackend {
    fn info(&self) -> BackendInfo {
        self.info.clone()
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        self.context.make_current()?;
        let len = film.pixels.len();
        if self.film.as_ref().is_none_or(|f| f.len() != len) {
            self.film = None;
            let size = (len * size_of::<PixelSum>()) as u64;
            let (free, _) = self.context.memory()?;
            if size > free {
                return Err(out_of_memory("the film", size, free));
            }
            self.film = Some(DeviceBuffer::new(len)?);
        }
        if let Some(film) = &mut self.film {
            film.clear()?;
        }
        let n_done = self.launch_all(film.region, samples, control)?;
        if n_done > 0 {
            let start = Instant::now();
            self.download(film)?;
            self.times.download_s += start.elapsed().as_secs_f64();
        }
        Ok(n_done)
    }

    fn times(&self) -> Times {
        self.times
    }
}
