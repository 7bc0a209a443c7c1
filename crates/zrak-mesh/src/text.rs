//! Text made of lines and words, as OBJ, MTL and the text form of PLY are.
//!
//! Files are bytes until a word is looked at: one with a comment in another encoding than UTF-8 is as
//! good as any.

use std::borrow::Cow;
use std::ops::Range;

use crate::Error;

/// The lines of a text. A line that ends in a backslash goes on in the next, and is counted as the first.
#[derive(Clone, Debug)]
pub struct Lines<'a> {
    rest: &'a [u8],
    /// Lines that were given.
    n_lines: usize,
}

/// A line, without its end.
#[derive(Clone, Debug)]
pub struct Line<'a> {
    /// Counted from 1.
    pub number: usize,
    /// What is in it.
    pub bytes: Cow<'a, [u8]>,
}

impl<'a> Lines<'a> {
    /// The lines of a text, with or without a byte order mark.
    #[must_use]
    pub fn new(text: &'a [u8]) -> Self {
        Self { rest: text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text), n_lines: 0 }
    }

    fn physical(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = &self.rest[(end + 1).min(self.rest.len())..];
        self.n_lines += 1;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let first = self.physical()?;
        let number = self.n_lines;
        let Some(start) = first.strip_suffix(b"\\") else {
            return Some(Line { number, bytes: Cow::Borrowed(first) });
        };
        let mut joined = start.to_vec();
        loop {
            joined.push(b' ');
            let Some(next) = self.physical() else { break };
            match next.strip_suffix(b"\\") {
                Some(more) => joined.extend_from_slice(more),
                None => {
                    joined.extend_from_slice(next);
                    break;
                }
            }
        }
        Some(Line { number, bytes: Cow::Owned(joined) })
    }
}

impl Line<'_> {
    /// The words up to a `#`.
    #[must_use]
    pub fn words(&self) -> Words<'_> {
        Words { line: &self.bytes, at: 0 }
    }

    /// An error that shows a part of this line.
    #[must_use]
    pub fn error(&self, span: Range<usize>, message: impl Into<String>) -> Error {
        Error::at(self.number, &self.bytes, span, message)
    }
}

/// The words of a line.
#[derive(Clone, Debug)]
pub struct Words<'a> {
    line: &'a [u8],
    at: usize,
}

/// A word and where it stands in its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word<'a> {
    /// What it is.
    pub bytes: &'a [u8],
    /// Where it starts.
    pub start: usize,
}

impl<'a> Words<'a> {
    /// All that is left of the line, without spaces at both ends: a name that may have some in it.
    #[must_use]
    pub fn rest(&self) -> Word<'a> {
        let rest = &self.line[self.at..];
        let start = self.at + (rest.len() - rest.trim_ascii_start().len());
        Word { bytes: rest.trim_ascii(), start }
    }

    /// The empty place behind the last word.
    #[must_use]
    pub fn end(&self) -> Range<usize> {
        let end = self.line.trim_ascii_end().len();
        end..end
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    #[inline]
    fn next(&mut self) -> Option<Word<'a>> {
        let mut start = self.at;
        while self.line.get(start).is_some_and(|&b| is_space(b)) {
            start += 1;
        }
        let mut end = start;
        while self.line.get(end).is_some_and(|&b| !is_space(b)) {
            end += 1;
        }
        if start == end || self.line[start] == b'#' {
            self.at = self.line.len();
            return None;
        }
        self.at = end;
        Some(Word { bytes: &self.line[start..end], start })
    }
}

impl<'a> Word<'a> {
    /// Where it stands in its line.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.start..self.start + self.bytes.len()
    }

    /// The word as text; what is not UTF-8 is replaced.
    #[must_use]
    pub fn text(&self) -> Cow<'a, str> {
        String::from_utf8_lossy(self.bytes)
    }

    /// The number that it says, if it is a finite one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        parse_number(self.bytes).filter(|x| x.is_finite())
    }
}

