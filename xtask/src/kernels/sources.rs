//! The sources of the kernels, as one hash.

use std::path::{Path, PathBuf};

use anyhow::Context;
use sha2::{Digest, Sha256};

/// Files and folders that the PTX depends on.
const SOURCES: [&str; 5] = [
    "crates/zrak-core/Cargo.toml",
    "crates/zrak-core/src",
    "crates/zrak-kernels/Cargo.toml",
    "crates/zrak-kernels/Cargo.lock",
    "crates/zrak-kernels/src",
];

/// SHA-256 over names and contents, in hexadecimal. Tests are left out: they are not compiled in.
pub(super) fn hash(root: &Path) -> anyhow::Result<String> {
    let mut files = Vec::new();
    for source in SOURCES {
        collect(&root.join(source), &mut files)?;
    }
    files.sort();
    let mut hasher = Sha256::new();
    for file in files {
        let name = file.strip_prefix(root)?.to_string_lossy().replace('\\', "/");
        let content =
            std::fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
        hasher.update((name.len() as u64).to_le_bytes());
        hasher.update(name.as_bytes());
        hasher.update((content.len() as u64).to_le_bytes());
        hasher.update(&content);
    }
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let is_test = path.file_stem().is_some_and(|stem| stem == "tests" || stem == "testing");
    if is_test {
        return Ok(());
    }
    if path.is_dir() {
        let entries =
            std::fs::read_dir(path).with_context(|| format!("cannot read {}", path.display()))?;
        for entry in entries {
            collect(&entry?.path(), files)?;
        }
    } else {
        files.push(path.to_owned());
    }
    Ok(())
}
