//! Textures: the common ones as records of their own, all others as programs.

mod program;
mod raster;

use std::collections::HashMap;

use zrak_core::math::Color;
use zrak_core::scene::{TextureKind, TextureRef};
use zrak_core::textures::{
    CHANNEL_A, CHANNEL_B, CHANNEL_COLOR, CHANNEL_G, CHANNEL_LUMINANCE, CHANNEL_R, Checker,
    ColorInput, FILTER_BILINEAR, FILTER_NEAREST, FILTER_TRILINEAR, ImageMap, ImageTexture,
    NO_MAPPING, Noise, PATTERN_MARBLE, PATTERN_NOISE, PATTERN_TURBULENCE, ScalarInput, WRAP_BLACK,
    WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT,
};

use self::raster::Rasters;
use super::budget::Budget;
use super::{LoadedImage, LowerOptions};
use crate::arena::SceneArrays;
use crate::desc::{
    ColorDesc, ImageChannel, ImageEncoding, ImageFilter, NoisePattern, ScalarDesc, SceneDesc,
    TextureDesc, Triple, WrapMode,
};
use crate::validate::{KeyPath, Problem};

/// What a texture is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Role {
    /// A colour: the codes of 8 and 16-bit images are those of sRGB.
    Color,
    /// A number.
    Scalar,
    /// Three numbers that are no colour.
    Data,
}

/// A colour input, and whether it looks at texture coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoweredInput {
    pub(super) input: ColorInput,
    pub(super) needs_uv: bool,
}

/// Lowers textures when they are first asked for.
///
/// Validation has made sure that all names are known and that no texture is a part of itself.
pub(super) struct Textures<'a> {
    desc: &'a SceneDesc,
    done: HashMap<(&'a str, Role), LoweredInput>,
    rasters: Rasters<'a>,
    problems: Vec<Problem>,
}

fn solid(c: Triple) -> LoweredInput {
    let input = ColorInput { solid: color(c), texture: TextureRef::default() };
    LoweredInput { input, needs_uv: false }
}

fn textured(kind: TextureKind, index: usize, needs_uv: bool) -> LoweredInput {
    let texture = TextureRef::new(kind, index as u32);
    LoweredInput { input: ColorInput { solid: Color::BLACK, texture }, needs_uv }
}

fn color(c: Triple) -> Color {
    Color::from_array(c.map(|x| x as f32))
}

impl<'a> Textures<'a> {
    pub(super) fn new(desc: &'a SceneDesc) -> Self {
        let rasters = Rasters::new(desc);
        Self { desc, done: HashMap::new(), rasters, problems: Vec::new() }
    }

    pub(super) fn color_input(
        &mut self,
        arrays: &mut SceneArrays,
        desc: &'a ColorDesc,
    ) -> LoweredInput {
        match desc {
            ColorDesc::Solid(c) => solid(*c),
            ColorDesc::Texture(name) => self.texture(arrays, name, Role::Color),
        }
    }

    /// A number, and whether it looks at texture coordinates.
    pub(super) fn scalar_input(
        &mut self,
        arrays: &mut SceneArrays,
        desc: &'a ScalarDesc,
    ) -> (ScalarInput, bool) {
        match desc {
            ScalarDesc::Value(x) => (ScalarInput::solid(*x as f32), false),
            ScalarDesc::Texture(name) => {
                let LoweredInput { input, needs_uv } = self.texture(arrays, name, Role::Scalar);
                (ScalarInput { value: input.solid.r, texture: input.texture }, needs_uv)
            }
        }
    }

    /// A texture of normals.
    pub(super) fn normals(&mut self, arrays: &mut SceneArrays, name: &'a str) -> LoweredInput {
        self.texture(arrays, name, Role::Data)
    }

    /// The picture of an environment, as an image map of its own.
    pub(super) fn environment(
        &mut self,
        arrays: &mut SceneArrays,
        path: &'a str,
        filter: u32,
        wrap_u: u32,
    ) -> u32 {
        let id = self.rasters.ask(
            path,
            Role::Color,
            ImageEncoding::Auto,
            KeyPath::default().join("background").join("path"),
        );
        self.rasters.maps.push((id, arrays.image_maps.len()));
        arrays.image_maps.push(ImageMap { filter, wrap_u, wrap_v: WRAP_CLAMP, ..plain_map() });
        arrays.image_maps.len() as u32 - 1
    }

    /// Reads all images that were asked for, and says which are there. To be called at the end.
    pub(super) fn read_images(
        self,
        options: &LowerOptions,
        budget: &Budget,
        arrays: &mut SceneArrays,
        warnings: &mut Vec<Problem>,
    ) -> Result<Vec<LoadedImage>, Vec<Problem>> {
        let mut problems = self.problems;
        let images = self.rasters.read(options, budget, arrays, &mut problems, warnings);
        if problems.is_empty() { Ok(images) } else { Err(problems) }
    }

    fn texture(&mut self, arrays: &mut SceneArrays, name: &'a str, role: Role) -> LoweredInput {
        if let Some(done) = self.done.get(&(name, role)) {
            return *done;
        }
        let desc = &self.desc.textures[name];
        let lowered = match self.common(arrays, name, desc, role) {
            Some(lowered) => lowered,
            None => self.program(arrays, name, role),
        };
        self.done.insert((name, role), lowered);
        lowered
    }

