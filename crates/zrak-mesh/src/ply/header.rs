//! The header of a PLY file.

use crate::Error;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn n_bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// Property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// Type of the number of entries, if it is a list.
    pub(super) list: Option<Scalar>,
}

/// Kind of thing that a file has a number of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// The header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Where the body begins, in bytes.
    pub(super) body: usize,
    /// Number of lines of the header.
    pub(super) n_lines: usize,
}

/// Most bytes of a header, and most properties in it: real ones have a few hundred bytes.
const MAX_BYTES: usize = 1 << 20;
const MAX_PROPERTIES: usize = 4096;

pub(super) fn parse(bytes: &[u8]) -> Result<Header, Error> {
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut n_properties = 0;
    let mut at = 0;
    let mut n_lines = 0;
    loop {
        let rest = &bytes[at..bytes.len().min(MAX_BYTES)];
        let fail = |message: String| Err(Error::new(format!("line {}: {message}", n_lines + 1)));
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
            return fail("the header has no `end_header`; this is not a whole PLY file".to_owned());
        };
        let Ok(line) = std::str::from_utf8(&rest[..end]) else {
            return fail("the header is not text; this is not a PLY file".to_owned());
        };
        at += end + 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        if n_lines == 0 {
            if words != ["ply"] {
                return fail("a PLY file begins with `ply`, this one does not".to_owned());
            }
            n_lines = 1;
            continue;
        }
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, version] => {
                if version != "1.0" {
                    return fail(format!("version {version} of PLY is not known, only 1.0 is"));
                }
                format = Some(match name {
                    "ascii" => Format::Ascii,
                    "binary_little_endian" => Format::LittleEndian,
                    "binary_big_endian" => Format::BigEndian,
                    _ => return fail(format!("unknown format `{name}`")),
                });
            }
            ["element", name, count] => {
                let Ok(count) = count.parse() else {
                    return fail(format!("`{count}` is not a number of elements"));
                };
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref rest @ ..] => {
                let Some(element) = elements.last_mut() else {
                    return fail("a property before any element".to_owned());
                };
                let scalar = |name: &str| Scalar::of_name(name);
                let (name, scalar, list) = match *rest {
                    ["list", count, entry, name] => (name, scalar(entry), Some(scalar(count))),
                    [entry, name] => (name, scalar(entry), None),
                    _ => return fail("a property is `property TYPE NAME`".to_owned()),
                };
                let (Some(scalar), Some(list)) = (scalar, list.map_or(Some(None), |l| l.map(Some)))
                else {
                    return fail(format!("property `{name}` has an unknown type"));
                };
                if list.is_some_and(|count| !count.is_integer()) {
                    return fail(format!("the length of list `{name}` is not an integer"));
                }
                n_properties += 1;
                if n_properties > MAX_PROPERTIES {
                    return fail(format!("more than {MAX_PROPERTIES} properties"));
                }
                element.properties.push(Property { name: name.to_owned(), scalar, list });
            }
            ["end_header"] => {
                let Some(format) = format else {
                    return fail("the header has no `format`".to_owned());
                };
                return Ok(Header { format, elements, body: at, n_lines: n_lines + 1 });
            }
            _ => return fail(format!("`{line}` is not understood")),
        }
        n_lines += 1;
    }
}
