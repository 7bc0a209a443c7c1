//! *The Next Week* 6.5, "2D Primitives": five coloured parallelograms about the view.

use super::parts::{blue_sky, camera, lambertian, quad, scene};
use crate::desc::SceneDesc;

pub(super) fn quads() -> SceneDesc {
    let camera = camera([0.0, 0.0, 9.0], [0.0, 0.0, 0.0], 80.0, [400, 400]);
    let mut scene = scene("quads", camera, 64, blue_sky());
    for (name, color) in [
        ("left_red", [1.0, 0.2, 0.2]),
        ("back_green", [0.2, 1.0, 0.2]),
        ("right_blue", [0.2, 0.2, 1.0]),
        ("upper_orange", [1.0, 0.5, 0.0]),
        ("lower_teal", [0.2, 0.8, 0.8]),
    ] {
        scene.materials.insert(name.to_owned(), lambertian(color));
    }
    scene.objects = vec![
        quad([-3.0, -2.0, 5.0], [0.0, 0.0, -4.0], [0.0, 4.0, 0.0], "left_red"),
        quad([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], "back_green"),
        quad([3.0, -2.0, 1.0], [0.0, 0.0, 4.0], [0.0, 4.0, 0.0], "right_blue"),
        quad([-2.0, 3.0, 1.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0], "upper_orange"),
        quad([-2.0, -3.0, 5.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0], "lower_teal"),
    ];
    scene
}
