//! *The Next Week* 8.2 and 9.2: the Cornell box with two boxes in it, and with two boxes of smoke.

use super::parts::{
    camera, darkness, isotropic, lambertian, light, quad, scene, turned_then_moved,
};
use crate::desc::{BoundaryDesc, ObjectDesc, SceneDesc, TransformStep, Triple};

/// The box as in the book, lit by a small light in the ceiling.
pub(super) fn cornell_box() -> SceneDesc {
    let mut scene = empty_room("cornell-box", [15.0, 15.0, 15.0]);
    scene.objects.push(quad(
        [343.0, 554.0, 332.0],
        [-130.0, 0.0, 0.0],
        [0.0, 0.0, -105.0],
        "light",
    ));
    for (max, transform) in tall_and_short() {
        scene.objects.push(ObjectDesc::Box {
            min: [0.0; 3],
            max,
            material: "white".to_owned(),
            transform,
        });
    }
    scene
}

/// The box with a larger, dimmer light and its two boxes made of black and of white smoke.
pub(super) fn cornell_smoke() -> SceneDesc {
    let mut scene = empty_room("cornell-smoke", [7.0, 7.0, 7.0]);
    scene.materials.insert("black_smoke".to_owned(), isotropic([0.0; 3]));
    scene.materials.insert("white_smoke".to_owned(), isotropic([1.0; 3]));
    scene.objects.push(quad([113.0, 554.0, 127.0], [330.0, 0.0, 0.0], [0.0, 0.0, 305.0], "light"));
    for ((max, transform), smoke) in
        tall_and_short().into_iter().zip(["black_smoke", "white_smoke"])
    {
        let boundary = BoundaryDesc::Box { min: [0.0; 3], max, transform: Vec::new() };
        scene.objects.push(ObjectDesc::Medium {
            boundary,
            density: 0.01,
            material: smoke.to_owned(),
            transform,
        });
    }
    scene
}

/// Five walls, the camera and the materials.
fn empty_room(name: &str, radiance: Triple) -> SceneDesc {
    let camera = camera([278.0, 278.0, -800.0], [278.0, 278.0, 0.0], 40.0, [400, 400]);
    let mut scene = scene(name, camera, 200, darkness());
    for (name, material) in [
        ("red", lambertian([0.65, 0.05, 0.05])),
        ("white", lambertian([0.73, 0.73, 0.73])),
        ("green", lambertian([0.12, 0.45, 0.15])),
        ("light", light(radiance)),
    ] {
        scene.materials.insert(name.to_owned(), material);
    }
    scene.objects = vec![
        quad([555.0, 0.0, 0.0], [0.0, 555.0, 0.0], [0.0, 0.0, 555.0], "green"),
        quad([0.0, 0.0, 0.0], [0.0, 555.0, 0.0], [0.0, 0.0, 555.0], "red"),
        quad([0.0, 0.0, 0.0], [555.0, 0.0, 0.0], [0.0, 0.0, 555.0], "white"),
        quad([555.0, 555.0, 555.0], [-555.0, 0.0, 0.0], [0.0, 0.0, -555.0], "white"),
        quad([0.0, 0.0, 555.0], [555.0, 0.0, 0.0], [0.0, 555.0, 0.0], "white"),
    ];
    scene
}

/// Size and place of the two boxes.
fn tall_and_short() -> [(Triple, Vec<TransformStep>); 2] {
    [
        ([165.0, 330.0, 165.0], turned_then_moved(15.0, [265.0, 0.0, 295.0])),
        ([165.0, 165.0, 165.0], turned_then_moved(-18.0, [130.0, 0.0, 65.0])),
    ]
}
