//! The faces of a PLY file.

use rayon::prelude::*;

use super::body::{CHUNK, Source};
use super::header::{Element, Format, Property, Scalar};
use crate::triangulate::triangulate;
use crate::{Error, Limits, TriangleMesh};

/// Most groups of faces.
const GROUPS_MAX: u32 = 65_536;

/// Faces between two looks at the memory that triangles take.
const FACES_PER_CHECK: u64 = 1 << 12;

pub(super) fn faces(
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
    if let Some(layout) = Layout::of(source, element, corners) {
        let is_done = mesh.triangles.is_empty() && all_triangles(source, element, &layout, mesh);
        if !is_done {
            polygons(source, element, &layout, mesh, limits)?;
        }
        return name_groups(mesh);
    }
    let group = element.properties.iter().position(is_group);
    let n_vertices = mesh.positions.len();
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
            return Err(beyond(i, x, n_vertices));
        }
        triangulate(&polygon, &mesh.positions, &mut mesh.triangles);
        if group.is_some() {
            // What is no number of a group becomes one that is too large.
            mesh.face_groups.resize(mesh.triangles.len(), group_of_face as u32);
        }
        if i % FACES_PER_CHECK == 0 {
            check_memory(mesh, limits)?;
        }
    }
    check_memory(mesh, limits)?;
    name_groups(mesh)
}

fn is_group(property: &Property) -> bool {
    property.list.is_none() && property.name == "group"
}

/// Groups have numbers for names.
fn name_groups(mesh: &mut TriangleMesh) -> Result<(), Error> {
    let Some(largest) = mesh.face_groups.par_iter().max() else { return Ok(()) };
    if *largest >= GROUPS_MAX {
        let message = format!("a face is of group {largest}; groups have numbers from 0 to 65535");
        return Err(Error::new(message));
    }
    mesh.groups = (0..=*largest).map(|i| i.to_string()).collect();
    Ok(())
}

fn beyond(face: u64, corner: f64, n_vertices: usize) -> Error {
    Error::new(format!(
        "face {face} has a corner {corner}, but vertices are counted from 0 to {}",
        n_vertices - 1
    ))
}

fn check_memory(mesh: &TriangleMesh, limits: &Limits) -> Result<(), Error> {
    if (mesh.triangles.len() as u64).saturating_mul(12) > limits.max_bytes {
        return Err(Error::new("the triangles take more memory than the limit allows"));
    }
    Ok(())
}

/// Records of bytes with one list, the corners: what comes before it, its types, and what follows.
struct Layout {
    before: usize,
    count: Scalar,
    index: Scalar,
    after: usize,
    /// Whether the group of a face comes after its corners, where in that part, and its type.
    group: Option<(bool, usize, Scalar)>,
    big: bool,
}

impl Layout {
    fn of(source: &Source<'_>, element: &Element, corners: usize) -> Option<Self> {
        let (before, rest) = element.properties.split_at(corners);
        let (list, after) = rest.split_first()?;
        let size = |properties: &[Property]| -> Option<usize> {
            properties.iter().map(|p| p.list.is_none().then(|| p.scalar.n_bytes())).sum()
        };
        let is_bytes = source.format != Format::Ascii && list.scalar.is_integer();
        let group = [before, after].into_iter().enumerate().find_map(|(k, part)| {
            let i = part.iter().position(is_group)?;
            Some((k == 1, size(&part[..i])?, part[i].scalar))
        });
        is_bytes.then_some(Self {
            before: size(before)?,
            count: list.list?,
            index: list.scalar,
            after: size(after)?,
            group,
            big: source.format == Format::BigEndian,
        })
    }
}

impl Layout {
    /// The group of a face, if it has one, from the bytes before and after its corners.
    #[inline(always)]
    fn group(&self, before: &[u8], after: &[u8]) -> Option<u32> {
        let (is_after, at, scalar) = self.group?;
        let bytes = &(if is_after { after } else { before })[at..at + scalar.n_bytes()];
        Some(match scalar {
            Scalar::F32 | Scalar::F64 => super::body::decode(bytes, scalar, self.big) as u32,
            _ => integer(bytes, scalar, self.big).unwrap_or(u32::MAX),
        })
    }
}

/// An integer from its bytes; none if it is negative.
#[inline(always)]
fn integer(bytes: &[u8], scalar: Scalar, big: bool) -> Option<u32> {
    match (scalar, bytes) {
        (Scalar::U8, &[a]) => Some(u32::from(a)),
        (Scalar::I8, &[a]) => u32::try_from(a as i8).ok(),
        (Scalar::U16 | Scalar::I16, &[a, b]) => {
            let x = if big { u16::from_be_bytes([a, b]) } else { u16::from_le_bytes([a, b]) };
            if scalar == Scalar::U16 { Some(u32::from(x)) } else { u32::try_from(x as i16).ok() }
        }
        (Scalar::U32 | Scalar::I32, &[a, b, c, d]) => {
            let x = [a, b, c, d];
            let x = if big { u32::from_be_bytes(x) } else { u32::from_le_bytes(x) };
            if scalar == Scalar::U32 { Some(x) } else { u32::try_from(x as i32).ok() }
        }
        _ => None,
    }
}

