//! The body of a PLY file.

use rayon::prelude::*;

use super::header::{Element, Format, Header, Property, Scalar};
use crate::triangulate::triangulate;
use crate::{Error, Limits, TriangleMesh};

/// Vertices or faces that one task decodes.
const CHUNK: usize = 1 << 16;

/// Most groups of faces.
const GROUPS_MAX: f64 = 65536.0;

/// Names of the properties of a vertex, in the order of [`Vertices`]' columns; the first of each that
/// is there counts.
const COLUMNS: [&[&str]; N_COLUMNS] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a"],
    &["tx"],
    &["ty"],
    &["tz"],
    &["tw"],
];

const N_COLUMNS: usize = 16;

/// Which property each column is, if it is there.
struct Columns([Option<usize>; N_COLUMNS]);

impl Columns {
    fn of(element: &Element) -> Result<Self, Error> {
        let find = |names: &[&str]| {
            names.iter().find_map(|name| {
                element.properties.iter().position(|p| p.name == *name && p.list.is_none())
            })
        };
        let columns = Self(COLUMNS.map(find));
        if columns.0[..3].iter().any(Option::is_none) {
            return Err(Error::new("the vertices lack x, y or z"));
        }
        Ok(columns)
    }

    fn has(&self, columns: std::ops::Range<usize>) -> bool {
        columns.into_iter().all(|c| self.0[c].is_some())
    }
}

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
struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    format: Format,
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

    fn cut_off(&self, element: &Element, i: u64) -> Error {
        Error::new(format!("the file ends within element `{}` number {i}", element.name))
    }

    /// Reads one record; calls `one` for each number that is no list's, with the property's index,
    /// and `entry` for each entry of a list.
    fn record(
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
            if rest[..end].iter().any(|b| !b.is_ascii_whitespace()) {
                break &rest[..end];
            }
        };
        let line_number = self.line;
        let fail = |message: String| Error::new(format!("line {line_number}: {message}"));
        let Ok(text) = std::str::from_utf8(line) else {
            return Err(fail("this is not text".to_owned()));
        };
        let mut words = text.split_ascii_whitespace();
        let mut next = |property: &Property| -> Result<f64, Error> {
            let Some(word) = words.next() else {
                let message = format!(
                    "element `{}` number {i} ends before its property `{}`",
                    element.name, property.name
                );
                return Err(fail(message));
            };
            word.parse().map_err(|_| fail(format!("`{word}` is not a number")))
        };
        for (k, property) in element.properties.iter().enumerate() {
            match property.list {
                None => one(k, next(property)?),
                Some(_) => {
                    let n = next(property)?;
                    if !(n >= 0.0 && n <= line.len() as f64) {
                        let message = format!("a list `{}` of {n} entries", property.name);
                        return Err(fail(message));
                    }
                    for _ in 0..n as usize {
                        entry(k, next(property)?);
                    }
                }
            }
        }
        Ok(())
    }
}

