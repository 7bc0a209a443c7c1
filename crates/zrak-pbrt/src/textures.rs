//! Textures.

use zrak_image::Texels;
use zrak_scene::desc::{
    ColorDesc, FractalPattern, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, NoisePattern,
    ScalarDesc, TextureDesc, TransformStep, WrapMode,
};

use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::references::What;
use crate::state::{Importer, steps};

/// The types of textures.
const KINDS: [&str; 13] = [
    "constant",
    "scale",
    "mix",
    "directionmix",
    "bilerp",
    "checkerboard",
    "imagemap",
    "dots",
    "fbm",
    "wrinkled",
    "windy",
    "marble",
    "ptex",
];

/// Name of a texture in the description: numbers and colours have names of their own.
fn name_of(name: &str, is_float: bool) -> String {
    format!("{}:{name}", if is_float { "float" } else { "spectrum" })
}

impl Importer {
    /// Name in the description of a texture that is asked for: an earlier one, if for a texture.
    pub(crate) fn texture_name(&mut self, name: &str, is_float: bool, at: &Span) -> Result<String> {
        let what = if is_float { What::FloatTexture } else { What::SpectrumTexture };
        if self.in_texture {
            self.must_exist(what, name, at)?;
        } else {
            self.refer(what, name, at);
        }
        Ok(name_of(name, is_float))
    }

    /// A colour or a number, by what the texture is made of.
    fn input(
        &mut self,
        params: &Params,
        name: &str,
        is_float: bool,
        default: f64,
    ) -> Result<ColorDesc> {
        if is_float {
            return Ok(match self.scalar(params, name)? {
                Some(ScalarDesc::Texture(texture)) => ColorDesc::Texture(texture),
                Some(ScalarDesc::Value(x)) => ColorDesc::Solid([x; 3]),
                None => ColorDesc::Solid([default; 3]),
            });
        }
        match params.float(name)? {
            Some(x) => Ok(ColorDesc::Solid([x; 3])),
            None => self.color(params, name, [default; 3]),
        }
    }

