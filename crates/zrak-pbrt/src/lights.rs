//! Light sources and area lights.

use std::rc::Rc;

use zrak_scene::desc::{
    BackgroundDesc, ColorDesc, EnvironmentMapping, ImageEncoding, ImageFilter, LightDesc,
    SpotFalloff, TextureDesc, WrapMode,
};

use crate::color::Rgb;
use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::{AreaLight, Importer, dot, steps, sub};

/// The types of lights.
const KINDS: [&str; 6] = ["point", "spot", "distant", "infinite", "goniometric", "projection"];

impl Importer {
    /// Emitted light: the parameter's colour times `scale`, or white.
    fn emission(&mut self, params: &Params, name: &str) -> Result<Rgb> {
        let color = self.light_color(params, name)?.unwrap_or([1.0; 3]);
        let scale = params.float("scale")?.unwrap_or(1.0) * self.exposure;
        if color.iter().any(|&x| x * scale < 0.0) {
            let span = params.span_of(if scale < 0.0 { "scale" } else { name });
            self.warn(&span, "light cannot be negative: it is 0");
        }
        Ok(color.map(|x| (x * scale).max(0.0)))
    }

    pub(crate) fn area_light(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        if kind != "diffuse" {
            return Err(Fault::unknown(at, "area light", kind, &["diffuse"]));
        }
        let two_sided = params.bool("twosided")?.unwrap_or(false);
        let mut power = params.float("power")?.filter(|&power| power > 0.0);
        let light = if let Some(name) = params.string("filename")?.map(str::to_owned) {
            let span = params.span_of("filename");
            if params.has("L") {
                let fault = Fault::new(&span, "an area light has an `L` or a `filename`");
                return Err(fault.help("leave out one of them"));
            }
            let path = self.picture(&name, &span)?;
            let mut mean = 1.0;
            if power.is_some() {
                match self.mean_luminance(&path, |_, _| 1.0) {
                    Some(m) => mean = m,
                    None => power = None,
                }
            }
            let key = self.fresh("emission");
            let mut texture = TextureDesc::image(path, ImageFilter::Bilinear);
            if let TextureDesc::Image { wrap_u, encoding, .. } = &mut texture {
                (*wrap_u, *encoding) = (WrapMode::Clamp, ImageEncoding::Srgb);
            }
            self.desc.textures.insert(key.clone(), texture);
            let scale = params.float("scale")?.unwrap_or(1.0) * self.exposure;
            AreaLight {
                emission: ColorDesc::Texture(key),
                strength: scale.max(0.0),
                two_sided,
                power,
                mean,
            }
        } else {
            let radiance = self.emission(params, "L")?;
            AreaLight {
                emission: ColorDesc::Solid(radiance),
                strength: 1.0,
                two_sided,
                power,
                mean: 1.0,
            }
        };
        self.state.light = Some(Rc::new(light));
        Ok(())
    }

    /// Mean over a picture of luminance times a weight by column and row, each from 0 to 1; none if it
    /// cannot be read, which is an error later.
    fn mean_luminance(&self, path: &str, weight: impl Fn(f64, f64) -> f64) -> Option<f64> {
        if !self.sources.has_pictures() {
            return None;
        }
        let picture = zrak_image::read_picture(&self.sources.base().join(path)).ok()?;
        let (w, h) = (picture.width as usize, picture.height as usize);
        let mut sum = 0.0;
        for (i, pixel) in picture.pixels.iter().enumerate() {
            let (u, v) = ((i % w) as f64 + 0.5, (i / w) as f64 + 0.5);
            sum += luminance(pixel.map(f64::from)) * weight(u / w as f64, v / h as f64);
        }
        Some(sum / (w * h) as f64).filter(|mean| mean.is_finite() && *mean > 0.0)
    }

    pub(crate) fn light_source(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        let ctm = self.state.ctm.start;
        if self.state.ctm.is_moving() {
            self.warn(at, "the light moves; it is taken as it stands at first");
        }
        let from = params.triple("from")?.unwrap_or([0.0; 3]);
        let to = params.triple("to")?.unwrap_or([0.0, 0.0, 1.0]);
        let direction = ctm.vector(sub(to, from));
        let has_direction = dot(direction, direction) > 1e-24;
        match kind {
            "point" | "goniometric" => {
                let mut intensity = self.emission(params, "I")?;
                // Intensity in all directions together, for an intensity of 1.
                let mut whole = 4.0 * std::f64::consts::PI;
                if kind == "goniometric" {
                    let message =
                        "a goniometric light shines evenly, as bright as its picture in the mean";
                    self.warn(at, message);
                    if let Some(name) = params.string("filename")?.map(str::to_owned) {
                        let path = self.picture(&name, &params.span_of("filename"))?;
                        let mean = self.mean_luminance(&path, |_, _| 1.0).unwrap_or(1.0);
                        intensity = intensity.map(|x| x * mean);
                        whole *= mean;
                    }
                }
                if let Some(power) = params.float("power")?.filter(|&power| power > 0.0) {
                    intensity = intensity.map(|x| x * power / whole);
                }
                self.desc.lights.push(LightDesc::Point { position: ctm.point(from), intensity });
            }
            "spot" => {
                let mut intensity = self.emission(params, "I")?;
                let cone = params.float("coneangle")?.unwrap_or(30.0);
                let delta = params.float("conedeltaangle")?.unwrap_or(5.0);
                if !(cone > 0.0 && cone < 180.0) {
                    let message = format!("`coneangle` must be between 0 and 180, is {cone}");
                    return Err(Fault::new(&params.span_of("coneangle"), message));
                }
                if !has_direction {
                    return Err(Fault::new(at, "the light has no direction"));
                }
                let start = (cone - delta).clamp(0.0, cone);
                if let Some(power) = params.float("power")?.filter(|&power| power > 0.0) {
                    let cos = |deg: f64| libm::cos(deg.to_radians());
                    let solid_angle = 2.0
                        * std::f64::consts::PI
                        * ((1.0 - cos(start)) + 0.5 * (cos(start) - cos(cone)));
                    intensity = intensity.map(|x| x * power / solid_angle);
                }
                self.desc.lights.push(LightDesc::Spot {
                    position: ctm.point(from),
                    direction,
                    intensity,
                    cone_angle_deg: cone,
                    falloff_start_deg: start,
                    falloff: SpotFalloff::Smoothstep,
                });
            }
            "projection" => self.projection(at, params)?,
            "distant" => {
                let mut irradiance = self.emission(params, "L")?;
                if let Some(lux) = params.float("illuminance")?.filter(|&lux| lux > 0.0) {
                    irradiance = irradiance.map(|x| x * lux);
                }
                if !has_direction {
                    return Err(Fault::new(at, "the light has no direction"));
                }
                self.desc.lights.push(LightDesc::Distant { direction, irradiance });
            }
            "infinite" => self.infinite(at, params)?,
            _ => return Err(Fault::unknown(at, "light", kind, &KINDS)),
        }
        Ok(())
    }

