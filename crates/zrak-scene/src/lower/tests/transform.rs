//! Transforms against closed forms.

use super::super::Transform;
use super::Rng;
use crate::desc::{ScaleDesc, TransformStep, Triple};

fn close(a: Triple, b: Triple) {
    let size = a.iter().chain(&b).fold(1.0, |m: f64, x| m.max(x.abs()));
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-12 * size), "{a:?} is not {b:?}");
}

fn of(steps: &[TransformStep]) -> Transform {
    Transform::of_steps(steps)
}

fn random_step(rng: &mut Rng) -> TransformStep {
    match rng.range(0.0, 7.0) as u32 {
        0 => TransformStep::Translate(rng.triple(10.0)),
        1 => {
            TransformStep::Rotate { axis: rng.triple(3.0), angle_deg: rng.range(-400.0, 400.0) }
        }
        2 => TransformStep::RotateXDeg(rng.range(-400.0, 400.0)),
        3 => TransformStep::RotateYDeg(rng.range(-400.0, 400.0)),
        4 => TransformStep::RotateZDeg(rng.range(-400.0, 400.0)),
        5 => TransformStep::Scale(ScaleDesc::PerAxis([
            rng.range(0.5, 2.0),
            rng.range(-2.0, -0.5),
            rng.range(0.5, 2.0),
        ])),
        _ => TransformStep::Matrix([
            [1.0, rng.range(-0.3, 0.3), 0.1, 5.0],
            [0.2, 1.0, rng.range(-0.3, 0.3), -1.0],
            [rng.range(-0.3, 0.3), 0.1, 1.0, 0.0],
        ]),
    }
}

#[test]
fn rotations_turn_counter_clockwise_seen_from_the_tip() {
    let quarter = |step: TransformStep, p: Triple, q: Triple| close(of(&[step]).point(p), q);
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    quarter(TransformStep::RotateXDeg(90.0), y, z);
    quarter(TransformStep::RotateYDeg(90.0), z, x);
    quarter(TransformStep::RotateZDeg(90.0), x, y);
    quarter(TransformStep::Rotate { axis: [5.0, 5.0, 5.0], angle_deg: 120.0 }, x, y);
    let mut rng = Rng(1);
    for _ in 0..1000 {
        let angle = rng.range(-720.0, 720.0);
        let (s, c) = angle.to_radians().sin_cos();
        let p = rng.triple(3.0);
        close(
            of(&[TransformStep::RotateYDeg(angle)]).point(p),
            [c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]],
        );
        let axis = rng.triple(1.0);
        let turn = of(&[TransformStep::Rotate { axis, angle_deg: angle }]);
        // The axis stays, lengths stay, and turning by the same again is turning by twice as much.
        close(turn.vector(axis), axis);
        assert!((turn.determinant() - 1.0).abs() < 1e-12);
        assert!((turn.uniform_scale().unwrap() - 1.0).abs() < 1e-12);
        let twice = of(&[TransformStep::Rotate { axis, angle_deg: 2.0 * angle }]);
        close(turn.point(turn.point(p)), twice.point(p));
    }
}

#[test]
fn steps_apply_in_order() {
    let steps = [
        TransformStep::Scale(ScaleDesc::Uniform(2.0)),
        TransformStep::RotateZDeg(90.0),
        TransformStep::Translate([10.0, 0.0, 0.0]),
    ];
    close(of(&steps).point([1.0, 0.0, 0.0]), [10.0, 2.0, 0.0]);
    close(of(&steps).vector([1.0, 0.0, 0.0]), [0.0, 2.0, 0.0]);
    let mut rng = Rng(2);
    for _ in 0..1000 {
        let steps: Vec<_> = (0..5).map(|_| random_step(&mut rng)).collect();
        let p = rng.triple(3.0);
        let one_by_one = steps.iter().fold(p, |p, step| of(&[*step]).point(p));
        close(of(&steps).point(p), one_by_one);
        let (a, b) = steps.split_at(2);
        close(of(a).then(&of(b)).point(p), one_by_one);
    }
}

#[test]
fn inverses_lead_back() {
    let mut rng = Rng(3);
    for _ in 0..1000 {
        let steps: Vec<_> = (0..4).map(|_| random_step(&mut rng)).collect();
        let map = of(&steps);
        let back = map.inverse().unwrap();
        let p = rng.triple(3.0);
        let there_and_back = back.point(map.point(p));
        assert!((0..3).all(|i| (there_and_back[i] - p[i]).abs() < 1e-10), "{p:?}");
        assert!((map.determinant() * back.determinant() - 1.0).abs() < 1e-9);
    }
    let flat = of(&[TransformStep::Matrix([[1.0, 0.0, 0.0, 0.0]; 3])]);
    assert_eq!(flat.inverse(), None);
}

#[test]
fn similarities_and_axis_maps_are_recognised() {
    let turn = TransformStep::RotateXDeg(30.0);
    let double = TransformStep::Scale(ScaleDesc::Uniform(2.0));
    let mirror = TransformStep::Scale(ScaleDesc::PerAxis([-2.0, 2.0, 2.0]));
    let stretch = TransformStep::Scale(ScaleDesc::PerAxis([1.0, 2.0, 3.0]));
    let shift = TransformStep::Translate([1.0, 2.0, 3.0]);
    let scale = |steps: &[TransformStep]| of(steps).uniform_scale();
    assert_eq!(scale(&[]), Some(1.0));
    assert_eq!(scale(&[shift, double]), Some(2.0));
    assert!((scale(&[turn, double, turn]).unwrap() - 2.0).abs() < 1e-14);
    assert_eq!(scale(&[mirror]), Some(2.0));
    assert_eq!(scale(&[stretch]), None);
    assert_eq!(scale(&[turn, stretch]), None);
    let keeps = |steps: &[TransformStep]| of(steps).keeps_axes();
    assert!(keeps(&[]) && keeps(&[shift, stretch, double]));
    assert!(!keeps(&[turn]) && !keeps(&[mirror]));
    // Turns out of the axes and back are not exact, and so not plain.
    assert!(!keeps(&[TransformStep::RotateYDeg(90.0)]));
}
