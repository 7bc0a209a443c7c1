//! Meshes and where they stand.
//!
//! A mesh that one node has becomes objects with that node's map; one that several have becomes a
//! prototype that each of them places.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use zrak_scene::desc::{MeshDesc, ObjectDesc, TransformStep, Triple};
use zrak_scene::lower::Transform;
use zrak_scene::validate::limits::{LENGTH_MIN, NUMBER_MAX};

use crate::accessor::Kind;
use crate::buffers::element;
use crate::error::{Error, Warnings};
use crate::hierarchy::{self, Hierarchy};
use crate::json::{Instancing, Mesh, Node};
use crate::materials::Materials;
use crate::names::Names;
use crate::primitive::{self, Request, Source};

/// Everything that was placed.
pub(crate) struct Placed<'a> {
    pub(crate) materials: Materials<'a>,
    pub(crate) meshes: BTreeMap<String, MeshDesc>,
    pub(crate) prototypes: BTreeMap<String, Vec<ObjectDesc>>,
    pub(crate) objects: Vec<ObjectDesc>,
    /// Smallest and largest corner of a box around everything.
    pub(crate) bounds: Option<[Triple; 2]>,
}

pub(crate) struct Placer<'a> {
    source: &'a Source<'a>,
    placed: Placed<'a>,
    /// Meshes in the order in which they are met, and where they are.
    wanted: Vec<Wanted>,
    /// Index among `wanted` of a mesh and the bits of its morph weights.
    known: HashMap<(usize, Vec<u64>), usize>,
    mesh_names: Names,
    prototype_names: Names,
}

/// A mesh in one form.
struct Wanted {
    mesh: usize,
    weights: Vec<f64>,
    /// The maps of its joints, if it has a skin.
    joints: Option<Vec<Transform>>,
    places: Vec<Transform>,
}

impl<'a> Placer<'a> {
    pub(crate) fn new(source: &'a Source<'a>, materials: Materials<'a>) -> Self {
        let placed = Placed {
            materials,
            meshes: BTreeMap::new(),
            prototypes: BTreeMap::new(),
            objects: Vec::new(),
            bounds: None,
        };
        Self {
            source,
            placed,
            wanted: Vec::new(),
            known: HashMap::new(),
            mesh_names: Names::default(),
            prototype_names: Names::default(),
        }
    }

    /// Notes the mesh of a node.
    pub(crate) fn mesh(
        &mut self,
        node_index: usize,
        node: &Node,
        index: usize,
        hierarchy: &Hierarchy,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let at = format!("nodes[{node_index}]");
        let mesh = element(&self.source.root.meshes, "meshes", index, format_args!("{at}.mesh"))?;
        let weights = if node.weights.is_empty() { &mesh.weights } else { &node.weights };
        self.source.budget.spend(&at, weights.len() as u64, 16)?;
        let world = hierarchy.world_from_node[node_index];
        if let Some(skin) = node.skin {
            let joints = self.joints(skin, hierarchy, &format!("{at}.skin"), warnings)?;
            let places = vec![Transform::IDENTITY];
            let (weights, joints) = (weights.clone(), Some(joints));
            self.wanted.push(Wanted { mesh: index, weights, joints, places });
            return Ok(());
        }
        let places = match node.extensions.as_ref().and_then(|e| e.instancing.as_ref()) {
            Some(instancing) => self.instances(instancing, &world, &at, warnings)?,
            None => vec![world],
        };
        // Every place becomes an object.
        let size = size_of::<ObjectDesc>() + size_of::<TransformStep>() + 64;
        self.source.budget.spend(&at, places.len() as u64, size as u64)?;
        let key = (index, weights.iter().map(|w| w.to_bits()).collect());
        let slot = *self.known.entry(key).or_insert_with(|| {
            let weights = weights.clone();
            self.wanted.push(Wanted { mesh: index, weights, joints: None, places: Vec::new() });
            self.wanted.len() - 1
        });
        self.wanted[slot].places.extend(places);
        Ok(())
    }

