//! Textures: a colour for every point of a surface or of space.
//!
//! Solid colours, checkers, noise and plain images are looked up at once; all others are parts of a
//! [`Program`].
//!
//! # To add a texture
//! Add an operation to [`program`](Program), unless it is so common that it earns a kind of its own:
//! 1. Write its record and its evaluation in a file of its own here, with tests.
//! 2. Add its array to [`crate::for_each_scene_array!`] and its kind to [`TextureKind`].
//! 3. Add it to the `match` of [`ColorInput::evaluate`] and to `SceneView::kinds_in_use`.
//! 4. On the host: describe it (`zrak-scene`, `desc.rs`), validate it, lower it, and check its handles
//!    (`arena/check.rs`).

mod checker;
mod fractal;
mod image;
mod image_map;
mod mapping;
mod noise;
mod perlin;
mod program;

#[cfg(test)]
mod tests;

pub use checker::Checker;
pub use fractal::{FRACTAL_FBM, FRACTAL_WINDY, FRACTAL_WRINKLED, Fractal};
pub use image::{ImageTexture, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM8, TEXELS_UNORM16};
pub use image_map::{
    CHANNEL_A, CHANNEL_B, CHANNEL_COLOR, CHANNEL_G, CHANNEL_LUMINANCE, CHANNEL_R, FILTER_BILINEAR,
    FILTER_NEAREST, FILTER_TRILINEAR, ImageMap, MAX_LEVELS, NO_MAPPING, WRAP_BLACK, WRAP_CLAMP,
    WRAP_MIRROR, WRAP_REPEAT, words_per_texel,
};
pub use mapping::{
    MAPPING_CYLINDRICAL, MAPPING_PLANAR, MAPPING_SPHERICAL, MAPPING_UV, TextureMapping,
};
pub use noise::{Noise, PATTERN_MARBLE, PATTERN_NOISE, PATTERN_TURBULENCE};
pub use perlin::{perlin, turbulence};
pub use program::{
    N_OPS, N_SLOTS, OP_CHECKER, OP_DOTS, OP_FRACTAL, OP_IMAGE, OP_LERP_U, OP_LERP_V, OP_MIX,
    OP_MULTIPLY, OP_NOISE, OP_SOLID, OP_UV_CHECKER, OP_VERTEX_COLOR, Program, TextureOp,
};

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
    /// Width of the ray's footprint, in world units.
    pub footprint: f32,
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
        Self { p, uv: [0.0; 2], duv: [0.0; 2], footprint: 0.0, color: Color::WHITE, alpha: 1.0 }
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
            evaluate(&arrays, *self, at, scene.kinds.has_texture(TextureKind::Program))
        } else {
            evaluate_inline(&arrays, *self, at, scene.kinds.has_texture(TextureKind::Program))
        }
    }
}

/// What textures are made of.
#[derive(Clone, Copy)]
pub(crate) struct TextureArrays<'a> {
    checkers: Array<'a, Checker>,
    noises: Array<'a, Noise>,
    images: Array<'a, ImageTexture>,
    pub(crate) image_maps: Array<'a, ImageMap>,
    mappings: Array<'a, TextureMapping>,
    fractals: Array<'a, Fractal>,
    programs: Array<'a, Program>,
    texture_ops: Array<'a, TextureOp>,
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
            image_maps: scene.image_maps,
            mappings: scene.mappings,
            fractals: scene.fractals,
            programs: scene.programs,
            texture_ops: scene.texture_ops,
            texels: scene.texels,
            srgb_table: scene.srgb_table,
        }
    }
}

/// [`evaluate_inline`] as a function of its own.
#[inline(never)]
fn evaluate(
    arrays: &TextureArrays,
    input: ColorInput,
    at: &TextureContext,
    has_programs: bool,
) -> Color {
    evaluate_inline(arrays, input, at, has_programs)
}

/// Colour of a texture at a point.
#[inline(always)]
fn evaluate_inline(
    arrays: &TextureArrays,
    input: ColorInput,
    at: &TextureContext,
    has_programs: bool,
) -> Color {
    let mut input = input;
    // Checkers lead to other textures; the host made sure that they do not lead in a circle.
    while let Some(TextureKind::Checker) = input.texture.kind() {
        input = arrays.checkers.get(input.texture.index()).pick(at.p);
    }
    let i = input.texture.index();
    match input.texture.kind() {
        Some(TextureKind::Noise) => arrays.noises.get(i).evaluate(at.p),
        Some(TextureKind::Image) => arrays.images.get(i).evaluate(arrays, at.uv),
        Some(TextureKind::Program) if has_programs => arrays.programs.get(i).evaluate(arrays, at),
        _ => input.solid,
    }
}
