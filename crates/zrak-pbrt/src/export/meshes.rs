//! Meshes: in the scene file if they are small, else as binary PLY files beside it.

use std::borrow::Cow;
use std::collections::HashMap;

use zrak_mesh::{Limits, TriangleMesh, ply};
use zrak_scene::desc::MeshDesc;
use zrak_scene::error::SceneError;

use super::text::{param, word};
use super::{Writer, failure};

type Result<T> = std::result::Result<T, SceneError>;

impl Writer<'_, '_> {
    /// The shapes of a mesh, each a type and parameters, with the name of its material.
    pub(super) fn mesh_shapes(
        &mut self,
        name: &str,
        material: &str,
        group_materials: &[String],
    ) -> Result<Vec<(String, String)>> {
        let desc = self.desc;
        let Some(mesh) = desc.meshes.get(name) else { return Ok(Vec::new()) };
        if let Some(known) = self.meshes.get(name).filter(|_| group_materials.is_empty()) {
            return Ok(vec![(material.to_owned(), known.clone())]);
        }
        let mesh = match mesh {
            MeshDesc::Patches { positions, patches, normals, uvs } => {
                let mut shape = "\"bilinearmesh\"".to_owned()
                    + &param("integer", "indices", patches.iter().flatten())
                    + &param("point3", "P", positions.iter().flatten());
                if !normals.is_empty() {
                    shape += &param("normal3", "N", normals.iter().flatten());
                }
                if !uvs.is_empty() {
                    shape += &param("point2", "uv", uvs.iter().flatten());
                }
                self.meshes.insert(name.to_owned(), shape.clone());
                return Ok(vec![(material.to_owned(), shape)]);
            }
            MeshDesc::File { path } => {
                let limits = Limits { max_bytes: self.options.max_bytes };
                let read = zrak_mesh::read(&self.base_dir.join(path), &limits);
                Cow::Owned(read.map_err(|error| failure(&error.to_string()))?)
            }
            MeshDesc::Inline { positions, triangles, normals, uvs, colors } => {
                Cow::Owned(TriangleMesh {
                    positions: positions.clone(),
                    triangles: triangles.clone(),
                    normals: normals.clone(),
                    uvs: uvs.clone(),
                    colors: colors.clone(),
                    ..TriangleMesh::default()
                })
            }
            MeshDesc::Loaded(mesh) => Cow::Borrowed(mesh.as_ref()),
        };
        if group_materials.is_empty() || mesh.face_groups.is_empty() {
            let shape = self.mesh_shape(name, &mesh)?;
            if group_materials.is_empty() {
                self.meshes.insert(name.to_owned(), shape.clone());
            }
            return Ok(vec![(material.to_owned(), shape)]);
        }
        let mut shapes = Vec::new();
        let n_groups = mesh.face_groups.iter().max().map_or(0, |most| most + 1);
        for group in 0..n_groups {
            let part = part_of(&mesh, group);
            if part.triangles.is_empty() {
                continue;
            }
            let material = group_materials.get(group as usize).map_or(material, String::as_str);
            let shape = self.mesh_shape(&format!("{name}-{group}"), &part)?;
            shapes.push((material.to_owned(), shape));
        }
        Ok(shapes)
    }

    fn mesh_shape(&mut self, name: &str, mesh: &TriangleMesh) -> Result<String> {
        if !mesh.colors.is_empty() {
            self.warn("colours of vertices are in the PLY files, where pbrt does not look at them");
        }
        if mesh.triangles.len() <= self.options.max_inline && mesh.colors.is_empty() {
            return Ok(inline(mesh));
        }
        let mut bytes = Vec::new();
        ply::write(&mut bytes, mesh).map_err(|error| failure(&error.to_string()))?;
        let path = (self.sink)(&format!("{name}.ply"), &bytes)?;
        Ok("\"plymesh\"".to_owned() + &word("string", "filename", &path))
    }
}

/// A triangle mesh among the parameters of a shape.
pub(super) fn inline(mesh: &TriangleMesh) -> String {
    let mut shape = "\"trianglemesh\"".to_owned()
        + &param("integer", "indices", mesh.triangles.iter().flatten())
        + &param("point3", "P", mesh.positions.iter().flatten());
    if !mesh.normals.is_empty() {
        shape += &param("normal", "N", mesh.normals.iter().flatten());
    }
    if !mesh.uvs.is_empty() {
        shape += &param("point2", "uv", mesh.uvs.iter().flatten());
    }
    shape
}

/// The triangles of a group, and their vertices.
fn part_of(mesh: &TriangleMesh, group: u32) -> TriangleMesh {
    let mut part = TriangleMesh::default();
    let mut known: HashMap<u32, u32> = HashMap::new();
    for (triangle, _) in mesh.triangles.iter().zip(&mesh.face_groups).filter(|(_, g)| **g == group)
    {
        let corners = triangle.map(|v| {
            *known.entry(v).or_insert_with(|| {
                let i = v as usize;
                part.positions.push(mesh.positions[i]);
                part.normals.extend(mesh.normals.get(i));
                part.uvs.extend(mesh.uvs.get(i));
                part.colors.extend(mesh.colors.get(i));
                part.positions.len() as u32 - 1
            })
        });
        part.triangles.push(corners);
    }
    part
}
