//! Numbers, strings and names as pbrt reads them.

use std::collections::BTreeSet;
use std::fmt::Write;

use zrak_scene::lower::Transform;

/// Numbers with blanks between them.
pub(super) fn numbers<T: std::fmt::Display>(values: impl IntoIterator<Item = T>) -> String {
    let mut out = String::new();
    for (i, x) in values.into_iter().enumerate() {
        if i > 0 {
            out.push(' ');
        }
        let _ = write!(out, "{x}");
    }
    out
}

/// A string in quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A parameter of one or more numbers.
pub(super) fn param<T: std::fmt::Display>(
    kind: &str,
    name: &str,
    values: impl IntoIterator<Item = T>,
) -> String {
    format!(" \"{kind} {name}\" [ {} ]", numbers(values))
}

/// A parameter that is a string, or the name of a texture.
pub(super) fn word(kind: &str, name: &str, value: &str) -> String {
    format!(" \"{kind} {name}\" [ {} ]", quoted(value))
}

/// Sets the map: its columns, as pbrt has them.
pub(super) fn transform(map: &Transform) -> String {
    let column = |j: usize| [0, 1, 2].map(|i| map.rows[i][j]);
    let columns = (0..4).flat_map(|j| {
        let [x, y, z] = column(j);
        [x, y, z, if j == 3 { 1.0 } else { 0.0 }]
    });
    format!("Transform [ {} ]\n", numbers(columns))
}

/// A name of letters that every file system has.
pub(super) fn file_name(wanted: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let name: String = wanted.chars().map(|c| if is_plain(c) { c } else { '-' }).collect();
    let name = name.trim_start_matches('.');
    if name.is_empty() { "file".to_owned() } else { name.to_owned() }
}

/// A file name that is not taken, in any case of its letters.
pub(super) fn unique(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let (stem, extension) = match wanted.split_once('.') {
        Some((stem, extension)) => (stem, format!(".{extension}")),
        None => (wanted, String::new()),
    };
    let mut name = wanted.to_owned();
    let mut i = 1;
    while !taken.insert(name.to_lowercase()) {
        i += 1;
        name = format!("{stem}-{i}{extension}");
    }
    name
}
