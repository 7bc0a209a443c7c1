//! Primitives: from accessors to a triangle mesh.

use std::collections::BTreeMap;

use zrak_mesh::TriangleMesh;
use zrak_scene::lower::Transform;
use zrak_scene::validate::limits::NUMBER_MAX;

use crate::accessor::{self, Accessor, Kind};
use crate::budget::Budget;
use crate::buffers::Buffers;
use crate::deform;
use crate::error::{Error, ErrorKind, Warnings};
use crate::json::{Primitive, Root};

/// What primitives are read from.
pub(crate) struct Source<'a> {
    pub(crate) root: &'a Root,
    pub(crate) buffers: &'a Buffers<'a>,
    pub(crate) budget: &'a Budget,
}

impl<'a> Source<'a> {
    pub(crate) fn open(
        &self,
        index: usize,
        kinds: &[Kind],
        location: &str,
        warnings: &mut Warnings,
    ) -> Result<Accessor<'a>, Error> {
        accessor::open(self.root, self.buffers, index, kinds, location, warnings)
    }

    /// The accessor of an attribute, which must have `n` elements.
    pub(crate) fn attribute(
        &self,
        attributes: &BTreeMap<String, usize>,
        name: &str,
        kinds: &[Kind],
        n: usize,
        location: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Accessor<'a>>, Error> {
        let Some(&index) = attributes.get(name) else { return Ok(None) };
        let at = format!("{location}.{name}");
        let accessor = self.open(index, kinds, &at, warnings)?;
        if accessor.count != n {
            let message = format!("it has {} elements, POSITION has {n}", accessor.count);
            return Err(Error::invalid(at, message));
        }
        Ok(Some(accessor))
    }
}

/// How a primitive is to be read.
pub(crate) struct Request<'a> {
    /// Which set of texture coordinates the mesh carries.
    pub(crate) uv_set: usize,
    /// Whether its material looks at texture coordinates.
    pub(crate) needs_uv: bool,
    /// Weights of the morph targets.
    pub(crate) weights: &'a [f64],
    /// The maps of the skin's joints, if it has one.
    pub(crate) joints: Option<&'a [Transform]>,
}

/// The vertices of the accessors that are taken.
pub(crate) enum Selection {
    All(usize),
    Some(Vec<u32>),
}

impl Selection {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::All(n) => *n,
            Self::Some(list) => list.len(),
        }
    }

    /// The numbers of an accessor for these vertices.
    pub(crate) fn floats<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        budget: &Budget,
        location: &str,
    ) -> Result<Vec<[f32; N]>, Error> {
        budget.spend(location, self.len() as u64, 4 * N as u64)?;
        Ok(match self {
            Self::All(n) => (0..*n).map(|i| accessor.floats(i)).collect(),
            Self::Some(list) => list.iter().map(|&i| accessor.floats(i as usize)).collect(),
        })
    }

    /// The same for counts.
    pub(crate) fn counts<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        budget: &Budget,
        location: &str,
    ) -> Result<Vec<[u32; N]>, Error> {
        budget.spend(location, self.len() as u64, 4 * N as u64)?;
        Ok(match self {
            Self::All(n) => (0..*n).map(|i| accessor.counts(i)).collect(),
            Self::Some(list) => list.iter().map(|&i| accessor.counts(i as usize)).collect(),
        })
    }
}

