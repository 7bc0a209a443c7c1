//! Shapes.

use std::sync::Arc;

use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{MeshDesc, ObjectDesc, TransformStep};

use crate::curves::curve;
use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::{Importer, steps};

/// zrak's spheres have their texture about y, from -x towards z; pbrt's about z, from x towards y.
pub(crate) const SPHERE_TURN: [[f64; 4]; 3] =
    [[-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]];

impl Importer {
    pub(crate) fn shape(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        let material = self.surface(params)?;
        // Orientation is turned by a mirrored map and by ReverseOrientation; triangles keep the side
        // that their corners' order says, and so do zrak's maps.
        let flip = self.state.reverse;
        let object = match kind {
            "sphere" => {
                if flip && self.state.light.is_some() {
                    self.warn(
                        at,
                        "a sphere that shines inwards is rendered as one that shines outwards",
                    );
                }
                let Some(sphere) = sphere(params, material)? else {
                    self.warn(at, "nothing is left of the sphere");
                    return Ok(());
                };
                sphere
            }
            "disk" => {
                let height = params.float("height")?.unwrap_or(0.0);
                let radius = positive(params, "radius", 1.0)?;
                let inner_radius =
                    params.float("innerradius")?.unwrap_or(0.0).clamp(0.0, 0.999_999 * radius);
                let phi_max_deg = params.float("phimax")?.unwrap_or(360.0).clamp(1e-3, 360.0);
                ObjectDesc::Disk {
                    height: if flip { -height } else { height },
                    radius,
                    inner_radius,
                    phi_max_deg,
                    material,
                    transform: if flip {
                        vec![TransformStep::RotateXDeg(180.0)]
                    } else {
                        Vec::new()
                    },
                }
            }
            "cylinder" => {
                let z =
                    [params.float("zmin")?.unwrap_or(-1.0), params.float("zmax")?.unwrap_or(1.0)];
                let [z_min, z_max] = [z[0].min(z[1]), z[0].max(z[1])];
                if z_max - z_min < 1e-12 {
                    return Err(Fault::new(at, "the cylinder has no height"));
                }
                if flip && self.state.light.is_some() {
                    self.warn(
                        at,
                        "a cylinder that shines inwards is rendered as one that shines outwards",
                    );
                }
                ObjectDesc::Cylinder {
                    radius: positive(params, "radius", 1.0)?,
                    z_min,
                    z_max,
                    phi_max_deg: params.float("phimax")?.unwrap_or(360.0).clamp(1e-3, 360.0),
                    material,
                    transform: Vec::new(),
                }
            }
            "trianglemesh" => {
                let mesh = triangle_mesh(at, params)?;
                self.mesh(mesh, material, flip, at)?
            }
            "loopsubdiv" => {
                let levels = params.integer("levels")?.unwrap_or(3).clamp(0, 64) as u32;
                params.ignore(&["scheme"]);
                let control = triangle_mesh(at, params)?;
                let mesh = self
                    .sources
                    .subdivided(&control, levels)
                    .map_err(|error| Fault::new(at, error.to_string()))?;
                self.mesh(mesh, material, flip, at)?
            }
            "plymesh" => {
                let Some(name) = params.string("filename")? else {
                    return Err(Fault::new(at, "a plymesh needs a \"string filename\""));
                };
                let name = name.to_owned();
                let path = self.sources.resolve(&name, at)?;
                params.ignore(&["displacement", "displacement.edgelength"]);
                let mesh = self.sources.mesh(&path, at)?;
                self.mesh(mesh, material, flip, at)?
            }
            "bilinearmesh" => {
                let name = self.fresh("mesh");
                self.desc.meshes.insert(name.clone(), bilinear_mesh(at, params)?);
                placed_mesh(name, material, flip)
            }
            "curve" => {
                // How pbrt cuts it changes no picture.
                params.ignore(&["splitdepth"]);
                let Some(curve) = curve(at, params)? else {
                    self.warn(at, "the curve has no length or no width");
                    return Ok(());
                };
                if curve.has_normals_in_vain {
                    self.warn(at, "`N` has no effect: only ribbons have normals");
                }
                curve.object(material)
            }
            _ => {
                let fault = Fault::new(at, format!("unknown shape \"{kind}\""));
                return Err(fault.help(
                    "there are sphere, disk, cylinder, trianglemesh, plymesh, loopsubdiv, \
                     bilinearmesh and curve",
                ));
            }
        };
        self.add(object);
        Ok(())
    }

    /// Adds a shape under the present map: to the object that is being defined or to the world.
    fn add(&mut self, mut object: ObjectDesc) {
        let ctm = self.state.ctm;
        if ctm.is_moving() {
            let prototype = self.fresh("moving");
            self.desc.prototypes.insert(prototype.clone(), vec![object]);
            object = self.instance(prototype);
        } else if let ObjectDesc::Sphere { transform, .. }
        | ObjectDesc::Disk { transform, .. }
        | ObjectDesc::Cylinder { transform, .. }
        | ObjectDesc::Curve { transform, .. }
        | ObjectDesc::Mesh { transform, .. } = &mut object
        {
            transform.extend(steps(&ctm.start));
        }
        match &mut self.object {
            Some((_, objects)) => objects.push(object),
            None => self.desc.objects.push(object),
        }
    }

