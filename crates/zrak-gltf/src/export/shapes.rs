//! Shapes without triangles, made of triangles; with the texture coordinates that they have in zrak.

use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{CurveForm, Triple};

/// Steps around a full turn.
const AROUND: u32 = 96;
/// Steps from pole to pole.
const UP: u32 = 48;

/// Steps along a side of a bent bilinear patch.
const PATCH_STEPS: u32 = 16;
/// Rings of a tube for each segment of a curve.
const RINGS: u32 = 8;
/// Sides of a tube.
const TUBE_SIDES: u32 = 6;

/// A sphere.
pub(super) fn sphere(center: Triple, radius: f64) -> TriangleMesh {
    grid(AROUND, UP, |u, v| {
        let (s, c) = turn(u);
        let (sp, cp) = turn(v / 2.0);
        // u runs around y from -x over +z, v from the south pole.
        let n = [-c * sp, -cp, s * sp];
        ([0, 1, 2].map(|i| center[i] + radius * n[i]), n)
    })
}

/// A part of a sphere about z, with the texture coordinates of one.
pub(super) fn partial_sphere(
    center: Triple,
    radius: f64,
    [z_min, z_max]: [f64; 2],
    phi_max_deg: f64,
) -> TriangleMesh {
    let theta = |z: f64| libm::acos((z / radius).clamp(-1.0, 1.0));
    let (low, high) = (theta(z_min), theta(z_max));
    grid(AROUND, UP, |u, v| {
        let (s, c) = turn(u * phi_max_deg / 360.0);
        let (st, ct) = libm::sincos(low + (high - low) * v);
        let n = [c * st, s * st, ct];
        ([0, 1, 2].map(|i| center[i] + radius * n[i]), n)
    })
}

/// Bilinear patches as grids of triangles; one that is flat is two.
pub(super) fn patches(
    positions: &[[f32; 3]],
    patches: &[[u32; 4]],
    normals: &[[f32; 3]],
    uvs: &[[f32; 2]],
) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for patch in patches {
        let corners = patch.map(|v| positions[v as usize].map(f64::from));
        let [p00, p10, p01, p11] = corners;
        let size = (0..3).map(|i| (p11[i] - p00[i]).abs() + (p10[i] - p01[i]).abs()).sum::<f64>();
        let is_flat = (0..3).all(|i| (p00[i] + p11[i] - p10[i] - p01[i]).abs() <= 1e-6 * size);
        let n = if is_flat { 1 } else { PATCH_STEPS };
        let first = mesh.positions.len() as u32;
        for k in 0..(n + 1) * (n + 1) {
            let (u, v) =
                (f64::from(k % (n + 1)) / f64::from(n), f64::from(k / (n + 1)) / f64::from(n));
            let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
            let blend = |value: &dyn Fn(u32) -> f32| -> f32 {
                (0..4).map(|k| weights[k] * f64::from(value(patch[k]))).sum::<f64>() as f32
            };
            mesh.positions.push([0, 1, 2].map(|i| blend(&|v| positions[v as usize][i])));
            mesh.uvs.push(if uvs.is_empty() {
                [u as f32, v as f32]
            } else {
                [0, 1].map(|i| blend(&|v| uvs[v as usize][i]))
            });
            if !normals.is_empty() {
                mesh.normals.push([0, 1, 2].map(|i| blend(&|v| normals[v as usize][i])));
            }
        }
        for j in 0..n {
            for i in 0..n {
                let a = first + j * (n + 1) + i;
                mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
            }
        }
    }
    mesh.drop_degenerate();
    mesh
}

