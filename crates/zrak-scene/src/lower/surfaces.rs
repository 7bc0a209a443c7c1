//! Textures and materials.

use std::collections::HashMap;

use zrak_core::materials::{
    Dielectric, DiffuseLight, FRESNEL_EXACT, FRESNEL_SCHLICK, Isotropic, Lambertian, Metal,
    SIDES_BOTH, SIDES_FRONT,
};
use zrak_core::math::Color;
use zrak_core::scene::{MaterialKind, MaterialRef, TextureKind, TextureRef};
use zrak_core::textures::{
    Checker, ColorInput, ImageTexture, Noise, PATTERN_MARBLE, PATTERN_NOISE, PATTERN_TURBULENCE,
    TEXELS_LINEAR, TEXELS_SRGB8,
};
use zrak_image::{Texels, TextureImage};

use super::{LowerOptions, assets};
use crate::arena::SceneArrays;
use crate::desc::{
    ColorDesc, FresnelDesc, ImageFilter, LightSides, MaterialDesc, NoisePattern, SceneDesc,
    TextureDesc, Triple,
};
use crate::validate::{KeyPath, Problem};

/// A material, and what shapes must know of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoweredMaterial {
    pub(super) handle: MaterialRef,
    /// Whether it looks at texture coordinates.
    pub(super) needs_uv: bool,
}

/// A colour input, and whether it looks at texture coordinates.
#[derive(Clone, Copy)]
struct LoweredInput {
    input: ColorInput,
    needs_uv: bool,
}

struct Lowering<'a, 'b> {
    desc: &'a SceneDesc,
    options: &'b LowerOptions,
    arrays: &'b mut SceneArrays,
    textures: HashMap<&'a str, LoweredInput>,
    problems: Vec<Problem>,
}

/// Lowers all textures and materials; the latter by name.
pub(super) fn lower<'a>(
    desc: &'a SceneDesc,
    options: &LowerOptions,
    arrays: &mut SceneArrays,
) -> Result<HashMap<&'a str, LoweredMaterial>, Vec<Problem>> {
    let mut lowering =
        Lowering { desc, options, arrays, textures: HashMap::new(), problems: Vec::new() };
    for name in desc.textures.keys() {
        lowering.texture(name);
    }
    let materials =
        desc.materials.iter().map(|(name, m)| (name.as_str(), lowering.material(m))).collect();
    if lowering.problems.is_empty() { Ok(materials) } else { Err(lowering.problems) }
}

fn color(c: Triple) -> Color {
    Color::from_array(c.map(|x| x as f32))
}

fn solid(c: Triple) -> LoweredInput {
    let input = ColorInput { solid: color(c), texture: TextureRef::default() };
    LoweredInput { input, needs_uv: false }
}

fn textured(kind: TextureKind, index: usize, needs_uv: bool) -> LoweredInput {
    let texture = TextureRef::new(kind, index as u32);
    LoweredInput { input: ColorInput { solid: Color::BLACK, texture }, needs_uv }
}

