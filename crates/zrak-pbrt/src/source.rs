//! The files of a scene: where they may be, and which are open.

use std::path::{Component, Path, PathBuf};

use zrak_mesh::Limits;

use crate::error::{Fault, Result, Span};
use crate::{ImportOptions, Warning};

/// How deep files may include each other.
const DEPTH_MAX: usize = 64;

/// A file that was read.
#[derive(Debug)]
pub(crate) struct File {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
}

/// An open file.
#[derive(Debug)]
pub(crate) struct Open {
    /// Index of the file.
    pub(crate) file: usize,
    /// How far it has been read, in bytes.
    pub(crate) at: usize,
    /// Whether what it changes in the graphics state is forgotten at its end.
    pub(crate) is_import: bool,
    canonical: PathBuf,
}

/// All files, and those that are open, the innermost last.
#[derive(Debug)]
pub(crate) struct Sources {
    pub(crate) files: Vec<File>,
    pub(crate) open: Vec<Open>,
    base: PathBuf,
    options: ImportOptions,
    n_bytes: u64,
}

impl Sources {
    pub(crate) fn new(base: &Path, options: ImportOptions) -> Self {
        let base = if base.as_os_str().is_empty() { Path::new(".") } else { base };
        Self { files: Vec::new(), open: Vec::new(), base: base.to_owned(), options, n_bytes: 0 }
    }

    pub(crate) fn base(&self) -> &Path {
        &self.base
    }

    /// Path of a file that the scene names, relative to the scene's folder, if it may be read.
    pub(crate) fn resolve(&self, name: &str, span: &Span) -> Result<PathBuf> {
        let path = self.base.join(name);
        if self.options.allow_external {
            return Ok(path);
        }
        let help = "move the file there, or allow files from elsewhere with --allow-external";
        let leaves =
            || Fault::new(span, format!("\"{name}\" is outside of the scene's folder")).help(help);
        let relative = Path::new(name);
        let mut depth = 0_i32;
        for part in relative.components() {
            match part {
                Component::Normal(_) => depth += 1,
                Component::CurDir => {}
                Component::ParentDir => depth -= 1,
                Component::RootDir | Component::Prefix(_) => return Err(leaves()),
            }
            if depth < 0 {
                return Err(leaves());
            }
        }
        // A link may lead anywhere.
        if let (Ok(real), Ok(base)) = (path.canonicalize(), self.base.canonicalize())
            && !real.starts_with(base)
        {
            return Err(leaves());
        }
        Ok(path)
    }

    /// How much may still be read.
    pub(crate) fn limits(&self) -> Limits {
        Limits { max_bytes: self.options.max_bytes.saturating_sub(self.n_bytes) }
    }

    /// The text of a file, which counts towards the limit.
    pub(crate) fn read(&mut self, path: &Path, span: &Span) -> Result<String> {
        let bytes = zrak_mesh::read_file(path, &self.limits())
            .map_err(|error| Fault::new(span, error.to_string()))?;
        self.n_bytes += bytes.len() as u64;
        String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            Fault::new(span, format!("{} is not UTF-8 text (byte {at})", path.display()))
        })
    }

    /// Opens a file, to be read before the rest of those that are open.
    pub(crate) fn enter(&mut self, path: PathBuf, is_import: bool, span: &Span) -> Result<()> {
        if self.open.len() >= DEPTH_MAX {
            let message = format!("files include each other more than {DEPTH_MAX} deep");
            return Err(Fault::new(span, message));
        }
        let canonical = path.canonicalize().unwrap_or_else(|_| path.clone());
        if self.open.iter().any(|open| open.canonical == canonical) {
            return Err(Fault::new(span, format!("{} includes itself", path.display())));
        }
        let text = self.read(&path, span)?;
        self.files.push(File { path, text });
        let file = self.files.len() - 1;
        self.open.push(Open { file, at: 0, is_import, canonical });
        Ok(())
    }

    /// The text of a file from a byte on.
    pub(crate) fn text(&self, file: usize) -> &str {
        &self.files[file].text
    }

    pub(crate) fn warning(&self, span: &Span, message: impl Into<String>) -> Warning {
        let file = &self.files[span.file];
        let before = &file.text.as_bytes()[..span.bytes.start.min(file.text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        Warning { file: file.path.clone(), line, message: message.into() }
    }
}
