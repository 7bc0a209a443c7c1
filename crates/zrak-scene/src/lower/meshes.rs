//! Meshes: read before they are placed, and brought into the space that they are placed in.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use rayon::prelude::*;
use zrak_core::math::Vec3;
use zrak_core::scene::{MaterialRef, PrimKind, PrimRef};
use zrak_core::shapes::{MESH_COLORS, MESH_NORMALS, MESH_TANGENTS, MESH_UVS, Mesh, MeshTriangle};
use zrak_mesh::TriangleMesh;

use super::budget::Budget;
use super::patches::{self, Patches};
use super::transform::Transform;
use super::{LowerOptions, assets};
use crate::arena::SceneArrays;
use crate::desc::{MeshDesc, ObjectDesc, SceneDesc, Triple};
use crate::validate::limits::NUMBER_MAX;
use crate::validate::{KeyPath, Problem};

/// Meshes of fewer triangles are copied rather than shared: a tree of their own costs more.
const SHARED_MIN: usize = 64;

/// The meshes of a scene.
pub(super) struct Meshes<'a> {
    desc: &'a SceneDesc,
    options: &'a LowerOptions,
    /// What meshes, and what is placed, may still take.
    pub(super) budget: &'a Budget,
    /// How often each is placed.
    n_uses: HashMap<&'a str, usize>,
    read: HashMap<&'a str, Result<Arc<TriangleMesh>, String>>,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(desc: &'a SceneDesc, options: &'a LowerOptions, budget: &'a Budget) -> Self {
        let mut n_uses = HashMap::new();
        // Those of prototypes that are placed count once, however often that is.
        let mut placed = HashSet::new();
        let mut lists: Vec<&[ObjectDesc]> = vec![&desc.objects];
        while let Some(objects) = lists.pop() {
            for object in objects {
                match object {
                    ObjectDesc::Mesh { mesh, .. } => {
                        *n_uses.entry(mesh.as_str()).or_insert(0) += 1;
                    }
                    ObjectDesc::Group { objects, .. } => lists.push(objects),
                    ObjectDesc::Instance { prototype, .. } if placed.insert(prototype.as_str()) => {
                        lists.extend(desc.prototypes.get(prototype).map(Vec::as_slice));
                    }
                    _ => {}
                }
            }
        }
        Self { desc, options, budget, n_uses, read: HashMap::new() }
    }

    /// Reads the files of the meshes that are placed, all at once. What is wrong with one is said when it
    /// is placed, so that errors come in the same order every time.
    pub(super) fn read_files(&mut self) {
        let mut wanted: Vec<(&'a str, &'a MeshDesc)> = Vec::new();
        for (name, desc) in &self.desc.meshes {
            if matches!(desc, MeshDesc::File { .. }) && self.n_uses.contains_key(name.as_str()) {
                wanted.push((name, desc));
            }
        }
        let this = &*self;
        let read = wanted.into_par_iter().map(|(name, desc)| (name, this.load(desc))).collect();
        self.read = read;
    }

    /// Whether a mesh is placed more than once and large enough to be stored once for all.
    pub(super) fn is_shared(&mut self, name: &str) -> bool {
        let is_large = |n: usize| n >= SHARED_MIN;
        self.n_uses.get(name).is_some_and(|&n| n > 1)
            && match &self.desc.meshes[name] {
                MeshDesc::Inline { triangles, .. } => is_large(triangles.len()),
                MeshDesc::Patches { patches, .. } => is_large(patches.len()),
                MeshDesc::Loaded(mesh) => is_large(mesh.triangles.len()),
                MeshDesc::File { .. } => true,
            }
    }

    /// Adds a mesh to the arrays, placed by a map; gives its triangles.
    pub(super) fn add(
        &mut self,
        name: &str,
        materials: &[MaterialRef],
        flip: bool,
        to_world: &Transform,
        arrays: &mut SceneArrays,
    ) -> Result<impl Iterator<Item = PrimRef> + use<>, Problem> {
        let problem = |message: String, help: Option<&str>| Problem {
            path: KeyPath::default().join("meshes").join(name),
            message,
            help: help.map(str::to_owned),
        };
        let (key, desc) = self
            .desc
            .meshes
            .get_key_value(name)
            .ok_or_else(|| problem(format!("unknown mesh `{name}`"), None))?;
        let help = Some("choose a larger unit of length, or mend the file");
        if let MeshDesc::Patches { positions, patches, normals, uvs } = desc {
            let mesh = Patches { positions, patches, normals, uvs };
            let prims = patches::append(&mesh, materials[0], flip, to_world, arrays)
                .map_err(|message| problem(message, help))?;
            return Ok((0..0).map(triangle as fn(u32) -> PrimRef).chain(prims));
        }
        // What is placed once is not kept.
        let is_kept = self.n_uses.get(name).is_some_and(|&n| n > 1);
        let mesh = match self.read.remove(name) {
            Some(mesh) => mesh,
            None => self.load(desc),
        };
        if is_kept {
            self.read.insert(key, mesh.clone());
        }
        let mesh = mesh.map_err(|message| problem(message, None))?;
        let too_many = |what: &str| {
            problem(format!("with this mesh, the scene has more than 2^28 {what}"), None)
        };
        let first = arrays.mesh_triangles.len();
        if first + mesh.triangles.len() > 1 << 28 {
            return Err(too_many("triangles"));
        }
        if arrays.positions.len() + mesh.positions.len() > u32::MAX as usize {
            return Err(too_many("vertices"));
        }
        append(&mesh, materials, flip, to_world, arrays)
            .map_err(|message| problem(message, help))?;
        let range = first as u32..arrays.mesh_triangles.len() as u32;
        Ok(range.map(triangle as fn(u32) -> PrimRef).chain(Vec::new()))
    }

    fn load(&self, desc: &MeshDesc) -> Result<Arc<TriangleMesh>, String> {
        match desc {
            MeshDesc::Loaded(mesh) => Ok(Arc::clone(mesh)),
            // They have been added as they are.
            MeshDesc::Patches { .. } => Ok(Arc::default()),
            MeshDesc::Inline { positions, triangles, normals, uvs, colors } => {
                Ok(Arc::new(TriangleMesh {
                    positions: positions.clone(),
                    triangles: triangles.clone(),
                    normals: normals.clone(),
                    uvs: uvs.clone(),
                    colors: colors.clone(),
                    ..TriangleMesh::default()
                }))
            }
            MeshDesc::File { path } => {
                let path = assets::resolve(path, self.options).map_err(|e| e.to_string())?;
                let limits = zrak_mesh::Limits { max_bytes: self.budget.left() };
                let mesh = zrak_mesh::read(&path, &limits).map_err(|e| e.to_string())?;
                self.budget.spend(mesh.n_bytes() as u64)?;
                self.options.progress.add(1);
                Ok(Arc::new(mesh))
            }
        }
    }
}