    fn mesh(
        &mut self,
        mesh: TriangleMesh,
        material: String,
        flip: bool,
        at: &Span,
    ) -> Result<ObjectDesc> {
        mesh.validate().map_err(|error| Fault::new(at, error.to_string()))?;
        self.sources.spend(mesh.n_bytes() as u64, at)?;
        let name = self.fresh("mesh");
        self.desc.meshes.insert(name.clone(), MeshDesc::Loaded(Arc::new(mesh)));
        Ok(placed_mesh(name, material, flip))
    }
}

fn placed_mesh(mesh: String, material: String, flip: bool) -> ObjectDesc {
    let (group_materials, transform) = (Vec::new(), Vec::new());
    ObjectDesc::Mesh { mesh, material, group_materials, flip, transform }
}

/// A sphere or what there is of it; none if that is nothing.
fn sphere(params: &Params, material: String) -> Result<Option<ObjectDesc>> {
    let radius = positive(params, "radius", 1.0)?;
    let z = [params.float("zmin")?.unwrap_or(-radius), params.float("zmax")?.unwrap_or(radius)];
    let [z_min, z_max] = [z[0].min(z[1]), z[0].max(z[1])].map(|z| z.clamp(-radius, radius));
    let phi = params.float("phimax")?.unwrap_or(360.0).clamp(0.0, 360.0);
    if z_max - z_min < 1e-12 || phi <= 0.0 {
        return Ok(None);
    }
    let is_whole = z_min <= -radius && z_max >= radius && phi >= 360.0;
    let part = |x: f64, is_cut: bool| is_cut.then_some(x);
    Ok(Some(ObjectDesc::Sphere {
        center: [0.0; 3],
        center_end: None,
        radius,
        z_min: part(z_min, z_min > -radius),
        z_max: part(z_max, z_max < radius),
        phi_max_deg: part(phi, phi < 360.0),
        material,
        transform: if is_whole { vec![TransformStep::Matrix(SPHERE_TURN)] } else { Vec::new() },
    }))
}

fn positive(params: &Params, name: &str, default: f64) -> Result<f64> {
    let x = params.float(name)?.unwrap_or(default);
    if x >= 1e-12 {
        return Ok(x);
    }
    Err(Fault::new(&params.span, format!("`{name}` must be more than 0, is {x}")))
}

fn single<const N: usize>(values: Vec<[f64; N]>) -> Vec<[f32; N]> {
    values.into_iter().map(|v| v.map(|x| x as f32)).collect()
}

fn triangle_mesh(at: &Span, params: &Params) -> Result<TriangleMesh> {
    let Some(positions) = params.triples("P")? else {
        return Err(Fault::new(at, "the mesh needs vertices: \"point3 P\""));
    };
    let indices = match params.indices("indices")? {
        Some(indices) => indices,
        None if positions.len() == 3 => vec![0, 1, 2],
        None => return Err(Fault::new(at, "the mesh needs \"integer indices\"")),
    };
    if indices.len() % 3 != 0 {
        let message = format!("`indices` has {} numbers, which is no multiple of 3", indices.len());
        return Err(Fault::new(at, message));
    }
    params.ignore(&["S", "faceIndices", "emissionfilename"]);
    let mut mesh = TriangleMesh {
        positions: single(positions),
        normals: single(params.triples("N")?.unwrap_or_default()),
        uvs: single(match params.pairs("uv")? {
            Some(uv) => uv,
            None => params.pairs("st")?.unwrap_or_default(),
        }),
        triangles: indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        ..TriangleMesh::default()
    };
    mesh.validate().map_err(|error| Fault::new(at, error.to_string()))?;
    mesh.drop_degenerate();
    Ok(mesh)
}

fn bilinear_mesh(at: &Span, params: &Params) -> Result<MeshDesc> {
    let Some(points) = params.triples("P")? else {
        return Err(Fault::new(at, "the mesh needs vertices: \"point3 P\""));
    };
    let indices = match params.indices("indices")? {
        Some(indices) => indices,
        None if points.len() == 4 => vec![0, 1, 2, 3],
        None => return Err(Fault::new(at, "the mesh needs \"integer indices\"")),
    };
    let uvs = params.pairs("uv")?.unwrap_or_default();
    let normals = params.triples("N")?.unwrap_or_default();
    params.ignore(&["faceIndices", "emissionfilename"]);
    let is_beyond = |&i: &u32| i as usize >= points.len();
    let is_short = |len: usize| len != 0 && len != points.len();
    if indices.is_empty()
        || indices.len() % 4 != 0
        || indices.iter().any(is_beyond)
        || is_short(uvs.len())
        || is_short(normals.len())
    {
        let message =
            "patches need four indices of vertices each, and one uv and N for each vertex";
        return Err(Fault::new(at, message));
    }
    if points.iter().flatten().any(|x| !(x.abs() <= 1e12)) {
        return Err(Fault::new(at, "a vertex of the mesh is farther than 1e12 from the origin"));
    }
    Ok(MeshDesc::Patches {
        positions: single(points),
        patches: indices.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect(),
        normals: single(normals),
        uvs: single(uvs),
    })
}
