//! Indexed triangles in memory.

/// Indexed triangles. Arrays other than `positions` and `triangles` are empty if there is nothing in
/// them, and else have one entry for each vertex or, the last, for each triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// Normals, of any length but zero.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents and their handedness, 1 or -1, as glTF has them.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates.
    pub uvs: Vec<[f32; 2]>,
    /// Linear red, green, blue, and alpha.
    pub colors: Vec<[f32; 4]>,
    /// Indices of three vertices each, counter-clockwise seen from where the normal points.
    pub triangles: Vec<[u32; 3]>,
    /// Group of each triangle, an index into `groups`.
    pub face_groups: Vec<u32>,
    /// Names of the groups: materials, in OBJ files.
    pub groups: Vec<String>,
}
