//! *The Next Week* 7.3, "Turning Objects into Lights": marble lit by a sphere and a quad.

use super::parts::{camera, darkness, light, marble, quad, scene, sphere, texture};
use crate::desc::{MaterialDesc, SceneDesc};

pub(super) fn simple_light() -> SceneDesc {
    let camera = camera([26.0, 3.0, 6.0], [0.0, 2.0, 0.0], 20.0, [400, 225]);
    let mut scene = scene("simple-light", camera, 200, darkness());
    scene.textures.insert("marble".to_owned(), marble(4.0));
    scene
        .materials
        .insert("stone".to_owned(), MaterialDesc::Lambertian { color: texture("marble") });
    scene.materials.insert("light".to_owned(), light([4.0, 4.0, 4.0]));
    scene.objects = vec![
        sphere([0.0, -1000.0, 0.0], 1000.0, "stone"),
        sphere([0.0, 2.0, 0.0], 2.0, "stone"),
        sphere([0.0, 7.0, 0.0], 2.0, "light"),
        quad([3.0, 1.0, -2.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], "light"),
    ];
    scene
}
