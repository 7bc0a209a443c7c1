//! Normals of vertices: those of the file, means of those of faces, or the faces' own.

use std::collections::HashMap;

use super::weld::{Corner, FLAT};
use crate::{Error, TriangleMesh};

/// Adds the normals of the vertices, unless all faces are flat.
pub(super) fn add_normals(
    mesh: &mut TriangleMesh,
    vertices: &[Corner],
    normals: &[[f32; 3]],
    max_bytes: u64,
) -> Result<(), Error> {
    if vertices.iter().all(|v| v.normal == FLAT) {
        return Ok(());
    }
    let sums = sums(mesh, vertices);
    let normal = |v: &Corner| -> Option<[f32; 3]> {
        let n = match v.normal {
            FLAT => return None,
            _ if v.is_smooth() => unit(*sums.get(&(v.position, v.normal))?)?,
            i => normals[i as usize],
        };
        // Those without a length say nothing.
        (n != [0.0; 3]).then_some(n)
    };
    let known: Vec<Option<[f32; 3]>> = vertices.iter().map(normal).collect();
    mesh.normals = known.iter().map(|n| n.unwrap_or([0.0, 0.0, 1.0])).collect();
    if known.iter().all(Option::is_some) {
        return Ok(());
    }
    // Flat faces among others get vertices of their own.
    for i in 0..mesh.triangles.len() {
        let corners = mesh.triangles[i];
        if corners.iter().all(|&v| known[v as usize].is_some()) {
            continue;
        }
        let own = unit(cross(mesh, corners)).unwrap_or([0.0, 0.0, 1.0]);
        for (k, v) in corners.map(|v| v as usize).into_iter().enumerate() {
            if known[v].is_some() {
                continue;
            }
            mesh.triangles[i][k] = mesh.positions.len() as u32;
            mesh.positions.push(mesh.positions[v]);
            mesh.normals.push(own);
            mesh.uvs.extend(mesh.uvs.get(v).copied());
            mesh.colors.extend(mesh.colors.get(v).copied());
        }
        if mesh.positions.len() as u64 * 48 > max_bytes {
            let message = format!("the mesh takes more memory than the limit of {max_bytes} bytes");
            return Err(Error::new(message));
        }
    }
    Ok(())
}

/// For each position and smoothing group, the sum of the unit normals of faces times their angles there.
/// Vertices that differ in their texture coordinates alone are one here.
fn sums(mesh: &TriangleMesh, vertices: &[Corner]) -> HashMap<(u32, u32), [f64; 3]> {
    let mut sums: HashMap<(u32, u32), [f64; 3]> = HashMap::new();
    for &corners in &mesh.triangles {
        if corners.iter().all(|&v| !vertices[v as usize].is_smooth()) {
            continue;
        }
        let Some(n) = unit64(cross(mesh, corners)) else { continue };
        let p = corners.map(|v| mesh.positions[v as usize].map(f64::from));
        for k in 0..3 {
            let vertex = &vertices[corners[k] as usize];
            if !vertex.is_smooth() {
                continue;
            }
            let (a, b) = (sub(p[(k + 1) % 3], p[k]), sub(p[(k + 2) % 3], p[k]));
            let (Some(a), Some(b)) = (unit64(a), unit64(b)) else { continue };
            // Not of the platform's: the picture must be the same everywhere.
            let angle = libm::acos((a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).clamp(-1.0, 1.0));
            let sum = sums.entry((vertex.position, vertex.normal)).or_default();
            for axis in 0..3 {
                sum[axis] += n[axis] * angle;
            }
        }
    }
    sums
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(mesh: &TriangleMesh, corners: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|v| mesh.positions[v as usize].map(f64::from));
    let (u, v) = (sub(b, a), sub(c, a));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn unit64(v: [f64; 3]) -> Option<[f64; 3]> {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    Some(v.map(|x| x / length))
}

fn unit(v: [f64; 3]) -> Option<[f32; 3]> {
    unit64(v).map(|v| v.map(|x| x as f32))
}