/// Reads a primitive; none if it has no triangles.
pub(crate) fn read(
    source: &Source<'_>,
    primitive: &Primitive,
    request: &Request<'_>,
    location: &str,
    warnings: &mut Warnings,
) -> Result<Option<TriangleMesh>, Error> {
    let budget = source.budget;
    let mode = primitive.mode.unwrap_or(4);
    match mode {
        0..=3 => {
            let what = if mode == 0 { "points" } else { "lines" };
            warnings.note(location, format!("{what} have no surface and are left out"));
            return Ok(None);
        }
        4..=6 => {}
        _ => {
            let message = format!("{mode} is no mode of a primitive");
            return Err(Error::invalid(format_args!("{location}.mode"), message));
        }
    }
    let at = format!("{location}.attributes");
    let Some(&position) = primitive.attributes.get("POSITION") else {
        warnings.note(location, "the primitive has no POSITION and is left out");
        return Ok(None);
    };
    let position_at = format!("{at}.POSITION");
    let positions = source.open(position, &[Kind::Vec3], &position_at, warnings)?;
    if primitive.extensions.draco.is_some() && source.root.accessors[position].buffer_view.is_none()
    {
        let message = "the primitive is compressed by KHR_draco_mesh_compression, which zrak lacks";
        let help = "export it without compression, or decompress it with \
                    `npx @gltf-transform/cli copy`";
        return Err(Error::new(ErrorKind::Unsupported, location, message, help));
    }
    let n = positions.count;
    let (triangles, selection) = faces(source, primitive, n, mode, location, warnings)?;
    if triangles.is_empty() {
        warnings.note(location, "the primitive has no triangles and is left out");
        return Ok(None);
    }
    let mut mesh = TriangleMesh {
        positions: selection.floats(&positions, budget, &position_at)?,
        triangles,
        ..TriangleMesh::default()
    };
    let optional = |name: &str, kinds: &[Kind], warnings: &mut Warnings| {
        source.attribute(&primitive.attributes, name, kinds, n, &at, warnings)
    };
    if let Some(normals) = optional("NORMAL", &[Kind::Vec3], warnings)? {
        mesh.normals = selection.floats(&normals, budget, &at)?;
        // Tangents mean nothing without normals.
        if let Some(tangents) = optional("TANGENT", &[Kind::Vec4], warnings)? {
            mesh.tangents = selection.floats(&tangents, budget, &at)?;
        }
    }
    let uv_name = format!("TEXCOORD_{}", request.uv_set);
    if let Some(uvs) = optional(&uv_name, &[Kind::Vec2], warnings)? {
        mesh.uvs = selection.floats(&uvs, budget, &at)?;
    } else if request.needs_uv {
        let message = format!("its material has textures on {uv_name}, which is missing");
        warnings.note(location, message);
    }
    if let Some(colors) = optional("COLOR_0", &[Kind::Vec3, Kind::Vec4], warnings)? {
        mesh.colors = selection.floats(&colors, budget, &at)?;
        if colors.kind == Kind::Vec3 {
            mesh.colors.iter_mut().for_each(|c| c[3] = 1.0);
        }
    }
    deform::morph(
        source,
        primitive,
        request.weights,
        n,
        &selection,
        &mut mesh,
        location,
        warnings,
    )?;
    if let Some(joints) = request.joints {
        deform::skin(source, primitive, joints, n, &selection, &mut mesh, location, warnings)?;
    }
    let far = |p: &[f32; 3]| !p.iter().all(|x| x.abs() <= NUMBER_MAX as f32);
    if let Some(i) = mesh.positions.iter().position(far) {
        let message = format!("vertex {i} is not a number or farther than 1e12 from the origin");
        return Err(Error::invalid(position_at, message));
    }
    tidy(&mut mesh);
    mesh.drop_degenerate();
    if mesh.triangles.is_empty() {
        warnings.note(location, "no triangle of the primitive has an area: it is left out");
        return Ok(None);
    }
    Ok(Some(mesh))
}

