//! A rustc that can build `core` for the GPU.
//!
//! The target nvptx64 comes without a compiled `core`, so the compiler needs its own library's sources:
//! Debian's packages `rustc-web cargo-web rust-web-src`, or a rustup nightly with `rust-src`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

/// A compiler and its cargo.
pub(super) struct Toolchain {
    pub(super) rustc: PathBuf,
    pub(super) cargo: PathBuf,
    /// What `rustc --version` says.
    pub(super) version: String,
}

impl Toolchain {
    /// The one asked for, or the first that there is.
    pub(super) fn find(asked_for: Option<&Path>) -> anyhow::Result<Self> {
        if let Some(rustc) = asked_for {
            return Self::at(rustc);
        }
        let mut candidates = vec![PathBuf::from("/usr/bin/rustc")];
        if let Some(nightly) = rustup_nightly() {
            candidates.push(nightly);
        }
        for rustc in &candidates {
            if let Ok(toolchain) = Self::at(rustc) {
                return Ok(toolchain);
            }
        }
        bail!(
            "no rustc with the sources of its library: install Debian's rustc-web, cargo-web and \
             rust-web-src, or `rustup toolchain install nightly --component rust-src`, or name one \
             by --rustc"
        )
    }

    fn at(rustc: &Path) -> anyhow::Result<Self> {
        let sysroot = PathBuf::from(say(rustc, &["--print", "sysroot"])?);
        let library = sysroot.join("lib/rustlib/src/rust/library/core/Cargo.toml");
        if !library.exists() {
            bail!("{} has no library sources at {}", rustc.display(), library.display());
        }
        let cargo = rustc.with_file_name("cargo");
        if !cargo.exists() {
            bail!("there is no cargo beside {}", rustc.display());
        }
        Ok(Self { rustc: rustc.to_owned(), cargo, version: say(rustc, &["--version"])? })
    }
}

/// The first line that a program prints.
fn say(program: &Path, arguments: &[&str]) -> anyhow::Result<String> {
    let output = Command::new(program)
        .args(arguments)
        .output()
        .with_context(|| format!("cannot run {}", program.display()))?;
    if !output.status.success() {
        bail!("{} {} failed", program.display(), arguments.join(" "));
    }
    Ok(String::from_utf8_lossy(&output.stdout).lines().next().unwrap_or_default().to_owned())
}

fn rustup_nightly() -> Option<PathBuf> {
    let path = say(Path::new("rustup"), &["which", "--toolchain", "nightly", "rustc"]).ok()?;
    Some(PathBuf::from(path))
}