/// Reads faces that are all triangles, all at once. False, with nothing read, if they are not.
fn all_triangles(
    source: &mut Source<'_>,
    element: &Element,
    layout: &Layout,
    mesh: &mut TriangleMesh,
) -> bool {
    let Layout { before, count, index, after, big, .. } = *layout;
    let (first, size) = (before + count.n_bytes(), index.n_bytes());
    let stride = first + 3 * size + after;
    let n = element.count as usize;
    let Some(body) =
        n.checked_mul(stride).and_then(|len| source.bytes.get(source.at..source.at + len))
    else {
        return false;
    };
    let is_triangle = |r: &[u8]| integer(&r[before..first], count, big) == Some(3);
    let all = |part: &[u8]| part.chunks_exact(stride).all(is_triangle);
    if !body.par_chunks(CHUNK * stride).all(all) {
        return false;
    }
    let mut triangles = vec![[0; 3]; n];
    triangles.par_chunks_mut(CHUNK).zip(body.par_chunks(CHUNK * stride)).for_each(|(out, part)| {
        // Indices out of range, which negative ones become, are found by the mesh's validation.
        match (index, big) {
            (Scalar::I32 | Scalar::U32, false) => {
                copy(out, part.chunks_exact(stride), first, u32::from_le_bytes);
            }
            (Scalar::I32 | Scalar::U32, true) => {
                copy(out, part.chunks_exact(stride), first, u32::from_be_bytes);
            }
            _ => {
                for (triangle, record) in out.iter_mut().zip(part.chunks_exact(stride)) {
                    *triangle = [0, 1, 2].map(|k| {
                        let at = first + k * size;
                        integer(&record[at..at + size], index, big).unwrap_or(u32::MAX)
                    });
                }
            }
        }
    });
    mesh.triangles = triangles;
    if layout.group.is_some() {
        let group = |r: &[u8]| layout.group(&r[..before], &r[stride - after..]).unwrap_or(0);
        mesh.face_groups = body.par_chunks_exact(stride).with_min_len(CHUNK).map(group).collect();
    }
    source.at += n * stride;
    true
}

#[inline(always)]
fn copy<'a>(
    out: &mut [[u32; 3]],
    records: impl Iterator<Item = &'a [u8]>,
    at: usize,
    number: impl Fn([u8; 4]) -> u32,
) {
    for (triangle, record) in out.iter_mut().zip(records) {
        if let [a, b, c, d, e, f, g, h, i, j, k, l] = record[at..at + 12] {
            *triangle = [number([a, b, c, d]), number([e, f, g, h]), number([i, j, k, l])];
        }
    }
}

/// Reads faces of any numbers of corners.
fn polygons(
    source: &mut Source<'_>,
    element: &Element,
    layout: &Layout,
    mesh: &mut TriangleMesh,
    limits: &Limits,
) -> Result<(), Error> {
    let Layout { before, count, index, after, big, .. } = *layout;
    let n_vertices = mesh.positions.len();
    let mut polygon = Vec::new();
    let mut rest = &source.bytes[source.at..];
    for i in 0..element.count {
        let mut take = |n: usize| -> Option<&[u8]> {
            let (taken, left) = rest.split_at_checked(n)?;
            rest = left;
            Some(taken)
        };
        let head = take(before);
        let n_corners = take(count.n_bytes()).and_then(|bytes| integer(bytes, count, big));
        let corners = n_corners.and_then(|n| take(n as usize * index.n_bytes()));
        let (Some(head), Some(corners), Some(tail)) = (head, corners, take(after)) else {
            return Err(source.cut_off(element, i));
        };
        polygon.clear();
        for bytes in corners.chunks_exact(index.n_bytes()) {
            match integer(bytes, index, big) {
                Some(corner) if (corner as usize) < n_vertices => polygon.push(corner),
                _ => {
                    let corner = super::body::decode(bytes, index, big);
                    return Err(beyond(i, corner, n_vertices));
                }
            }
        }
        triangulate(&polygon, &mesh.positions, &mut mesh.triangles);
        if let Some(group) = layout.group(head, tail) {
            mesh.face_groups.resize(mesh.triangles.len(), group);
        }
        if i % FACES_PER_CHECK == 0 {
            check_memory(mesh, limits)?;
        }
    }
    source.at = source.bytes.len() - rest.len();
    check_memory(mesh, limits)
}
