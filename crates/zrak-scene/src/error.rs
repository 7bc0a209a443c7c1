//! Why a scene could not be read, in words that show the place and the way out.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::validate::{KeyPath, Problem};

/// A scene could not be read, or cannot be rendered.
///
/// `Display` gives whole diagnostics of several lines, each starting with `error:`, in plain text;
/// [`SceneError::styled`] gives the same with colours for a terminal.
pub struct SceneError(Box<Inner>);

struct Inner {
    kind: SceneErrorKind,
    diagnostics: Vec<Diagnostic>,
    n_problems: usize,
    origin: String,
}

/// What sort of error it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SceneErrorKind {
    /// The file could not be read.
    Io,
    /// The file is too large to be a scene.
    TooLarge,
    /// The file is not text in UTF-8.
    Encoding,
    /// The text is not TOML.
    Syntax,
    /// The format's version is unknown.
    UnsupportedFormat,
    /// The scene is TOML, but it is not a scene that can be rendered.
    Invalid,
    /// A compiled scene is not as it was written, or leads astray.
    Damaged,
}

/// A problem and its place in the text.
struct Diagnostic {
    problem: Problem,
    place: Option<Place>,
}

/// A line of a text, and the part of it that matters.
struct Place {
    /// Counted from 1.
    line: usize,
    /// In characters, counted from 1.
    column: usize,
    text: String,
    /// In bytes of `text`.
    span: Range<usize>,
}

/// More problems than this are counted, not shown.
const SHOWN_MAX: usize = 10;

/// A longer message, in bytes, is cut.
const TITLE_MAX: usize = 500;

/// A longer line, in bytes, is not shown.
const LINE_MAX: usize = 4096;

impl SceneError {
    /// A problem with the file `origin` as a whole.
    #[must_use]
    pub fn file(kind: SceneErrorKind, origin: &str, message: String, help: Option<&str>) -> Self {
        let problem = Problem { path: KeyPath::default(), message, help: help.map(str::to_owned) };
        let diagnostics = vec![Diagnostic { problem, place: None }];
        Self(Box::new(Inner { kind, diagnostics, n_problems: 1, origin: origin.to_owned() }))
    }

    /// Problems, at least one, of the text of the file `origin`, each with its span in bytes. They
    /// are put in the order of the text.
    #[must_use]
    pub fn text(
        kind: SceneErrorKind,
        origin: &str,
        text: &str,
        mut problems: Vec<(Problem, Range<usize>)>,
    ) -> Self {
        problems.sort_by_key(|(_, span)| span.start);
        let n_problems = problems.len();
        let diagnostics = problems
            .into_iter()
            .take(SHOWN_MAX)
            .map(|(problem, span)| Diagnostic { problem, place: Some(Place::new(text, span)) })
            .collect();
        let origin = origin.to_owned();
        Self(Box::new(Inner { kind, diagnostics, n_problems, origin }))
    }

    /// A problem of a line of the file `origin`, by its number and its text, of which the part `span`, in
    /// bytes, matters: for files too large to be kept as a text.
    #[must_use]
    pub fn line(
        kind: SceneErrorKind,
        origin: &str,
        (line, text): (usize, &str),
        span: Range<usize>,
        message: String,
    ) -> Self {
        let problem = Problem { path: KeyPath::default(), message, help: None };
        let place = Some(Place { line, ..Place::new(text, span) });
        let diagnostics = vec![Diagnostic { problem, place }];
        Self(Box::new(Inner { kind, diagnostics, n_problems: 1, origin: origin.to_owned() }))
    }

    /// What sort of error it is.
    pub fn kind(&self) -> SceneErrorKind {
        self.0.kind
    }

    /// The problems that are shown, at most 10.
    pub fn problems(&self) -> impl Iterator<Item = &Problem> {
        self.0.diagnostics.iter().map(|diagnostic| &diagnostic.problem)
    }

    /// Line and column of the first problem, in characters counted from 1, if it has a place.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let place = self.0.diagnostics.first()?.place.as_ref()?;
        Some((place.line, place.column))
    }

    /// The diagnostics with colours for a terminal.
    pub fn styled(&self) -> String {
        self.render(&Renderer::styled())
    }

    fn render(&self, renderer: &Renderer) -> String {
        let inner = &self.0;
        // rustc's plain characters, on every platform.
        let renderer = renderer.clone().decor_style(DecorStyle::Ascii);
        let mut shown: Vec<String> = inner
            .diagnostics
            .iter()
            .map(|diagnostic| renderer.render(&[diagnostic.group(&inner.origin)]))
            .collect();
        if inner.n_problems > inner.diagnostics.len() {
            let n_more = inner.n_problems - inner.diagnostics.len();
            let s = if n_more == 1 { "" } else { "s" };
            let title = format!("{n_more} more problem{s} in this file");
            shown.push(renderer.render(&[Group::with_title(Level::ERROR.primary_title(title))]));
        }
        shown.join("\n\n")
    }
}

impl Diagnostic {
    fn group<'a>(&'a self, origin: &'a str) -> Group<'a> {
        let title = Level::ERROR.primary_title(one_line(&self.problem.message));
        let origin = one_line(origin);
        let group = match &self.place {
            None => title.element(Origin::path(origin)),
            Some(place) if place.text.len() > LINE_MAX => {
                let place = Origin::path(origin).line(place.line).char_column(place.column);
                title.element(place)
            }
            Some(place) => {
                let mut annotation = AnnotationKind::Primary.span(place.span.clone());
                if !self.problem.path.0.is_empty() {
                    let path = self.problem.path.to_string();
                    annotation = annotation.label(one_line(&path).into_owned());
                }
                let snippet = Snippet::source(place.text.as_str())
                    .line_start(place.line)
                    .path(origin)
                    .annotation(annotation);
                title.element(snippet)
            }
        };
        match &self.problem.help {
            Some(help) => group.element(Level::HELP.message(one_line(help))),
            None => group,
        }
    }
}

/// `text` with its control characters written out, so that it cannot disturb a terminal, and cut
/// where it gets too long.
fn one_line(text: &str) -> Cow<'_, str> {
    if text.len() <= TITLE_MAX && !text.contains(char::is_control) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::new();
    for c in text.chars() {
        if c.is_control() {
            clean.extend(c.escape_default());
        } else {
            clean.push(c);
        }
        if clean.len() > TITLE_MAX {
            clean.push_str("...");
            break;
        }
    }
    Cow::Owned(clean)
}

impl Place {
    /// The place of `span`, which is cut to its first line and to whole characters.
    fn new(text: &str, span: Range<usize>) -> Self {
        let start = floor_char_boundary(text, span.start);
        // An error at the end of the text belongs to the last line that has something in it.
        let start = if start == text.len() { text.trim_end().len() } else { start };
        let end = floor_char_boundary(text, span.end).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let line_end = line_start + text[line_start..line_end].trim_end_matches('\r').len();
        let [start, end] = [start, end].map(|i| i.min(line_end));
        Self {
            line: text[..line_start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            text: text[line_start..line_end].to_owned(),
            span: start - line_start..end - line_start,
        }
    }
}

/// The last boundary between characters at or before `index`.
fn floor_char_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&Renderer::plain()))
    }
}

// `unwrap` and a test's `Result` show an error by `Debug`: let them show something to read.
impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SceneError ({:?})\n{self}", self.0.kind)
    }
}

impl std::error::Error for SceneError {}
