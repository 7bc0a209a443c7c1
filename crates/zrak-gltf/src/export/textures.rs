//! Textures: what of them glTF can say.

use std::collections::HashMap;
use std::fs;

use serde_json::{Value, json};
use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageFilter, MappingDesc, ScalarDesc, TextureDesc, Triple, WrapMode,
};

use super::Export;
use crate::textures::{EMBEDDED, extension};

/// How deep textures are looked into, as validation has it.
const NESTING_MAX: usize = 16;

/// A colour as glTF has it: a factor, and perhaps a picture and the colours of vertices.
#[derive(Clone, Debug)]
pub(super) struct Color {
    pub(super) factor: Triple,
    pub(super) picture: Option<Picture>,
    pub(super) has_vertices: bool,
}

impl Color {
    fn solid(factor: Triple) -> Self {
        Self { factor, picture: None, has_vertices: false }
    }
}

/// A picture that is looked up: the JSON of a `textureInfo`, and which channel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) info: Value,
    pub(super) channel: ImageChannel,
}

/// A number as glTF has it.
#[derive(Clone, Debug)]
pub(super) struct Scalar {
    pub(super) factor: f64,
    pub(super) picture: Option<Picture>,
    pub(super) has_vertices: bool,
}

/// The pictures and textures that are written.
#[derive(Default)]
pub(super) struct Textures {
    /// Indices of images by path; none if one cannot be written.
    images: HashMap<String, Option<usize>>,
    /// Indices of textures by image and sampler.
    textures: HashMap<(usize, String), usize>,
    samplers: HashMap<String, usize>,
}

impl Textures {
    pub(super) fn color(&mut self, export: &mut Export<'_>, input: &ColorDesc) -> Color {
        self.color_at(export, input, 0)
    }

    pub(super) fn scalar(&mut self, export: &mut Export<'_>, input: &ScalarDesc) -> Scalar {
        match input {
            ScalarDesc::Value(x) => Scalar { factor: *x, picture: None, has_vertices: false },
            ScalarDesc::Texture(name) => {
                let color = self.named(export, name, 0);
                Scalar {
                    factor: color.factor[0],
                    picture: color.picture,
                    has_vertices: color.has_vertices,
                }
            }
        }
    }

    fn color_at(&mut self, export: &mut Export<'_>, input: &ColorDesc, depth: usize) -> Color {
        match input {
            ColorDesc::Solid(color) => Color::solid(*color),
            ColorDesc::Texture(name) => self.named(export, name, depth),
        }
    }

    fn named(&mut self, export: &mut Export<'_>, name: &str, depth: usize) -> Color {
        let at = format!("textures.{name}");
        let Some(texture) = export.desc.textures.get(name).filter(|_| depth < NESTING_MAX) else {
            export.warnings.note(at, "the texture is not there or nested too deep: it is white");
            return Color::solid([1.0; 3]);
        };
        match texture {
            TextureDesc::Solid { color } => Color::solid(*color),
            TextureDesc::VertexColor { .. } => {
                Color { has_vertices: true, ..Color::solid([1.0; 3]) }
            }
            TextureDesc::Multiply { a, b } => {
                let a = self.color_at(export, a, depth + 1);
                let b = self.color_at(export, b, depth + 1);
                if a.picture.is_some() && b.picture.is_some() {
                    export.warnings.note(at, "of a product of two pictures, only one is written");
                }
                Color {
                    factor: [0, 1, 2].map(|i| a.factor[i] * b.factor[i]),
                    picture: a.picture.or(b.picture),
                    has_vertices: a.has_vertices || b.has_vertices,
                }
            }
            TextureDesc::Image { invert: false, scale, .. } => {
                let picture = self.picture(export, texture, &at);
                Color { factor: [*scale; 3], picture, has_vertices: false }
            }
            _ => {
                export.warnings.note(at, "glTF has no such texture: one colour of it is written");
                Color::solid(self.mean(export, texture, depth))
            }
        }
    }

