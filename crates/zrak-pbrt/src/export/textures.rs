//! Textures. pbrt has those of colours and those of numbers, so one that is used as both is written twice.

use std::fmt::Write;

use zrak_scene::desc::{
    ColorDesc, FractalPattern, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, NoisePattern,
    ScalarDesc, ScaleDesc, TextureDesc, TransformStep, WrapMode,
};
use zrak_scene::error::SceneError;
use zrak_scene::lower::Transform;

use super::Writer;
use super::text::{param, quoted, transform, word};

type Result<T> = std::result::Result<T, SceneError>;

/// A texture's parameters, and the map that it stands under.
struct Parts {
    class: &'static str,
    params: String,
    map: Transform,
}

impl Writer<'_, '_> {
    /// A parameter that is a colour.
    pub(super) fn color(&mut self, key: &str, color: &ColorDesc) -> Result<String> {
        self.input(key, color, false, &Transform::IDENTITY)
    }

    /// A parameter that is a number.
    pub(super) fn scalar(&mut self, key: &str, scalar: &ScalarDesc) -> Result<String> {
        self.scalar_under(key, scalar, &Transform::IDENTITY)
    }

    fn scalar_under(&mut self, key: &str, scalar: &ScalarDesc, map: &Transform) -> Result<String> {
        Ok(match scalar {
            ScalarDesc::Value(x) => param("float", key, [*x]),
            ScalarDesc::Texture(name) => word("texture", key, &self.texture(name, true, map)?),
        })
    }

    fn input(
        &mut self,
        key: &str,
        color: &ColorDesc,
        is_float: bool,
        map: &Transform,
    ) -> Result<String> {
        Ok(match color {
            ColorDesc::Solid(color) if is_float => param("float", key, [color[0]]),
            ColorDesc::Solid(color) => param("rgb", key, *color),
            ColorDesc::Texture(name) => word("texture", key, &self.texture(name, is_float, map)?),
        })
    }

    fn both(
        &mut self,
        a: (&str, &ColorDesc),
        b: (&str, &ColorDesc),
        is_float: bool,
        map: &Transform,
    ) -> Result<String> {
        Ok(self.input(a.0, a.1, is_float, map)? + &self.input(b.0, b.1, is_float, map)?)
    }

    /// Name of a texture that is written as one of colours or of numbers, moved by `map`.
    pub(super) fn texture(
        &mut self,
        name: &str,
        is_float: bool,
        map: &Transform,
    ) -> Result<String> {
        let key = format!("{name}|{is_float}|{:?}", map.rows);
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let Some(texture) = self.desc.textures.get(name) else { return Ok(name.to_owned()) };
        let parts = self.parts(name, texture, is_float, map)?;
        let written = self.define(name, is_float, &parts);
        self.textures.insert(key, written.clone());
        Ok(written)
    }

    fn define(&mut self, wanted: &str, is_float: bool, parts: &Parts) -> String {
        let value = if is_float { "float" } else { "spectrum" };
        let name = self.unique_name(value, wanted);
        let Parts { class, params, map } = parts;
        let line = format!("Texture {} \"{value}\" \"{class}\"{params}\n", quoted(&name));
        if *map == Transform::IDENTITY {
            self.out += &line;
        } else {
            let _ = write!(self.out, "AttributeBegin\n{}{line}AttributeEnd\n", transform(map));
        }
        name
    }

