//! Triangle meshes.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use zrak_mesh::TriangleMesh;

impl MeshDesc {
    /// The mesh with its numbers written out, if it is one in memory.
    #[must_use]
    pub fn inlined(&self) -> Self {
        match self {
            Self::Loaded(mesh) => Self::Inline {
                positions: mesh.positions.clone(),
                triangles: mesh.triangles.clone(),
                normals: mesh.normals.clone(),
                uvs: mesh.uvs.clone(),
                colors: mesh.colors.clone(),
            },
            other => other.clone(),
        }
    }
}

/// A mesh, by the file it is in or by its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MeshDesc {
    /// PLY or OBJ file, which may be gzip-ed; of an OBJ file the faces, not the materials.
    File {
        /// The file, relative to the scene file.
        path: String,
    },
    /// The numbers themselves.
    Inline {
        /// Positions of the vertices.
        positions: Vec<[f32; 3]>,
        /// Three indices of vertices for each triangle.
        triangles: Vec<[u32; 3]>,
        /// Normal at each vertex, or nothing.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        normals: Vec<[f32; 3]>,
        /// Texture coordinates of each vertex, or nothing.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        uvs: Vec<[f32; 2]>,
        /// Linear red, green, blue and alpha of each vertex, or nothing.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        colors: Vec<[f32; 4]>,
    },
    /// Bilinear patches.
    Patches {
        /// Positions of the vertices.
        positions: Vec<[f32; 3]>,
        /// Four indices of vertices for each patch: where (u, v) is (0, 0), (1, 0), (0, 1) and (1, 1).
        patches: Vec<[u32; 4]>,
        /// Normal at each vertex, or nothing.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        normals: Vec<[f32; 3]>,
        /// Texture coordinates of each vertex, or nothing.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        uvs: Vec<[f32; 2]>,
    },
    /// A mesh in memory, from an importer or a program; in a scene file its numbers are written out.
    #[serde(skip)]
    Loaded(#[schemars(skip)] Arc<TriangleMesh>),
}
