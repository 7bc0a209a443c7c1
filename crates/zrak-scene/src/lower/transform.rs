//! Affine maps in `f64`.

use crate::desc::{ScaleDesc, TransformStep, Triple};

/// Affine map p' = L p + t, as the rows of (L | t).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Rows of (L | t).
    pub rows: [[f64; 4]; 3],
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// The map of the steps, the first first.
    #[must_use]
    pub fn of_steps(steps: &[TransformStep]) -> Self {
        steps.iter().fold(Self::IDENTITY, |all, step| all.then(&Self::of_step(step)))
    }

    fn of_step(step: &TransformStep) -> Self {
        match *step {
            TransformStep::Translate([x, y, z]) => {
                Self { rows: [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]] }
            }
            TransformStep::Rotate { axis, angle_deg } => rotation(axis, angle_deg),
            TransformStep::RotateXDeg(angle) => rotation([1.0, 0.0, 0.0], angle),
            TransformStep::RotateYDeg(angle) => rotation([0.0, 1.0, 0.0], angle),
            TransformStep::RotateZDeg(angle) => rotation([0.0, 0.0, 1.0], angle),
            TransformStep::Scale(ScaleDesc::Uniform(s)) => scaling([s; 3]),
            TransformStep::Scale(ScaleDesc::PerAxis(s)) => scaling(s),
            TransformStep::Matrix(rows) => Self { rows },
        }
    }

    /// This map, and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let mut rows = [[0.0; 4]; 3];
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x = (0..3).map(|k| next.rows[i][k] * self.rows[k][j]).sum();
            }
            row[3] += next.rows[i][3];
        }
        Self { rows }
    }

    /// Image of a point.
    #[must_use]
    pub fn point(&self, p: Triple) -> Triple {
        let v = self.vector(p);
        [v[0] + self.rows[0][3], v[1] + self.rows[1][3], v[2] + self.rows[2][3]]
    }

    /// Image of a direction.
    #[must_use]
    pub fn vector(&self, v: Triple) -> Triple {
        self.rows.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2])
    }

    /// Transposed linear part applied to a direction: maps normals when `self` is the inverse of the map
    /// of the points.
    #[must_use]
    pub fn transposed_vector(&self, n: Triple) -> Triple {
        let column = |j: usize| (0..3).map(|i| self.rows[i][j] * n[i]).sum();
        [column(0), column(1), column(2)]
    }

    /// Determinant of the linear part: how volumes are scaled, negative for reflections.
    #[must_use]
    pub fn determinant(&self) -> f64 {
        let [a, b, c] = self.rows;
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// The map back; none if the determinant is zero.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let det = self.determinant();
        if det == 0.0 || !det.is_finite() {
            return None;
        }
        let m = &self.rows;
        let cofactor = |r0: usize, c0: usize, r1: usize, c1: usize| {
            m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0]
        };
        let mut rows = [[0.0; 4]; 3];
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().take(3).enumerate() {
                // Entry (i, j) of the inverse is the cofactor (j, i) over the determinant.
                let (r0, r1) = ((j + 1) % 3, (j + 2) % 3);
                let (c0, c1) = ((i + 1) % 3, (i + 2) % 3);
                *x = cofactor(r0, c0, r1, c1) / det;
            }
        }
        let t = Self { rows }.vector([m[0][3], m[1][3], m[2][3]]);
        for (row, t) in rows.iter_mut().zip(t) {
            row[3] = -t;
        }
        Some(Self { rows })
    }

    /// The factor by which all lengths are scaled, if it is one: for turns, moves, reflections and
    /// uniform scales.
    #[must_use]
    pub fn uniform_scale(&self) -> Option<f64> {
        self.uniform_scale_within(1e-14)
    }

    /// The same, with a tolerance relative to the square of the factor.
    pub(super) fn uniform_scale_within(&self, tolerance: f64) -> Option<f64> {
        let column = |j: usize| [self.rows[0][j], self.rows[1][j], self.rows[2][j]];
        let dot = |a: Triple, b: Triple| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let columns = [column(0), column(1), column(2)];
        let s2 = dot(columns[0], columns[0]);
        let close = |x: f64, y: f64| (x - y).abs() <= tolerance * s2;
        let same = close(dot(columns[1], columns[1]), s2) && close(dot(columns[2], columns[2]), s2);
        let orthogonal = close(dot(columns[0], columns[1]), 0.0)
            && close(dot(columns[1], columns[2]), 0.0)
            && close(dot(columns[2], columns[0]), 0.0);
        (same && orthogonal).then(|| s2.sqrt())
    }

    /// Whether axes stay axes with their directions: moves and positive scales along the axes.
    #[must_use]
    pub fn keeps_axes(&self) -> bool {
        self.rows
            .iter()
            .enumerate()
            .all(|(i, row)| (0..3).all(|j| if i == j { row[j] > 0.0 } else { row[j] == 0.0 }))
    }

    /// Rounded to the renderer's precision.
    #[must_use]
    pub fn to_affine(&self) -> zrak_core::math::Affine {
        zrak_core::math::Affine { rows: self.rows.map(|row| row.map(|x| x as f32)) }
    }
}

fn scaling([x, y, z]: Triple) -> Transform {
    Transform { rows: [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]] }
}

/// Rotation by Rodrigues' formula.
fn rotation(axis: Triple, angle_deg: f64) -> Transform {
    let length = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
    let [x, y, z] = axis.map(|a| a / length);
    let angle = angle_deg * (std::f64::consts::PI / 180.0);
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let k = 1.0 - c;
    Transform {
        rows: [
            [c + x * x * k, x * y * k - z * s, x * z * k + y * s, 0.0],
            [y * x * k + z * s, c + y * y * k, y * z * k - x * s, 0.0],
            [z * x * k - y * s, z * y * k + x * s, c + z * z * k, 0.0],
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::Transform;
    use crate::desc::{ScaleDesc, TransformStep};

    #[test]
    fn steps_apply_in_order() {
        let map = Transform::of_steps(&[
            TransformStep::Scale(ScaleDesc::Uniform(2.0)),
            TransformStep::RotateYDeg(90.0),
            TransformStep::Translate([0.0, 0.0, 1.0]),
        ]);
        // x turns to -z about y.
        let p = map.point([1.0, 3.0, 0.0]);
        for (p, expected) in p.into_iter().zip([0.0, 6.0, -1.0]) {
            assert!((p - expected).abs() < 1e-12, "{p} is not {expected}");
        }
    }
}
