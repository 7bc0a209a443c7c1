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
pub mod ply;
mod subdivide;
mod triangulate;

pub use bytes::{Limits, read_file, unpack};
pub use error::Error;
pub use mesh::TriangleMesh;
pub use subdivide::loop_subdivide;