/// A curve as a tube, a ribbon as a strip.
pub(super) fn curve(
    points: &[Triple],
    widths: [f64; 2],
    form: CurveForm,
    normals: &[Triple],
) -> TriangleMesh {
    let n_segments = (points.len() / 3) as u32;
    let is_ribbon = form == CurveForm::Ribbon;
    // An arm that is carried along, so that tubes do not twist.
    let n_rings = n_segments * RINGS;
    let mut arm = [0.0; 3];
    let mut rings = Vec::new();
    for k in 0..=n_rings {
        let segment = (k / RINGS).min(n_segments - 1);
        let u = f64::from(k - segment * RINGS) / f64::from(RINGS);
        let (c, along) = on_curve(&points[3 * segment as usize..], u);
        let along = unit(along);
        let n = if is_ribbon {
            let (a, b) = (normals[segment as usize], normals[segment as usize + 1]);
            unit([0, 1, 2].map(|i| a[i] * (1.0 - u) + b[i] * u))
        } else {
            let least = (0..3).min_by(|&a, &b| along[a].abs().total_cmp(&along[b].abs()));
            let mut away = arm;
            if k == 0 {
                away[least.unwrap_or(0)] = 1.0;
            }
            unit(cross(cross(along, away), along))
        };
        arm = n;
        rings.push((c, n, cross(along, n)));
    }
    let around = if is_ribbon { 1 } else { TUBE_SIDES };
    grid(around, n_rings, |u, v| {
        let (c, n, b) = rings[(v * f64::from(n_rings)).round() as usize];
        let half = 0.5 * (widths[0] + (widths[1] - widths[0]) * v);
        let at = |d: Triple| [0, 1, 2].map(|i| c[i] + half * d[i]);
        if is_ribbon {
            return (at(b.map(|x| x * (2.0 * u - 1.0))), n);
        }
        let (s, co) = turn(u);
        let out = [0, 1, 2].map(|i| co * n[i] + s * b[i]);
        (at(out), out)
    })
}

/// Point and derivative of a cubic Bézier segment.
fn on_curve(points: &[Triple], u: f64) -> (Triple, Triple) {
    let mix = |a: Triple, b: Triple| [0, 1, 2].map(|i| a[i] * (1.0 - u) + b[i] * u);
    let (ab, bc, cd) =
        (mix(points[0], points[1]), mix(points[1], points[2]), mix(points[2], points[3]));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    let along = [0, 1, 2].map(|i| bcd[i] - abc[i]);
    // Where control points coincide, the chord says where it leads.
    let chord = [0, 1, 2].map(|i| points[3][i] - points[0][i]);
    (mix(abc, bcd), if along == [0.0; 3] { chord } else { along })
}

fn cross(u: Triple, v: Triple) -> Triple {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The direction as a unit vector; up, if it has none.
fn unit(v: Triple) -> Triple {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !(largest > 0.0) {
        return [0.0, 0.0, 1.0];
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}

/// A disk or ring about z, facing +z.
pub(super) fn disk(height: f64, radius: f64, inner: f64, phi_max_deg: f64) -> TriangleMesh {
    grid(AROUND, 1, |u, v| {
        let (s, c) = turn(u * phi_max_deg / 360.0);
        let r = radius + (inner - radius) * v;
        ([r * c, r * s, height], [0.0, 0.0, 1.0])
    })
}

/// An open cylinder about z, facing away from it.
pub(super) fn cylinder(radius: f64, z_min: f64, z_max: f64, phi_max_deg: f64) -> TriangleMesh {
    grid(AROUND, 1, |u, v| {
        let (s, c) = turn(u * phi_max_deg / 360.0);
        ([radius * c, radius * s, z_min + (z_max - z_min) * v], [c, s, 0.0])
    })
}

/// A parallelogram.
pub(super) fn quad(corner: Triple, u: Triple, v: Triple) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    add_quad(&mut mesh, corner, u, v);
    mesh
}

/// A triangle.
pub(super) fn triangle(vertices: [Triple; 3], uv: [[f64; 2]; 3]) -> TriangleMesh {
    TriangleMesh {
        positions: vertices.map(|p| p.map(|x| x as f32)).to_vec(),
        uvs: uv.map(|uv| uv.map(|x| x as f32)).to_vec(),
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    }
}

/// A box with sides along the axes.
pub(super) fn cuboid(min: Triple, max: Triple) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let [x, y, z] = [0, 1, 2].map(|i| max[i] - min[i]);
    let (right, up, front) = ([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]);
    let back = |v: Triple| v.map(|x| 0.0 - x);
    let at = |x: Triple, y: Triple, z: Triple| [x[0], y[1], z[2]];
    for (corner, u, v) in [
        (at(max, min, max), back(front), up),
        (at(min, min, min), front, up),
        (at(min, max, max), right, back(front)),
        (at(min, min, min), right, front),
        (at(min, min, max), right, up),
        (at(max, min, min), back(right), up),
    ] {
        add_quad(&mut mesh, corner, u, v);
    }
    mesh
}

fn add_quad(mesh: &mut TriangleMesh, corner: Triple, u: Triple, v: Triple) {
    let first = mesh.positions.len() as u32;
    for [a, b] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        let p = [0, 1, 2].map(|i| (corner[i] + a * u[i] + b * v[i]) as f32);
        mesh.positions.push(p);
        mesh.uvs.push([a as f32, b as f32]);
    }
    mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i| first + i)));
}

