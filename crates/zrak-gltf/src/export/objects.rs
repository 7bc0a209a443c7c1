//! Objects as nodes in the world, with the meshes that they share.

use std::collections::HashMap;
use std::sync::Arc;

use serde_json::json;
use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{CurveForm, MeshDesc, ObjectDesc, TransformStep, Triple};
use zrak_scene::lower::Transform;

use super::geometry::{self, Form, Parts};
use super::materials::{Material, Materials};
use super::{Export, shapes};
use crate::error::{Error, ErrorKind};

/// Most nodes: instances in instances can ask for any number.
const NODES_MAX: usize = 1 << 20;
/// How deep groups and instances may be nested, as validation has it.
const NESTING_MAX: usize = 128;

/// Name, materials and whether it is turned inside out.
type MeshForm<'d> = (&'d str, Vec<Option<usize>>, bool);

pub(super) struct Objects<'e, 'd, 'n> {
    export: &'e mut Export<'d>,
    materials: Materials,
    nodes: &'n mut Vec<usize>,
    /// Meshes that are read, by name.
    loaded: HashMap<&'d str, Option<Arc<TriangleMesh>>>,
    /// Meshes that are written, by name, materials and side.
    written: HashMap<MeshForm<'d>, Option<usize>>,
    /// The unit sphere, and the meshes of it by material.
    sphere: Option<Parts>,
    spheres: HashMap<usize, usize>,
}

impl<'e, 'd, 'n> Objects<'e, 'd, 'n> {
    /// Writes all objects of the scene; adds their nodes to `nodes`.
    pub(super) fn write(
        export: &'e mut Export<'d>,
        nodes: &'n mut Vec<usize>,
    ) -> Result<(), Error> {
        let objects = &export.desc.objects;
        let mut this = Self {
            export,
            materials: Materials::default(),
            nodes,
            loaded: HashMap::new(),
            written: HashMap::new(),
            sphere: None,
            spheres: HashMap::new(),
        };
        this.all(objects, &Transform::IDENTITY, "objects", 0)
    }

    fn all(
        &mut self,
        objects: &'d [ObjectDesc],
        outer: &Transform,
        at: &str,
        depth: usize,
    ) -> Result<(), Error> {
        if depth > NESTING_MAX {
            let message = "groups or instances are nested too deep";
            return Err(Error::new(ErrorKind::Invalid, at, message, "validate the scene"));
        }
        for (i, object) in objects.iter().enumerate() {
            let at = if depth == 0 { format!("objects[{i}]") } else { at.to_owned() };
            self.object(object, outer, &at, depth)?;
        }
        Ok(())
    }