    /// The maps of EXT_mesh_gpu_instancing, each before the node's own.
    fn instances(
        &self,
        instancing: &Instancing,
        world: &Transform,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<Transform>, Error> {
        let at = format!("{at}.extensions.EXT_mesh_gpu_instancing.attributes");
        let attributes = &instancing.attributes;
        let mut open = |index: Option<usize>, kind: Kind| {
            index.map(|i| self.source.open(i, &[kind], &at, warnings)).transpose()
        };
        let moves = open(attributes.translation, Kind::Vec3)?;
        let turns = open(attributes.rotation, Kind::Vec4)?;
        let scales = open(attributes.scale, Kind::Vec3)?;
        let counts = || [&moves, &turns, &scales].into_iter().flatten().map(|a| a.count);
        let n = counts().next().unwrap_or(0);
        if counts().any(|count| count != n) {
            return Err(Error::invalid(at, "the attributes have different numbers of elements"));
        }
        self.source.budget.spend(&at, n as u64, size_of::<Transform>() as u64)?;
        let mut places = Vec::with_capacity(n);
        for i in 0..n {
            let by = moves.as_ref().map_or([0.0; 3], |a| a.floats::<3>(i).map(f64::from));
            let turn =
                turns.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |a| a.floats::<4>(i).map(f64::from));
            let scale = scales.as_ref().map_or([1.0; 3], |a| a.floats::<3>(i).map(f64::from));
            let map = hierarchy::of_steps(by, turn, scale).map(|map| map.then(world));
            match map.filter(|map| !is_degenerate(map)) {
                Some(map) => places.push(map),
                None => warnings.note(&at, "instances that are flat or without size are left out"),
            }
        }
        Ok(places)
    }

    /// The maps of the joints of a skin: from the mesh where it was bound to the world.
    fn joints(
        &self,
        index: usize,
        hierarchy: &Hierarchy,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<Transform>, Error> {
        let root = self.source.root;
        let skin = element(&root.skins, "skins", index, at)?;
        let key = format!("skins[{index}].inverseBindMatrices");
        let inverse = match skin.inverse_bind_matrices {
            Some(i) => Some(self.source.open(i, &[Kind::Mat4], &key, warnings)?),
            None => None,
        };
        if let Some(inverse) = inverse.as_ref().filter(|m| m.count < skin.joints.len()) {
            let (n, n_joints) = (inverse.count, skin.joints.len());
            let message = format!("there are {n} matrices for {n_joints} joints");
            return Err(Error::invalid(key, message));
        }
        let n_joints = skin.joints.len() as u64;
        self.source.budget.spend(at, n_joints, size_of::<Transform>() as u64)?;
        let mut joints = Vec::with_capacity(skin.joints.len());
        for (k, &node) in skin.joints.iter().enumerate() {
            let at = format_args!("skins[{index}].joints[{k}]");
            let world = element(&hierarchy.world_from_node, "nodes", node, at)?;
            let bind = match &inverse {
                Some(inverse) => {
                    let m = inverse.floats::<16>(k).map(f64::from);
                    let row = |r: usize| [m[r], m[4 + r], m[8 + r], m[12 + r]];
                    Transform { rows: [row(0), row(1), row(2)] }
                }
                None => Transform::IDENTITY,
            };
            joints.push(bind.then(world));
        }
        Ok(joints)
    }

    /// Reads the meshes and makes the objects.
    pub(crate) fn finish(mut self, warnings: &mut Warnings) -> Result<Placed<'a>, Error> {
        for wanted in std::mem::take(&mut self.wanted) {
            if wanted.places.is_empty() {
                continue;
            }
            let mesh = &self.source.root.meshes[wanted.mesh];
            let (objects, bounds) = self.objects(&wanted, mesh, warnings)?;
            if objects.is_empty() {
                continue;
            }
            for place in &wanted.places {
                self.grow(bounds, place);
            }
            if let [place] = &wanted.places[..] {
                self.placed.objects.extend(objects.into_iter().map(|object| moved(object, place)));
                continue;
            }
            let fallback = format!("mesh {}", wanted.mesh);
            let prototype = self.prototype_names.unique(mesh.name.as_deref(), &fallback);
            self.placed.prototypes.insert(prototype.clone(), objects);
            self.placed.objects.extend(wanted.places.iter().map(|place| ObjectDesc::Instance {
                prototype: prototype.clone(),
                transform: steps(place),
                transform_end: None,
            }));
        }
        Ok(self.placed)
    }