    /// A projector as a spot of the same power, as wide as its picture on the longer side.
    fn projection(&mut self, at: &Span, params: &Params) -> Result<()> {
        let ctm = self.state.ctm.start;
        self.warn(at, "a projection light is a spot, as bright as its picture in the mean");
        let Some(name) = params.string("filename")?.map(str::to_owned) else {
            return Err(Fault::new(at, "a projection light needs a \"string filename\""));
        };
        let path = self.picture(&name, &params.span_of("filename"))?;
        let fov = params.float("fov")?.unwrap_or(90.0);
        if !(fov > 0.0 && fov < 180.0) {
            let message = format!("`fov` must be between 0 and 180, is {fov}");
            return Err(Fault::new(&params.span_of("fov"), message));
        }
        let mean = self.mean_luminance(&path, |_, _| 1.0).unwrap_or(1.0);
        let mut intensity =
            [params.float("scale")?.unwrap_or(1.0).max(0.0) * mean * self.exposure; 3];
        if let Some(power) = params.float("power")?.filter(|&power| power > 0.0) {
            let solid_angle =
                2.0 * std::f64::consts::PI * (1.0 - libm::cos(fov.to_radians() / 2.0));
            intensity = [power * self.exposure / solid_angle; 3];
        }
        self.desc.lights.push(LightDesc::Spot {
            position: ctm.point([0.0; 3]),
            direction: ctm.vector([0.0, 0.0, 1.0]),
            intensity,
            cone_angle_deg: 0.5 * fov,
            falloff_start_deg: 0.5 * fov,
            falloff: SpotFalloff::Smoothstep,
        });
        Ok(())
    }

    fn infinite(&mut self, at: &Span, params: &Params) -> Result<()> {
        if params.triples("portal")?.is_some() {
            let span = params.span_of("portal");
            self.warn(&span, "the portal is not looked through: the light comes from everywhere");
        }
        let lux = params.float("illuminance")?.filter(|&lux| lux > 0.0);
        let mut tint = self.emission(params, "L")?;
        let new = match params.string("filename")?.map(str::to_owned) {
            None => {
                if let Some(lux) = lux {
                    tint = tint.map(|x| x * lux / std::f64::consts::PI);
                }
                BackgroundDesc::Constant { color: tint }
            }
            Some(name) => {
                let span = params.span_of("filename");
                if params.has("L") {
                    let fault = Fault::new(&span, "an infinite light has an `L` or a `filename`");
                    return Err(
                        fault.help("leave out one of them; `scale` makes a picture brighter")
                    );
                }
                let path = self.picture(&name, &span)?;
                if let Some(lux) = lux {
                    // What falls on a patch that faces +z.
                    let cosine = |u: f64, v: f64| equal_area_z(u, v).max(0.0);
                    let all = 4.0 * std::f64::consts::PI;
                    if let Some(mean) = self.mean_luminance(&path, cosine) {
                        // pbrt counts each texel as 2 pi of the sphere, not 4 pi.
                        tint = tint.map(|x| x * lux / (0.5 * all * mean));
                    }
                }
                let ctm = self.state.ctm.start;
                BackgroundDesc::Image {
                    path,
                    mapping: EnvironmentMapping::EqualArea,
                    strength: 1.0,
                    tint,
                    transform: steps(&ctm),
                }
            }
        };
        // Two even ones add up; of others there can be one.
        match (&mut self.desc.background, new) {
            (BackgroundDesc::Constant { color }, BackgroundDesc::Constant { color: more }) => {
                (0..3).for_each(|i| color[i] += more[i]);
            }
            (old, new) => {
                if *old != BackgroundDesc::default() {
                    *old = new;
                    self.warn(at, "of several infinite lights with pictures the last is rendered");
                } else {
                    *old = new;
                }
            }
        }
        Ok(())
    }
}

fn luminance(color: Rgb) -> f64 {
    0.212_639 * color[0] + 0.715_169 * color[1] + 0.072_192 * color[2]
}

/// z of the direction that falls on a place of Clarberg's equal-area map.
fn equal_area_z(u: f64, v: f64) -> f64 {
    let (u, v) = ((2.0 * u - 1.0).abs(), (2.0 * v - 1.0).abs());
    let signed = 1.0 - (u + v);
    let r = 1.0 - signed.abs();
    (1.0 - r * r).copysign(signed)
}
