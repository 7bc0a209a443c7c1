//! Objects, and prototypes as pbrt's objects.

use std::fmt::Write;

use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{BoundaryDesc, CurveForm, MaterialDesc, ObjectDesc, TransformStep, Triple};
use zrak_scene::error::SceneError;
use zrak_scene::lower::Transform;

use super::meshes::inline;
use super::text::{param, quoted, transform, word};
use super::{Writer, failure};
use crate::shapes::SPHERE_TURN;

type Result<T> = std::result::Result<T, SceneError>;

/// How deep prototypes may be nested, as validation has it, and groups in them.
const NESTING_MAX: usize = 128;

/// Where something is at the shutter's opening and, if it moves, at its closing.
#[derive(Clone, Copy)]
struct Path {
    start: Transform,
    end: Option<Transform>,
}

impl Writer<'_, '_> {
    /// Writes an object under the map of the groups around it. Objects of pbrt hold no others.
    pub(super) fn object(
        &mut self,
        object: &ObjectDesc,
        outer: &Transform,
        is_inside: bool,
    ) -> Result<()> {
        self.object_at(object, outer, is_inside, 0)
    }

    fn object_at(
        &mut self,
        object: &ObjectDesc,
        outer: &Transform,
        is_inside: bool,
        depth: usize,
    ) -> Result<()> {
        if self.out.len() as u64 > self.options.max_bytes {
            return Err(failure("the scene has more objects than a file may hold, written out"));
        }
        if depth > NESTING_MAX {
            return Err(failure("the scene's objects are nested too deep"));
        }
        let at = |steps: &[TransformStep]| Transform::of_steps(steps).then(outer);
        let still = |start: Transform| Path { start, end: None };
        match object {
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
                let is_whole = z_min.is_none() && z_max.is_none() && phi_max_deg.is_none();
                let place = |center: Triple| {
                    let turn = TransformStep::Matrix(SPHERE_TURN);
                    let first: &[TransformStep] = if is_whole { &[turn] } else { &[] };
                    let own = Transform::of_steps(first);
                    own.then(&Transform::of_steps(&[TransformStep::Translate(center)]))
                        .then(&at(transform))
                };
                let path = Path { start: place(*center), end: center_end.map(place) };
                let mut shape = "\"sphere\"".to_owned() + &param("float", "radius", [*radius]);
                for (key, x) in [("zmin", z_min), ("zmax", z_max), ("phimax", phi_max_deg)] {
                    if let Some(x) = x {
                        shape += &param("float", key, [*x]);
                    }
                }
                self.shape(&shape, material, &path, false)
            }
            ObjectDesc::Quad { corner, u, v, material, transform } => {
                let sum = |a: Triple, b: &Triple| [0, 1, 2].map(|i| a[i] + b[i]);
                let (a, b) = (sum(*corner, u), sum(*corner, v));
                let points = [*corner, a, b, sum(a, v)];
                let shape = "\"bilinearmesh\"".to_owned()
                    + &param("integer", "indices", 0..4)
                    + &param("point3", "P", points.as_flattened());
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Triangle { vertices, uv, material, transform } => {
                let shape = "\"trianglemesh\"".to_owned()
                    + &param("integer", "indices", 0..3)
                    + &param("point3", "P", vertices.as_flattened())
                    + &param("point2", "uv", uv.as_flattened());
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Box { min, max, material, transform } => {
                let shape = inline(&cuboid(*min, *max));
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Disk { height, radius, inner_radius, phi_max_deg, material, transform } => {
                let shape = "\"disk\"".to_owned()
                    + &param("float", "height", [*height])
                    + &param("float", "radius", [*radius])
                    + &param("float", "innerradius", [*inner_radius])
                    + &param("float", "phimax", [*phi_max_deg]);
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, material, transform } => {
                let shape = "\"cylinder\"".to_owned()
                    + &param("float", "radius", [*radius])
                    + &param("float", "zmin", [*z_min])
                    + &param("float", "zmax", [*z_max])
                    + &param("float", "phimax", [*phi_max_deg]);
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Curve { points, widths, form, normals, material, transform } => {
                let kind = match form {
                    CurveForm::Flat => "flat",
                    CurveForm::Cylinder => "cylinder",
                    CurveForm::Ribbon => "ribbon",
                };
                let mut shape = "\"curve\"".to_owned()
                    + &word("string", "type", kind)
                    + &param("point3", "P", points.as_flattened())
                    + &param("float", "width0", [widths[0]])
                    + &param("float", "width1", [widths[1]]);
                if !normals.is_empty() {
                    shape += &param("normal", "N", normals.as_flattened());
                }
                self.shape(&shape, material, &still(at(transform)), false)
            }
            ObjectDesc::Mesh { mesh, material, group_materials, flip, transform } => {
                let map = at(transform);
                for (material, shape) in self.mesh_shapes(mesh, material, group_materials)? {
                    self.shape(&shape, &material, &still(map), *flip)?;
                }
                Ok(())
            }
            ObjectDesc::Medium { boundary, density, material, transform } => {
                self.fog(boundary, *density, material, &at(transform))
            }
            ObjectDesc::Group { objects, transform } => {
                let map = at(transform);
                objects
                    .iter()
                    .try_for_each(|object| self.object_at(object, &map, is_inside, depth + 1))
            }
            ObjectDesc::Instance { prototype, transform, transform_end } => {
                let path = Path { start: at(transform), end: transform_end.as_deref().map(at) };
                self.instance(prototype, &path, is_inside, depth)
            }
        }
    }

    fn instance(
        &mut self,
        prototype: &str,
        path: &Path,
        is_inside: bool,
        depth: usize,
    ) -> Result<()> {
        let desc = self.desc;
        if !is_inside && let Some(name) = self.prototype(prototype)? {
            self.out += "AttributeBegin\n";
            self.place(path);
            let _ = writeln!(self.out, "ObjectInstance {}\nAttributeEnd", quoted(&name));
            return Ok(());
        }
        let Some(objects) = desc.prototypes.get(prototype) else { return Ok(()) };
        if path.end.is_some() {
            self.warn(
                "what moves within an object or shines stands still where it is at first: pbrt \
                 moves neither",
            );
        }
        objects
            .iter()
            .try_for_each(|object| self.object_at(object, &path.start, is_inside, depth + 1))
    }

    /// Name of the object that a prototype is; none if its instances have to be written out, because
    /// it shines, which pbrt's objects do not.
    fn prototype(&mut self, prototype: &str) -> Result<Option<String>> {
        if let Some(known) = self.objects.get(prototype) {
            return Ok(known.clone());
        }
        let desc = self.desc;
        let name = if self.shines(prototype, 0)? {
            None
        } else {
            let Some(objects) = desc.prototypes.get(prototype) else { return Ok(None) };
            let name = self.unique_name("object", prototype);
            let _ = writeln!(self.out, "ObjectBegin {}", quoted(&name));
            for object in objects {
                self.object_at(object, &Transform::IDENTITY, true, 1)?;
            }
            self.out += "ObjectEnd\n";
            Some(name)
        };
        self.objects.insert(prototype.to_owned(), name.clone());
        Ok(name)
    }

    /// Whether something in a prototype shines.
    fn shines(&mut self, prototype: &str, depth: usize) -> Result<bool> {
        if depth > NESTING_MAX {
            return Ok(false);
        }
        let desc = self.desc;
        let mut level: Vec<&ObjectDesc> =
            desc.prototypes.get(prototype).into_iter().flatten().collect();
        while let Some(object) = level.pop() {
            let materials: Vec<&String> = match object {
                ObjectDesc::Sphere { material, .. }
                | ObjectDesc::Quad { material, .. }
                | ObjectDesc::Triangle { material, .. }
                | ObjectDesc::Box { material, .. }
                | ObjectDesc::Disk { material, .. }
                | ObjectDesc::Cylinder { material, .. }
                | ObjectDesc::Curve { material, .. } => vec![material],
                ObjectDesc::Mesh { material, group_materials, .. } => {
                    std::iter::once(material).chain(group_materials).collect()
                }
                ObjectDesc::Medium { .. } => Vec::new(),
                ObjectDesc::Group { objects, .. } => {
                    level.extend(objects);
                    Vec::new()
                }
                ObjectDesc::Instance { prototype, .. } => {
                    if self.shines(prototype, depth + 1)? {
                        return Ok(true);
                    }
                    Vec::new()
                }
            };
            for material in materials {
                if self.shading(material)?.shines {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Writes the present map.
    fn place(&mut self, path: &Path) {
        match path.end {
            None if path.start == Transform::IDENTITY => {}
            None => self.out += &transform(&path.start),
            Some(end) => {
                self.out += "ActiveTransform StartTime\n";
                self.out += &transform(&path.start);
                self.out += "ActiveTransform EndTime\n";
                self.out += &transform(&end);
                self.out += "ActiveTransform All\n";
            }
        }
    }

    fn shape(&mut self, shape: &str, material: &str, path: &Path, flip: bool) -> Result<()> {
        let shading = self.shading(material)?;
        let mut path = *path;
        if shading.shines && path.end.is_some() {
            self.warn(
                "what moves within an object or shines stands still where it is at first: pbrt \
                 moves neither",
            );
            path.end = None;
        }
        self.out += "AttributeBegin\n";
        self.place(&path);
        if flip {
            self.out += "ReverseOrientation\n";
        }
        let _ =
            writeln!(self.out, "{}Shape {shape}{}\nAttributeEnd", shading.before, shading.params);
        Ok(())
    }

    /// A medium of constant density inside a boundary of its own.
    fn fog(
        &mut self,
        boundary: &BoundaryDesc,
        density: f64,
        material: &str,
        map: &Transform,
    ) -> Result<()> {
        let albedo = match self.desc.materials.get(material) {
            Some(MaterialDesc::Isotropic { color: zrak_scene::desc::ColorDesc::Solid(color) }) => {
                *color
            }
            _ => {
                self.warn("media whose colour is a texture are white");
                [1.0; 3]
            }
        };
        self.n_media += 1;
        let name = self.unique_name("medium", &format!("fog-{}", self.n_media));
        let sigma_s = albedo.map(|a| density * a);
        self.define_medium(&name, albedo.map(|a| density * (1.0 - a)), sigma_s, 0.0);
        let (shape, path) = match boundary {
            BoundaryDesc::Sphere { center, center_end, radius, transform } => {
                let place = |center: Triple| {
                    Transform::of_steps(&[TransformStep::Translate(center)])
                        .then(&Transform::of_steps(transform))
                        .then(map)
                };
                let shape = "\"sphere\"".to_owned() + &param("float", "radius", [*radius]);
                (shape, Path { start: place(*center), end: center_end.map(place) })
            }
            BoundaryDesc::Box { min, max, transform } => {
                let start = Transform::of_steps(transform).then(map);
                (inline(&cuboid(*min, *max)), Path { start, end: None })
            }
        };
        self.out += "AttributeBegin\n";
        self.place(&path);
        let _ = writeln!(
            self.out,
            "Material \"interface\"\nMediumInterface {} \"\"\nShape {shape}\nAttributeEnd",
            quoted(&name)
        );
        Ok(())
    }
}

/// A box as a mesh whose faces have corners, and coordinates, of their own.
fn cuboid(min: Triple, max: Triple) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        for is_max in [false, true] {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let first = mesh.positions.len() as u32;
            for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut p = [0.0; 3];
                p[axis] = if is_max { max[axis] } else { min[axis] };
                p[a] = if u == 1 { max[a] } else { min[a] };
                p[b] = if v == 1 { max[b] } else { min[b] };
                mesh.positions.push(p.map(|x| x as f32));
                mesh.uvs.push([u as f32, v as f32]);
            }
            let [i, j, k, l] = [0, 1, 2, 3].map(|k| first + k);
            // Counter-clockwise from outside.
            let faces = if is_max { [[i, j, k], [i, k, l]] } else { [[i, k, j], [i, l, k]] };
            mesh.triangles.extend(faces);
        }
    }
    mesh
}
