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

/// Reads numbers as long as there are only blanks between them; gives where it stopped, before whatever
/// is no number or is left to those who tell what is wrong with it.
pub(crate) fn numbers(text: &str, at: usize, out: &mut Vec<f64>) -> usize {
    let bytes = text.as_bytes();
    let mut i = at;
    loop {
        while i < bytes.len() && matches!(bytes[i], b' ' | b'\t' | b'\r' | b'\n') {
            i += 1;
        }
        let start = i;
        let mut integer = 0_u64;
        while i < bytes.len() && bytes[i].is_ascii_digit() {
            integer = integer.wrapping_mul(10).wrapping_add(u64::from(bytes[i] - b'0'));
            i += 1;
        }
        let n_digits = i - start;
        while i < bytes.len() && matches!(bytes[i], b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E')
        {
            i += 1;
        }
        let ends =
            bytes.get(i).is_none_or(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b']' | b'#'));
        if i == start || !ends {
            return start;
        }
        if n_digits == i - start && n_digits <= 15 {
            out.push(integer as f64);
            continue;
        }
        match text.get(start..i).map(str::parse::<f64>) {
            Some(Ok(x)) if x.is_finite() => out.push(x),
            _ => return start,
        }
    }
}
