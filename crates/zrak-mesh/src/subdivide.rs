//! Loop's subdivision: a smooth surface from a coarse control mesh.
//!
//! Loop, *Smooth Subdivision Surfaces Based on Triangles*, 1987, with Warren's weights for vertices of
//! irregular valence and the boundary rules of Pharr, Jakob, Humphreys, *Physically Based Rendering*,
//! 3rd ed., section 3.8. After the last level, vertices move to the limit surface and get its normals.

use std::collections::HashMap;

use crate::{Error, Limits, TriangleMesh};

/// Most triangles that a subdivision may come to.
const TRIANGLES_MAX: u64 = 1 << 28;

/// About what a triangle of the result takes in memory while it is made.
const BYTES_PER_TRIANGLE: u64 = 256;

/// What surrounds each vertex of a mesh.
struct Neighbours {
    /// Vertices around each vertex, in order; from one side of the boundary to the other at one.
    rings: Vec<Vec<u32>>,
    on_boundary: Vec<bool>,
}

/// Subdivides a control mesh, without other attributes, `levels` times.
///
/// # Errors
/// If it is not a manifold (an edge of three triangles, two sheets that meet in a point, or neighbours
/// of opposite orientation), or the result would be too large for the limits.
pub fn loop_subdivide(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    levels: u32,
    limits: &Limits,
) -> Result<TriangleMesh, Error> {
    let control = TriangleMesh {
        positions: positions.to_vec(),
        triangles: triangles.to_vec(),
        ..TriangleMesh::default()
    };
    control.validate()?;
    let most = TRIANGLES_MAX.min(limits.max_bytes / BYTES_PER_TRIANGLE);
    let n = (triangles.len() as u64).checked_shl(2 * levels.min(31));
    if levels > 24 || n.is_none_or(|n| n > most || n >> (2 * levels) != triangles.len() as u64) {
        return Err(Error::new(format!(
            "{levels} levels of subdivision of {} triangles are too many; at most {most} \
             triangles may come of it",
            triangles.len()
        )));
    }
    let mut points: Vec<[f64; 3]> = positions.iter().map(|p| p.map(f64::from)).collect();
    let mut triangles = triangles.to_vec();
    for _ in 0..levels {
        let around = neighbours(points.len(), &triangles)?;
        (points, triangles) = refine(&points, &triangles, &around);
    }
    let around = neighbours(points.len(), &triangles)?;
    let limit: Vec<[f64; 3]> =
        (0..points.len()).map(|v| limit_point(v, &points, &around)).collect();
    let normals = (0..limit.len()).map(|v| normal(v, &limit, &around)).collect();
    let mut mesh = TriangleMesh {
        positions: limit.iter().map(|p| p.map(|x| x as f32)).collect(),
        normals,
        triangles,
        ..TriangleMesh::default()
    };
    mesh.drop_degenerate();
    Ok(mesh)
}

/// Walks around each vertex.
fn neighbours(n_vertices: usize, triangles: &[[u32; 3]]) -> Result<Neighbours, Error> {
    // From each vertex: the next vertex around it after each of its neighbours.
    let mut next: Vec<Vec<(u32, u32)>> = vec![Vec::new(); n_vertices];
    for (i, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (v, a, b) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            if v == a || a == b || b == v {
                return Err(Error::new(format!(
                    "triangle {i} of the control mesh has two equal corners"
                )));
            }
            next[v as usize].push((a, b));
        }
    }
    let mut rings = Vec::with_capacity(n_vertices);
    let mut on_boundary = Vec::with_capacity(n_vertices);
    for (v, pairs) in next.iter().enumerate() {
        let follow: HashMap<u32, u32> = pairs.iter().copied().collect();
        let targets: HashMap<u32, u32> = pairs.iter().map(|&(a, b)| (b, a)).collect();
        if follow.len() != pairs.len() || targets.len() != pairs.len() {
            return Err(Error::new(format!(
                "the control mesh is no surface at vertex {v}: an edge there belongs to more than two \
                 triangles, or to two of opposite orientation"
            )));
        }
        // Start where nothing comes before: at a boundary.
        let start = pairs.iter().map(|p| p.0).find(|a| !targets.contains_key(a));
        on_boundary.push(start.is_some());
        let mut ring = Vec::with_capacity(pairs.len() + 1);
        if let Some(first) = start.or_else(|| pairs.first().map(|p| p.0)) {
            ring.push(first);
            let mut at = first;
            while let Some(&b) = follow.get(&at) {
                if b == first {
                    break;
                }
                ring.push(b);
                at = b;
            }
        }
        let expected = pairs.len() + usize::from(start.is_some());
        if ring.len() != expected {
            return Err(Error::new(format!(
                "the control mesh is no surface at vertex {v}: two sheets meet there in one point"
            )));
        }
        rings.push(ring);
    }
    Ok(Neighbours { rings, on_boundary })
}

