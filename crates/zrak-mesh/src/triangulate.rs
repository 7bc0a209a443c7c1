//! Polygons as triangles.

/// Cuts a polygon into triangles, given the positions of its corners: quads along the diagonal of
/// corners 0 and 2 unless it lies outside of them, others by clipping ears, so that concave ones come out
/// right. Always gives two triangles less than there are corners.
pub(crate) fn triangulate(corners: &[u32], positions: &[[f32; 3]], out: &mut Vec<[u32; 3]>) {
    let position = |i: usize| positions[corners[i] as usize];
    triangulate_by(corners.len(), position, |triangle| out.push(triangle.map(|i| corners[i])));
}

/// [`triangulate`] with the positions of `n` corners by their number; gives numbers of corners.
#[inline]
pub(crate) fn triangulate_by(
    n: usize,
    position: impl Fn(usize) -> [f32; 3],
    mut add: impl FnMut([usize; 3]),
) {
    if n == 4 && is_bent(&[0, 1, 2, 3].map(|i| position(i).map(f64::from))) {
        add([1, 2, 3]);
        add([1, 3, 0]);
        return;
    }
    if n <= 4 || n > MAX_CLIPPED {
        (2..n).for_each(|i| add([0, i - 1, i]));
        return;
    }
    let positions: Vec<[f64; 3]> = (0..n).map(|i| position(i).map(f64::from)).collect();
    clip_ears(&positions, &mut add);
}

/// Whether the two triangles on both sides of the diagonal of corners 0 and 2 lie on each other.
#[inline]
fn is_bent(p: &[[f64; 3]; 4]) -> bool {
    let from_first = |i: usize| [0, 1, 2].map(|axis| p[i][axis] - p[0][axis]);
    let [a, b, c] = [1, 2, 3].map(from_first);
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let (m, n) = (cross(a, b), cross(b, c));
    m[0] * n[0] + m[1] * n[1] + m[2] * n[2] < 0.0
}

fn clip_ears(positions: &[[f64; 3]], add: &mut dyn FnMut([usize; 3])) {
    // Newell's normal of the polygon decides the plane that ears are looked for in.
    let point = |i: usize| positions[i];
    let n = positions.len();
    let mut normal = [0.0_f64; 3];
    for i in 0..n {
        let (a, b) = (point(i), point((i + 1) % n));
        for (axis, sum) in normal.iter_mut().enumerate() {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += (a[j] - b[j]) * (a[k] + b[k]);
        }
    }
    let largest = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
    let (j, k) = ((largest + 1) % 3, (largest + 2) % 3);
    let side = if normal[largest] < 0.0 { -1.0 } else { 1.0 };
    let flat: Vec<[f64; 2]> = (0..n).map(|i| [point(i)[j], point(i)[k] * side]).collect();
    let cross = |a: usize, b: usize, c: usize| {
        let (p, q, r) = (flat[a], flat[b], flat[c]);
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let mut left: Vec<usize> = (0..n).collect();
    while left.len() > 3 {
        let m = left.len();
        let ear = (0..m).find(|&i| {
            let (a, b, c) = (left[(i + m - 1) % m], left[i], left[(i + 1) % m]);
            cross(a, b, c) > 0.0
                && left.iter().all(|&p| {
                    p == a
                        || p == b
                        || p == c
                        || cross(a, b, p) < 0.0
                        || cross(b, c, p) < 0.0
                        || cross(c, a, p) < 0.0
                })
        });
        // One that crosses itself has none; any corner will do.
        let i = ear.unwrap_or(0);
        let (a, b, c) = (left[(i + m - 1) % m], left[i], left[(i + 1) % m]);
        add([a, b, c]);
        left.remove(i);
    }
    add([left[0], left[1], left[2]]);
}

/// Polygons with more corners are fans: clipping takes the cube of their number at worst.
const MAX_CLIPPED: usize = 128;

#[cfg(test)]
mod tests {
    use super::triangulate;

    fn area(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> f32 {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| positions[i as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        triangles.iter().map(area).sum()
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        // Two darts, an arrow head, an L and a star, counter-clockwise; no triangle may be turned over.
        let shapes: [&[[f32; 2]]; 5] = [
            &[[0.0, 0.0], [2.0, -1.0], [1.0, 0.0], [2.0, 1.0]],
            &[[2.0, -1.0], [1.0, 0.0], [2.0, 1.0], [0.0, 0.0]],
            &[[0.0, 0.0], [2.0, -2.0], [0.0, 4.0], [-2.0, -2.0], [-0.5, -0.5]],
            &[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]],
            &[
                [2.0, 0.0],
                [0.5, 0.5],
                [0.0, 2.0],
                [-0.5, 0.5],
                [-2.0, 0.0],
                [-0.5, -0.5],
                [0.0, -2.0],
                [0.5, -0.5],
            ],
        ];
        for shape in shapes {
            let positions: Vec<[f32; 3]> = shape.iter().map(|p| [p[0], p[1], 1.0]).collect();
            let corners: Vec<u32> = (0..shape.len() as u32).collect();
            let mut triangles = Vec::new();
            triangulate(&corners, &positions, &mut triangles);
            assert_eq!(triangles.len(), shape.len() - 2);
            let n = shape.len();
            let exact: f32 = (0..n)
                .map(|i| {
                    let (a, b) = (shape[i], shape[(i + 1) % n]);
                    0.5 * (a[0] * b[1] - a[1] * b[0])
                })
                .sum();
            assert!((area(&positions, &triangles) - exact).abs() < 1e-5);
            assert!(triangles.iter().all(|t| area(&positions, &[*t]) > 0.0), "{triangles:?}");
        }
    }

    #[test]
    fn degenerate_polygons_end() {
        let positions = vec![[0.0; 3]; 10];
        let mut triangles = Vec::new();
        triangulate(&(0..10).collect::<Vec<_>>(), &positions, &mut triangles);
        assert_eq!(triangles.len(), 8);
    }
}