    /// An object for each primitive of a mesh, and a box around all.
    fn objects(
        &mut self,
        wanted: &Wanted,
        mesh: &Mesh,
        warnings: &mut Warnings,
    ) -> Result<(Vec<ObjectDesc>, [Triple; 2]), Error> {
        let mut objects = Vec::new();
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let location = format!("meshes[{}].primitives[{i}]", wanted.mesh);
            let has_colors = primitive.attributes.contains_key("COLOR_0");
            let material =
                self.placed.materials.get(primitive.material, has_colors, &location, warnings)?;
            let request = Request {
                uv_set: material.uv_set,
                needs_uv: material.needs_uv,
                weights: &wanted.weights,
                joints: wanted.joints.as_deref(),
            };
            let read = primitive::read(self.source, primitive, &request, &location, warnings)?;
            let Some(triangles) = read else { continue };
            for p in &triangles.positions {
                for axis in 0..3 {
                    let x = f64::from(p[axis]);
                    bounds[0][axis] = bounds[0][axis].min(x);
                    bounds[1][axis] = bounds[1][axis].max(x);
                }
            }
            let fallback = match mesh.primitives.len() {
                1 => format!("mesh {}", wanted.mesh),
                _ => format!("mesh {}.{i}", wanted.mesh),
            };
            let own = mesh.name.as_ref().map(|name| match mesh.primitives.len() {
                1 => name.clone(),
                _ => format!("{name}.{i}"),
            });
            let name = self.mesh_names.unique(own.as_deref(), &fallback);
            self.placed.meshes.insert(name.clone(), MeshDesc::Loaded(Arc::new(triangles)));
            objects.push(ObjectDesc::Mesh {
                mesh: name,
                material: material.name,
                group_materials: Vec::new(),
                flip: false,
                transform: Vec::new(),
            });
        }
        Ok((objects, bounds))
    }

    /// Makes room for a box under a map.
    fn grow(&mut self, [lo, hi]: [Triple; 2], place: &Transform) {
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let mut all = self.placed.bounds.unwrap_or(none);
        for i in 0..8 {
            let corner = [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { lo[axis] } else { hi[axis] });
            let p = place.point(corner);
            for axis in 0..3 {
                all[0][axis] = all[0][axis].min(p[axis]);
                all[1][axis] = all[1][axis].max(p[axis]);
            }
        }
        self.placed.bounds = Some(all);
    }
}

fn moved(object: ObjectDesc, place: &Transform) -> ObjectDesc {
    match object {
        ObjectDesc::Mesh { mesh, material, group_materials, flip, .. } => {
            ObjectDesc::Mesh { mesh, material, group_materials, flip, transform: steps(place) }
        }
        other => other,
    }
}

fn steps(place: &Transform) -> Vec<TransformStep> {
    if *place == Transform::IDENTITY {
        return Vec::new();
    }
    vec![TransformStep::Matrix(place.rows)]
}

/// Whether a map leaves the range in which zrak computes; the rule of the scene's validation.
pub(crate) fn is_degenerate(map: &Transform) -> bool {
    let column = |j: usize| [map.rows[0][j], map.rows[1][j], map.rows[2][j]];
    let length = |v: Triple| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let lengths = [0, 1, 2].map(|j| length(column(j)));
    let far = length(column(3));
    let ok = lengths.iter().all(|l| (LENGTH_MIN..=NUMBER_MAX).contains(l))
        && far <= NUMBER_MAX
        && map.determinant().abs() >= 1e-9 * lengths[0] * lengths[1] * lengths[2];
    !ok
}
