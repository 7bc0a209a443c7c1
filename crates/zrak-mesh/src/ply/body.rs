//! The body of a PLY file: elements one after the other.

use super::faces::faces;
use super::header::{Element, Format, Header, Property, Scalar};
use super::vertices::vertices;
use crate::text::Word;
use crate::{Error, Limits, TriangleMesh};

/// Vertices or faces that one task decodes.
pub(super) const CHUNK: usize = 1 << 15;

pub(super) fn parse(bytes: &[u8], header: &Header, limits: &Limits) -> Result<TriangleMesh, Error> {
    let mut mesh = TriangleMesh::default();
    let mut source = Source { bytes, at: header.body, format: header.format, line: header.n_lines };
    for element in &header.elements {
        source.check_size(element, limits)?;
        match element.name.as_str() {
            "vertex" => vertices(&mut source, element, &mut mesh)?,
            "face" => faces(&mut source, element, &mut mesh, limits)?,
            _ => {
                for i in 0..element.count {
                    source.record(element, i, |_, _| {}, |_, _| {})?;
                }
            }
        }
    }
    Ok(mesh)
}

/// The body, and how far it has been read.
pub(super) struct Source<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
    pub(super) format: Format,
    line: usize,
}

impl Source<'_> {
    /// Refuses an element that the rest of the file cannot hold, before memory is taken for it.
    fn check_size(&self, element: &Element, limits: &Limits) -> Result<(), Error> {
        // In text, a record takes a line; in bytes, its numbers.
        let smallest: u64 = match self.format {
            Format::Ascii => 1,
            _ => {
                element.properties.iter().map(|p| p.list.unwrap_or(p.scalar).n_bytes() as u64).sum()
            }
        };
        let rest = (self.bytes.len() - self.at) as u64;
        // A text's last line may lack its end.
        let fits = element.count.checked_mul(smallest).is_some_and(|n| n <= rest + 1);
        if !fits || (smallest == 0 && element.count > 0) {
            return Err(Error::new(format!(
                "the header says that there are {} elements `{}`, but the file ends before; it is \
                 damaged or cut off",
                element.count, element.name
            )));
        }
        // What a vertex or a face takes in memory, at most.
        if element.count.saturating_mul(60) > limits.max_bytes {
            return Err(Error::new(format!(
                "{} elements `{}` take more memory than the limit of {} bytes",
                element.count, element.name, limits.max_bytes
            )));
        }
        Ok(())
    }

    pub(super) fn cut_off(&self, element: &Element, i: u64) -> Error {
        Error::new(format!("the file ends within element `{}` number {i}", element.name))
    }

    /// Reads one record; calls `one` for each number that is no list's, with the property's index,
    /// and `entry` for each entry of a list.
    pub(super) fn record(
        &mut self,
        element: &Element,
        i: u64,
        mut one: impl FnMut(usize, f64),
        mut entry: impl FnMut(usize, f64),
    ) -> Result<(), Error> {
        if self.format == Format::Ascii {
            return self.text_record(element, i, one, entry);
        }
        for (k, property) in element.properties.iter().enumerate() {
            match property.list {
                None => one(k, self.number(property.scalar, element, i)?),
                Some(count) => {
                    let n = self.number(count, element, i)?;
                    let rest = (self.bytes.len() - self.at) as f64;
                    if !(n >= 0.0 && n * property.scalar.n_bytes() as f64 <= rest) {
                        return Err(self.cut_off(element, i));
                    }
                    for _ in 0..n as usize {
                        entry(k, self.number(property.scalar, element, i)?);
                    }
                }
            }
        }
        Ok(())
    }

    fn number(&mut self, scalar: Scalar, element: &Element, i: u64) -> Result<f64, Error> {
        let end = self.at + scalar.n_bytes();
        let Some(bytes) = self.bytes.get(self.at..end) else {
            return Err(self.cut_off(element, i));
        };
        self.at = end;
        Ok(decode(bytes, scalar, self.format == Format::BigEndian))
    }

    fn text_record(
        &mut self,
        element: &Element,
        i: u64,
        mut one: impl FnMut(usize, f64),
        mut entry: impl FnMut(usize, f64),
    ) -> Result<(), Error> {
        let line = loop {
            let rest = &self.bytes[self.at..];
            if rest.is_empty() {
                return Err(self.cut_off(element, i));
            }
            let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
            self.at += (end + 1).min(rest.len());
            self.line += 1;
            let line = rest[..end].trim_ascii_end();
            if !line.is_empty() {
                break line;
            }
        };
        let line_number = self.line;
        let mut at = 0;
        let mut next = |property: &Property| -> Result<(f64, Word<'_>), Error> {
            while line.get(at).is_some_and(u8::is_ascii_whitespace) {
                at += 1;
            }
            let start = at;
            while line.get(at).is_some_and(|b| !b.is_ascii_whitespace()) {
                at += 1;
            }
            let word = Word { bytes: &line[start..at], start };
            if word.bytes.is_empty() {
                let message = format!(
                    "element `{}` number {i} ends before its property `{}`",
                    element.name, property.name
                );
                return Err(Error::at(line_number, line, start..start, message));
            }
            // Whether it is finite is looked at with the whole mesh.
            match crate::text::parse_number(word.bytes) {
                Some(x) => Ok((x, word)),
                None => {
                    let message = format!("`{}` is not a number", word.text());
                    Err(Error::at(line_number, line, word.span(), message))
                }
            }
        };
        for (k, property) in element.properties.iter().enumerate() {
            match property.list {
                None => one(k, next(property)?.0),
                Some(_) => {
                    let (n, word) = next(property)?;
                    if !(n >= 0.0 && n <= line.len() as f64) {
                        let message = format!(
                            "a list `{}` of {} entries does not fit the line",
                            property.name,
                            word.text()
                        );
                        return Err(Error::at(line_number, line, word.span(), message));
                    }
                    for _ in 0..n as usize {
                        entry(k, next(property)?.0);
                    }
                }
            }
        }
        Ok(())
    }
}

/// A number from exactly its bytes.
#[inline]
pub(super) fn decode(bytes: &[u8], scalar: Scalar, big: bool) -> f64 {
    let mut b = [0_u8; 8];
    let n = bytes.len();
    if big {
        for (to, from) in b[..n].iter_mut().zip(bytes.iter().rev()) {
            *to = *from;
        }
    } else {
        b[..n].copy_from_slice(bytes);
    }
    let [b0, b1, b2, b3, ..] = b;
    match scalar {
        Scalar::I8 => f64::from(b0 as i8),
        Scalar::U8 => f64::from(b0),
        Scalar::I16 => f64::from(i16::from_le_bytes([b0, b1])),
        Scalar::U16 => f64::from(u16::from_le_bytes([b0, b1])),
        Scalar::I32 => f64::from(i32::from_le_bytes([b0, b1, b2, b3])),
        Scalar::U32 => f64::from(u32::from_le_bytes([b0, b1, b2, b3])),
        Scalar::F32 => f64::from(f32::from_le_bytes([b0, b1, b2, b3])),
        Scalar::F64 => f64::from_le_bytes(b),
    }
}