    /// A texture with a record of its own, if it is one.
    fn common(
        &mut self,
        arrays: &mut SceneArrays,
        name: &str,
        desc: &'a TextureDesc,
        role: Role,
    ) -> Option<LoweredInput> {
        match desc {
            TextureDesc::Solid { color } => Some(solid(*color)),
            TextureDesc::Checker { scale, even, odd } => {
                let mut part = |part: &'a ColorDesc| match part {
                    ColorDesc::Solid(c) => solid(*c),
                    ColorDesc::Texture(name) => self.texture(arrays, name, role),
                };
                // The inner ones first: handles lead to earlier checkers only.
                let (even, odd) = (part(even), part(odd));
                let is_program =
                    |part: LoweredInput| part.input.texture.kind() == Some(TextureKind::Program);
                if is_program(even) || is_program(odd) {
                    return None;
                }
                arrays.checkers.push(Checker {
                    even: even.input,
                    odd: odd.input,
                    inv_scale: (1.0 / scale) as f32,
                    _pad: [0; 3],
                });
                let index = arrays.checkers.len() - 1;
                Some(textured(TextureKind::Checker, index, even.needs_uv || odd.needs_uv))
            }
            TextureDesc::Noise { .. } => {
                let index = noise(arrays, desc);
                Some(textured(TextureKind::Noise, index as usize, false))
            }
            TextureDesc::Image { path, filter, .. } if role == Role::Color => {
                if *filter == ImageFilter::Trilinear
                    || *desc != TextureDesc::image(path.clone(), *filter)
                {
                    return None;
                }
                let key = KeyPath::default().join("textures").join(name).join("path");
                let id = self.rasters.ask(path, role, ImageEncoding::Auto, key);
                self.rasters.images.push((id, arrays.images.len()));
                arrays.images.push(ImageTexture {
                    bilinear: u32::from(*filter == ImageFilter::Bilinear),
                    ..bytemuck::Zeroable::zeroed()
                });
                Some(textured(TextureKind::Image, arrays.images.len() - 1, true))
            }
            _ => None,
        }
    }

    /// The image map of an image texture with this mapping; gives its index.
    fn image_map(
        &mut self,
        arrays: &mut SceneArrays,
        name: &str,
        desc: &'a TextureDesc,
        role: Role,
        mapping: u32,
    ) -> u32 {
        let TextureDesc::Image {
            path,
            filter,
            wrap_u,
            wrap_v,
            encoding,
            channel,
            scale,
            invert,
            ..
        } = desc
        else {
            unreachable!("only images have maps")
        };
        // Alpha is a share, whatever colours are; and so that an image is kept once, the codes of colours
        // do for its alpha.
        let role_of_codes = if *channel == ImageChannel::A { Role::Color } else { role };
        let key = KeyPath::default().join("textures").join(name).join("path");
        let id = self.rasters.ask(path, role_of_codes, *encoding, key);
        self.rasters.maps.push((id, arrays.image_maps.len()));
        let wrap = |mode: &WrapMode| match mode {
            WrapMode::Repeat => WRAP_REPEAT,
            WrapMode::Clamp => WRAP_CLAMP,
            WrapMode::Mirror => WRAP_MIRROR,
            WrapMode::Black => WRAP_BLACK,
        };
        arrays.image_maps.push(ImageMap {
            filter: match filter {
                ImageFilter::Nearest => FILTER_NEAREST,
                ImageFilter::Bilinear => FILTER_BILINEAR,
                ImageFilter::Trilinear => FILTER_TRILINEAR,
            },
            wrap_u: wrap(wrap_u),
            wrap_v: wrap(wrap_v),
            channel: match channel {
                ImageChannel::Color if role == Role::Scalar => CHANNEL_LUMINANCE,
                ImageChannel::Color => CHANNEL_COLOR,
                ImageChannel::R => CHANNEL_R,
                ImageChannel::G => CHANNEL_G,
                ImageChannel::B => CHANNEL_B,
                ImageChannel::A => CHANNEL_A,
            },
            mapping,
            scale: *scale as f32,
            invert: u32::from(*invert),
            ..plain_map()
        });
        arrays.image_maps.len() as u32 - 1
    }
}

/// A map of no image yet.
fn plain_map() -> ImageMap {
    ImageMap {
        raster: bytemuck::Zeroable::zeroed(),
        n_levels: 1,
        filter: FILTER_BILINEAR,
        wrap_u: WRAP_REPEAT,
        wrap_v: WRAP_CLAMP,
        channel: CHANNEL_COLOR,
        mapping: NO_MAPPING,
        scale: 1.0,
        invert: 0,
    }
}

/// The record of a noise texture; gives its index.
fn noise(arrays: &mut SceneArrays, desc: &TextureDesc) -> u32 {
    let TextureDesc::Noise { scale, pattern, octaves, seed, low, high } = desc else {
        unreachable!("it is noise")
    };
    arrays.noises.push(Noise {
        low: color(*low),
        scale: *scale as f32,
        high: color(*high),
        pattern: match pattern {
            NoisePattern::Noise => PATTERN_NOISE,
            NoisePattern::Turbulence => PATTERN_TURBULENCE,
            NoisePattern::Marble => PATTERN_MARBLE,
        },
        octaves: *octaves,
        seed: *seed,
        _pad: [0; 2],
    });
    arrays.noises.len() as u32 - 1
}
