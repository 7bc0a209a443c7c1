//! Wavefront OBJ files: polygons, as text.
//!
//! Read are `v` (with colours behind the coordinates, as MeshLab and Blender write them: sRGB codes, made
//! linear), `vt`, `vn`, `f` with negative indices and any number of corners, `s`, `usemtl`, `mtllib`, `g` and
//! `o`. All faces make one mesh whose groups are the materials, or, in a file that names none, its
//! groups. Points, lines and free-form geometry are left out with a warning.
//!
//! A corner without a normal gets one if its face is in a smoothing group: the mean of the normals of the
//! faces of that group around the vertex, weighted by their angles. Other faces are flat.
//!
//! The reader is our own because the published ones do not say where in a file something is wrong, take
//! memory for anything that a file asks for, or leave out smoothing groups and the options of maps.

mod reader;
mod smooth;
mod weld;

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::{Error, Limits, TriangleMesh, read_file};

/// What is in an OBJ file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Obj {
    /// The faces; its groups are named by `usemtl`, or by `g` if no material is named.
    pub mesh: TriangleMesh,
    /// Whether the groups are materials.
    pub has_materials: bool,
    /// Where each group was first used, or 0 for faces before any.
    pub group_lines: Vec<usize>,
    /// What follows `mtllib`, each with its line: one name, or several.
    pub libraries: Vec<(String, usize)>,
    /// Name of the first object.
    pub name: Option<String>,
    /// What was left out, each with its line.
    pub warnings: Vec<(usize, String)>,
}

/// Reads a file, which may be gzip-ed.
///
/// # Errors
/// If it cannot be read, is not an OBJ file, is damaged, or larger than the limits allow.
pub fn read(path: &Path, limits: &Limits) -> Result<Obj, Error> {
    let bytes = read_file(path, limits)?;
    parse(&bytes, limits).map_err(|error| error.in_file(path.display()))
}

/// What the bytes of a file say. Triangles without an area are dropped.
///
/// # Errors
/// If it is not an OBJ file, is damaged, has no face with an area, or the mesh is larger than the limits
/// allow.
pub fn parse(bytes: &[u8], limits: &Limits) -> Result<Obj, Error> {
    let mut obj = reader::read(bytes, limits)?;
    let n_dropped = obj.mesh.drop_degenerate();
    if obj.mesh.triangles.is_empty() {
        return Err(Error::new("no face of the file has an area"));
    }
    if n_dropped > 0 {
        obj.warnings.push((0, format!("{n_dropped} triangles without an area are left out")));
    }
    obj.mesh.validate()?;
    Ok(obj)
}
