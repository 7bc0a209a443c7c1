//! PLY files: the Stanford polygon format, as text and as bytes of both orders.
//!
//! Read are the elements `vertex` (x y z; nx ny nz; u v, s t, texture_u texture_v or texture_s texture_t;
//! red green blue and alpha) and `face` (vertex_indices or vertex_index). Everything else is skipped, but
//! for what only zrak writes: tangents (tx ty tz tw) and the groups of faces (group).
//! Colours of integer type are sRGB codes, as scanners write them, and are made linear; those of
//! floating-point type are linear.

mod body;
mod faces;
mod header;
mod vertices;
mod write;

#[cfg(test)]
mod tests;

use std::path::Path;

pub(crate) use vertices::linear;
pub use write::write;

use crate::{Error, Limits, TriangleMesh, read_file};

/// Reads a file, which may be gzip-ed.
///
/// # Errors
/// If it cannot be read, is not a PLY file, is damaged, or larger than the limits allow.
pub fn read(path: &Path, limits: &Limits) -> Result<TriangleMesh, Error> {
    let bytes = read_file(path, limits)?;
    parse(&bytes, limits).map_err(|error| error.in_file(path.display()))
}

/// The mesh in the bytes of a file. Triangles without an area are dropped.
///
/// # Errors
/// If it is not a PLY file, is damaged, or the mesh is larger than the limits allow.
pub fn parse(bytes: &[u8], limits: &Limits) -> Result<TriangleMesh, Error> {
    let header = header::parse(bytes)?;
    let mut mesh = body::parse(bytes, &header, limits)?;
    mesh.validate()?;
    mesh.drop_degenerate();
    Ok(mesh)
}
