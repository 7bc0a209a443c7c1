//! Meshes as glTF has them.

use serde_json::{Map, Value, json};
use zrak_mesh::TriangleMesh;
use zrak_scene::lower::Transform;

use super::file::GltfFile;

/// How a mesh is written.
pub(super) struct Form<'a> {
    /// Materials of the mesh's face groups, without those of nothing.
    pub(super) materials: Vec<Option<usize>>,
    /// Whether its materials look at the colours of vertices; glTF's always would.
    pub(super) has_colors: bool,
    /// Whether the side that normals point to is the other one.
    pub(super) flip: bool,
    /// A map that nodes cannot have, for the vertices.
    pub(super) baked: Option<Transform>,
    pub(super) name: &'a str,
}

/// Adds a mesh; none if it has no triangle.
pub(super) fn write(file: &mut GltfFile, mesh: &TriangleMesh, form: &Form<'_>) -> Option<usize> {
    if mesh.triangles.is_empty() || mesh.positions.is_empty() {
        return None;
    }
    let attributes = attributes(file, mesh, form);
    let mirrors = form.baked.as_ref().is_some_and(|map| map.determinant() < 0.0);
    let swaps = form.flip != mirrors;
    let n = mesh.positions.len();
    let mut primitives = Vec::new();
    for (group, material) in form.materials.iter().enumerate() {
        let in_group = |i: usize| {
            mesh.face_groups.is_empty()
                || mesh.face_groups.get(i).is_some_and(|&g| g as usize == group)
        };
        let triangles: Vec<[u32; 3]> = mesh
            .triangles
            .iter()
            .enumerate()
            .filter(|&(i, triangle)| in_group(i) && triangle.iter().all(|&v| (v as usize) < n))
            .map(|(_, &[a, b, c])| if swaps { [a, c, b] } else { [a, b, c] })
            .collect();
        // A group without material is not there.
        if let (Some(material), false) = (material, triangles.is_empty()) {
            let indices = file.triangles(&triangles, n);
            primitives
                .push(json!({"attributes": attributes, "indices": indices, "material": material}));
        }
    }
    if primitives.is_empty() {
        return None;
    }
    Some(file.push("meshes", json!({"primitives": primitives, "name": form.name})))
}

/// The attributes and indices of a mesh, to be shared by several.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    attributes: Value,
    indices: usize,
}

impl Parts {
    pub(super) fn of(file: &mut GltfFile, mesh: &TriangleMesh) -> Self {
        let form =
            Form { materials: Vec::new(), has_colors: false, flip: false, baked: None, name: "" };
        let attributes = attributes(file, mesh, &form);
        let indices = file.triangles(&mesh.triangles, mesh.positions.len());
        Self { attributes, indices }
    }

    /// Adds a mesh of them.
    pub(super) fn mesh(&self, file: &mut GltfFile, material: usize) -> usize {
        let Self { attributes, indices } = self;
        let primitive = json!({"attributes": attributes, "indices": indices, "material": material});
        file.push("meshes", json!({"primitives": [primitive]}))
    }
}

fn attributes(file: &mut GltfFile, mesh: &TriangleMesh, form: &Form<'_>) -> Value {
    let mut attributes = Map::new();
    let mut add = |name: &str, accessor: usize| attributes.insert(name.into(), json!(accessor));
    let n = mesh.positions.len();
    let map = form.baked.as_ref();
    let single = |v: [f64; 3]| v.map(|x| x as f32);
    let positions = mesh.positions.iter().map(|&p| match map {
        Some(map) => single(map.point(p.map(f64::from))),
        None => p,
    });
    add("POSITION", file.floats(&positions.collect::<Vec<_>>(), true));
    if mesh.normals.len() == n {
        let back = map.and_then(Transform::inverse);
        let sign = if form.flip { -1.0 } else { 1.0 };
        let normals = mesh.normals.iter().map(|normal| {
            let v = normal.map(|x| f64::from(x) * sign);
            unit(back.as_ref().map_or(v, |back| back.transposed_vector(v)))
        });
        add("NORMAL", file.floats(&normals.collect::<Vec<_>>(), false));
        if mesh.tangents.len() == n {
            let mirrors = map.is_some_and(|map| map.determinant() < 0.0);
            let tangents = mesh.tangents.iter().map(|&[x, y, z, w]| {
                let t = [x, y, z].map(f64::from);
                let [x, y, z] = unit(map.map_or(t, |map| map.vector(t)));
                let w = if w < 0.0 { -1.0 } else { 1.0 };
                [x, y, z, if mirrors != form.flip { -w } else { w }]
            });
            add("TANGENT", file.floats(&tangents.collect::<Vec<_>>(), false));
        }
    }
    if mesh.uvs.len() == n {
        // glTF's v points down.
        let uvs: Vec<[f32; 2]> = mesh.uvs.iter().map(|&[u, v]| [u, 1.0 - v]).collect();
        add("TEXCOORD_0", file.floats(&uvs, false));
    }
    if form.has_colors && mesh.colors.len() == n {
        add("COLOR_0", file.floats(&mesh.colors, false));
    }
    Value::Object(attributes)
}

fn unit(v: [f64; 3]) -> [f32; 3] {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return [0.0, 0.0, 1.0];
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| (x / length) as f32)
}

/// Whether a map is a scale, then a turn, then a move, which is all that nodes can have.
pub(super) fn fits_node(map: &Transform) -> bool {
    let column = |j: usize| [map.rows[0][j], map.rows[1][j], map.rows[2][j]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let columns = [column(0), column(1), column(2)];
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
        let (a, b) = (columns[i], columns[j]);
        dot(a, b).abs() <= 1e-7 * (dot(a, a) * dot(b, b)).sqrt()
    })
}

/// A node's matrix; none for the identity.
pub(super) fn matrix(map: &Transform) -> Option<Value> {
    let r = &map.rows;
    let column = |j: usize| [r[0][j], r[1][j], r[2][j]];
    let mut numbers = Vec::with_capacity(16);
    for j in 0..4 {
        numbers.extend(column(j));
        numbers.push(if j == 3 { 1.0 } else { 0.0 });
    }
    (*map != Transform::IDENTITY).then(|| json!(numbers))
}
