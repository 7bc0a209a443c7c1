//! Morph targets and skins, applied once: zrak renders the pose that the file's nodes are in.

use zrak_mesh::TriangleMesh;
use zrak_scene::lower::Transform;

use crate::accessor::Kind;
use crate::error::{Error, Warnings};
use crate::json::Primitive;
use crate::primitive::{Selection, Source};

/// Adds the morph targets, each times its weight.
pub(crate) fn morph(
    source: &Source<'_>,
    primitive: &Primitive,
    weights: &[f64],
    n: usize,
    selection: &Selection,
    mesh: &mut TriangleMesh,
    location: &str,
    warnings: &mut Warnings,
) -> Result<(), Error> {
    for (i, (target, &weight)) in primitive.targets.iter().zip(weights).enumerate() {
        if weight == 0.0 {
            continue;
        }
        let at = format!("{location}.targets[{i}]");
        let mut moves = |name: &str| -> Result<Option<Vec<[f32; 3]>>, Error> {
            let accessor = source.attribute(target, name, &[Kind::Vec3], n, &at, warnings)?;
            accessor.map(|a| selection.floats(&a, source.budget, &at)).transpose()
        };
        if let Some(moves) = moves("POSITION")? {
            mesh.positions.iter_mut().zip(&moves).for_each(|(p, by)| add(p, by, weight));
        }
        if let Some(moves) = moves("NORMAL")? {
            mesh.normals.iter_mut().zip(&moves).for_each(|(n, by)| add(n, by, weight));
        }
        if let Some(moves) = moves("TANGENT")? {
            mesh.tangents.iter_mut().zip(&moves).for_each(|(t, by)| add(&mut t[..3], by, weight));
        }
    }
    Ok(())
}

fn add(v: &mut [f32], by: &[f32; 3], weight: f64) {
    for (x, &by) in v.iter_mut().zip(by) {
        *x = (f64::from(*x) + weight * f64::from(by)) as f32;
    }
}

/// Places every vertex by the weighted mean of its joints' maps.
pub(crate) fn skin(
    source: &Source<'_>,
    primitive: &Primitive,
    joints: &[Transform],
    n: usize,
    selection: &Selection,
    mesh: &mut TriangleMesh,
    location: &str,
    warnings: &mut Warnings,
) -> Result<(), Error> {
    let at = format!("{location}.attributes");
    let n_vertices = mesh.positions.len();
    source.budget.spend(&at, n_vertices as u64, size_of::<[[f64; 4]; 3]>() as u64 + 8)?;
    let mut sums = vec![[[0.0_f64; 4]; 3]; n_vertices];
    let mut totals = vec![0.0_f64; n_vertices];
    for set in 0..4 {
        let [joint_name, weight_name] = ["JOINTS", "WEIGHTS"].map(|name| format!("{name}_{set}"));
        let mut open = |name: &str| {
            source.attribute(&primitive.attributes, name, &[Kind::Vec4], n, &at, warnings)
        };
        let (Some(ids), Some(weights)) = (open(&joint_name)?, open(&weight_name)?) else {
            break;
        };
        let ids = selection.counts::<4>(&ids, source.budget, &at)?;
        let weights = selection.floats::<4>(&weights, source.budget, &at)?;
        for (v, (ids, weights)) in ids.iter().zip(&weights).enumerate() {
            for (&id, &weight) in ids.iter().zip(weights) {
                if !(weight > 0.0 && weight.is_finite()) {
                    continue;
                }
                let Some(joint) = joints.get(id as usize) else {
                    let n_joints = joints.len();
                    let message = format!("joint {id} is used, but the skin has {n_joints} joints");
                    return Err(Error::invalid(format_args!("{at}.{joint_name}"), message));
                };
                let weight = f64::from(weight);
                totals[v] += weight;
                for (sum, row) in sums[v].iter_mut().zip(&joint.rows) {
                    for (sum, x) in sum.iter_mut().zip(row) {
                        *sum += weight * x;
                    }
                }
            }
        }
    }
    if totals.contains(&0.0) {
        warnings.note(location, "vertices without a joint stay where the mesh has them");
    }
    let mut is_mirrored = vec![false; n_vertices];
    for (v, (sum, total)) in sums.into_iter().zip(totals).enumerate() {
        if total == 0.0 {
            continue;
        }
        let map = Transform { rows: sum.map(|row| row.map(|x| x / total)) };
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        mesh.positions[v] = single(map.point(mesh.positions[v].map(f64::from)));
        if let Some(back) = map.inverse() {
            is_mirrored[v] = map.determinant() < 0.0;
            if let Some(normal) = mesh.normals.get_mut(v) {
                *normal = single(back.transposed_vector(normal.map(f64::from)));
            }
        }
        if let Some([x, y, z, w]) = mesh.tangents.get_mut(v) {
            [*x, *y, *z] = single(map.vector([*x, *y, *z].map(f64::from)));
            if is_mirrored[v] {
                *w = -*w;
            }
        }
    }
    for triangle in &mut mesh.triangles {
        if is_mirrored[triangle[0] as usize] {
            triangle.swap(1, 2);
        }
    }
    Ok(())
}
