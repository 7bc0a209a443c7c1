//! From lines to faces.

use std::collections::HashMap;

use super::weld::{Corner, FLAT, MAX_INDEX, NO_UV, Welder, smooth_normal};
use super::{Obj, smooth};
use crate::ply::linear;
use crate::text::{Line, Lines, Word, Words};
use crate::triangulate::triangulate_by;
use crate::{Error, Limits};

/// More kinds of lines that are left out are not told of.
const WARNINGS_MAX: usize = 32;
/// Lines between two looks at the memory that is taken.
const LINES_PER_CHECK: usize = 1 << 12;
/// A vertex farther from the origin is refused.
const FAR: f64 = 1e12;

pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Obj, Error> {
    let max_bytes = limits.max_bytes;
    let mut reader = Reader { max_bytes, smoothing: FLAT, ..Reader::default() };
    for line in Lines::new(bytes) {
        reader.line(&line)?;
        if line.number % LINES_PER_CHECK == 0 {
            reader.check_memory()?;
        }
    }
    reader.check_memory()?;
    reader.finish()
}

#[derive(Default)]
struct Reader {
    max_bytes: u64,
    positions: Vec<[f32; 3]>,
    /// One for each position, once there is any.
    colors: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    welder: Welder,
    triangles: Vec<[u32; 3]>,
    /// Group of each triangle, once there is more than one.
    face_groups: Vec<u32>,
    groups: HashMap<String, u32>,
    group: u32,
    /// What the normals of corners without one are.
    smoothing: u32,
    smoothing_groups: HashMap<String, u32>,
    polygon: Vec<u32>,
    corner_positions: Vec<[f32; 3]>,
    warned: Vec<String>,
    out: Obj,
}

