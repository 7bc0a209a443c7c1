//! Bilinear patches; those that are parallelograms become quads.

use zrak_core::math::{Vec3, cross};
use zrak_core::scene::{MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{MESH_NORMALS, MESH_UVS, Mesh, MeshPatch, Quad};

use super::meshes::{append_normals, append_positions};
use super::transform::Transform;
use crate::arena::SceneArrays;

/// How far corners may be off a parallelogram, as a share of its size: less than quads overlap.
const FLATNESS: f32 = 5e-7;

/// A mesh of patches as it is described.
pub(super) struct Patches<'a> {
    pub(super) positions: &'a [[f32; 3]],
    pub(super) patches: &'a [[u32; 4]],
    pub(super) normals: &'a [[f32; 3]],
    pub(super) uvs: &'a [[f32; 2]],
}

/// Adds the vertices and patches of a mesh; gives its primitives.
pub(super) fn append(
    mesh: &Patches<'_>,
    material: MaterialRef,
    flip: bool,
    to_world: &Transform,
    arrays: &mut SceneArrays,
) -> Result<Vec<PrimRef>, String> {
    let first_vertex = arrays.positions.len();
    if first_vertex + mesh.positions.len() > u32::MAX as usize {
        return Err("with this mesh, the scene has more than 2^28 vertices".to_owned());
    }
    let n = mesh.patches.len();
    if arrays.mesh_patches.len().max(arrays.quads.len()) + n > 1 << 28 {
        return Err("with this mesh, the scene has more than 2^28 patches".to_owned());
    }
    append_positions(mesh.positions, to_world, arrays)?;
    let first_vertex = first_vertex as u32;
    let offset = |len: usize| (len as u32).wrapping_sub(first_vertex);
    let (normal_offset, uv_offset) = (offset(arrays.normals.len()), offset(arrays.uvs.len()));
    let mut flags = 0;
    if !mesh.normals.is_empty() {
        flags |= MESH_NORMALS;
        append_normals(mesh.normals, flip, to_world, arrays);
    }
    if !mesh.uvs.is_empty() {
        flags |= MESH_UVS;
        arrays.uvs.extend_from_slice(mesh.uvs);
    }
    let mesh_index = arrays.meshes.len() as u32;
    arrays.meshes.push(Mesh {
        material,
        flags,
        normal_offset,
        uv_offset,
        ..bytemuck::Zeroable::zeroed()
    });
    // A reflection turns dp/du x dp/dv around, but the side that is the front stays it.
    let turns = (to_world.determinant() < 0.0) != flip;
    let mut prims = Vec::with_capacity(n);
    for patch in mesh.patches {
        let corners = patch.map(|v| arrays.positions[(v + first_vertex) as usize]);
        let has_own_uv = !mesh.uvs.is_empty()
            && patch.map(|v| mesh.uvs[v as usize])
                != [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        if mesh.normals.is_empty()
            && !has_own_uv
            && let Some(mut quad) = quad_of(corners, material)
        {
            quad.normal = if turns { -quad.normal } else { quad.normal };
            arrays.quads.push(quad);
            prims.push(PrimRef::new(PrimKind::Quad, arrays.quads.len() as u32 - 1));
        } else if has_area(corners) {
            arrays.mesh_patches.push(MeshPatch {
                vertices: patch.map(|v| v + first_vertex),
                mesh: mesh_index,
                flip: u32::from(turns),
                _pad: [0; 2],
            });
            let index = arrays.mesh_patches.len() as u32 - 1;
            prims.push(PrimRef::new(PrimKind::MeshPatch, index));
        }
    }
    Ok(prims)
}

/// The patch as a quad, if it is a parallelogram.
fn quad_of([p00, p10, p01, p11]: [Vec3; 4], material: MaterialRef) -> Option<Quad> {
    let (u, v) = (p10 - p00, p01 - p00);
    let off = ((p11 - p10) - v).abs().max_component();
    let size = u.length().min(v.length());
    let area = cross(u * (1.0 / u.length()), v * (1.0 / v.length())).length();
    // False for NaN.
    (off <= FLATNESS * size && area > 1e-3).then(|| Quad::new(p00, u, v, material))
}

/// Whether the corners are not all on one line.
fn has_area([p00, p10, p01, p11]: [Vec3; 4]) -> bool {
    let spans = |u: Vec3, v: Vec3| {
        let size = u.abs().max_component().max(v.abs().max_component());
        size > 0.0 && cross(u * (1.0 / size), v * (1.0 / size)) != Vec3::ZERO
    };
    spans(p10 - p00, p01 - p00) || spans(p10 - p00, p11 - p00) || spans(p11 - p00, p01 - p00)
}