fn triangle(i: u32) -> PrimRef {
    PrimRef::new(PrimKind::MeshTriangle, i)
}

/// Adds the positions of a mesh's vertices.
pub(super) fn append_positions(
    positions: &[[f32; 3]],
    to_world: &Transform,
    arrays: &mut SceneArrays,
) -> Result<(), String> {
    let map = if *to_world == Transform::IDENTITY { None } else { Some(to_world) };
    let limit = NUMBER_MAX as f32;
    let mut is_far = false;
    arrays.positions.extend(positions.iter().map(|p| {
        let p = placed(*p, map, Transform::point);
        // Negated, so that NaN counts as far.
        is_far |= !p.iter().all(|x| x.abs() <= limit);
        Vec3::from_array(p)
    }));
    if is_far {
        return Err("a vertex of the mesh is farther than 1e12 from the origin".to_owned());
    }
    Ok(())
}

/// Adds the normals of a mesh's vertices.
pub(super) fn append_normals(
    normals: &[[f32; 3]],
    flip: bool,
    to_world: &Transform,
    arrays: &mut SceneArrays,
) {
    let is_placed = *to_world != Transform::IDENTITY;
    let back = to_world.inverse().unwrap_or(Transform::IDENTITY);
    let side = if flip { -1.0 } else { 1.0 };
    arrays.normals.extend(normals.iter().map(|n| {
        let n = n.map(|x| f64::from(x) * side);
        unit(if is_placed { back.transposed_vector(n) } else { n })
    }));
}