#[inline(always)]
fn is_space(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// Powers of ten that double precision holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The number that a word says, rounded as `str::parse` rounds it.
///
/// Digits that make an integer below 2^53, times or over a power of ten up to 10^22, need a single
/// operation on exact numbers, so the result is the correctly rounded one (Clinger, *How to Read Floating
/// Point Numbers Accurately*, 1990). All else is left to the standard library.
#[must_use]
pub fn parse_number(word: &[u8]) -> Option<f64> {
    let (is_negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    let mut mantissa = 0_u64;
    let mut n_digits = 0;
    let mut exponent = 0_i32;
    let mut at = 0;
    let mut is_fraction = false;
    while let Some(&b) = digits.get(at) {
        let digit = b.wrapping_sub(b'0');
        if digit <= 9 {
            // Wraps with 20 digits and more, which are given away below.
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            n_digits += 1;
            exponent -= i32::from(is_fraction);
        } else if b == b'.' && !is_fraction {
            is_fraction = true;
        } else {
            break;
        }
        at += 1;
    }
    let slow = || std::str::from_utf8(word).ok()?.parse().ok();
    if n_digits == 0 || n_digits > 19 {
        return slow();
    }
    if let [b'e' | b'E', tail @ ..] = &digits[at..] {
        let (sign, tail) = match tail {
            [b'-', tail @ ..] => (-1, tail),
            [b'+', tail @ ..] => (1, tail),
            _ => (1, tail),
        };
        if tail.is_empty() || tail.len() > 4 || !tail.iter().all(u8::is_ascii_digit) {
            return slow();
        }
        exponent += sign * tail.iter().fold(0, |n, &b| n * 10 + i32::from(b - b'0'));
    } else if at < digits.len() {
        return slow();
    }
    if mantissa >= 1 << 53 || exponent.unsigned_abs() > 22 {
        return slow();
    }
    let power = POWERS[exponent.unsigned_abs() as usize];
    let exact = mantissa as f64;
    let x = if exponent < 0 { exact / power } else { exact * power };
    Some(if is_negative { -x } else { x })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Lines, parse_number};

    #[test]
    fn lines_and_words() {
        let text = b"\xef\xbb\xbfa bb\\\r\n  c\n\n# none\n d # e\\";
        let lines: Vec<(usize, Vec<String>)> = Lines::new(text)
            .map(|l| (l.number, l.words().map(|w| w.text().into_owned()).collect()))
            .collect();
        let expected: [(usize, &[&str]); 4] =
            [(1, &["a", "bb", "c"]), (3, &[]), (4, &[]), (5, &["d"])];
        assert_eq!(lines.len(), expected.len());
        for (line, (number, words)) in lines.iter().zip(expected) {
            assert_eq!((line.0, line.1.as_slice()), (number, words.map_owned().as_slice()));
        }
        let line = Lines::new(b"newmtl  a name \t").next().unwrap();
        let mut words = line.words();
        assert_eq!(words.next().unwrap().text(), "newmtl");
        assert_eq!((words.rest().text().as_ref(), words.rest().start), ("a name", 8));
    }

    trait Owned {
        fn map_owned(&self) -> Vec<String>;
    }

    impl Owned for &[&str] {
        fn map_owned(&self) -> Vec<String> {
            self.iter().map(|s| (*s).to_owned()).collect()
        }
    }

    #[test]
    fn what_is_no_number_is_none() {
        for word in ["", "-", ".", "e5", "1e", "1e+", "1.2.3", "0x10", "1,5", "--1", "1e5x", "-.e1"]
        {
            assert_eq!(parse_number(word.as_bytes()), None, "{word}");
        }
        for word in ["nan", "-inf", "1e999"] {
            assert!(!parse_number(word.as_bytes()).unwrap().is_finite(), "{word}");
        }
    }

    fn agrees(word: &str) {
        let (own, std) = (parse_number(word.as_bytes()), word.parse::<f64>().ok());
        assert_eq!(own.map(f64::to_bits), std.map(f64::to_bits), "{word}");
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(x in any::<f64>(), y in any::<f32>(), n in -9999_i64..9999) {
            if x.is_finite() {
                agrees(&format!("{x}"));
                agrees(&format!("{x:e}"));
            }
            if y.is_finite() {
                agrees(&format!("{y}"));
                agrees(&format!("{y:E}"));
                agrees(&format!("{:.6}", y % 1000.0));
            }
            agrees(&n.to_string());
        }

        #[test]
        fn any_word_is_taken_like_the_standard_library_takes_it(word in "[-+]?[0-9]{0,22}[.]?[0-9]{0,5}(e[-+]?[0-9]{0,4})?") {
            agrees(&word);
        }
    }
}
