//! Indexed triangles in memory.

use rayon::prelude::*;

use crate::Error;

/// Vertices or triangles that a thread looks at at a time.
const CHUNK: usize = 1 << 15;

/// Indexed triangles. Arrays other than `positions` and `triangles` are empty if there is nothing in
/// them, and else have one entry for each vertex or, `face_groups`, for each triangle.
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

impl TriangleMesh {
    /// Checks that indices lead to vertices, arrays have their lengths, and numbers are finite.
    ///
    /// # Errors
    /// If one of these does not hold, or there is no triangle.
    pub fn validate(&self) -> Result<(), Error> {
        let n = self.positions.len();
        if n == 0 || self.triangles.is_empty() {
            return Err(Error::new("the mesh has no triangles"));
        }
        for (name, len) in [
            ("normals", self.normals.len()),
            ("tangents", self.tangents.len()),
            ("texture coordinates", self.uvs.len()),
            ("colours", self.colors.len()),
        ] {
            if len != 0 && len != n {
                return Err(Error::new(format!("the mesh has {n} vertices but {len} {name}")));
            }
        }
        if !self.face_groups.is_empty() {
            if self.face_groups.len() != self.triangles.len() {
                return Err(Error::new("not every triangle of the mesh has a group"));
            }
            let n_groups = self.groups.len();
            if let Some(group) = self.face_groups.iter().find(|&&g| g as usize >= n_groups) {
                return Err(Error::new(format!("the mesh has no group {group}")));
            }
        }
        let is_beyond = |t: &[u32; 3]| t.iter().any(|&v| v as usize >= n);
        if let Some(i) = find(&self.triangles, is_beyond) {
            let message = format!(
                "triangle {i} of the mesh has a corner beyond its {n} vertices: {:?}",
                self.triangles[i]
            );
            return Err(Error::new(message));
        }
        finite("position", &self.positions)?;
        finite("normal", &self.normals)?;
        finite("tangent", &self.tangents)?;
        finite("texture coordinate", &self.uvs)?;
        finite("colour", &self.colors)
    }

    /// Removes triangles without an area, which no ray can hit; gives their number.
    pub fn drop_degenerate(&mut self) -> usize {
        let positions = &self.positions;
        let has_area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            t[0] != t[1] && t[1] != t[2] && t[2] != t[0] && a != b && b != c && c != a && {
                let sub =
                    |p: [f32; 3], q: [f32; 3]| [0, 1, 2].map(|i| f64::from(p[i]) - f64::from(q[i]));
                let (u, v) = (sub(b, a), sub(c, a));
                (0..3).any(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    u[j] * v[k] != u[k] * v[j]
                })
            }
        };
        // Most meshes have none, and nothing has to be moved.
        if find(&self.triangles, |t| !has_area(t)).is_none() {
            return 0;
        }
        let before = self.triangles.len();
        if self.face_groups.is_empty() {
            self.triangles.retain(has_area);
        } else {
            let keep: Vec<bool> = self.triangles.iter().map(has_area).collect();
            let mut kept = keep.iter();
            self.triangles.retain(|_| *kept.next().unwrap_or(&true));
            let mut kept = keep.iter();
            self.face_groups.retain(|_| *kept.next().unwrap_or(&true));
        }
        before - self.triangles.len()
    }

    /// Bytes of all arrays.
    #[must_use]
    pub fn n_bytes(&self) -> usize {
        size_of_val(self.positions.as_slice())
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.tangents.as_slice())
            + size_of_val(self.uvs.as_slice())
            + size_of_val(self.colors.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.face_groups.as_slice())
    }
}

/// Index of the first item that is so.
fn find<T: Sync>(items: &[T], is: impl Fn(&T) -> bool + Sync) -> Option<usize> {
    let has = |chunk: &[T]| chunk.iter().any(&is);
    let first = items.par_chunks(CHUNK).position_first(has)? * CHUNK;
    items[first..].iter().position(is).map(|i| first + i)
}

fn finite<const N: usize>(what: &str, values: &[[f32; N]]) -> Result<(), Error> {
    match find(values, |v| v.iter().any(|x| !x.is_finite())) {
        Some(i) => {
            let message =
                format!("the {what} of vertex {i} of the mesh is not finite: {:?}", values[i]);
            Err(Error::new(message))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::TriangleMesh;

    fn triangle() -> TriangleMesh {
        TriangleMesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..TriangleMesh::default()
        }
    }

    #[test]
    fn damage_is_found() {
        assert_eq!(triangle().validate(), Ok(()));
        let refused = |words: &str, damage: fn(&mut TriangleMesh)| {
            let mut mesh = triangle();
            damage(&mut mesh);
            let error = mesh.validate().unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        refused("no triangles", |m| m.triangles.clear());
        refused("no triangles", |m| m.positions.clear());
        refused("corner beyond", |m| m.triangles[0][1] = 3);
        refused("position of vertex 2", |m| m.positions[2][0] = f32::NAN);
        refused("position of vertex 1", |m| m.positions[1][2] = f32::INFINITY);
        refused("3 vertices but 2 normals", |m| m.normals = vec![[1.0; 3]; 2]);
        refused("but 1 texture", |m| m.uvs = vec![[1.0; 2]]);
        refused("no group 0", |m| m.face_groups = vec![0]);
        refused("not every triangle", |m| m.face_groups = vec![0, 0]);
    }

    #[test]
    fn triangles_without_an_area_are_dropped() {
        let mut mesh = triangle();
        mesh.positions.push([0.5, 0.0, 0.0]);
        mesh.positions.push([0.0, 0.0, 0.0]);
        mesh.triangles = vec![[0, 0, 1], [0, 1, 2], [0, 1, 3], [0, 4, 2], [1, 2, 3]];
        mesh.face_groups = vec![0, 1, 2, 3, 4];
        mesh.groups = vec![String::new(); 5];
        assert_eq!(mesh.drop_degenerate(), 3);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 2, 3]]);
        assert_eq!(mesh.face_groups, [1, 4]);
    }
}
