//! Triangle meshes: in memory, in files, and made of other shapes.
//!
//! Files are untrusted. Nothing is allocated for what a file claims before the bytes for it have been
//! seen, and no reader takes more memory than its [`Limits`] allow.
//!
//! PLY files are read by code of our own because the published readers build a table of boxed
//! values for each element, which is several times slower than the disk and takes many times the memory of
//! the mesh.

mod bytes;
mod error;
mod mesh;
pub mod obj;
pub mod ply;
mod subdivide;
pub mod text;
mod triangulate;

use std::path::Path;

pub use bytes::{Limits, read_file, unpack};
pub use error::{Error, Place};
pub use mesh::TriangleMesh;
pub use subdivide::loop_subdivide;

/// Reads the mesh in a file: OBJ if its name ends in `.obj` or `.obj.gz`, else PLY; both may be gzip-ed.
///
/// # Errors
/// If it cannot be read, is damaged, or larger than the limits allow.
pub fn read(path: &Path, limits: &Limits) -> Result<TriangleMesh, Error> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if name.ends_with(".obj") || name.ends_with(".obj.gz") {
        return obj::read(path, limits).map(|obj| obj.mesh);
    }
    ply::read(path, limits)
}
