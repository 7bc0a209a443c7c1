//! The vertices of a PLY file.

use rayon::prelude::*;

use super::body::{CHUNK, Source, decode};
use super::header::{Element, Format, Scalar};
use crate::{Error, TriangleMesh};

/// Names of the properties of a vertex, in the order of [`Row`]; the first of each that is there counts.
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

/// A number for each column, 0 where there is none.
type Row = [f64; N_COLUMNS];

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

/// How the numbers of a colour become linear.
struct Colors {
    /// Largest code of each channel that has codes.
    codes: [Option<f64>; 4],
    has_alpha: bool,
}

impl Colors {
    fn of(element: &Element, columns: &Columns) -> Self {
        let code = |c: usize| {
            columns.0[c].and_then(|p| match element.properties[p].scalar {
                Scalar::F32 | Scalar::F64 => None,
                Scalar::U16 | Scalar::I16 => Some(65535.0),
                _ => Some(255.0),
            })
        };
        Self { codes: [8, 9, 10, 11].map(code), has_alpha: columns.0[11].is_some() }
    }

    fn color(&self, row: [f64; 4]) -> [f32; 4] {
        std::array::from_fn(|i| match self.codes[i] {
            _ if i == 3 && !self.has_alpha => 1.0,
            Some(largest) if i == 3 => (row[i] / largest) as f32,
            Some(largest) => linear(row[i] / largest) as f32,
            None => row[i] as f32,
        })
    }
}

/// What a record of an element takes, if it has no list.
fn fixed_size(element: &Element) -> Option<usize> {
    element.properties.iter().map(|p| p.list.is_none().then(|| p.scalar.n_bytes())).sum()
}

pub(super) fn vertices(
    source: &mut Source<'_>,
    element: &Element,
    mesh: &mut TriangleMesh,
) -> Result<(), Error> {
    if !mesh.positions.is_empty() {
        return Err(Error::new("the file has two elements `vertex`"));
    }
    let columns = Columns::of(element)?;
    let n = element.count as usize;
    if n > u32::MAX as usize {
        return Err(Error::new("the file has more than 2^32 vertices"));
    }
    let colors = Colors::of(element, &columns);
    let (has_normals, has_uvs) = (columns.has(3..6), columns.has(6..8));
    let (has_colors, has_tangents) = (columns.has(8..11), columns.has(12..16));
    mesh.positions = vec![[0.0; 3]; n];
    mesh.normals = vec![[0.0; 3]; if has_normals { n } else { 0 }];
    mesh.uvs = vec![[0.0; 2]; if has_uvs { n } else { 0 }];
    mesh.colors = vec![[0.0; 4]; if has_colors { n } else { 0 }];
    mesh.tangents = vec![[0.0; 4]; if has_tangents { n } else { 0 }];
    if let (Some(stride), true) = (fixed_size(element), source.format != Format::Ascii) {
        // Every record at its place: all at once.
        let Some(bytes) =
            n.checked_mul(stride).and_then(|len| source.bytes.get(source.at..source.at + len))
        else {
            return Err(source.cut_off(element, 0));
        };
        source.at += n * stride;
        let big = source.format == Format::BigEndian;
        let table = Table { bytes, stride, big, fields: fields(element, &columns) };
        table.fill([0, 1, 2], &mut mesh.positions, narrow);
        table.fill([3, 4, 5], &mut mesh.normals, narrow);
        table.fill([6, 7], &mut mesh.uvs, narrow);
        table.fill([8, 9, 10, 11], &mut mesh.colors, |row| colors.color(row));
        table.fill([12, 13, 14, 15], &mut mesh.tangents, narrow);
        return Ok(());
    }
    let mut column_of = vec![None; element.properties.len()];
    for (c, property) in columns.0.iter().enumerate() {
        if let Some(p) = property {
            column_of[*p] = Some(c);
        }
    }
    for i in 0..n {
        let mut row: Row = [0.0; N_COLUMNS];
        let put = |p: usize, x: f64| {
            if let Some(c) = column_of[p] {
                row[c] = x;
            }
        };
        source.record(element, i as u64, put, |_, _| {})?;
        let [x, y, z, nx, ny, nz, u, v, r, g, b, a, tangent @ ..] = row;
        mesh.positions[i] = narrow([x, y, z]);
        if has_normals {
            mesh.normals[i] = narrow([nx, ny, nz]);
        }
        if has_uvs {
            mesh.uvs[i] = narrow([u, v]);
        }
        if has_colors {
            mesh.colors[i] = colors.color([r, g, b, a]);
        }
        if has_tangents {
            mesh.tangents[i] = narrow(tangent);
        }
    }
    Ok(())
}

fn narrow<const N: usize>(row: [f64; N]) -> [f32; N] {
    row.map(|x| x as f32)
}

/// A number of a record.
#[derive(Clone, Copy)]
struct Field {
    offset: usize,
    scalar: Scalar,
}

fn fields(element: &Element, columns: &Columns) -> [Option<Field>; N_COLUMNS] {
    let mut offset = 0;
    let mut all = Vec::with_capacity(element.properties.len());
    for property in &element.properties {
        all.push(Field { offset, scalar: property.scalar });
        offset += property.scalar.n_bytes();
    }
    columns.0.map(|p| p.map(|p| all[p]))
}

/// Records of one size.
struct Table<'a> {
    bytes: &'a [u8],
    stride: usize,
    big: bool,
    fields: [Option<Field>; N_COLUMNS],
}

impl Table<'_> {
    /// Fills an array, which may be empty, with what is made of some columns.
    fn fill<const N: usize>(
        &self,
        columns: [usize; N],
        out: &mut [[f32; N]],
        make: impl Fn([f64; N]) -> [f32; N] + Sync,
    ) {
        let fields = columns.map(|c| self.fields[c]);
        let stride = self.stride;
        let parts = out.par_chunks_mut(CHUNK).zip(self.bytes.par_chunks(CHUNK * stride));
        // What nearly all files have: no number is converted.
        let at = fields.map(|f| f.filter(|f| f.scalar == Scalar::F32).map(|f| f.offset));
        let is_plain = N < 4 && at.iter().all(Option::is_some);
        let at = at.map(Option::unwrap_or_default);
        let big = self.big;
        parts.for_each(|(out, bytes)| {
            let records = bytes.chunks_exact(stride);
            match (is_plain, big) {
                (true, false) => copy(out, records, at, f32::from_le_bytes),
                (true, true) => copy(out, records, at, f32::from_be_bytes),
                (false, _) => {
                    for (value, record) in out.iter_mut().zip(records) {
                        *value = make(fields.map(|field| {
                            field.map_or(0.0, |Field { offset, scalar }| {
                                decode(&record[offset..offset + scalar.n_bytes()], scalar, big)
                            })
                        }));
                    }
                }
            }
        });
    }
}

#[inline(always)]
fn copy<'a, const N: usize>(
    out: &mut [[f32; N]],
    records: impl Iterator<Item = &'a [u8]>,
    at: [usize; N],
    number: impl Fn([u8; 4]) -> f32,
) {
    for (value, record) in out.iter_mut().zip(records) {
        *value = at.map(|at| match record[at..] {
            [a, b, c, d, ..] => number([a, b, c, d]),
            // A field lies within its record.
            _ => 0.0,
        });
    }
}

/// The linear value of an sRGB code in [0, 1] (IEC 61966-2-1), in double precision by exact powers: the
/// exponent 2.4 is the square times the square root of the fifth root of the square.
pub(crate) fn linear(code: f64) -> f64 {
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
