//! Shapes.

use std::sync::Arc;

use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{
    ColorDesc, LightSides, MaterialDesc, MediumInterfaceDesc, MeshDesc, ObjectDesc, ScalarDesc,
    TransformStep,
};

use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::{Importer, steps};

/// Triangles along a side that a curved bilinear patch is cut into.
const PATCH_STEPS: u32 = 16;

impl Importer {
    pub(crate) fn shape(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        let material = self.surface(params)?;
        let partial = |importer: &mut Self, what: &str| {
            importer.warn(at, format!("a part of a {what} is rendered as the whole"));
        };
        // Orientation is turned by a mirrored map and by ReverseOrientation; triangles keep the side
        // that their corners' order says, and so do zrak's maps.
        let flip = self.state.reverse;
        let object = match kind {
            "sphere" => {
                let radius = positive(params, "radius", 1.0)?;
                let z_min = params.float("zmin")?.unwrap_or(-radius);
                let z_max = params.float("zmax")?.unwrap_or(radius);
                let phi = params.float("phimax")?.unwrap_or(360.0);
                if z_min > -radius || z_max < radius || phi < 360.0 {
                    partial(self, "sphere");
                }
                if flip && self.state.light.is_some() {
                    self.warn(
                        at,
                        "a sphere that shines inwards is rendered as one that shines outwards",
                    );
                }
                let material = material.clone();
                ObjectDesc::Sphere {
                    center: [0.0; 3],
                    center_end: None,
                    radius,
                    material,
                    transform: Vec::new(),
                }
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
                let mesh = bilinear_mesh(at, params, self.sources.limits().max_bytes)?;
                self.mesh(mesh, material, flip, at)?
            }
            "curve" => {
                self.warn(at, "curves are not rendered yet");
                let names: Vec<&str> = params.all.iter().map(|p| p.name.as_str()).collect();
                params.ignore(&names);
                return Ok(());
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
        Ok(ObjectDesc::Mesh {
            mesh: name,
            material,
            group_materials: Vec::new(),
            flip,
            transform: Vec::new(),
        })
    }

    /// Name of the material of a shape, with the light, the media and the holes that it has.
    fn surface(&mut self, params: &Params) -> Result<String> {
        let material = self.state.material.to_string();
        let alpha = self.scalar(params, "alpha")?.filter(|alpha| *alpha != ScalarDesc::Value(1.0));
        let [inside, outside] = self.state.media.clone();
        let light = self.state.light.clone();
        let has_media = inside != outside;
        if alpha.is_none() && light.is_none() && !has_media {
            return Ok(material);
        }
        // The same again is made once.
        let key = format!("{material}|{alpha:?}|{light:?}|{inside}|{outside}");
        if let Some(name) = self.surfaces.get(&key) {
            return Ok(name.clone());
        }
        let mut surface = match self.desc.materials.get(&material) {
            Some(surface @ MaterialDesc::Surface { .. }) => surface.clone(),
            _ => MaterialDesc::surface(material),
        };
        if let MaterialDesc::Surface { emission, emission_sides, alpha: a, medium, .. } =
            &mut surface
        {
            if let Some(light) = light {
                *emission = Some(ColorDesc::Solid(light.radiance));
                *emission_sides =
                    if light.two_sided { LightSides::Both } else { LightSides::Front };
            }
            *a = alpha;
            if has_media {
                let name = |name: &str| Some(name.to_owned()).filter(|name| !name.is_empty());
                *medium =
                    Some(MediumInterfaceDesc { inside: name(&inside), outside: name(&outside) });
            }
        }
        let name = self.fresh("surface");
        self.desc.materials.insert(name.clone(), surface);
        self.surfaces.insert(key, name.clone());
        Ok(name)
    }
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

/// Bilinear patches as triangles: two for a flat one, a grid for one that is bent.
fn bilinear_mesh(at: &Span, params: &Params, max_bytes: u64) -> Result<TriangleMesh> {
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
    if indices.len() % 4 != 0
        || indices.iter().any(is_beyond)
        || is_short(uvs.len())
        || is_short(normals.len())
    {
        let message =
            "patches need four indices of vertices each, and one uv and N for each vertex";
        return Err(Fault::new(at, message));
    }
    // What a bent patch takes: vertices with normals and uv, and triangles.
    let n_steps = u64::from(PATCH_STEPS);
    let patch_bytes = (n_steps + 1) * (n_steps + 1) * 32 + n_steps * n_steps * 24;
    let n_patches = indices.len() as u64 / 4;
    if n_patches > max_bytes / patch_bytes {
        let message = format!("{n_patches} patches take more than the limit of {max_bytes} bytes");
        return Err(Fault::new(at, message).help("raise the limit if they are meant"));
    }
    let mut mesh = TriangleMesh::default();
    for patch in indices.chunks_exact(4) {
        let corner = |k: usize| points[patch[k] as usize];
        let [p00, p10, p01, p11] = [corner(0), corner(1), corner(2), corner(3)];
        // Flat if opposite corners' sums agree.
        let size = (0..3).map(|i| (p11[i] - p00[i]).abs() + (p10[i] - p01[i]).abs()).sum::<f64>();
        let is_flat = (0..3).all(|i| (p00[i] + p11[i] - p10[i] - p01[i]).abs() <= 1e-6 * size);
        let n = if is_flat { 1 } else { PATCH_STEPS };
        let first = mesh.positions.len() as u32;
        for j in 0..=n {
            for i in 0..=n {
                let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
                let blend = |value: &dyn Fn(usize) -> f64| -> f32 {
                    (0..4).map(|k| weights[k] * value(patch[k] as usize)).sum::<f64>() as f32
                };
                mesh.positions.push(std::array::from_fn(|axis| blend(&|v| points[v][axis])));
                if uvs.is_empty() {
                    mesh.uvs.push([u as f32, v as f32]);
                } else {
                    mesh.uvs.push(std::array::from_fn(|axis| blend(&|v| uvs[v][axis])));
                }
                if !normals.is_empty() {
                    mesh.normals.push(std::array::from_fn(|axis| blend(&|v| normals[v][axis])));
                }
            }
        }
        for j in 0..n {
            for i in 0..n {
                let a = first + j * (n + 1) + i;
                mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
            }
        }
    }
    mesh.validate().map_err(|error| Fault::new(at, error.to_string()))?;
    mesh.drop_degenerate();
    Ok(mesh)
}
