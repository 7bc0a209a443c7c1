//! Scene files: TOML in, TOML out.
//!
//! Reading has four steps, each of which sees only what passed the one before: TOML to a tree that
//! knows where in the text each value stands (the `toml` crate); the tree's shape against the
//! format's schema (`shape`); the tree to a [`SceneDesc`] (serde); the description's meaning
//! ([`crate::validate`]). What the second and fourth find is shown at its place in the text.

mod shape;
mod spans;
mod write;

#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;
use toml::de::DeTable;

pub use write::write_string;

use crate::desc::SceneDesc;
use crate::error::{SceneError, SceneErrorKind};
use crate::validate::{FORMAT, KeyPath, Problem, validate};

/// Larger files, in bytes, are not read.
pub const FILE_SIZE_MAX: u64 = 256 << 20;

/// A scene from a file.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene, without problems.
    pub desc: SceneDesc,
    /// The folder of the file: paths of images start here.
    pub base_dir: PathBuf,
    /// The file it came from.
    pub source: Source,
}

/// A text and what to call it.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path of the file, or any other name.
    pub origin: String,
    /// What is in it.
    pub text: String,
}

impl Source {
    /// An error that shows `problems`, at least one, at their places in the text: for what is found
    /// wrong with a scene after it was read, such as an image that is missing.
    pub fn error(&self, problems: Vec<Problem>) -> SceneError {
        locate(&self.origin, &self.text, problems)
    }
}

/// Reads a scene file.
pub fn read(path: impl AsRef<Path>) -> Result<LoadedScene, SceneError> {
    read_within(path, FILE_SIZE_MAX)
}

/// Reads a scene file of at most so many bytes, and at most [`FILE_SIZE_MAX`].
pub fn read_within(path: impl AsRef<Path>, max_bytes: u64) -> Result<LoadedScene, SceneError> {
    let path = path.as_ref();
    let text = read_text(path, max_bytes.min(FILE_SIZE_MAX))?;
    let source = Source { origin: path.display().to_string(), text };
    let desc = parse(&source.text, &source.origin)?;
    let base_dir = path.parent().unwrap_or(Path::new("")).to_owned();
    Ok(LoadedScene { desc, base_dir, source })
}

/// Reads a scene from a text; `origin` is what errors call it.
pub fn parse(text: &str, origin: &str) -> Result<SceneDesc, SceneError> {
    let tree = parse_tree(text, origin)?;
    let desc = to_desc(tree, text, origin)?;
    let problems = validate(&desc);
    if problems.is_empty() { Ok(desc) } else { Err(locate(origin, text, problems)) }
}

/// An error that shows problems of a description in the text it came from.
fn locate(origin: &str, text: &str, problems: Vec<Problem>) -> SceneError {
    let (tree, _) = DeTable::parse_recoverable(text);
    let with_span = |problem: Problem| {
        let span = spans::find(&tree, &problem.path);
        (problem, span)
    };
    let located = problems.into_iter().map(with_span).collect();
    SceneError::text(SceneErrorKind::Invalid, origin, text, located)
}

/// Text to tree: syntax.
fn parse_tree<'a>(text: &'a str, origin: &str) -> Result<Spanned<DeTable<'a>>, SceneError> {
    let (tree, errors) = DeTable::parse_recoverable(text);
    let place = |error: &toml::de::Error| error.span().unwrap_or(0..0);
    // One slip makes the parser stumble over much that follows: only the first is worth showing.
    let Some(first) = errors.into_iter().min_by_key(|error| place(error).start) else {
        return Ok(tree);
    };
    let span = place(&first);
    let (message, help) = if first.message().contains("recur") {
        let help = "values and keys can be nested at most 80 deep; write groups in groups as \
                    `[[objects.objects]]` tables";
        ("nested too deeply".to_owned(), Some(help.to_owned()))
    } else {
        (first.message().to_owned(), Some("this is not TOML; see https://toml.io".to_owned()))
    };
    let problem = Problem { path: KeyPath::default(), message, help };
    let problems = vec![(problem, span)];
    Err(SceneError::text(SceneErrorKind::Syntax, origin, text, problems))
}

/// Tree to description: version, shape, types.
fn to_desc(tree: Spanned<DeTable<'_>>, text: &str, origin: &str) -> Result<SceneDesc, SceneError> {
    let error = |kind, problems: Vec<(Problem, Range<usize>)>| {
        SceneError::text(kind, origin, text, problems)
    };
    // A file of another version may contain anything: say nothing else about it.
    if let Some(problem) = unknown_format(&tree) {
        return Err(error(SceneErrorKind::UnsupportedFormat, vec![problem]));
    }
    let problems = shape::check(&tree);
    if !problems.is_empty() {
        return Err(error(SceneErrorKind::Invalid, problems));
    }
    SceneDesc::deserialize(toml::Deserializer::from(tree)).map_err(|serde_error| {
        // Only what the schema does not say can get here.
        let span = serde_error.span().unwrap_or(0..0);
        let message = serde_error.message().to_owned();
        let problem = Problem { path: KeyPath::default(), message, help: None };
        error(SceneErrorKind::Invalid, vec![(problem, span)])
    })
}

fn unknown_format(tree: &Spanned<DeTable<'_>>) -> Option<(Problem, Range<usize>)> {
    let value = tree.get_ref().get("format")?;
    let format = value.get_ref().as_integer()?.to_string();
    if format == FORMAT.to_string() {
        return None;
    }
    let problem = Problem {
        path: KeyPath::default().join("format"),
        message: format!("format {format} is not known; this zrak reads {FORMAT}"),
        help: Some("the file may have been written for a newer zrak".to_owned()),
    };
    Some((problem, value.span()))
}

fn read_text(path: &Path, max_bytes: u64) -> Result<String, SceneError> {
    let origin = path.display().to_string();
    let io_error = |io: io::Error| {
        let help = match io.kind() {
            io::ErrorKind::NotFound => {
                Some("check the path; relative paths start at the current folder")
            }
            io::ErrorKind::PermissionDenied => Some("check that you may read it"),
            _ => None,
        };
        let message = match io.kind() {
            io::ErrorKind::NotFound => "there is no such scene file".to_owned(),
            _ => format!("cannot read the scene file: {io}"),
        };
        SceneError::file(SceneErrorKind::Io, &origin, message, help)
    };
    let other =
        |kind, message: &str, help| SceneError::file(kind, &origin, message.to_owned(), Some(help));

    if path.is_dir() {
        let help = "name the scene file in it, such as `scene.toml`";
        return Err(other(SceneErrorKind::Io, "this is a folder, not a scene file", help));
    }
    let mut bytes = Vec::new();
    // One byte more than the limit tells a file that is too large, however it grows.
    let mut reader = File::open(path).map_err(io_error)?.take(max_bytes + 1);
    reader.read_to_end(&mut bytes).map_err(io_error)?;
    if bytes.len() as u64 > max_bytes {
        if max_bytes < FILE_SIZE_MAX {
            let help = "if the scene is meant to be so large, raise the limit (--max-bytes)";
            let message = format!("the file has more than the {max_bytes} bytes it may have");
            return Err(other(SceneErrorKind::TooLarge, &message, help));
        }
        let help = "a scene file is TOML text of at most 256 MiB; is this another kind of file?";
        return Err(other(SceneErrorKind::TooLarge, "the file is too large for a scene", help));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let message = format!("the file is not UTF-8 text (line {line}, byte {valid})");
        other(SceneErrorKind::Encoding, &message, "a scene file is TOML text: save it as UTF-8")
    })
}