    fn parts(
        &mut self,
        name: &str,
        texture: &TextureDesc,
        is_float: bool,
        map: &Transform,
    ) -> Result<Parts> {
        let flat = |class, params| Parts { class, params, map: Transform::IDENTITY };
        Ok(match texture {
            TextureDesc::Solid { color } => {
                flat("constant", self.input("value", &(*color).into(), is_float, map)?)
            }
            TextureDesc::Checker { scale, even, odd } => {
                let params = self.both(("tex1", even), ("tex2", odd), is_float, map)?;
                let cube = TransformStep::Scale(ScaleDesc::Uniform(*scale));
                let map = Transform::of_steps(&[cube]).then(map);
                Parts {
                    class: "checkerboard",
                    params: params + &param("integer", "dimension", [3]),
                    map,
                }
            }
            TextureDesc::UvChecker { even, odd, mapping } => {
                let params = self.both(("tex1", even), ("tex2", odd), is_float, map)?;
                self.mapped("checkerboard", params, mapping, map)
            }
            TextureDesc::Dots { inside, outside, mapping } => {
                self.warn("dots, noise and marble have the same look in pbrt, in another pattern");
                let params = self.both(("inside", inside), ("outside", outside), is_float, map)?;
                self.mapped("dots", params, mapping, map)
            }
            TextureDesc::Bilerp { corners, mapping } => {
                let mut params = String::new();
                for (key, corner) in ["v00", "v01", "v10", "v11"].iter().zip(corners) {
                    params += &self.input(key, &(*corner).into(), is_float, map)?;
                }
                self.mapped("bilerp", params, mapping, map)
            }
            TextureDesc::Mix { a, b, amount } => {
                let params = self.both(("tex1", a), ("tex2", b), is_float, map)?;
                flat("mix", params + &self.scalar_under("amount", amount, map)?)
            }
            TextureDesc::Multiply { a, b } => {
                let is_one =
                    |c: &ColorDesc| matches!(c, ColorDesc::Solid([r, g, b]) if r == g && g == b);
                let (tex, scale) = if is_one(a) && !is_one(b) { (b, a) } else { (a, b) };
                if !is_float && !is_one(scale) && !self.is_number(scale) {
                    self.warn(
                        "of products of two colours pbrt's has the red of the second for all three",
                    );
                }
                let tex = self.input("tex", tex, is_float, map)?;
                flat("scale", tex + &self.input("scale", scale, true, map)?)
            }
            TextureDesc::Placed { texture, transform } => {
                let map = Transform::of_steps(transform).then(map);
                let ColorDesc::Texture(inner) = texture else {
                    return Ok(flat("constant", self.input("value", texture, is_float, &map)?));
                };
                let Some(texture) = self.desc.textures.get(inner) else {
                    return Ok(flat("constant", String::new()));
                };
                self.parts(name, texture, is_float, &map)?
            }
            TextureDesc::Fractal { scale, pattern, octaves, roughness, seed, low, high } => {
                if *seed != 0 {
                    self.warn("the seeds of noise are not written");
                }
                let class = match pattern {
                    FractalPattern::Fbm => "fbm",
                    FractalPattern::Wrinkled => "wrinkled",
                    FractalPattern::Windy => "windy",
                };
                let params = param("integer", "octaves", [*octaves])
                    + &param("float", "roughness", [*roughness]);
                let params = if *pattern == FractalPattern::Windy { String::new() } else { params };
                self.warn("dots, noise and marble have the same look in pbrt, in another pattern");
                let noise = Parts { class, params, map: cells(*scale, map) };
                if is_float && (low[0], high[0]) == (0.0, 1.0) {
                    return Ok(noise);
                }
                let amount = self.define(&format!("{name}-noise"), true, &noise);
                let ends = self.input("tex1", &(*low).into(), is_float, map)?
                    + &self.input("tex2", &(*high).into(), is_float, map)?;
                flat("mix", ends + &word("texture", "amount", &amount))
            }
            TextureDesc::Noise { scale, pattern, octaves, seed, low, high } => {
                if *seed != 0 {
                    self.warn("the seeds of noise are not written");
                }
                self.warn("dots, noise and marble have the same look in pbrt, in another pattern");
                let (class, params) = match pattern {
                    NoisePattern::Marble if !is_float => {
                        self.warn("marble has the colours of pbrt's");
                        let params = param("integer", "octaves", [*octaves])
                            + &param("float", "scale", [*scale]);
                        // Ours runs along z, theirs along y.
                        let turn = Transform::of_steps(&[TransformStep::RotateXDeg(90.0)]);
                        return Ok(Parts { class: "marble", params, map: turn.then(map) });
                    }
                    NoisePattern::Noise => ("fbm", param("integer", "octaves", [1])),
                    NoisePattern::Turbulence | NoisePattern::Marble => (
                        "wrinkled",
                        param("integer", "octaves", [*octaves])
                            + &param("float", "roughness", [0.5]),
                    ),
                };
                let noise = Parts { class, params, map: cells(*scale, map) };
                let mut amount = self.define(&format!("{name}-noise"), true, &noise);
                if *pattern == NoisePattern::Noise {
                    // From -1 to 1: its half from the middle.
                    let params = param("float", "tex1", [0.5])
                        + &param("float", "tex2", [1.0])
                        + &word("texture", "amount", &amount);
                    amount = self.define(&format!("{name}-amount"), true, &flat("mix", params));
                }
                let ends = self.input("tex1", &(*low).into(), is_float, map)?
                    + &self.input("tex2", &(*high).into(), is_float, map)?;
                flat("mix", ends + &word("texture", "amount", &amount))
            }
            TextureDesc::VertexColor { .. } => {
                self.warn("colours of vertices are not written: they are white");
                flat("constant", self.input("value", &[1.0; 3].into(), is_float, map)?)
            }
            TextureDesc::Image { .. } => self.image(name, texture, is_float, map)?,
        })
    }