/// Warren's weight of a neighbour.
fn beta(valence: usize) -> f64 {
    if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * valence as f64) }
}

fn blend(terms: &[(f64, [f64; 3])]) -> [f64; 3] {
    std::array::from_fn(|i| terms.iter().map(|(w, p)| w * p[i]).sum())
}

/// `w` of each neighbour and the rest of the vertex itself.
fn one_ring(v: usize, w: f64, points: &[[f64; 3]], ring: &[u32]) -> [f64; 3] {
    let own = 1.0 - w * ring.len() as f64;
    let around: [f64; 3] =
        std::array::from_fn(|i| ring.iter().map(|&r| points[r as usize][i]).sum::<f64>());
    blend(&[(own, points[v]), (w, around)])
}

/// `w` of the two neighbours along the boundary and the rest of the vertex itself.
fn along_boundary(v: usize, w: f64, points: &[[f64; 3]], ring: &[u32]) -> [f64; 3] {
    let (first, last) = (ring[0] as usize, ring[ring.len() - 1] as usize);
    blend(&[(1.0 - 2.0 * w, points[v]), (w, points[first]), (w, points[last])])
}

/// One level: old vertices move, every edge gets a vertex, every triangle becomes four.
fn refine(
    points: &[[f64; 3]],
    triangles: &[[u32; 3]],
    around: &Neighbours,
) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut moved: Vec<[f64; 3]> = (0..points.len())
        .map(|v| {
            let ring = &around.rings[v];
            if ring.is_empty() {
                points[v]
            } else if around.on_boundary[v] {
                along_boundary(v, 1.0 / 8.0, points, ring)
            } else {
                one_ring(v, beta(ring.len()), points, ring)
            }
        })
        .collect();
    // The two vertices opposite of each edge.
    let mut edges: HashMap<(u32, u32), (u32, Option<u32>)> = HashMap::new();
    let mut order = Vec::new();
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    for t in triangles {
        for k in 0..3 {
            let (a, b, opposite) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            edges.entry(key(a, b)).and_modify(|e| e.1 = Some(opposite)).or_insert_with(|| {
                order.push(key(a, b));
                (opposite, None)
            });
        }
    }
    let mut middles = HashMap::with_capacity(order.len());
    for edge in order {
        let (a, b) = (points[edge.0 as usize], points[edge.1 as usize]);
        let middle = match edges[&edge] {
            (c, Some(d)) => blend(&[
                (3.0 / 8.0, a),
                (3.0 / 8.0, b),
                (1.0 / 8.0, points[c as usize]),
                (1.0 / 8.0, points[d as usize]),
            ]),
            (_, None) => blend(&[(0.5, a), (0.5, b)]),
        };
        middles.insert(edge, moved.len() as u32);
        moved.push(middle);
    }
    let finer = triangles
        .iter()
        .flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middles[&key(a, b)], middles[&key(b, c)], middles[&key(c, a)]);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        })
        .collect();
    (moved, finer)
}

/// Where a vertex comes to lie after endless subdivision.
fn limit_point(v: usize, points: &[[f64; 3]], around: &Neighbours) -> [f64; 3] {
    let ring = &around.rings[v];
    if ring.is_empty() {
        points[v]
    } else if around.on_boundary[v] {
        along_boundary(v, 1.0 / 5.0, points, ring)
    } else {
        one_ring(v, 1.0 / (ring.len() as f64 + 3.0 / (8.0 * beta(ring.len()))), points, ring)
    }
}