    fn object(
        &mut self,
        object: &'d ObjectDesc,
        outer: &Transform,
        at: &str,
        depth: usize,
    ) -> Result<(), Error> {
        let place = |steps: &[TransformStep]| Transform::of_steps(steps).then(outer);
        let (shape, material, transform) = match object {
            ObjectDesc::Group { objects, transform } => {
                return self.all(objects, &place(transform), at, depth + 1);
            }
            ObjectDesc::Instance { prototype, transform, transform_end } => {
                if transform_end.is_some() {
                    self.export.warnings.note(at, "the instance stands where it is at time 0");
                }
                let Some(members) = self.export.desc.prototypes.get(prototype) else {
                    let message = format!("there is no prototype `{prototype}`");
                    return Err(Error::new(ErrorKind::Invalid, at, message, "validate the scene"));
                };
                return self.all(members, &place(transform), at, depth + 1);
            }
            ObjectDesc::Mesh { mesh, material, group_materials, flip, transform } => {
                let names: Vec<&str> = group_materials.iter().map(String::as_str).collect();
                return self.mesh(mesh, material, &names, *flip, &place(transform), at);
            }
            ObjectDesc::Medium { .. } => {
                self.export.warnings.note(at, "glTF has no media of their own: it is left out");
                return Ok(());
            }
            ObjectDesc::Sphere {
                center,
                center_end,
                radius,
                z_min,
                z_max,
                phi_max_deg,
                material,
                transform,
            } => {
                if center_end.is_some() {
                    self.export.warnings.note(at, "the sphere stands where it is at time 0");
                }
                let (center, radius) = (*center, *radius);
                if z_min.is_some() || z_max.is_some() || phi_max_deg.is_some() {
                    let z = [z_min.unwrap_or(-radius), z_max.unwrap_or(radius)];
                    let phi = phi_max_deg.unwrap_or(360.0);
                    let mesh = shapes::partial_sphere(center, radius, z, phi);
                    return self.shape(&mesh, material, place(transform), at);
                }
                return self.sphere(center, radius, material, &place(transform), at);
            }
            ObjectDesc::Quad { corner, u, v, material, transform } => {
                (shapes::quad(*corner, *u, *v), material, transform)
            }
            ObjectDesc::Triangle { vertices, uv, material, transform } => {
                (shapes::triangle(*vertices, *uv), material, transform)
            }
            ObjectDesc::Box { min, max, material, transform } => {
                (shapes::cuboid(*min, *max), material, transform)
            }
            ObjectDesc::Disk { height, radius, inner_radius, phi_max_deg, material, transform } => {
                let mesh = shapes::disk(*height, *radius, *inner_radius, *phi_max_deg);
                (mesh, material, transform)
            }
            ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, material, transform } => {
                (shapes::cylinder(*radius, *z_min, *z_max, *phi_max_deg), material, transform)
            }
            ObjectDesc::Curve { points, widths, form, normals, material, transform } => {
                let n = points.len();
                let n_normals = if *form == CurveForm::Ribbon { n / 3 + 1 } else { 0 };
                if n < 4 || n % 3 != 1 || normals.len() != n_normals {
                    let message = "the curve lacks points or normals";
                    return Err(Error::new(ErrorKind::Invalid, at, message, "validate the scene"));
                }
                (shapes::curve(points, *widths, *form, normals), material, transform)
            }
        };
        self.shape(&shape, material, place(transform), at)
    }

    /// A shape as triangles, in the world.
    fn shape(
        &mut self,
        shape: &TriangleMesh,
        material: &str,
        map: Transform,
        at: &str,
    ) -> Result<(), Error> {
        let Some(Material { index, .. }) = self.materials.get(self.export, material, at)? else {
            return Ok(());
        };
        let materials = vec![Some(index)];
        let form = Form { materials, has_colors: false, flip: false, baked: Some(map), name: at };
        if let Some(mesh) = geometry::write(&mut self.export.file, shape, &form) {
            self.node(mesh, &Transform::IDENTITY, at)?;
        }
        Ok(())
    }

    /// Spheres are all the unit sphere, if nodes can place it.
    fn sphere(
        &mut self,
        center: Triple,
        radius: f64,
        material: &str,
        map: &Transform,
        at: &str,
    ) -> Result<(), Error> {
        let Some(Material { index, .. }) = self.materials.get(self.export, material, at)? else {
            return Ok(());
        };
        let [x, y, z] = center;
        let rows = [[radius, 0.0, 0.0, x], [0.0, radius, 0.0, y], [0.0, 0.0, radius, z]];
        let map = Transform { rows }.then(map);
        let file = &mut self.export.file;
        if !geometry::fits_node(&map) {
            let mesh = shapes::sphere([0.0; 3], 1.0);
            let materials = vec![Some(index)];
            let form =
                Form { materials, has_colors: false, flip: false, baked: Some(map), name: at };
            return match geometry::write(file, &mesh, &form) {
                Some(mesh) => self.node(mesh, &Transform::IDENTITY, at),
                None => Ok(()),
            };
        }
        let parts =
            self.sphere.get_or_insert_with(|| Parts::of(file, &shapes::sphere([0.0; 3], 1.0)));
        let mesh = *self.spheres.entry(index).or_insert_with(|| parts.mesh(file, index));
        self.node(mesh, &map, at)
    }

    fn mesh(
        &mut self,
        name: &'d str,
        material: &str,
        group_materials: &[&str],
        flip: bool,
        map: &Transform,
        at: &str,
    ) -> Result<(), Error> {
        let Some(mesh) = self.load(name, at)? else { return Ok(()) };
        let n_groups = if mesh.face_groups.is_empty() { 1 } else { mesh.groups.len().max(1) };
        let mut materials = Vec::with_capacity(n_groups);
        let mut has_colors = false;
        for group in 0..n_groups {
            let own = group_materials.get(group).filter(|_| !mesh.face_groups.is_empty());
            let found = self.materials.get(self.export, own.unwrap_or(&material), at)?;
            has_colors |= found.is_some_and(|m| m.has_colors);
            materials.push(found.map(|m| m.index));
        }
        let mut form = Form { materials, has_colors, flip, baked: None, name };
        if !geometry::fits_node(map) {
            form.baked = Some(*map);
            if let Some(index) = geometry::write(&mut self.export.file, &mesh, &form) {
                self.node(index, &Transform::IDENTITY, at)?;
            }
            return Ok(());
        }
        let key = (name, form.materials.clone(), flip);
        let index = match self.written.get(&key) {
            Some(index) => *index,
            None => {
                let index = geometry::write(&mut self.export.file, &mesh, &form);
                self.written.insert(key, index);
                index
            }
        };
        match index {
            Some(index) => self.node(index, map, at),
            None => Ok(()),
        }
    }

    fn node(&mut self, mesh: usize, map: &Transform, at: &str) -> Result<(), Error> {
        if self.nodes.len() >= NODES_MAX {
            let message =
                format!("the scene has more than {NODES_MAX} objects, counting instances");
            return Err(Error::new(ErrorKind::TooLarge, at, message, "split the scene"));
        }
        let mut node = json!({"mesh": mesh});
        if let Some(matrix) = geometry::matrix(map) {
            node["matrix"] = matrix;
        }
        let node = self.export.file.push("nodes", node);
        self.nodes.push(node);
        Ok(())
    }

    fn load(&mut self, name: &'d str, at: &str) -> Result<Option<Arc<TriangleMesh>>, Error> {
        if let Some(mesh) = self.loaded.get(name) {
            return Ok(mesh.clone());
        }
        let help = "validate the scene";
        let Some(desc) = self.export.desc.meshes.get(name) else {
            let message = format!("there is no mesh `{name}`");
            return Err(Error::new(ErrorKind::Invalid, at, message, help));
        };
        let mesh = match desc {
            MeshDesc::Loaded(mesh) => Some(Arc::clone(mesh)),
            MeshDesc::Patches { positions, patches, normals, uvs } => {
                let n = positions.len();
                let is_good = |len: usize| len == 0 || len == n;
                if patches.iter().flatten().any(|&v| v as usize >= n)
                    || !is_good(normals.len())
                    || !is_good(uvs.len())
                {
                    let message = "a patch has a corner that is not there";
                    let at = format!("meshes.{name}");
                    return Err(Error::new(ErrorKind::Invalid, at, message, help));
                }
                Some(Arc::new(shapes::patches(positions, patches, normals, uvs)))
            }
            MeshDesc::Inline { positions, triangles, normals, uvs, colors } => {
                Some(Arc::new(TriangleMesh {
                    positions: positions.clone(),
                    triangles: triangles.clone(),
                    normals: normals.clone(),
                    uvs: uvs.clone(),
                    colors: colors.clone(),
                    ..TriangleMesh::default()
                }))
            }
            MeshDesc::File { path, .. } if path.to_ascii_lowercase().ends_with(".ply") => {
                let limits = zrak_mesh::Limits::default();
                let file = self.export.base_dir.join(path);
                let mesh = zrak_mesh::ply::read(&file, &limits);
                let help = "check the path, or take the mesh out of the scene";
                Some(Arc::new(mesh.map_err(|e| {
                    Error::new(ErrorKind::Io, format_args!("meshes.{name}"), e, help)
                })?))
            }
            MeshDesc::File { path, .. } => {
                let message = format!("only PLY files are exported, not '{path}': it is left out");
                self.export.warnings.note(format_args!("meshes.{name}"), message);
                None
            }
        };
        if let Some(mesh) = &mesh {
            let invalid =
                |e| Error::new(ErrorKind::Invalid, format_args!("meshes.{name}"), e, help);
            mesh.validate().map_err(invalid)?;
        }
        self.loaded.insert(name, mesh.clone());
        Ok(mesh)
    }
}