/// The triangles, whose corners count from 0 among the vertices that are selected.
fn faces(
    source: &Source<'_>,
    primitive: &Primitive,
    n: usize,
    mode: u32,
    location: &str,
    warnings: &mut Warnings,
) -> Result<(Vec<[u32; 3]>, Selection), Error> {
    let budget = source.budget;
    let at = format!("{location}.indices");
    let n_triangles = |n_corners: usize| match mode {
        4 => n_corners / 3,
        _ => n_corners.saturating_sub(2),
    };
    let Some(index) = primitive.indices else {
        if mode == 4 && !n.is_multiple_of(3) {
            let message =
                format!("{n} vertices do not make whole triangles: the last are left out");
            warnings.note(location, message);
        }
        budget.spend(&at, n_triangles(n) as u64, 12)?;
        return Ok((triangulate(mode, n, |i| i as u32), Selection::All(n)));
    };
    let indices = source.open(index, &[Kind::Scalar], &at, warnings)?;
    if !indices.is_unsigned() {
        let message = format!("accessors[{index}] must have whole numbers without a sign");
        return Err(Error::invalid(at, message));
    }
    let n_corners = indices.count;
    if mode == 4 && !n_corners.is_multiple_of(3) {
        let message =
            format!("{n_corners} indices do not make whole triangles: the last are left out");
        warnings.note(&at, message);
    }
    // The corners, their triangles, and perhaps the list of those that are used.
    budget.spend(&at, n_corners as u64, 20)?;
    let mut corners: Vec<u32> = (0..n_corners).map(|i| indices.counts::<1>(i)[0]).collect();
    if let Some(i) = corners.iter().position(|&v| v as usize >= n) {
        let message = format!("index {i} is {}, but there are {n} vertices", corners[i]);
        return Err(Error::invalid(at, message));
    }
    let mut selection = Selection::All(n);
    // Some exporters let many primitives share one large set of vertices.
    if n_corners < n {
        let mut used = corners.clone();
        used.sort_unstable();
        used.dedup();
        for corner in &mut corners {
            // Every corner is in the list that was made of them.
            *corner = used.binary_search(corner).unwrap_or(0) as u32;
        }
        selection = Selection::Some(used);
    }
    Ok((triangulate(mode, n_corners, |i| corners[i]), selection))
}

/// The triangles of a list, strip or fan, without those that are only a line.
fn triangulate(mode: u32, n: usize, corner: impl Fn(usize) -> u32) -> Vec<[u32; 3]> {
    let triangle = |i: usize| match mode {
        4 => [3 * i, 3 * i + 1, 3 * i + 2],
        5 => [i, i + 1 + i % 2, i + 2 - i % 2],
        _ => [i + 1, i + 2, 0],
    };
    let count = if mode == 4 { n / 3 } else { n.saturating_sub(2) };
    (0..count)
        .map(|i| triangle(i).map(&corner))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect()
}

/// Brings attributes into the form that [`TriangleMesh`] asks for.
fn tidy(mesh: &mut TriangleMesh) {
    for uv in &mut mesh.uvs {
        let [u, v] = uv.map(|x| if x.abs() <= NUMBER_MAX as f32 { x } else { 0.0 });
        // glTF's v points down the picture, zrak's up.
        *uv = [u, 1.0 - v];
    }
    for color in &mut mesh.colors {
        // Negated, so that NaN becomes 0.
        *color = color.map(|x| if x > 0.0 { x.min(1.0) } else { 0.0 });
    }
    let length2 = |v: &[f32]| v.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>();
    let is_direction = |v: &[f32]| {
        let l2 = length2(v);
        l2 > 1e-30 && l2 < 1e30
    };
    if mesh.normals.iter().any(|n| !is_direction(n)) {
        let mut sums = vec![[0.0_f64; 3]; mesh.positions.len()];
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|v| mesh.positions[v as usize].map(f64::from));
            let n = cross(sub(b, a), sub(c, a));
            for &v in triangle {
                let sum = &mut sums[v as usize];
                *sum = [0, 1, 2].map(|i| sum[i] + n[i]);
            }
        }
        for (normal, sum) in mesh.normals.iter_mut().zip(sums) {
            if !is_direction(normal) {
                let largest = sum.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let known = largest > 0.0 && largest.is_finite();
                *normal = if known { sum.map(|x| (x / largest) as f32) } else { [0.0, 0.0, 1.0] };
            }
        }
    }
    // Without them, tangents are made of the texture coordinates.
    if mesh.tangents.iter().any(|t| !is_direction(&t[..3])) {
        mesh.tangents.clear();
    }
    for tangent in &mut mesh.tangents {
        let length = length2(&tangent[..3]).sqrt();
        let [x, y, z, w] = *tangent;
        let unit = [x, y, z].map(|x| (f64::from(x) / length) as f32);
        *tangent = [unit[0], unit[1], unit[2], if w < 0.0 { -1.0 } else { 1.0 }];
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