/// Normal of the limit surface: the product of two tangents.
fn normal(v: usize, points: &[[f64; 3]], around: &Neighbours) -> [f32; 3] {
    let ring: Vec<[f64; 3]> = around.rings[v].iter().map(|&r| points[r as usize]).collect();
    let n = ring.len();
    let p = points[v];
    let (mut s, mut t) = ([0.0; 3], [0.0; 3]);
    if n < 2 {
        return [0.0, 0.0, 1.0];
    }
    let add = |to: &mut [f64; 3], w: f64, p: [f64; 3]| {
        for i in 0..3 {
            to[i] += w * p[i];
        }
    };
    let pi = std::f64::consts::PI;
    if around.on_boundary[v] {
        add(&mut s, 1.0, ring[n - 1]);
        add(&mut s, -1.0, ring[0]);
        match n {
            2 => {
                add(&mut t, 1.0, ring[0]);
                add(&mut t, 1.0, ring[1]);
                add(&mut t, -2.0, p);
            }
            3 => {
                add(&mut t, 1.0, ring[1]);
                add(&mut t, -1.0, p);
            }
            4 => {
                for (w, q) in [(-1.0, ring[0]), (2.0, ring[1]), (2.0, ring[2]), (-1.0, ring[3])] {
                    add(&mut t, w, q);
                }
                add(&mut t, -2.0, p);
            }
            _ => {
                let theta = pi / (n - 1) as f64;
                let ends = [ring[0], ring[n - 1]];
                ends.iter().for_each(|&q| add(&mut t, libm::sin(theta), q));
                for (k, &q) in ring.iter().enumerate().take(n - 1).skip(1) {
                    let w = (2.0 * libm::cos(theta) - 2.0) * libm::sin(k as f64 * theta);
                    add(&mut t, w, q);
                }
                t = t.map(|x| -x);
            }
        }
        // Both tangents along the boundary and inwards: their product points out of the back.
        return unit(cross(s, t)).map(|x| -x as f32);
    }
    for (k, &q) in ring.iter().enumerate() {
        let angle = 2.0 * pi * k as f64 / n as f64;
        add(&mut s, libm::cos(angle), q);
        add(&mut t, libm::sin(angle), q);
    }
    unit(cross(s, t)).map(|x| x as f32)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { [0.0, 0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use crate::{Error, Limits, TriangleMesh};

    fn loop_subdivide(
        points: &[[f32; 3]],
        triangles: &[[u32; 3]],
        levels: u32,
    ) -> Result<TriangleMesh, Error> {
        super::loop_subdivide(points, triangles, levels, &Limits::default())
    }

    const OCTAHEDRON: ([[f32; 3]; 6], [[u32; 3]; 8]) = (
        [
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ],
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    );

    #[test]
    fn closed_meshes_become_round_and_stay_closed() {
        let (points, triangles) = OCTAHEDRON;
        let mesh = loop_subdivide(&points, &triangles, 4).unwrap();
        assert_eq!(mesh.triangles.len(), 8 * 256);
        // Euler's formula for a sphere.
        let n_edges = mesh.triangles.len() * 3 / 2;
        assert_eq!(mesh.positions.len() + mesh.triangles.len() - n_edges, 2);
        let radius = |p: &[f32; 3]| p.iter().map(|x| x * x).sum::<f32>().sqrt();
        let radii: Vec<f32> = mesh.positions.iter().map(radius).collect();
        let (lo, hi) = radii.iter().fold((9.0_f32, 0.0_f32), |(l, h), &r| (l.min(r), h.max(r)));
        assert!(lo > 0.4 && hi < 0.51 && hi / lo < 1.25, "{lo} {hi}");
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let cos = (0..3).map(|i| p[i] * n[i]).sum::<f32>() / radius(p);
            assert!(cos > 0.9, "{p:?} {n:?}");
        }
        // The limit does not depend on where subdivision stops: a control vertex is where it was.
        let coarse = loop_subdivide(&points, &triangles, 1).unwrap();
        for (a, b) in coarse.positions[..6].iter().zip(&mesh.positions) {
            assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-6), "{a:?} {b:?}");
        }
    }

    #[test]
    fn flat_sheets_stay_flat_and_face_the_same_way() {
        for n in [1_u32, 2, 4] {
            let points: Vec<[f32; 3]> = (0..(n + 1) * (n + 1))
                .map(|i| [(i % (n + 1)) as f32, (i / (n + 1)) as f32, 0.5])
                .collect();
            let triangles: Vec<[u32; 3]> = (0..n * n)
                .flat_map(|i| {
                    let a = i % n + i / n * (n + 1);
                    [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
                })
                .collect();
            for levels in 0..3 {
                let mesh = loop_subdivide(&points, &triangles, levels).unwrap();
                assert!(mesh.positions.iter().all(|p| (p[2] - 0.5).abs() < 1e-6));
                for (p, normal) in mesh.positions.iter().zip(&mesh.normals) {
                    assert!(normal[2] > 0.999, "{n} {levels} {p:?} {normal:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
        for (triangles, words) in [
            (vec![[0, 1, 2], [0, 1, 3]], "opposite orientation"),
            (vec![[0, 1, 2], [1, 0, 3], [1, 0, 4]], "more than two"),
            (vec![[0, 1, 2], [0, 3, 4]], "in one point"),
            (vec![[0, 0, 2]], "equal corners"),
            (vec![[0, 1, 9]], "beyond"),
        ] {
            let error = loop_subdivide(&points, &triangles, 1).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        let error = loop_subdivide(&points, &[[0, 1, 2]], 20).unwrap_err().to_string();
        assert!(error.contains("too many"), "{error}");
        let limits = Limits { max_bytes: 1 << 20 };
        let error =
            super::loop_subdivide(&points, &[[0, 1, 2]], 8, &limits).unwrap_err().to_string();
        assert!(error.contains("at most 4096 triangles"), "{error}");
    }
}
