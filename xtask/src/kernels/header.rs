//! The first lines of the committed PTX.

use anyhow::Context;

const TITLE: &str = "// zrak's kernels, made by `cargo xtask kernels`; do not edit.";
const SOURCES: &str = "// sources: ";
const COMPILER: &str = "// compiler: ";

/// What PTX was made from, and by what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// SHA-256 of the sources, in hexadecimal.
    pub(super) sources: String,
    /// Version of rustc.
    pub(super) compiler: String,
}

impl Header {
    /// The file: this header and the PTX.
    pub(super) fn with_body(&self, body: &str) -> String {
        format!(
            "{TITLE}\n{SOURCES}{}\n{COMPILER}{}\n{}\n",
            self.sources,
            self.compiler,
            body.trim_end()
        )
    }

    /// The header of a file.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        let field = |prefix: &str| {
            text.lines()
                .take(3)
                .find_map(|line| line.strip_prefix(prefix))
                .map(str::to_owned)
                .with_context(|| format!("the PTX has no line '{prefix}...' at its start"))
        };
        Ok(Self { sources: field(SOURCES)?, compiler: field(COMPILER)? })
    }
}
