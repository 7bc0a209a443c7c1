//! Light sources and area lights.

use std::rc::Rc;

use zrak_scene::desc::{BackgroundDesc, EnvironmentMapping, LightDesc, SpotFalloff};

use crate::color::Rgb;
use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::{AreaLight, Importer, dot, steps, sub};

impl Importer {
    /// Emitted light: the parameter's colour times `scale`, or white.
    fn emission(&mut self, params: &Params, name: &str) -> Result<Rgb> {
        let color = self.light_color(params, name)?.unwrap_or([1.0; 3]);
        let scale = params.float("scale")?.unwrap_or(1.0) * self.exposure;
        Ok(color.map(|x| (x * scale).max(0.0)))
    }

    pub(crate) fn area_light(&mut self, at: &Span, params: &Params) -> Result<()> {
        let mut radiance = self.emission(params, "L")?;
        if params.string("filename")?.is_some() {
            self.warn(at, "pictures on area lights are not read: the light is even");
            radiance = [self.exposure; 3];
        }
        if params.float("power")?.is_some() {
            self.warn(at, "the power of area lights is not read: L and scale are");
        }
        let two_sided = params.bool("twosided")?.unwrap_or(false);
        self.state.light = Some(Rc::new(AreaLight { radiance, two_sided }));
        Ok(())
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
                if let Some(power) = params.float("power")? {
                    // Given in total: over the whole sphere of directions.
                    let scale = self.exposure * power / (4.0 * std::f64::consts::PI);
                    intensity = scaled_to(intensity, scale);
                }
                if kind == "goniometric" {
                    self.warn(at, "goniometric lights shine evenly: their picture is not read");
                    params.ignore(&["filename"]);
                }
                self.desc.lights.push(LightDesc::Point { position: ctm.point(from), intensity });
            }
            "spot" | "projection" => {
                let mut intensity = self.emission(params, "I")?;
                let (cone, delta) = if kind == "projection" {
                    self.warn(at, "projection lights are spots: their picture is not read");
                    params.ignore(&["filename"]);
                    (0.5 * params.float("fov")?.unwrap_or(90.0), 0.0)
                } else {
                    let cone = params.float("coneangle")?.unwrap_or(30.0);
                    (cone, params.float("conedeltaangle")?.unwrap_or(5.0))
                };
                if !(has_direction && cone > 0.0 && cone <= 180.0) {
                    return Err(Fault::new(at, "the spot has no direction or no cone"));
                }
                let start = (cone - delta).clamp(0.0, cone);
                if let Some(power) = params.float("power")? {
                    let cos = |deg: f64| libm::cos(deg.to_radians());
                    let solid_angle = 2.0
                        * std::f64::consts::PI
                        * ((1.0 - cos(start)) + 0.5 * (cos(start) - cos(cone)));
                    intensity = scaled_to(intensity, self.exposure * power / solid_angle);
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
            "distant" => {
                let mut irradiance = self.emission(params, "L")?;
                if let Some(lux) = params.float("illuminance")? {
                    irradiance = scaled_to(irradiance, lux * self.exposure);
                }
                if !has_direction {
                    return Err(Fault::new(at, "the light has no direction"));
                }
                self.desc.lights.push(LightDesc::Distant { direction, irradiance });
            }
            "infinite" => self.infinite(at, params)?,
            _ => {
                let fault = Fault::new(at, format!("unknown light \"{kind}\""));
                return Err(fault
                    .help("there are point, spot, distant, infinite, goniometric and projection"));
            }
        }
        Ok(())
    }

    fn infinite(&mut self, at: &Span, params: &Params) -> Result<()> {
        if self.desc.background != BackgroundDesc::default() {
            self.warn(at, "there is one infinite light: the last");
        }
        let mut tint = self.emission(params, "L")?;
        if let Some(lux) = params.float("illuminance")? {
            tint = scaled_to(tint, lux * self.exposure / std::f64::consts::PI);
        }
        if params.triples("portal")?.is_some() {
            self.warn(at, "portals are not looked through: the light comes from everywhere");
        }
        self.desc.background = match params.string("filename")? {
            None => BackgroundDesc::Constant { color: tint },
            Some(name) => {
                let name = name.to_owned();
                self.sources.resolve(&name, at)?;
                let ctm = self.state.ctm.start;
                BackgroundDesc::Image {
                    path: name,
                    mapping: EnvironmentMapping::EqualArea,
                    strength: 1.0,
                    tint,
                    transform: steps(&ctm),
                }
            }
        };
        Ok(())
    }
}

/// The colour with this luminance.
fn scaled_to(color: Rgb, luminance: f64) -> Rgb {
    let own = 0.212_639 * color[0] + 0.715_169 * color[1] + 0.072_192 * color[2];
    if own > 0.0 { color.map(|x| x / own * luminance) } else { color }
}
