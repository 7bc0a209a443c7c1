//! Checks that triangles and patches of meshes lead to vertices, and vertices to all that their meshes say they have.

use zrak_core::scene::SceneView;
use zrak_core::shapes::{MESH_COLORS, MESH_NORMALS, MESH_TANGENTS, MESH_UVS, Mesh, MeshTriangle};

use super::{Check, each, require};
use crate::arena::PIECE_SIZE;

const PIECE: usize = PIECE_SIZE / size_of::<MeshTriangle>();

pub(super) struct MeshChecker<'a> {
    scene: SceneView<'a>,
    /// Vertices, from and to, that have all that each mesh needs; maybe not all such.
    good: Vec<[u32; 2]>,
}

/// Numbers of vertices' attributes that a mesh has: where they start, modulo 2^32, and how many there are.
fn attributes(scene: &SceneView, mesh: &Mesh) -> [Option<(u32, u32)>; 4] {
    [
        (MESH_NORMALS, mesh.normal_offset, scene.normals.len()),
        (MESH_UVS, mesh.uv_offset, scene.uvs.len()),
        (MESH_TANGENTS, mesh.tangent_offset, scene.tangents.len()),
        (MESH_COLORS, mesh.color_offset, scene.colors.len()),
    ]
    .map(|(flag, offset, len)| (mesh.flags & flag != 0).then_some((offset, len)))
}

impl<'a> MeshChecker<'a> {
    pub(super) fn new(scene: &SceneView<'a>) -> Self {
        let good = |i: u32| {
            let mut range = [0, scene.positions.len()];
            for (offset, len) in attributes(scene, &scene.meshes.get(i)).into_iter().flatten() {
                // v + offset < len, modulo 2^32, for v from -offset on, as long as that does not wrap.
                let first = offset.wrapping_neg();
                let Some(end) = first.checked_add(len) else { return [0, 0] };
                range = [range[0].max(first), range[1].min(end)];
            }
            range
        };
        Self { scene: *scene, good: (0..scene.meshes.len()).map(good).collect() }
    }

    /// Checks a piece of the triangles.
    #[inline(never)]
    pub(super) fn check_piece(&self, index: usize) -> Check {
        let triangles = self.scene.mesh_triangles;
        let first = (index * PIECE) as u32;
        let end = triangles.len().min(first.saturating_add(PIECE as u32));
        for i in first..end {
            let triangle = triangles.get(i);
            let is_good = match self.good.get(triangle.mesh as usize) {
                Some(&[first, end]) => triangle.vertices.iter().all(|&v| first <= v && v < end),
                None => false,
            };
            if !is_good {
                self.check_closely(triangle.mesh, &triangle.vertices)?;
            }
        }
        Ok(())
    }

    /// Checks all patches.
    pub(super) fn check_patches(&self) -> Check {
        each(&self.scene.mesh_patches, |_, patch| self.check_closely(patch.mesh, &patch.vertices))
    }

    #[cold]
    #[inline(never)]
    fn check_closely(&self, mesh: u32, vertices: &[u32]) -> Check {
        let scene = &self.scene;
        require(mesh < scene.meshes.len(), || format!("no mesh {mesh}"))?;
        let mesh = scene.meshes.get(mesh);
        for &v in vertices {
            require(v < scene.positions.len(), || format!("no vertex {v}"))?;
            for (offset, len) in attributes(scene, &mesh).into_iter().flatten() {
                require(v.wrapping_add(offset) < len, || {
                    format!("vertex {v} lacks an attribute of its mesh")
                })?;
            }
        }
        Ok(())
    }
}
