//! Textures: a colour for every point of a surface or of space.
//!
//! # To add a texture
//! 1. Write its record and its evaluation in a file of its own here, with tests.
//! 2. Add its array to [`crate::for_each_scene_array!`] and its kind to [`TextureKind`].
//! 3. Add it to the `match` of [`ColorInput::evaluate`] and to `SceneView::kinds_in_use`.
//! 4. On the host: describe it (`zrak-scene`, `desc.rs`), validate it, lower it, and check its handles
//!    (`arena/check.rs`).

mod checker;
mod image;
mod noise;
mod perlin;

#[cfg(test)]
mod tests;

pub use checker::Checker;
pub use image::{ImageTexture, TEXELS_LINEAR, TEXELS_SRGB8};
pub use noise::{Noise, PATTERN_MARBLE, PATTERN_NOISE, PATTERN_TURBULENCE};
pub use perlin::{perlin, turbulence};

use bytemuck::{Pod, Zeroable};

use crate::math::{Color, Vec3};
use crate::scene::{SceneView, TextureKind, TextureRef};

/// A colour that may vary: solid, or a texture.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct ColorInput {
    /// The colour, if the texture is [`TextureKind::Solid`].
    pub solid: Color,
    /// The texture.
    pub texture: TextureRef,
}

const _: () = assert!(size_of::<ColorInput>() == 16);

impl ColorInput {
    /// As [`ColorInput::evaluate`], for what must not be more than all of the light: an image with
    /// larger values does not make surfaces that shine.
    #[inline(always)]
    #[must_use]
    pub fn evaluate_share(&self, scene: &SceneView, p: Vec3, uv: [f32; 2]) -> Color {
        self.evaluate(scene, p, uv).to_share()
    }

    /// Colour at the world-space point `p` with texture coordinates `uv`.
    #[inline(always)]
    #[must_use]
    pub fn evaluate(&self, scene: &SceneView, p: Vec3, uv: [f32; 2]) -> Color {
        let mut input = *self;
        let has = |kind| scene.kinds.has_texture(kind);
        // Checkers lead to other textures; the host made sure that they do not lead in a circle.
        loop {
            let i = input.texture.index();
            match input.texture.kind() {
                Some(kind @ TextureKind::Checker) if has(kind) => {
                    input = scene.checkers.get(i).pick(p)
                }
                Some(kind @ TextureKind::Noise) if has(kind) => {
                    return scene.noises.get(i).evaluate(p);
                }
                Some(kind @ TextureKind::Image) if has(kind) => {
                    return scene.images.get(i).evaluate(scene, uv);
                }
                _ => return input.solid,
            }
        }
    }
}
