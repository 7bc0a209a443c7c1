//! From a path in a description to a place in the text.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::validate::{KeyPath, PathPart};

/// The span of the value at `path`, or of the nearest value around it that the text has.
pub(super) fn find(tree: &Spanned<DeTable<'_>>, path: &KeyPath) -> Range<usize> {
    let mut parts = path.0.iter();
    // The root's own span is the whole text: point to its beginning.
    let Some(PathPart::Key(key)) = parts.next() else { return 0..0 };
    let Some(mut value) = tree.get_ref().get(key.as_str()) else { return 0..0 };
    for part in parts {
        let inner = match (part, value.get_ref()) {
            (PathPart::Key(key), DeValue::Table(table)) => table.get(key.as_str()),
            (PathPart::Index(i), DeValue::Array(array)) => array.get(*i),
            _ => None,
        };
        let Some(inner) = inner else { break };
        value = inner;
    }
    value.span()
}
