//! What is wrong with a description, and where.

use std::fmt;

/// One step into a description.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum PathPart {
    /// A field of a table.
    Key(String),
    /// An element of an array, from 0.
    Index(usize),
}

impl From<&str> for PathPart {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for PathPart {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// The way from the root of a description to a value, such as `objects[3].boundary.radius`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct KeyPath(pub Vec<PathPart>);

impl KeyPath {
    /// This path and one more step.
    pub fn join(&self, part: impl Into<PathPart>) -> Self {
        let mut parts = self.0.clone();
        parts.push(part.into());
        Self(parts)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, part) in self.0.iter().enumerate() {
            match part {
                PathPart::Index(index) => write!(f, "[{index}]")?,
                PathPart::Key(key) => {
                    let dot = if i > 0 { "." } else { "" };
                    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                    if !key.is_empty() && key.chars().all(is_bare) {
                        write!(f, "{dot}{key}")?;
                    } else {
                        write!(f, "{dot}{key:?}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// One thing that is wrong with a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where it is.
    pub path: KeyPath,
    /// What is wrong, as a sentence without its full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.0.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        f.write_str(&self.message)?;
        if let Some(help) = &self.help {
            write!(f, " (help: {help})")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{KeyPath, Problem};

    #[test]
    fn paths_read_like_toml() {
        let path = KeyPath::default().join("objects").join(3).join("boundary").join("radius");
        assert_eq!(path.to_string(), "objects[3].boundary.radius");
        let path = KeyPath::default().join("materials").join("sea green");
        assert_eq!(path.to_string(), "materials.\"sea green\"");
    }

    #[test]
    fn a_problem_reads_as_one_line() {
        let path = KeyPath::default().join("camera").join("width");
        let problem =
            Problem { path, message: "too wide".to_owned(), help: Some("narrow it".to_owned()) };
        assert_eq!(problem.to_string(), "camera.width: too wide (help: narrow it)");
    }
}
