//! Textures.

use zrak_scene::desc::{
    ColorDesc, FractalPattern, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, NoisePattern,
    ScalarDesc, TextureDesc, WrapMode,
};

use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::{Importer, steps};

/// Name of a texture in the description: numbers and colours have names of their own.
fn name_of(name: &str, is_float: bool) -> String {
    format!("{}:{name}", if is_float { "float" } else { "spectrum" })
}

impl Importer {
    /// Name in the description of a texture that is asked for.
    pub(crate) fn texture_name(&self, name: &str, is_float: bool, at: &Span) -> Result<String> {
        let key = name_of(name, is_float);
        if self.desc.textures.contains_key(&key) {
            return Ok(key);
        }
        let what = if is_float { "float" } else { "spectrum" };
        let fault = Fault::new(at, format!("there is no {what} texture \"{name}\""));
        let prefix = name_of("", is_float);
        let names = self.desc.textures.keys().filter_map(|key| key.strip_prefix(&prefix));
        Err(match zrak_scene::suggest::closest(name, names) {
            Some(near) => fault.help(format!("did you mean \"{near}\"?")),
            None => fault.help("Texture makes one; it must come first"),
        })
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
        if let Some(texture) = params.texture(name)? {
            return Ok(ColorDesc::Texture(self.texture_name(texture, false, &params.span)?));
        }
        if let Some(x) = params.float(name)? {
            return Ok(ColorDesc::Solid([x; 3]));
        }
        Ok(ColorDesc::Solid(self.share_color(params, name)?.unwrap_or([default; 3])))
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
                let fault = Fault::new(at, format!("unknown mapping \"{other}\""));
                return Err(fault.help("there are uv, spherical, cylindrical and planar"));
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
                TextureDesc::Multiply { a: self.input(params, "tex", is_float, 1.0)?, b: scale }
            }
            "mix" => TextureDesc::Mix {
                a: self.input(params, "tex1", is_float, 0.0)?,
                b: self.input(params, "tex2", is_float, 1.0)?,
                amount: self.scalar(params, "amount")?.unwrap_or(ScalarDesc::Value(0.5)),
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
                if params.integer("dimension")? == Some(3) {
                    let key = self.fresh("checker");
                    let checker = TextureDesc::Checker { scale: 1.0, even, odd };
                    self.desc.textures.insert(key.clone(), checker);
                    self.placed(ColorDesc::Texture(key), at)?
                } else {
                    TextureDesc::UvChecker { even, odd, mapping: self.mapping(params, at)? }
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
                    if let ColorDesc::Solid(c) =
                        self.input(params, key, is_float, [0.0, 1.0, 0.0, 1.0][i])?
                    {
                        *corner = c;
                    }
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
            "marble" => {
                // Between two of the greys that pbrt's stone has.
                let octaves = params.integer("octaves")?.unwrap_or(8).clamp(1, 16) as u32;
                let marble = TextureDesc::Noise {
                    scale: params.float("scale")?.unwrap_or(1.0).max(1e-9),
                    pattern: NoisePattern::Marble,
                    octaves,
                    seed: 0,
                    low: [0.2, 0.2, 0.33],
                    high: [0.58, 0.58, 0.6],
                };
                params.ignore(&["variation", "roughness"]);
                let key = self.fresh(kind);
                self.desc.textures.insert(key.clone(), marble);
                self.placed(ColorDesc::Texture(key), at)?
            }
            "ptex" => {
                self.warn(at, "texture \"ptex\" is not read: it is mid grey");
                params.ignore(&["filename", "encoding", "scale"]);
                TextureDesc::Solid { color: [0.5; 3] }
            }
            _ => {
                let fault = Fault::new(at, format!("unknown texture \"{kind}\""));
                return Err(fault.help(
                    "there are constant, scale, mix, directionmix, checkerboard, imagemap, dots, \
                     bilerp, fbm, wrinkled, windy, marble and ptex",
                ));
            }
        };
        self.desc.textures.insert(name_of(name, is_float), texture);
        Ok(())
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
        self.sources.resolve(&path, at)?;
        let wrap = match params.string("wrap")?.unwrap_or("repeat") {
            "repeat" => WrapMode::Repeat,
            "clamp" => WrapMode::Clamp,
            "black" => WrapMode::Black,
            "octahedralsphere" => WrapMode::Clamp,
            other => {
                let fault = Fault::new(at, format!("unknown wrap \"{other}\""));
                return Err(fault.help("there are repeat, clamp and black"));
            }
        };
        let encoding = match params.string("encoding")?.map(str::to_owned) {
            None => ImageEncoding::Auto,
            Some(name) if name == "sRGB" => ImageEncoding::Srgb,
            Some(name) if name == "linear" => ImageEncoding::Linear,
            Some(name) => {
                self.warn(at, format!("encoding \"{name}\" is taken as sRGB"));
                ImageEncoding::Srgb
            }
        };
        // Numbers of 8-bit files are sRGB codes in pbrt, too.
        let encoding = match encoding {
            ImageEncoding::Auto if is_float => ImageEncoding::Srgb,
            other => other,
        };
        let filter = match params.string("filter")?.unwrap_or("bilinear") {
            "point" => ImageFilter::Nearest,
            "bilinear" => ImageFilter::Bilinear,
            "trilinear" => ImageFilter::Trilinear,
            "EWA" | "ewa" => ImageFilter::Trilinear,
            other => {
                let fault = Fault::new(at, format!("unknown filter \"{other}\""));
                return Err(fault.help("there are point, bilinear, trilinear and ewa"));
            }
        };
        params.ignore(&["maxanisotropy"]);
        Ok(TextureDesc::Image {
            path,
            filter,
            wrap_u: wrap,
            wrap_v: wrap,
            encoding,
            channel: ImageChannel::Color,
            scale: params.float("scale")?.unwrap_or(1.0),
            invert: params.bool("invert")?.unwrap_or(false),
            mapping: self.mapping(params, at)?,
        })
    }

    /// A texture of the normals in a file.
    pub(crate) fn normal_map(&mut self, path: &str, at: &Span) -> Result<String> {
        self.sources.resolve(path, at)?;
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