impl<'a> Lowering<'a, '_> {
    fn color_input(&mut self, desc: &'a ColorDesc) -> LoweredInput {
        match desc {
            ColorDesc::Solid(c) => solid(*c),
            ColorDesc::Texture(name) => self.texture(name),
        }
    }

    /// The texture of this name, lowered when it is first asked for. Validation has made sure that
    /// it exists and does not lead to itself.
    fn texture(&mut self, name: &'a str) -> LoweredInput {
        if let Some(done) = self.textures.get(name) {
            return *done;
        }
        let lowered = match &self.desc.textures[name] {
            TextureDesc::Solid { color } => solid(*color),
            TextureDesc::Checker { scale, even, odd } => {
                // The inner ones first: handles lead to earlier checkers only.
                let (even, odd) = (self.color_input(even), self.color_input(odd));
                self.arrays.checkers.push(Checker {
                    even: even.input,
                    odd: odd.input,
                    inv_scale: (1.0 / scale) as f32,
                    _pad: [0; 3],
                });
                let index = self.arrays.checkers.len() - 1;
                textured(TextureKind::Checker, index, even.needs_uv || odd.needs_uv)
            }
            TextureDesc::Noise { scale, pattern, octaves, seed, low, high } => {
                self.arrays.noises.push(Noise {
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
                textured(TextureKind::Noise, self.arrays.noises.len() - 1, false)
            }
            TextureDesc::Image { path, filter, .. } => {
                let (base, limits) = (&self.options.base_dir, &self.options.image_limits);
                match assets::read(path, base, limits) {
                    Ok(image) => self.image(&image, *filter),
                    Err(error) => {
                        let path = KeyPath::default().join("textures").join(name).join("path");
                        let message = error.to_string();
                        self.problems.push(Problem { path, message, help: None });
                        solid([0.0; 3])
                    }
                }
            }
            _ => solid([0.0; 3]),
        };
        self.textures.insert(name, lowered);
        lowered
    }

    fn image(&mut self, image: &TextureImage, filter: ImageFilter) -> LoweredInput {
        if self.arrays.srgb_table.is_empty() {
            self.arrays.srgb_table = zrak_image::srgb8_to_linear_table().to_vec();
        }
        let first_word = self.arrays.texels.len() as u32;
        let format = match &image.texels {
            Texels::Srgb8(texels) => {
                let words = texels.iter().map(|&[r, g, b, _]| u32::from_le_bytes([r, g, b, 255]));
                self.arrays.texels.extend(words);
                TEXELS_SRGB8
            }
            Texels::Linear(texels) => {
                self.arrays.texels.extend(texels.iter().flatten().map(|x| x.to_bits()));
                TEXELS_LINEAR
            }
        };
        self.arrays.images.push(ImageTexture {
            first_word,
            width: image.width,
            height: image.height,
            format,
            bilinear: u32::from(filter == ImageFilter::Bilinear),
            _pad: [0; 3],
        });
        textured(TextureKind::Image, self.arrays.images.len() - 1, true)
    }

    fn material(&mut self, desc: &'a MaterialDesc) -> LoweredMaterial {
        let (kind, index, needs_uv) = match desc {
            MaterialDesc::Lambertian { color } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                self.arrays.lambertians.push(Lambertian { albedo: input });
                (MaterialKind::Lambertian, self.arrays.lambertians.len(), needs_uv)
            }
            MaterialDesc::Metal { color, fuzz } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                let metal = Metal { reflectance: input, fuzz: *fuzz as f32, _pad: [0; 3] };
                self.arrays.metals.push(metal);
                (MaterialKind::Metal, self.arrays.metals.len(), needs_uv)
            }
            MaterialDesc::Dielectric { ior, fresnel } => {
                let fresnel = match fresnel {
                    FresnelDesc::Exact => FRESNEL_EXACT,
                    FresnelDesc::Schlick => FRESNEL_SCHLICK,
                };
                let dielectric = Dielectric { ior: *ior as f32, fresnel, _pad: [0; 2] };
                self.arrays.dielectrics.push(dielectric);
                (MaterialKind::Dielectric, self.arrays.dielectrics.len(), false)
            }
            MaterialDesc::Isotropic { color } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                self.arrays.isotropics.push(Isotropic { albedo: input });
                (MaterialKind::Isotropic, self.arrays.isotropics.len(), needs_uv)
            }
            MaterialDesc::DiffuseLight { color, sides } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                let sides = match sides {
                    LightSides::Both => SIDES_BOTH,
                    LightSides::Front => SIDES_FRONT,
                };
                let light = DiffuseLight { radiance: input, sides, _pad: [0; 3] };
                self.arrays.diffuse_lights.push(light);
                (MaterialKind::DiffuseLight, self.arrays.diffuse_lights.len(), needs_uv)
            }
            _ => (MaterialKind::Lambertian, 1, false),
        };
        LoweredMaterial { handle: MaterialRef::new(kind, index as u32 - 1), needs_uv }
    }
}