/// A number from exactly its bytes.
#[inline]
fn decode(bytes: &[u8], scalar: Scalar, big: bool) -> f64 {
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

/// What a record of an element takes, if it has no list.
fn fixed_size(element: &Element) -> Option<usize> {
    element.properties.iter().map(|p| p.list.is_none().then(|| p.scalar.n_bytes())).sum()
}

fn vertices(
    source: &mut Source<'_>,
    element: &Element,
    mesh: &mut TriangleMesh,
) -> Result<(), Error> {
    if !mesh.positions.is_empty() {
        return Err(Error::new("the file has two elements `vertex`"));
    }
    let columns = Columns::of(element)?;
    let n = element.count as usize;
    let code = |c: usize| -> bool {
        columns.0[c].is_some_and(|p| element.properties[p].scalar.is_integer())
    };
    let codes = [8, 9, 10, 11].map(code);
    let (has_normals, has_uvs, has_colors) =
        (columns.has(3..6), columns.has(6..8), columns.has(8..11));
    // The largest code of the type that colours have.
    let scale = |c: usize| {
        columns.0[c].map_or(1.0, |p| match element.properties[p].scalar {
            Scalar::U16 | Scalar::I16 => 65535.0,
            _ => 255.0,
        })
    };
    let scales = [8, 9, 10, 11].map(scale);
    let color = |row: &[f64; N_COLUMNS]| -> [f32; 4] {
        std::array::from_fn(|i| {
            let x = row[8 + i];
            if i == 3 {
                if columns.0[11].is_none() {
                    1.0
                } else if codes[3] {
                    (x / scales[3]) as f32
                } else {
                    x as f32
                }
            } else if codes[i] {
                linear(x / scales[i]) as f32
            } else {
                x as f32
            }
        })
    };
    let three = |row: &[f64; N_COLUMNS], at: usize| {
        [row[at] as f32, row[at + 1] as f32, row[at + 2] as f32]
    };
    mesh.positions = vec![[0.0; 3]; n];
    mesh.normals = vec![[0.0; 3]; if has_normals { n } else { 0 }];
    mesh.uvs = vec![[0.0; 2]; if has_uvs { n } else { 0 }];
    mesh.colors = vec![[0.0; 4]; if has_colors { n } else { 0 }];
    let has_tangents = columns.has(12..16);
    let tangent = |row: &[f64; N_COLUMNS]| [12, 13, 14, 15].map(|c| row[c] as f32);
    mesh.tangents = vec![[0.0; 4]; if has_tangents { n } else { 0 }];
    if let (Some(stride), true) = (fixed_size(element), source.format != Format::Ascii) {
        // Every record at its place: all at once.
        let big = source.format == Format::BigEndian;
        let mut offset = 0;
        let offsets: Vec<usize> = element
            .properties
            .iter()
            .map(|p| {
                let at = offset;
                offset += p.scalar.n_bytes();
                at
            })
            .collect();
        let Some(body) = source.bytes.get(source.at..source.at + n * stride) else {
            return Err(source.cut_off(element, 0));
        };
        source.at += n * stride;
        let row = |i: usize| -> [f64; N_COLUMNS] {
            let record = &body[i * stride..(i + 1) * stride];
            std::array::from_fn(|c| match columns.0[c] {
                Some(p) => {
                    let scalar = element.properties[p].scalar;
                    decode(&record[offsets[p]..offsets[p] + scalar.n_bytes()], scalar, big)
                }
                None => 0.0,
            })
        };
        let fill = |first: usize, positions: &mut [[f32; 3]]| {
            for (i, p) in positions.iter_mut().enumerate() {
                *p = three(&row(first + i), 0);
            }
        };
        mesh.positions.par_chunks_mut(CHUNK).enumerate().for_each(|(k, c)| fill(k * CHUNK, c));
        mesh.normals.par_chunks_mut(CHUNK).enumerate().for_each(|(k, chunk)| {
            for (i, n) in chunk.iter_mut().enumerate() {
                *n = three(&row(k * CHUNK + i), 3);
            }
        });
        mesh.uvs.par_chunks_mut(CHUNK).enumerate().for_each(|(k, chunk)| {
            for (i, uv) in chunk.iter_mut().enumerate() {
                let row = row(k * CHUNK + i);
                *uv = [row[6] as f32, row[7] as f32];
            }
        });
        mesh.colors.par_chunks_mut(CHUNK).enumerate().for_each(|(k, chunk)| {
            for (i, c) in chunk.iter_mut().enumerate() {
                *c = color(&row(k * CHUNK + i));
            }
        });
        mesh.tangents.par_chunks_mut(CHUNK).enumerate().for_each(|(k, chunk)| {
            for (i, t) in chunk.iter_mut().enumerate() {
                *t = tangent(&row(k * CHUNK + i));
            }
        });
        return Ok(());
    }
    for i in 0..n {
        let mut row = [0.0; N_COLUMNS];
        let put = |p: usize, x: f64| {
            if let Some(c) = columns.0.iter().position(|c| *c == Some(p)) {
                row[c] = x;
            }
        };
        source.record(element, i as u64, put, |_, _| {})?;
        mesh.positions[i] = three(&row, 0);
        if has_normals {
            mesh.normals[i] = three(&row, 3);
        }
        if has_uvs {
            mesh.uvs[i] = [row[6] as f32, row[7] as f32];
        }
        if has_colors {
            mesh.colors[i] = color(&row);
        }
        if has_tangents {
            mesh.tangents[i] = tangent(&row);
        }
    }
    Ok(())
}

fn faces(
    source: &mut Source<'_>,
    element: &Element,
    mesh: &mut TriangleMesh,
    limits: &Limits,
) -> Result<(), Error> {
    let is_corners =
        |p: &Property| p.list.is_some() && ["vertex_indices", "vertex_index"].contains(&&*p.name);
    let Some(corners) = element.properties.iter().position(is_corners) else {
        return Err(Error::new("the faces lack a list `vertex_indices`"));
    };
    if mesh.positions.is_empty() && element.count > 0 {
        return Err(Error::new("the file has faces before its vertices, or no vertices"));
    }
    if mesh.triangles.is_empty() && all_triangles(source, element, mesh) {
        return Ok(());
    }
    let n_vertices = mesh.positions.len();
    let group = element.properties.iter().position(|p| p.list.is_none() && p.name == "group");
    let mut n_groups = 0;
    let mut polygon = Vec::new();
    for i in 0..element.count {
        polygon.clear();
        let mut bad = None;
        let add = |p: usize, x: f64| {
            if p == corners {
                if x >= 0.0 && x < n_vertices as f64 {
                    polygon.push(x as u32);
                } else {
                    bad = Some(x);
                }
            }
        };
        let mut group_of_face = 0.0;
        let one = |p: usize, x: f64| {
            if Some(p) == group {
                group_of_face = x;
            }
        };
        source.record(element, i, one, add)?;
        if let Some(x) = bad {
            return Err(Error::new(format!(
                "face {i} has a corner {x}, but vertices are counted from 0 to {}",
                n_vertices - 1
            )));
        }
        triangulate(&polygon, &mesh.positions, &mut mesh.triangles);
        if group.is_some() {
            if !(group_of_face >= 0.0 && group_of_face < GROUPS_MAX) {
                let message = format!("face {i} is of group {group_of_face}, not one from 0 on");
                return Err(Error::new(message));
            }
            n_groups = n_groups.max(group_of_face as usize + 1);
            mesh.face_groups.resize(mesh.triangles.len(), group_of_face as u32);
        }
        if (mesh.triangles.len() as u64).saturating_mul(12) > limits.max_bytes {
            return Err(Error::new("the triangles take more memory than the limit allows"));
        }
    }
    mesh.groups.extend((0..n_groups).map(|i| i.to_string()));
    Ok(())
}

/// Reads faces that are all triangles of the most common form, a byte 3 and three 32-bit indices, all
/// at once. False, with nothing read, if they are not.
fn all_triangles(source: &mut Source<'_>, element: &Element, mesh: &mut TriangleMesh) -> bool {
    let [Property { scalar: Scalar::I32 | Scalar::U32, list: Some(Scalar::U8 | Scalar::I8), .. }] =
        element.properties[..]
    else {
        return false;
    };
    if source.format == Format::Ascii {
        return false;
    }
    const STRIDE: usize = 13;
    let n = element.count as usize;
    let Some(body) =
        n.checked_mul(STRIDE).and_then(|len| source.bytes.get(source.at..source.at + len))
    else {
        return false;
    };
    let records = body.par_chunks_exact(STRIDE);
    if !records.clone().all(|record| record[0] == 3) {
        return false;
    }
    let big = source.format == Format::BigEndian;
    let index = |b: &[u8]| {
        let b = [b[0], b[1], b[2], b[3]];
        if big { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) }
    };
    // Indices out of range, negative ones among them, are found by the mesh's validation.
    mesh.triangles = records
        .with_min_len(CHUNK)
        .map(|record| [index(&record[1..5]), index(&record[5..9]), index(&record[9..13])])
        .collect();
    source.at += n * STRIDE;
    true
}

/// The linear value of an sRGB code in [0, 1] (IEC 61966-2-1), in double precision by exact powers: the
/// exponent 2.4 is the square times the square root of the fifth root of the square.
fn linear(code: f64) -> f64 {
    if code <= 0.04045 {
        return code / 12.92;
    }
    let x = (code + 0.055) / 1.055;
    // x^(2/5) by Newton's method on y^5 = x^2, which converges from above to the last bit but one.
    let target = x * x;
    let mut y = 1.0_f64;
    for _ in 0..40 {
        let y4 = y * y * y * y;
        y -= (y4 * y - target) / (5.0 * y4);
    }
    target * y
}
