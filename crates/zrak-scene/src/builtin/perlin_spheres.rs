//! *The Next Week* 5.7, "Adjusting the Phase": marble made of Perlin's noise.

use super::parts::{blue_sky, camera, marble, scene, sphere, texture};
use crate::desc::{MaterialDesc, SceneDesc};

pub(super) fn perlin_spheres() -> SceneDesc {
    let camera = camera([13.0, 2.0, 3.0], [0.0, 0.0, 0.0], 20.0, [400, 225]);
    let mut scene = scene("perlin-spheres", camera, 64, blue_sky());
    scene.textures.insert("marble".to_owned(), marble(4.0));
    scene
        .materials
        .insert("stone".to_owned(), MaterialDesc::Lambertian { color: texture("marble") });
    scene.objects.push(sphere([0.0, -1000.0, 0.0], 1000.0, "stone"));
    scene.objects.push(sphere([0.0, 2.0, 0.0], 2.0, "stone"));
    scene
}
