//! Text to tokens.

use std::ops::Range;

use crate::error::{Fault, Result, Span};

/// A token, by where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A directive, a number, `true` or `false`.
    Word,
    /// In quotes, which are part of the range.
    String,
    /// [
    Open,
    /// ]
    Close,
}

/// The first token of `text` at or after byte `at`, if there is one.
pub(crate) fn next(text: &str, at: usize, file: usize) -> Result<Option<(Kind, Range<usize>)>> {
    let bytes = text.as_bytes();
    let mut i = at;
    while i < bytes.len() {
        match bytes[i] {
            b' ' | b'\t' | b'\r' | b'\n' => i += 1,
            b'#' => {
                while i < bytes.len() && bytes[i] != b'\n' {
                    i += 1;
                }
            }
            b'[' => return Ok(Some((Kind::Open, i..i + 1))),
            b']' => return Ok(Some((Kind::Close, i..i + 1))),
            b'"' => {
                let start = i;
                i += 1;
                while i < bytes.len() && bytes[i] != b'"' && bytes[i] != b'\n' {
                    i += if bytes[i] == b'\\' { 2 } else { 1 };
                }
                if i >= bytes.len() || bytes[i] != b'"' {
                    let end = i.min(bytes.len());
                    let span = Span { file, bytes: start..end };
                    let fault = Fault::new(&span, "the string has no end");
                    return Err(fault.help("strings end with a quote on the same line"));
                }
                return Ok(Some((Kind::String, start..i + 1)));
            }
            _ => {
                let start = i;
                let is_part =
                    |b: u8| !matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'"' | b'[' | b']' | b'#');
                while i < bytes.len() && is_part(bytes[i]) {
                    i += 1;
                }
                return Ok(Some((Kind::Word, start..i)));
            }
        }
    }
    Ok(None)
}

/// What a string in quotes says.
pub(crate) fn unquote(quoted: &str) -> String {
    let inner = quoted.strip_prefix('"').and_then(|s| s.strip_suffix('"')).unwrap_or(quoted);
    if !inner.contains('\\') {
        return inner.to_owned();
    }
    let mut out = String::with_capacity(inner.len());
    let mut chars = inner.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some('n') => out.push('\n'),
            Some('t') => out.push('\t'),
            Some('r') => out.push('\r'),
            Some('b') => out.push('\u{8}'),
            Some('f') => out.push('\u{c}'),
            Some(other) => out.push(other),
            None => {}
        }
    }
    out
}
