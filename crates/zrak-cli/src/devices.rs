//! `zrak devices`: what can be rendered on.

use std::fmt::Write;

use clap::Args;
use serde::Serialize;

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::{machine, terminal, text};

/// Options of `zrak devices`.
#[derive(Args, Debug)]
pub(crate) struct DevicesArgs {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Devices {
    cpu: Cpu,
    cuda: Vec<Cuda>,
    /// Why `cuda` is empty, if it is.
    no_cuda: Option<String>,
}

#[derive(Serialize)]
struct Cpu {
    name: String,
    threads: usize,
    instruction_set: String,
}

#[derive(Serialize)]
struct Cuda {
    device: u32,
    name: String,
    compute_capability: String,
    memory_bytes: u64,
    multiprocessors: u32,
}

/// Prints the list.
pub(crate) fn run(args: &DevicesArgs) -> Result<Exit, Failure> {
    let devices = find();
    if args.json {
        terminal::print_json(&devices)?;
    } else {
        terminal::print(&describe(&devices))?;
    }
    Ok(Exit::Success)
}

fn find() -> Devices {
    let cpu = Cpu {
        name: machine::cpu_model(),
        threads: zrak::n_threads(None),
        instruction_set: zrak::cpu_instruction_set().to_owned(),
    };
    let (found, no_cuda) = match zrak::cuda::devices() {
        Ok(found) if found.is_empty() => (found, Some("the NVIDIA driver knows no device".into())),
        Ok(found) => (found, None),
        Err(error) => (Vec::new(), Some(error.to_string())),
    };
    let cuda = found.into_iter().map(|device| {
        let (major, minor) = device.compute_capability;
        Cuda {
            device: device.ordinal,
            name: device.name,
            compute_capability: format!("{major}.{minor}"),
            memory_bytes: device.memory_bytes,
            multiprocessors: device.n_multiprocessors,
        }
    });
    Devices { cpu, cuda: cuda.collect(), no_cuda }
}

fn describe(devices: &Devices) -> String {
    let Cpu { name, threads, instruction_set } = &devices.cpu;
    let threads = text::count(*threads, "thread");
    let mut out = format!("cpu     {name}, {threads}, {instruction_set}\n");
    for cuda in &devices.cuda {
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "cuda {}  {}, {:.1} GiB, {} multiprocessors, compute capability {}",
            cuda.device,
            cuda.name,
            cuda.memory_bytes as f64 / f64::from(1 << 30),
            cuda.multiprocessors,
            cuda.compute_capability
        );
    }
    if let Some(reason) = &devices.no_cuda {
        let _ = writeln!(out, "cuda    none: {reason}");
    }
    out
}