    /// Whether a texture comes from a pbrt file's textures of numbers.
    fn is_number(&self, color: &ColorDesc) -> bool {
        matches!(color, ColorDesc::Texture(name) if name.starts_with("float:"))
    }

    fn image(
        &mut self,
        name: &str,
        texture: &TextureDesc,
        is_float: bool,
        map: &Transform,
    ) -> Result<Parts> {
        let TextureDesc::Image {
            path,
            filter,
            wrap_u,
            wrap_v,
            encoding,
            channel,
            scale,
            invert,
            mapping,
        } = texture
        else {
            return Ok(Parts { class: "constant", params: String::new(), map: *map });
        };
        let is_srgb = match encoding {
            ImageEncoding::Auto => !is_float,
            ImageEncoding::Srgb => true,
            ImageEncoding::Linear => false,
        };
        let (file, is_own) = self.of_channel(path, *channel, is_srgb, is_float)?;
        let mut params = word("string", "filename", &file);
        if !is_own {
            // Alpha is never a code, and pbrt takes it for one.
            let is_srgb = is_srgb && *channel != ImageChannel::A;
            params += &word("string", "encoding", if is_srgb { "sRGB" } else { "linear" });
        }
        params += &word(
            "string",
            "filter",
            match filter {
                ImageFilter::Nearest => "point",
                ImageFilter::Bilinear => "bilinear",
                ImageFilter::Trilinear => "trilinear",
            },
        );
        if wrap_u != wrap_v {
            self.warn("pictures go on across as they go on down in pbrt, as they do across here");
        }
        params += &word(
            "string",
            "wrap",
            match wrap_u {
                WrapMode::Repeat => "repeat",
                WrapMode::Clamp => "clamp",
                WrapMode::Black => "black",
                WrapMode::Mirror => {
                    self.warn("pictures are repeated as they are in pbrt, not mirrored");
                    "repeat"
                }
            },
        );
        if *invert {
            params += " \"bool invert\" true";
        }
        if *scale == 1.0 {
            return Ok(self.mapped("imagemap", params, mapping, map));
        }
        if !invert {
            params += &param("float", "scale", [*scale]);
            return Ok(self.mapped("imagemap", params, mapping, map));
        }
        // pbrt inverts what has been scaled.
        let inner = self.mapped("imagemap", params, mapping, map);
        let inner = self.define(&format!("{name}-picture"), is_float, &inner);
        let params = word("texture", "tex", &inner) + &param("float", "scale", [*scale]);
        Ok(Parts { class: "scale", params, map: Transform::IDENTITY })
    }

    /// A texture of a surface's coordinates, with where points fall.
    fn mapped(
        &mut self,
        class: &'static str,
        params: String,
        mapping: &MappingDesc,
        map: &Transform,
    ) -> Parts {
        let mut parts = Parts { class, params, map: Transform::IDENTITY };
        match mapping {
            MappingDesc::Uv => {}
            MappingDesc::UvAffine { matrix: [[su, shear_u, du], [shear_v, sv, dv]] } => {
                if *shear_u != 0.0 || *shear_v != 0.0 {
                    self.warn("pictures cannot be turned in pbrt: they are scaled and moved");
                }
                for (key, x) in [("uscale", su), ("vscale", sv), ("udelta", du), ("vdelta", dv)] {
                    parts.params += &param("float", key, [*x]);
                }
            }
            MappingDesc::Planar { matrix: [u, v] } => {
                parts.params += &word("string", "mapping", "planar");
                parts.params += &param("vector3", "v1", u[..3].iter());
                parts.params += &param("vector3", "v2", v[..3].iter());
                parts.params += &param("float", "udelta", [u[3]]);
                parts.params += &param("float", "vdelta", [v[3]]);
                parts.map = *map;
            }
            MappingDesc::Spherical { transform } | MappingDesc::Cylindrical { transform } => {
                let is_sphere = matches!(mapping, MappingDesc::Spherical { .. });
                let kind = if is_sphere { "spherical" } else { "cylindrical" };
                parts.params += &word("string", "mapping", kind);
                let texture_from_world = Transform::of_steps(transform);
                let inverse = texture_from_world.inverse().unwrap_or(Transform::IDENTITY);
                parts.map = inverse.then(map);
            }
        }
        parts
    }
}

/// The map of a noise with so many cells in a unit.
fn cells(scale: f64, map: &Transform) -> Transform {
    if scale == 1.0 {
        return *map;
    }
    Transform::of_steps(&[TransformStep::Scale(ScaleDesc::Uniform(1.0 / scale))]).then(map)
}
