//! *The Next Week* 4.3, "Rendering The Solid Checker Texture": two spheres that touch.

use super::parts::{blue_sky, camera, green_checker, scene, sphere, texture};
use crate::desc::{MaterialDesc, SceneDesc};

pub(super) fn checkered_spheres() -> SceneDesc {
    let camera = camera([13.0, 2.0, 3.0], [0.0, 0.0, 0.0], 20.0, [400, 225]);
    let mut scene = scene("checkered-spheres", camera, 64, blue_sky());
    scene.textures.insert("checker".to_owned(), green_checker());
    scene
        .materials
        .insert("checkered".to_owned(), MaterialDesc::Lambertian { color: texture("checker") });
    scene.objects.push(sphere([0.0, -10.0, 0.0], 10.0, "checkered"));
    scene.objects.push(sphere([0.0, 10.0, 0.0], 10.0, "checkered"));
    scene
}
