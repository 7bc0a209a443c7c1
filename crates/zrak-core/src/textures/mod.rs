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

use crate::accessor::Array;
use crate::math::{Color, Vec3};
use crate::scene::{Feature, SceneView, TextureKind, TextureRef};

/// What textures look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureContext {
    /// The point, in world space.
    pub p: Vec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// How much u and v change over the ray's footprint.
    pub duv: [f32; 2],
    /// Colour of the mesh's vertices.
    pub color: Color,
    /// Alpha of the mesh's vertices.
    pub alpha: f32,
}

impl TextureContext {
    /// A point in space that is on no surface.
    #[inline(always)]
    #[must_use]
    pub const fn in_space(p: Vec3) -> Self {
        Self { p, uv: [0.0; 2], duv: [0.0; 2], color: Color::WHITE, alpha: 1.0 }
    }
}

/// A number that may vary: solid, or the red channel of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ScalarInput {
    /// The number, if the texture is [`TextureKind::Solid`].
    pub value: f32,
    /// The texture.
    pub texture: TextureRef,
}

const _: () = assert!(size_of::<ScalarInput>() == 8);

impl ScalarInput {
    /// The same number everywhere.
    #[must_use]
    pub const fn solid(value: f32) -> Self {
        Self { value, texture: TextureRef(0) }
    }

    /// Number at a point.
    #[inline(always)]
    #[must_use]
    pub fn evaluate(&self, scene: &SceneView, at: &TextureContext) -> f32 {
        if self.texture.0 == 0 {
            return self.value;
        }
        let solid = Color::grey(self.value);
        ColorInput { solid, texture: self.texture }.evaluate(scene, at).r
    }
}

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
    pub fn evaluate_share(&self, scene: &SceneView, at: &TextureContext) -> Color {
        self.evaluate(scene, at).to_share()
    }

    /// Colour at a point.
    #[inline(always)]
    #[must_use]
    pub fn evaluate(&self, scene: &SceneView, at: &TextureContext) -> Color {
        const SOLID: u32 = 1 << TextureKind::Solid as u32;
        if scene.kinds.textures == SOLID || self.texture.0 == 0 {
            return self.solid;
        }
        let arrays = TextureArrays::of(scene);
        if scene.kinds.has_feature(Feature::TextureCalls) {
            evaluate(&arrays, *self, at)
        } else {
            evaluate_inline(&arrays, *self, at)
        }
    }
}

/// What textures are made of.
#[derive(Clone, Copy)]
pub(crate) struct TextureArrays<'a> {
    checkers: Array<'a, Checker>,
    noises: Array<'a, Noise>,
    images: Array<'a, ImageTexture>,
    pub(crate) texels: Array<'a, u32>,
    pub(crate) srgb_table: Array<'a, f32>,
}

impl<'a> TextureArrays<'a> {
    #[inline(always)]
    pub(crate) fn of(scene: &SceneView<'a>) -> Self {
        Self {
            checkers: scene.checkers,
            noises: scene.noises,
            images: scene.images,
            texels: scene.texels,
            srgb_table: scene.srgb_table,
        }
    }
}

/// [`evaluate_inline`] as a function of its own.
#[inline(never)]
fn evaluate(arrays: &TextureArrays, input: ColorInput, at: &TextureContext) -> Color {
    evaluate_inline(arrays, input, at)
}

/// Colour of a texture at a point.
#[inline(always)]
fn evaluate_inline(arrays: &TextureArrays, input: ColorInput, at: &TextureContext) -> Color {
    let mut input = input;
    // Checkers lead to other textures; the host made sure that they do not lead in a circle.
    while let Some(TextureKind::Checker) = input.texture.kind() {
        input = arrays.checkers.get(input.texture.index()).pick(at.p);
    }
    let i = input.texture.index();
    match input.texture.kind() {
        Some(TextureKind::Noise) => arrays.noises.get(i).evaluate(at.p),
        Some(TextureKind::Image) => arrays.images.get(i).evaluate(arrays, at.uv),
        _ => input.solid,
    }
}