impl Reader {
    fn line(&mut self, line: &Line<'_>) -> Result<(), Error> {
        let mut words = line.words();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.bytes {
            b"v" => self.vertex(line, words),
            b"vn" => {
                let n = numbers::<3>(line, &mut words, "a normal")?;
                self.normals.push(n.map(|x| x as f32));
                Ok(())
            }
            b"vt" => {
                let u = number(line, &mut words, "texture coordinates")?;
                let v = words.next().map_or(Ok(0.0), |word| finite(line, word))?;
                self.uvs.push([u as f32, v as f32]);
                Ok(())
            }
            b"f" | b"fo" => self.face(line, words),
            b"s" => {
                self.smoothing = match words.next() {
                    None => FLAT,
                    Some(word) if matches!(word.bytes, b"off" | b"0" | b"null") => FLAT,
                    Some(word) => {
                        let next = self.smoothing_groups.len() as u32;
                        let groups = &mut self.smoothing_groups;
                        smooth_normal(*groups.entry(word.text().into_owned()).or_insert(next))
                    }
                };
                Ok(())
            }
            b"usemtl" => {
                self.material(line, words.rest());
                Ok(())
            }
            b"g" => {
                if !self.out.has_materials {
                    self.set_group(line, words.rest());
                }
                Ok(())
            }
            b"o" => {
                let name = words.rest().text().into_owned();
                self.out.name.get_or_insert(name);
                Ok(())
            }
            b"mtllib" => {
                let rest = words.rest();
                if rest.bytes.is_empty() {
                    return Err(
                        line.error(words.end(), "`mtllib` is followed by the name of a file")
                    );
                }
                self.out.libraries.push((rest.text().into_owned(), line.number));
                Ok(())
            }
            b"p" | b"l" => {
                self.warn(line, "points and lines", "points and lines are left out");
                Ok(())
            }
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf"
            | b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech"
            | b"stech" => {
                let message =
                    "curves and free-form surfaces are left out: save the file as polygons";
                self.warn(line, "free-form", message);
                Ok(())
            }
            b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"shadow_obj"
            | b"trace_obj" | b"usemap" | b"maplib" | b"call" | b"csh" => {
                let name = keyword.text();
                self.warn(line, &name, &format!("`{name}` has no effect"));
                Ok(())
            }
            word if word.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_') => {
                let name = keyword.text();
                self.warn(line, &name, &format!("`{name}` is unknown and is left out"));
                Ok(())
            }
            _ => {
                let message = "this is not a line of an OBJ file; is it another kind of file?";
                Err(line.error(keyword.span(), message))
            }
        }
    }

    fn warn(&mut self, line: &Line<'_>, what: &str, message: &str) {
        if self.warned.len() < WARNINGS_MAX && !self.warned.iter().any(|w| w == what) {
            self.warned.push(what.to_owned());
            self.out.warnings.push((line.number, message.to_owned()));
        }
    }

    fn vertex(&mut self, line: &Line<'_>, mut words: Words<'_>) -> Result<(), Error> {
        let start = words.rest();
        let p = numbers::<3>(line, &mut words, "a vertex")?;
        if p.iter().any(|x| x.abs() > FAR) {
            let message = "the vertex is farther than 1e12 from the origin; choose a larger unit";
            return Err(line.error(start.span(), message));
        }
        let more: [Option<Word<'_>>; 3] = std::array::from_fn(|_| words.next());
        // A single number more is a weight, which polygons have no use for.
        let color = match more {
            [Some(r), Some(g), Some(b)] => {
                Some([finite(line, r)?, finite(line, g)?, finite(line, b)?].map(|x| x as f32))
            }
            _ => None,
        };
        if let Some(color) = color {
            self.colors.resize(self.positions.len(), [1.0; 3]);
            self.colors.push(color);
        } else if !self.colors.is_empty() {
            self.colors.push([1.0; 3]);
        }
        self.positions.push(p.map(|x| x as f32));
        if self.positions.len() > MAX_INDEX {
            return Err(Error::new("the file has more than 2^30 vertices"));
        }
        Ok(())
    }

    fn material(&mut self, line: &Line<'_>, name: Word<'_>) {
        if !self.out.has_materials {
            // What was there before are groups of another kind.
            self.out.has_materials = true;
            self.groups.clear();
            self.out.mesh.groups.clear();
            self.out.group_lines.clear();
            self.face_groups.clear();
            if !self.triangles.is_empty() {
                self.add_group(String::new(), 0);
            }
        }
        self.set_group(line, name);
    }

    fn set_group(&mut self, line: &Line<'_>, name: Word<'_>) {
        let name = name.text();
        self.group = match self.groups.get(name.as_ref()) {
            Some(&group) => group,
            None => {
                if self.groups.is_empty() && !self.triangles.is_empty() {
                    self.add_group(String::new(), 0);
                }
                self.add_group(name.into_owned(), line.number)
            }
        };
    }

    fn add_group(&mut self, name: String, line: usize) -> u32 {
        let next = self.out.mesh.groups.len() as u32;
        let group = *self.groups.entry(name.clone()).or_insert(next);
        if group == next {
            self.out.mesh.groups.push(name);
            self.out.group_lines.push(line);
        }
        if group > 0 {
            // All before were in the first.
            self.face_groups.resize(self.triangles.len(), 0);
        }
        group
    }

    fn face(&mut self, line: &Line<'_>, words: Words<'_>) -> Result<(), Error> {
        let end = words.end();
        self.polygon.clear();
        self.corner_positions.clear();
        for word in words {
            let corner = self.corner(line, word)?;
            self.corner_positions.push(self.positions[corner.position as usize]);
            self.polygon.push(self.welder.vertex(corner));
        }
        if self.polygon.len() < 3 {
            let message =
                format!("a face has three corners or more, this one {}", self.polygon.len());
            return Err(line.error(end, message));
        }
        let Self { polygon, triangles, corner_positions, .. } = self;
        triangulate_by(
            polygon.len(),
            |i| corner_positions[i],
            |corners| {
                triangles.push(corners.map(|i| polygon[i]));
            },
        );
        if self.out.mesh.groups.len() > 1 {
            self.face_groups.resize(self.triangles.len(), self.group);
        }
        Ok(())
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[inline]
    fn corner(&self, line: &Line<'_>, word: Word<'_>) -> Result<Corner, Error> {
        let mut corner = Corner { position: 0, uv: NO_UV, normal: self.smoothing };
        let mut start = 0;
        for part in 0..3 {
            let rest = &word.bytes[start..];
            let end = rest.iter().position(|&b| b == b'/').unwrap_or(rest.len());
            let here = Word { bytes: &rest[..end], start: word.start + start };
            if part == 0 || end > 0 {
                let (count, what) = match part {
                    0 => (self.positions.len(), "vertices"),
                    1 => (self.uvs.len(), "texture coordinates"),
                    _ => (self.normals.len(), "normals"),
                };
                let index = index(line, here, count, what)?;
                match part {
                    0 => corner.position = index,
                    1 => corner.uv = index,
                    _ => corner.normal = index,
                }
            }
            start += end + 1;
            if start > word.bytes.len() {
                return Ok(corner);
            }
        }
        Err(line.error(word.span(), "a corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`"))
    }

    fn check_memory(&self) -> Result<(), Error> {
        // What vertices take while they are read and in the mesh, and triangles.
        let n_bytes = self.positions.len() as u64 * 32
            + self.uvs.len() as u64 * 8
            + self.normals.len() as u64 * 12
            + self.welder.len() as u64 * 64
            + self.triangles.len() as u64 * 28
            + self.out.mesh.groups.len() as u64 * 128;
        if n_bytes > self.max_bytes {
            return Err(Error::new(format!(
                "the mesh takes more memory than the limit of {} bytes",
                self.max_bytes
            )));
        }
        if self.uvs.len().max(self.normals.len()).max(self.welder.len()) > MAX_INDEX {
            return Err(Error::new("the file has more than 2^30 vertices"));
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Obj, Error> {
        if self.triangles.is_empty() {
            return Err(Error::new(if self.positions.is_empty() {
                "the file has no vertices; is it an OBJ file?"
            } else {
                "the file has vertices but no faces"
            }));
        }
        let vertices = self.welder.into_vertices();
        let mut mesh = std::mem::take(&mut self.out.mesh);
        mesh.triangles = self.triangles;
        if mesh.groups.len() > 1 {
            mesh.face_groups = self.face_groups;
        }
        mesh.positions = vertices.iter().map(|c| self.positions[c.position as usize]).collect();
        if vertices.iter().any(|c| c.uv != NO_UV) {
            let uv = |c: &Corner| if c.uv == NO_UV { [0.0; 2] } else { self.uvs[c.uv as usize] };
            mesh.uvs = vertices.iter().map(uv).collect();
        }
        if !self.colors.is_empty() {
            let largest = self.colors.iter().flatten().fold(0.0_f32, |m, &x| m.max(x));
            let scale = if largest > 1.0 { 255.0 } else { 1.0 };
            if largest > 1.0 {
                let message = "colours of vertices are more than 1, and are taken for bytes";
                self.out.warnings.push((0, message.to_owned()));
            }
            let code = |x: f32| linear((f64::from(x) / scale).clamp(0.0, 1.0)) as f32;
            let color = |c: &Corner| {
                let [r, g, b] = self.colors[c.position as usize].map(code);
                [r, g, b, 1.0]
            };
            mesh.colors = vertices.iter().map(color).collect();
        }
        smooth::add_normals(&mut mesh, &vertices, &self.normals, self.max_bytes)?;
        Ok(Obj { mesh, ..self.out })
    }
}

fn finite(line: &Line<'_>, word: Word<'_>) -> Result<f64, Error> {
    // Beyond single precision is infinite too.
    word.number()
        .filter(|&x| (x as f32).is_finite())
        .ok_or_else(|| line.error(word.span(), format!("`{}` is not a finite number", word.text())))
}

fn number(line: &Line<'_>, words: &mut Words<'_>, what: &str) -> Result<f64, Error> {
    match words.next() {
        Some(word) => finite(line, word),
        None => Err(line.error(words.end(), format!("{what} ends here: a number is missing"))),
    }
}

fn numbers<const N: usize>(
    line: &Line<'_>,
    words: &mut Words<'_>,
    what: &str,
) -> Result<[f64; N], Error> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = number(line, words, what)?;
    }
    Ok(values)
}

/// The index, from 0, of one of `count` things; in the file it is counted from 1, or backwards from -1.
#[inline]
fn index(line: &Line<'_>, word: Word<'_>, count: usize, what: &str) -> Result<u32, Error> {
    let (is_back, digits) = match word.bytes {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    // Ten digits at most, so that nothing overflows.
    let is_number = (1..=10).contains(&digits.len()) && digits.iter().all(u8::is_ascii_digit);
    if !is_number {
        let message = format!("`{}` is not an index", word.text());
        return Err(line.error(word.span(), message));
    }
    let n = digits.iter().fold(0_u64, |n, &b| n * 10 + u64::from(b - b'0'));
    if n == 0 || n > count as u64 {
        let shown = word.text();
        let message = if n == 0 {
            format!("there is no index 0: {what} are counted from 1, or back from -1")
        } else if count == 0 {
            format!("there is no {shown} of the {what}: none came before this line")
        } else {
            format!("there is no {shown} of the {what}: {count} came before this line")
        };
        return Err(line.error(word.span(), message));
    }
    Ok(if is_back { count as u64 - n } else { n - 1 } as u32)
}
