//! Compiles the GPU kernels to PTX, and checks that the committed PTX is that of the sources.
//!
//! The PTX is committed so that users need neither a GPU compiler nor a nightly toolchain. It starts
//! with the hash of its sources and the version of its compiler, which is how the check knows whether
//! bytes must be equal.

mod header;
mod names;
mod sources;
mod toolchain;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};

use header::Header;
use toolchain::Toolchain;

/// Where the committed PTX lies.
const PTX: &str = "crates/zrak-cuda/ptx/zrak_kernels.ptx";
/// The crate that it is made from.
const CRATE: &str = "crates/zrak-kernels";
/// Turing, the oldest architecture that today's drivers take.
const TARGET_CPU: &str = "sm_75";
/// Architectures that the check assembles for: the oldest, and those of data centres and desks since.
const CHECKED_ARCHITECTURES: [&str; 4] = ["sm_75", "sm_86", "sm_90", "sm_120"];

/// Options of `cargo xtask kernels`.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Change nothing: rebuild, compare with the committed PTX, and assemble it.
    #[arg(long)]
    check: bool,
    /// rustc that can build `core` for nvptx64 (with its rust-src); found by itself if left out.
    #[arg(long, env = "ZRAK_KERNEL_RUSTC")]
    rustc: Option<PathBuf>,
    /// NVIDIA's assembler, for the check (PyPI's nvidia-cuda-nvcc has it).
    #[arg(long, env = "ZRAK_PTXAS", default_value = "ptxas")]
    ptxas: PathBuf,
}

/// Builds or checks.
pub(crate) fn run(root: &Path, options: &Options) -> anyhow::Result<()> {
    let toolchain = Toolchain::find(options.rustc.as_deref())?;
    println!("compiler: {}", toolchain.version);
    let body = compile(root, &toolchain)?;
    let sources = sources::hash(root)?;
    let built = Header { sources, compiler: toolchain.version.clone() }.with_body(&body);
    let committed = root.join(PTX);
    if !options.check {
        std::fs::write(&committed, &built)
            .with_context(|| format!("cannot write {}", committed.display()))?;
        println!("wrote {PTX} ({} bytes)", built.len());
        return Ok(());
    }
    let text = std::fs::read_to_string(&committed)
        .with_context(|| format!("cannot read {}", committed.display()))?;
    let header = Header::parse(&text)?;
    ensure!(
        header.sources == sources::hash(root)?,
        "{PTX} was made from other sources; run `cargo xtask kernels` and commit the result"
    );
    if header.compiler == toolchain.version {
        ensure!(text == built, "{PTX} differs from what its own compiler makes of its sources");
        println!("the committed PTX is what its compiler makes of its sources, byte for byte");
    } else {
        println!(
            "built with another compiler than the committed PTX ({}): bytes were not compared",
            header.compiler
        );
    }
    let scratch = root.join("target/kernels/rebuilt.ptx");
    std::fs::write(&scratch, &built)?;
    for architecture in CHECKED_ARCHITECTURES {
        assemble(&options.ptxas, architecture, &committed)?;
        assemble(&options.ptxas, architecture, &scratch)?;
    }
    Ok(())
}

/// Compiles the kernels; returns the PTX.
fn compile(root: &Path, toolchain: &Toolchain) -> anyhow::Result<String> {
    let target_dir = root.join("target/kernels");
    let output = target_dir.join("nvptx64-nvidia-cuda/release/deps/zrak_kernels.s");
    // An old output must not pass for a new one.
    if output.exists() {
        std::fs::remove_file(&output)?;
    }
    let status = Command::new(&toolchain.cargo)
        .current_dir(root.join(CRATE))
        .env("RUSTC", &toolchain.rustc)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTFLAGS", format!("-Ctarget-cpu={TARGET_CPU} -Zunstable-options"))
        .env("CARGO_TARGET_DIR", &target_dir)
        .env_remove("RUSTUP_TOOLCHAIN")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .args(["rustc", "--release", "--locked", "--target", "nvptx64-nvidia-cuda"])
        .args(["-Zbuild-std=core", "--", "--emit=asm", "-Clinker=/bin/true"])
        // With fat LTO the assembly is the whole program; there is nothing to link.
        .status()
        .with_context(|| format!("cannot run {}", toolchain.cargo.display()))?;
    ensure!(status.success(), "the kernels do not compile");
    let ptx = std::fs::read_to_string(&output)
        .with_context(|| format!("the compiler left no {}", output.display()))?;
    Ok(names::without_disambiguators(&ptx))
}

/// Assembles PTX and prints registers and spills.
fn assemble(ptxas: &Path, architecture: &str, ptx: &Path) -> anyhow::Result<()> {
    let output = Command::new(ptxas)
        .args(["-v", "-arch", architecture, "-o", "/dev/null"])
        .arg(ptx)
        .output()
        .with_context(|| {
            format!(
                "cannot run {}: install PyPI's nvidia-cuda-nvcc and give its ptxas by --ptxas",
                ptxas.display()
            )
        })?;
    let report = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        bail!("ptxas refuses {} for {architecture}:\n{report}", ptx.display());
    }
    let name = ptx.file_name().unwrap_or_default().to_string_lossy();
    for line in report.lines().filter(|l| l.contains("registers") || l.contains("spill")) {
        println!("{architecture} {name}: {}", line.trim_start_matches("ptxas info    :").trim());
    }
    Ok(())
}