/// Adds the vertices and triangles of a mesh.
fn append(
    mesh: &TriangleMesh,
    materials: &[MaterialRef],
    flip: bool,
    to_world: &Transform,
    arrays: &mut SceneArrays,
) -> Result<(), String> {
    let first_vertex = arrays.positions.len() as u32;
    let is_placed = *to_world != Transform::IDENTITY;
    let map = if is_placed { Some(to_world) } else { None };
    append_positions(&mesh.positions, to_world, arrays)?;
    // A reflection turns the order of the corners around, and so does being flipped.
    let mirrors = to_world.determinant() < 0.0;
    let swaps = mirrors != flip;
    let mut flags = 0;
    let offset = |len: usize| (len as u32).wrapping_sub(first_vertex);
    let normal_offset = offset(arrays.normals.len());
    if !mesh.normals.is_empty() {
        flags |= MESH_NORMALS;
        append_normals(&mesh.normals, flip, to_world, arrays);
    }
    let uv_offset = offset(arrays.uvs.len());
    if !mesh.uvs.is_empty() {
        flags |= MESH_UVS;
        arrays.uvs.extend_from_slice(&mesh.uvs);
    }
    let tangent_offset = offset(arrays.tangents.len());
    if !mesh.tangents.is_empty() {
        flags |= MESH_TANGENTS;
        arrays.tangents.extend(mesh.tangents.iter().map(|&[x, y, z, w]| {
            let t = unit(placed([x, y, z], map, Transform::vector).map(f64::from));
            [t.x, t.y, t.z, if mirrors { -w } else { w }]
        }));
    }
    let color_offset = offset(arrays.colors.len());
    if !mesh.colors.is_empty() {
        flags |= MESH_COLORS;
        arrays.colors.extend_from_slice(&mesh.colors);
    }
    // A record for each group, with its material.
    let first_mesh = arrays.meshes.len() as u32;
    let n_groups = if mesh.face_groups.is_empty() { 1 } else { mesh.groups.len().max(1) };
    for group in 0..n_groups {
        // The first material is for those without one of their own.
        let own = if mesh.face_groups.is_empty() { None } else { materials.get(1 + group) };
        arrays.meshes.push(Mesh {
            material: *own.unwrap_or(&materials[0]),
            flags,
            normal_offset,
            uv_offset,
            tangent_offset,
            color_offset,
            _pad: [0; 2],
        });
    }
    arrays.mesh_triangles.extend(mesh.triangles.iter().enumerate().map(|(i, &[a, b, c])| {
        let corners = if swaps { [a, c, b] } else { [a, b, c] };
        let group = mesh.face_groups.get(i).copied().unwrap_or(0);
        MeshTriangle { vertices: corners.map(|v| v + first_vertex), mesh: first_mesh + group }
    }));
    Ok(())
}

/// A point or direction under a map, computed in `f64`; exact without one.
fn placed(
    p: [f32; 3],
    map: Option<&Transform>,
    apply: impl Fn(&Transform, Triple) -> Triple,
) -> [f32; 3] {
    match map {
        Some(map) => apply(map, p.map(f64::from)).map(|x| x as f32),
        None => p,
    }
}

/// The direction as a unit vector; up, if it has none.
fn unit(v: Triple) -> Vec3 {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec3::from_array([0.0, 0.0, 1.0]);
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    Vec3::from_array(v.map(|x| (x / length) as f32))
}