/// Sine and cosine of a share of a turn; exact at quarters.
fn turn(share: f64) -> (f64, f64) {
    let quarter = (share * 4.0).round();
    let (s, c) = libm::sincos((share * 4.0 - quarter) * std::f64::consts::FRAC_PI_2);
    match (quarter as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// A surface over the unit square, of points and normals; triangles without area are left out.
fn grid(nu: u32, nv: u32, surface: impl Fn(f64, f64) -> (Triple, Triple)) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..=nv {
        for i in 0..=nu {
            let (u, v) = (f64::from(i) / f64::from(nu), f64::from(j) / f64::from(nv));
            let (p, n) = surface(u, v);
            mesh.positions.push(p.map(|x| x as f32));
            mesh.normals.push(n.map(|x| x as f32));
            mesh.uvs.push([u as f32, v as f32]);
        }
    }
    for j in 0..nv {
        for i in 0..nu {
            let at = |di: u32, dj: u32| (j + dj) * (nu + 1) + i + di;
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                let [p, q, r] = triangle.map(|v| mesh.positions[v as usize]);
                if p != q && q != r && r != p {
                    mesh.triangles.push(facing(&mesh, triangle));
                }
            }
        }
    }
    mesh
}

/// The triangle with its corners counter-clockwise seen from where its normals point.
fn facing(mesh: &TriangleMesh, [a, b, c]: [u32; 3]) -> [u32; 3] {
    let point = |v: u32| mesh.positions[v as usize].map(f64::from);
    let sub = |p: Triple, q: Triple| [0, 1, 2].map(|i| p[i] - q[i]);
    let cross = cross(sub(point(b), point(a)), sub(point(c), point(a)));
    let sum: f64 = [a, b, c]
        .iter()
        .flat_map(|&v| mesh.normals[v as usize].into_iter().zip(cross))
        .map(|(n, x)| f64::from(n) * x)
        .sum();
    if sum < 0.0 { [a, c, b] } else { [a, b, c] }
}

#[cfg(test)]
mod tests {
    use super::{cuboid, curve, cylinder, disk, partial_sphere, patches, quad, sphere};
    use zrak_mesh::TriangleMesh;
    use zrak_scene::desc::CurveForm;

    fn area_and_volume(mesh: &TriangleMesh) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize].map(f64::from));
            let (u, v) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
            let x =
                [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            sums.0 += (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt() / 2.0;
            sums.1 += (a[0] * x[0] + a[1] * x[1] + a[2] * x[2]) / 6.0;
        }
        sums
    }

    #[test]
    fn shapes_have_their_areas_and_face_outwards() {
        let pi = std::f64::consts::PI;
        let square = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 3.0, 1.0], [2.0, 3.0, 1.0]];
        let saddle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
        let line = [0.0, 1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0]);
        for (mesh, area, volume) in [
            (sphere([1.0, 2.0, 3.0], 2.0), 16.0 * pi, Some(32.0 / 3.0 * pi)),
            (cuboid([-1.0, 0.0, 1.0], [1.0, 3.0, 5.0]), 52.0, Some(24.0)),
            (quad([0.0; 3], [2.0, 0.0, 0.0], [1.0, 3.0, 0.0]), 6.0, None),
            (disk(1.0, 2.0, 0.0, 360.0), 4.0 * pi, None),
            (disk(1.0, 2.0, 1.0, 90.0), 0.75 * pi, None),
            (cylinder(2.0, 0.0, 3.0, 180.0), 6.0 * pi, None),
            (partial_sphere([1.0; 3], 2.0, [-1.0, 2.0], 90.0), 3.0 * pi, None),
            (patches(&square, &[[0, 1, 2, 3]], &[], &[]), 6.0, None),
            // A hyperbolic paraboloid z = x y over the unit square.
            (patches(&saddle, &[[0, 1, 2, 3]], &[], &[]), 1.280_789, None),
            (curve(&line, [0.2, 0.2], CurveForm::Ribbon, &[[0.0, 0.0, 1.0]; 2]), 0.6, None),
            // Hexagons.
            (curve(&line, [0.2, 0.2], CurveForm::Flat, &[]), 1.8, None),
        ] {
            let (a, v) = area_and_volume(&mesh);
            // The triangles lie inside of round shapes: 0.3% for 96 sides.
            assert!((a / area - 1.0).abs() < 4e-3, "area {a}, not {area}");
            if let Some(volume) = volume {
                assert!((v / volume - 1.0).abs() < 4e-3, "volume {v}, not {volume}");
            }
            assert!(mesh.positions.len() == mesh.uvs.len());
        }
    }
}
