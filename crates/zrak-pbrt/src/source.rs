//! The files of a scene: where they may be, and which are open.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use zrak_mesh::{Limits, TriangleMesh, loop_subdivide, ply};

use crate::error::{Fault, Result, Span};
use crate::{ImportOptions, Warning};

/// How deep files may include each other.
const DEPTH_MAX: usize = 64;

/// What an opened file takes at least of the limit of bytes: files of a few bytes that include each other
/// many times would be read for ever before they reached it.
const FILE_COST_MIN: u64 = 4096;

/// Where files are.
#[derive(Debug)]
pub(crate) enum Store {
    /// On disk.
    Disk,
    /// In memory, by their paths relative to the scene's folder.
    Memory(BTreeMap<PathBuf, Vec<u8>>),
}

impl Store {
    pub(crate) fn is_file(&self, path: &Path) -> bool {
        match self {
            Self::Disk => path.is_file(),
            Self::Memory(files) => files.contains_key(&plain(path)),
        }
    }

    /// The one path of a file that several may lead to, if it exists.
    fn canonical(&self, path: &Path) -> Option<PathBuf> {
        match self {
            Self::Disk => path.canonicalize().ok(),
            Self::Memory(_) => Some(plain(path)),
        }
    }

    /// The bytes of a file, unpacked.
    fn read(&self, path: &Path, limits: &Limits) -> std::result::Result<Vec<u8>, String> {
        match self {
            Self::Disk => zrak_mesh::read_file(path, limits).map_err(|error| error.to_string()),
            Self::Memory(files) => match files.get(&plain(path)) {
                Some(bytes) => zrak_mesh::unpack(bytes.clone(), path, limits)
                    .map_err(|error| error.to_string()),
                None => Err(format!("cannot read {}: there is no such file", path.display())),
            },
        }
    }
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            _ => plain.push(part),
        }
    }
    plain
}

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
    store: Store,
    options: ImportOptions,
    n_bytes: u64,
}

impl Sources {
    pub(crate) fn new(base: &Path, store: Store, options: ImportOptions) -> Self {
        let base = if base.as_os_str().is_empty() { Path::new(".") } else { base };
        Self {
            files: Vec::new(),
            open: Vec::new(),
            base: base.to_owned(),
            store,
            options,
            n_bytes: 0,
        }
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
        if let (Some(real), Some(base)) =
            (self.store.canonical(&path), self.store.canonical(&self.base))
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
        let bytes =
            self.store.read(path, &self.limits()).map_err(|message| Fault::new(span, message))?;
        self.spend(FILE_COST_MIN.max(bytes.len() as u64), span)?;
        String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            Fault::new(span, format!("{} is not UTF-8 text (byte {at})", path.display()))
        })
    }

    /// The mesh of a PLY file.
    pub(crate) fn mesh(&self, path: &Path, span: &Span) -> Result<TriangleMesh> {
        let limits = self.limits();
        let mesh = match &self.store {
            Store::Disk => ply::read(path, &limits).map_err(|error| error.to_string()),
            store => store.read(path, &limits).and_then(|bytes| {
                ply::parse(&bytes, &limits)
                    .map_err(|error| error.in_file(path.display()).to_string())
            }),
        };
        mesh.map_err(|message| Fault::new(span, message))
    }

    /// A control mesh, subdivided.
    pub(crate) fn subdivided(
        &self,
        control: &TriangleMesh,
        levels: u32,
    ) -> std::result::Result<TriangleMesh, zrak_mesh::Error> {
        loop_subdivide(&control.positions, &control.triangles, levels, &self.limits())
    }

    /// Counts what was made of the files towards the limit.
    pub(crate) fn spend(&mut self, n_bytes: u64, span: &Span) -> Result<()> {
        self.n_bytes = self.n_bytes.saturating_add(n_bytes);
        if self.n_bytes <= self.options.max_bytes {
            return Ok(());
        }
        let message = format!(
            "the scene's files and meshes take more than the limit of {} bytes",
            self.options.max_bytes
        );
        Err(Fault::new(span, message).help("raise the limit if the scene is meant"))
    }

    /// Whether pictures can be looked at: of those of a scene in memory only the paths are known.
    pub(crate) fn has_pictures(&self) -> bool {
        matches!(self.store, Store::Disk)
    }

    pub(crate) fn is_file(&self, path: &Path) -> bool {
        self.store.is_file(path)
    }

    /// Opens a file, to be read before the rest of those that are open.
    pub(crate) fn enter(&mut self, path: PathBuf, is_import: bool, span: &Span) -> Result<()> {
        if self.open.len() >= DEPTH_MAX {
            let message = format!("files include each other more than {DEPTH_MAX} deep");
            return Err(Fault::new(span, message));
        }
        let canonical = self.store.canonical(&path).unwrap_or_else(|| path.clone());
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
