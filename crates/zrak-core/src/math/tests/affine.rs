//! Affine maps against `f64`.

use crate::math::{Affine, Vec3};
use crate::testing::{D3, Rng, add, double};

fn random(rng: &mut Rng) -> Affine {
    let size = rng.log_range(1e-3, 1e3);
    let shift = if rng.chance(0.2) { 0.0 } else { rng.log_range(1e-3, 1e5) };
    let mut rows = [[0.0; 4]; 3];
    for row in &mut rows {
        for x in &mut row[..3] {
            *x = rng.range(-size, size) as f32;
        }
        row[3] = rng.range(-shift, shift) as f32;
    }
    Affine { rows }
}

fn linear(m: &Affine, v: D3) -> D3 {
    m.rows.map(|r| (0..3).map(|j| f64::from(r[j]) * v[j]).sum())
}

fn shift(m: &Affine) -> D3 {
    m.rows.map(|r| f64::from(r[3]))
}

#[test]
fn points_are_mapped_to_within_the_stated_rounding() {
    let mut rng = Rng::new(1);
    for _ in 0..300_000 {
        let m = random(&mut rng);
        let size = rng.log_range(1e-3, 1e5);
        let p = rng.in_cube(size);
        let image = double(m.point(p));
        let exact = add(linear(&m, double(p)), shift(&m));
        let bound = double(m.point_rounding(p));
        for axis in 0..3 {
            let error = (image[axis] - exact[axis]).abs();
            assert!(error <= bound[axis], "{error:e} > {:e}", bound[axis]);
        }
    }
}

#[test]
fn the_rounding_also_holds_for_a_matrix_that_was_rounded() {
    let mut rng = Rng::new(2);
    for _ in 0..300_000 {
        let exact: [[f64; 4]; 3] =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.range(-100.0, 100.0)));
        let m = Affine { rows: exact.map(|r| r.map(|x| x as f32)) };
        let p = rng.in_cube(10.0);
        let (image, bound, q) = (double(m.point(p)), double(m.point_rounding(p)), double(p));
        for axis in 0..3 {
            let r = exact[axis];
            let error = (image[axis] - (r[0] * q[0] + r[1] * q[1] + r[2] * q[2] + r[3])).abs();
            assert!(error <= bound[axis], "{error:e} > {:e}", bound[axis]);
        }
    }
}

#[test]
fn vectors_ignore_the_shift_and_normals_take_the_transpose() {
    let mut rng = Rng::new(3);
    for _ in 0..100_000 {
        let m = random(&mut rng);
        let v = rng.in_cube(2.0);
        let [image, transposed, abs] =
            [m.vector(v), m.transposed_vector(v), m.abs_vector(v)].map(double);
        let exact = linear(&m, double(v));
        let bound = double(m.point_rounding(v));
        for axis in 0..3 {
            assert!((image[axis] - exact[axis]).abs() <= bound[axis]);
            assert!(abs[axis] >= exact[axis].abs() * (1.0 - 1e-6));
            let column: [f64; 3] = std::array::from_fn(|i| f64::from(m.rows[i][axis]));
            let expected = crate::testing::dot(column, double(v));
            let size: f64 = column.iter().zip(double(v)).map(|(a, b)| (a * b).abs()).sum();
            assert!((transposed[axis] - expected).abs() <= 1e-6 * size);
        }
    }
}

#[test]
fn the_identity_changes_nothing() {
    let mut rng = Rng::new(4);
    for _ in 0..1000 {
        let p: Vec3 = rng.in_cube(1e4);
        let id = Affine::IDENTITY;
        assert_eq!((id.point(p), id.vector(p), id.transposed_vector(p)), (p, p, p));
    }
}