    fn mapping(&mut self, params: &Params, at: &Span) -> Result<MappingDesc> {
        let Some(texture_from_world) = self.state.ctm.start.inverse() else {
            return Err(Fault::new(at, "the texture's map flattens space"));
        };
        let two = |name: &str, default: f64| -> Result<f64> {
            Ok(params.float(name)?.unwrap_or(default))
        };
        Ok(match params.string("mapping")?.unwrap_or("uv") {
            "uv" => {
                let (su, sv) = (two("uscale", 1.0)?, two("vscale", 1.0)?);
                let (du, dv) = (two("udelta", 0.0)?, two("vdelta", 0.0)?);
                let matrix = [[su, 0.0, du], [0.0, sv, dv]];
                if matrix == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                    MappingDesc::Uv
                } else {
                    MappingDesc::UvAffine { matrix }
                }
            }
            "spherical" => MappingDesc::Spherical { transform: steps(&texture_from_world) },
            "cylindrical" => MappingDesc::Cylindrical { transform: steps(&texture_from_world) },
            "planar" => {
                let v1 = params.triple("v1")?.unwrap_or([1.0, 0.0, 0.0]);
                let v2 = params.triple("v2")?.unwrap_or([0.0, 1.0, 0.0]);
                let deltas = [two("udelta", 0.0)?, two("vdelta", 0.0)?];
                // A product with a vector of the texture's space, as a row for points of the world.
                let row = |v: [f64; 3], delta: f64| -> [f64; 4] {
                    let m = texture_from_world.rows;
                    std::array::from_fn(|j| {
                        let sum: f64 = (0..3).map(|i| v[i] * m[i][j]).sum();
                        if j == 3 { sum + delta } else { sum }
                    })
                };
                MappingDesc::Planar { matrix: [row(v1, deltas[0]), row(v2, deltas[1])] }
            }
            other => {
                let all = ["uv", "spherical", "cylindrical", "planar"];
                return Err(Fault::unknown(&params.span_of("mapping"), "mapping", other, &all));
            }
        })
    }

    pub(crate) fn texture(
        &mut self,
        name: &str,
        is_float: bool,
        kind: &str,
        at: &Span,
        params: &Params,
    ) -> Result<()> {
        let solid = |x: f64| ColorDesc::Solid([x; 3]);
        let texture = match kind {
            "constant" => match self.input(params, "value", is_float, 1.0)? {
                ColorDesc::Solid(color) => TextureDesc::Solid { color },
                other => TextureDesc::Multiply { a: other, b: solid(1.0) },
            },
            "scale" => {
                let scale = match self.scalar(params, "scale")? {
                    Some(ScalarDesc::Texture(texture)) => ColorDesc::Texture(texture),
                    Some(ScalarDesc::Value(x)) => solid(x),
                    None => solid(1.0),
                };
                // What is scaled may be more than 1.
                let solid = if is_float { None } else { self.coefficients(params, "tex")? };
                let a = match solid {
                    Some(color) => ColorDesc::Solid(color),
                    None => self.input(params, "tex", is_float, 1.0)?,
                };
                TextureDesc::Multiply { a, b: scale }
            }
            "mix" => TextureDesc::Mix {
                a: self.input(params, "tex1", is_float, 0.0)?,
                b: self.input(params, "tex2", is_float, 1.0)?,
                amount: self.part(params, "amount")?.unwrap_or(ScalarDesc::Value(0.5)),
            },
            "directionmix" => {
                self.warn(at, "texture \"directionmix\" is an even mix: no direction is looked at");
                params.ignore(&["dir"]);
                TextureDesc::Mix {
                    a: self.input(params, "tex1", is_float, 0.0)?,
                    b: self.input(params, "tex2", is_float, 1.0)?,
                    amount: ScalarDesc::Value(0.5),
                }
            }
            "checkerboard" => {
                let even = self.input(params, "tex1", is_float, 1.0)?;
                let odd = self.input(params, "tex2", is_float, 0.0)?;
                match params.integer("dimension")?.unwrap_or(2) {
                    2 => TextureDesc::UvChecker { even, odd, mapping: self.mapping(params, at)? },
                    3 => {
                        let key = self.fresh("checker");
                        let checker = TextureDesc::Checker { scale: 1.0, even, odd };
                        self.desc.textures.insert(key.clone(), checker);
                        self.placed(ColorDesc::Texture(key), at)?
                    }
                    n => {
                        let message = format!("a checkerboard has 2 or 3 dimensions, not {n}");
                        return Err(Fault::new(&params.span_of("dimension"), message));
                    }
                }
            }
            "dots" => TextureDesc::Dots {
                inside: self.input(params, "inside", is_float, 1.0)?,
                outside: self.input(params, "outside", is_float, 0.0)?,
                mapping: self.mapping(params, at)?,
            },
            "bilerp" => {
                let mut corners = [[0.0; 3]; 4];
                for (i, corner) in corners.iter_mut().enumerate() {
                    let key = ["v00", "v01", "v10", "v11"][i];
                    let default = [0.0, 1.0, 0.0, 1.0][i];
                    *corner = if is_float {
                        [params.float(key)?.unwrap_or(default); 3]
                    } else {
                        self.share(params, key)?.unwrap_or([default; 3])
                    };
                }
                TextureDesc::Bilerp { corners, mapping: self.mapping(params, at)? }
            }
            "imagemap" => self.image(is_float, at, params)?,
            "fbm" | "wrinkled" | "windy" => {
                let octaves = params.integer("octaves")?.unwrap_or(8).clamp(1, 16) as u32;
                let fractal = TextureDesc::Fractal {
                    scale: 1.0,
                    pattern: match kind {
                        "fbm" => FractalPattern::Fbm,
                        "wrinkled" => FractalPattern::Wrinkled,
                        _ => FractalPattern::Windy,
                    },
                    octaves,
                    roughness: params.float("roughness")?.unwrap_or(0.5).clamp(0.0, 1.0),
                    seed: 0,
                    low: [0.0; 3],
                    high: [1.0; 3],
                };
                let key = self.fresh(kind);
                self.desc.textures.insert(key.clone(), fractal);
                self.placed(ColorDesc::Texture(key), at)?
            }
            "marble" => self.marble(params, at)?,
            "ptex" => {
                self.warn(at, "texture \"ptex\" is not read: it is mid grey");
                params.ignore(&["filename", "encoding", "scale"]);
                TextureDesc::Solid { color: [0.5; 3] }
            }
            _ => {
                return Err(Fault::unknown(at, "texture", kind, &KINDS));
            }
        };
        self.desc.textures.insert(name_of(name, is_float), texture);
        Ok(())
    }

    /// Veins, with the colours in the middle and at the rim of pbrt's and along its axis.
    fn marble(&mut self, params: &Params, at: &Span) -> Result<TextureDesc> {
        self.warn(at, "texture \"marble\" has veins of two colours, of another shape than pbrt's");
        let octaves = params.integer("octaves")?.unwrap_or(8).clamp(1, 16) as u32;
        let marble = TextureDesc::Noise {
            scale: params.float("scale")?.unwrap_or(1.0).abs().max(1e-9),
            pattern: NoisePattern::Marble,
            octaves,
            seed: 0,
            low: [0.6, 0.6, 0.65],
            high: [0.87, 0.87, 0.9],
        };
        params.ignore(&["variation", "roughness"]);
        let key = self.fresh("marble");
        self.desc.textures.insert(key.clone(), marble);
        // Theirs run along y, ours along z.
        let map = self.state.ctm.start;
        let mut transform = vec![TransformStep::RotateXDeg(-90.0)];
        transform.extend(steps(&map));
        Ok(TextureDesc::Placed { texture: ColorDesc::Texture(key), transform })
    }

    /// A texture of space, moved to where the map is.
    fn placed(&mut self, texture: ColorDesc, at: &Span) -> Result<TextureDesc> {
        let map = self.state.ctm.start;
        if map.inverse().is_none() {
            return Err(Fault::new(at, "the texture's map flattens space"));
        }
        Ok(TextureDesc::Placed { texture, transform: steps(&map) })
    }

    fn image(&mut self, is_float: bool, at: &Span, params: &Params) -> Result<TextureDesc> {
        let Some(path) = params.string("filename")?.map(str::to_owned) else {
            return Err(Fault::new(at, "an imagemap needs a \"string filename\""));
        };
        let path = self.picture(&path, &params.span_of("filename"))?;
        let wrap = params.string("wrap")?.unwrap_or("repeat").to_owned();
        let wrap = match wrap.as_str() {
            "repeat" => WrapMode::Repeat,
            "clamp" => WrapMode::Clamp,
            "black" => WrapMode::Black,
            "octahedralsphere" => {
                let span = params.span_of("wrap");
                self.warn(&span, "wrap \"octahedralsphere\" is taken as \"clamp\"");
                WrapMode::Clamp
            }
            other => {
                let all = ["repeat", "clamp", "black", "octahedralsphere"];
                return Err(Fault::unknown(&params.span_of("wrap"), "wrap", other, &all));
            }
        };
        let encoding = match params.string("encoding")?.map(str::to_owned) {
            // 8-bit files are sRGB codes for numbers, too.
            None => ImageEncoding::Srgb,
            Some(name) if name == "sRGB" => ImageEncoding::Srgb,
            Some(name) if name == "linear" => ImageEncoding::Linear,
            Some(name) if name.starts_with("gamma ") => {
                let span = params.span_of("encoding");
                self.warn(&span, format!("encoding \"{name}\" is taken as sRGB"));
                ImageEncoding::Srgb
            }
            Some(name) => {
                let span = params.span_of("encoding");
                let all = ["sRGB", "linear", "gamma 2.2"];
                return Err(Fault::unknown(&span, "encoding", &name, &all));
            }
        };
        let filter = match params.string("filter")?.unwrap_or("bilinear") {
            "point" => ImageFilter::Nearest,
            "bilinear" => ImageFilter::Bilinear,
            "trilinear" | "EWA" | "ewa" => ImageFilter::Trilinear,
            other => {
                let all = ["point", "bilinear", "trilinear", "ewa"];
                return Err(Fault::unknown(&params.span_of("filter"), "filter", other, &all));
            }
        };
        params.ignore(&["maxanisotropy"]);
        let scale = params.float("scale")?.unwrap_or(1.0);
        let invert = params.bool("invert")?.unwrap_or(false);
        // A number is the alpha of a picture that has one.
        let has_alpha = is_float && self.has_alpha(&path);
        let image = TextureDesc::Image {
            path,
            filter,
            wrap_u: wrap,
            wrap_v: wrap,
            encoding,
            channel: if has_alpha { ImageChannel::A } else { ImageChannel::Color },
            scale: if invert { 1.0 } else { scale },
            invert,
            mapping: self.mapping(params, at)?,
        };
        if !invert || scale == 1.0 {
            return Ok(image);
        }
        // pbrt inverts what has been scaled: 1 - s x = (1 - s) 1 + s (1 - x).
        if !(0.0..=1.0).contains(&scale) {
            let message =
                format!("a picture times {scale} cannot be inverted; it is taken times 1");
            self.warn(&params.span_of("scale"), message);
            return Ok(image);
        }
        let key = self.fresh("inverted");
        self.desc.textures.insert(key.clone(), image);
        let (a, b) = (ColorDesc::Solid([1.0; 3]), ColorDesc::Texture(key));
        Ok(TextureDesc::Mix { a, b, amount: ScalarDesc::Value(scale) })
    }

    /// Path of a picture, with a warning if there is none: whether that is an error, the caller says.
    pub(crate) fn picture(&mut self, name: &str, at: &Span) -> Result<String> {
        let path = self.sources.resolve(name, at)?;
        if name.is_empty() {
            return Err(Fault::new(at, "the name of the picture is empty"));
        }
        if !self.sources.is_file(&path) {
            self.warn(at, format!("there is no picture {}", path.display()));
        }
        Ok(name.to_owned())
    }

    /// Whether a file is a PNG of which some texel is not opaque.
    fn has_alpha(&self, name: &str) -> bool {
        if !self.sources.has_pictures() {
            return false;
        }
        let path = self.sources.base().join(name);
        let mut head = [0_u8; 26];
        let is_read = std::fs::File::open(&path)
            .and_then(|mut file| std::io::Read::read_exact(&mut file, &mut head))
            .is_ok();
        // The colour type in a PNG header: RGB with alpha.
        if !is_read || !head.starts_with(b"\x89PNG") || head[25] != 6 {
            return false;
        }
        match zrak_image::read_texture(&path, &zrak_image::Limits::default()).map(|i| i.texels) {
            Ok(Texels::Srgb8(texels)) => texels.iter().any(|t| t[3] != u8::MAX),
            Ok(Texels::Srgb16(texels)) => texels.iter().any(|t| t[3] != u16::MAX),
            _ => false,
        }
    }

    /// A texture of the normals in a file.
    pub(crate) fn normal_map(&mut self, path: &str, at: &Span) -> Result<String> {
        let path = self.picture(path, at)?;
        let key = self.fresh("normals");
        let mut texture = TextureDesc::image(path, ImageFilter::Bilinear);
        if let TextureDesc::Image { encoding, wrap_v, .. } = &mut texture {
            *encoding = ImageEncoding::Linear;
            *wrap_v = WrapMode::Repeat;
        }
        self.desc.textures.insert(key.clone(), texture);
        Ok(key)
    }
}