    /// A colour in the middle of a texture's.
    fn mean(&mut self, export: &mut Export<'_>, texture: &TextureDesc, depth: usize) -> Triple {
        let mut pair = |a: &ColorDesc, b: &ColorDesc, share: f64| {
            let [a, b] = [a, b].map(|input| self.color_at(export, input, depth + 1).factor);
            [0, 1, 2].map(|i| a[i] * (1.0 - share) + b[i] * share)
        };
        match texture {
            TextureDesc::Checker { even: a, odd: b, .. }
            | TextureDesc::UvChecker { even: a, odd: b, .. }
            | TextureDesc::Dots { inside: a, outside: b, .. } => pair(a, b, 0.5),
            TextureDesc::Mix { a, b, amount } => {
                let share = if let ScalarDesc::Value(x) = amount { *x } else { 0.5 };
                pair(a, b, share)
            }
            TextureDesc::Noise { low, high, .. } | TextureDesc::Fractal { low, high, .. } => {
                pair(&ColorDesc::Solid(*low), &ColorDesc::Solid(*high), 0.5)
            }
            TextureDesc::Bilerp { corners, .. } => {
                [0, 1, 2].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / 4.0)
            }
            TextureDesc::Placed { texture, .. } => pair(texture, texture, 0.5),
            _ => [0.5; 3],
        }
    }

    fn picture(
        &mut self,
        export: &mut Export<'_>,
        texture: &TextureDesc,
        at: &str,
    ) -> Option<Picture> {
        let TextureDesc::Image { path, filter, wrap_u, wrap_v, channel, mapping, .. } = texture
        else {
            return None;
        };
        let image = match self.images.get(path) {
            Some(image) => *image,
            None => {
                let image = write_image(export, path, at);
                self.images.insert(path.clone(), image);
                image
            }
        }?;
        let code = |wrap: &WrapMode| match wrap {
            WrapMode::Repeat => 10497,
            WrapMode::Clamp | WrapMode::Black => 33071,
            WrapMode::Mirror => 33648,
        };
        if [wrap_u, wrap_v].contains(&&WrapMode::Black) {
            export.warnings.note(at, "glTF has no black beyond pictures: their rims go on");
        }
        let (mag, min) = match filter {
            ImageFilter::Nearest => (9728, 9728),
            ImageFilter::Bilinear => (9729, 9729),
            ImageFilter::Trilinear => (9729, 9987),
        };
        let sampler = json!({"magFilter": mag, "minFilter": min, "wrapS": code(wrap_u),
                             "wrapT": code(wrap_v)});
        let key = sampler.to_string();
        let sampler = *self
            .samplers
            .entry(key.clone())
            .or_insert_with(|| export.file.push("samplers", sampler));
        let texture = *self.textures.entry((image, key)).or_insert_with(|| {
            export.file.push("textures", json!({"source": image, "sampler": sampler}))
        });
        let mut info = json!({"index": texture});
        match mapping {
            MappingDesc::Uv => {}
            MappingDesc::UvAffine { matrix } => match texture_transform(matrix) {
                Some(transform) => {
                    export.file.uses("KHR_texture_transform");
                    info["extensions"] = json!({"KHR_texture_transform": transform});
                }
                None => export.warnings.note(at, "glTF cannot shear pictures: the map is left out"),
            },
            _ => export.warnings.note(at, "glTF has only the surface's own texture coordinates"),
        }
        Some(Picture { info, channel: *channel })
    }
}

fn write_image(export: &mut Export<'_>, path: &str, at: &str) -> Option<usize> {
    let bytes = match path.strip_prefix(EMBEDDED) {
        Some(name) => match export.assets.get(name) {
            Some(bytes) => bytes.to_vec(),
            None => {
                export.warnings.note(at, format!("there is no picture '{path}'"));
                return None;
            }
        },
        None if path.starts_with("builtin:") => {
            export.warnings.note(at, format!("the picture '{path}' inside zrak is left out"));
            return None;
        }
        None => match fs::read(export.base_dir.join(path)) {
            Ok(bytes) => bytes,
            Err(e) => {
                export.warnings.note(at, format!("cannot read '{path}': {e}: it is left out"));
                return None;
            }
        },
    };
    let media_type = match extension(&bytes) {
        Some("png") => "image/png",
        Some("jpg") => "image/jpeg",
        _ => {
            let message = format!("glTF has only PNG and JPEG pictures: '{path}' is left out");
            export.warnings.note(at, message);
            return None;
        }
    };
    let view = export.file.view(&bytes, None);
    let name = path.strip_prefix(EMBEDDED).unwrap_or(path);
    let name = name.rsplit('/').next().unwrap_or(name);
    let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let image = json!({"bufferView": view, "mimeType": media_type, "name": name});
    Some(export.file.push("images", image))
}

/// The scale, turn and move of a map of texture coordinates with v up, if it is no more.
fn texture_transform(m: &[[f64; 3]; 2]) -> Option<Value> {
    // With v down, as in `textures::mapping`.
    let [[a, b, tx], [d, e, ty]] =
        [[m[0][0], -m[0][1], m[0][1] + m[0][2]], [-m[1][0], m[1][1], 1.0 - m[1][1] - m[1][2]]];
    // Columns (c sx, -s sx) and (s sy, c sy).
    let sx = (a * a + d * d).sqrt();
    let length = (b * b + e * e).sqrt();
    if sx == 0.0 || length == 0.0 || (a * b + d * e).abs() > 1e-9 * sx * length {
        return None;
    }
    let sy = (a * e - b * d) / sx;
    let mut json = json!({"offset": [tx, ty], "scale": [sx, sy]});
    let rotation = libm::atan2(-d, a);
    if rotation != 0.0 {
        json["rotation"] = json!(rotation);
    }
    Some(json)
}
