//! Triangle meshes.

mod mesh;

pub use mesh::TriangleMesh;
