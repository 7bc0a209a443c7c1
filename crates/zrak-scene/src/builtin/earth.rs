//! *The Next Week* 4.6, "Rendering The Image Texture": a globe.

use super::parts::{blue_sky, camera, scene, sphere, texture};
use crate::desc::{ImageFilter, MaterialDesc, SceneDesc, TextureDesc};

pub(super) fn earth() -> SceneDesc {
    let camera = camera([0.0, 0.0, 12.0], [0.0, 0.0, 0.0], 20.0, [400, 225]);
    let mut scene = scene("earth", camera, 64, blue_sky());
    scene.textures.insert("earth".to_owned(), map());
    scene
        .materials
        .insert("surface".to_owned(), MaterialDesc::Lambertian { color: texture("earth") });
    scene.objects.push(sphere([0.0, 0.0, 0.0], 2.0, "surface"));
    scene
}

/// The map of the earth that is embedded in the program.
pub(super) fn map() -> TextureDesc {
    TextureDesc::image("builtin:earth.png", ImageFilter::Bilinear)
}
