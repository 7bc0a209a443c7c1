//! Materials and media.

use zrak_scene::desc::{
    CoatDesc, ColorDesc, ConductorDesc, FresnelDesc, MaterialDesc, MediumDesc, RoughnessDesc,
    RoughnessMap, ScalarDesc,
};

use crate::color::Rgb;
use crate::error::{Fault, Result, Span};
use crate::params::{Params, Values};
use crate::spectrum::{self, Named, Spectrum};
use crate::state::{Importer, named};

/// The types of materials.
const MATERIALS: [&str; 12] = [
    "diffuse",
    "conductor",
    "dielectric",
    "thindielectric",
    "coateddiffuse",
    "coatedconductor",
    "diffusetransmission",
    "mix",
    "interface",
    "hair",
    "measured",
    "subsurface",
];

/// What a parameter of type spectrum is.
enum Given {
    Rgb(Rgb),
    Spectrum(Spectrum),
    Named(Named),
    Blackbody(f64),
}

impl Importer {
    /// A parameter that may be a colour or a spectrum.
    fn given(&mut self, params: &Params, name: &str) -> Result<Option<(Given, Span)>> {
        let Some(param) = params.find(&["rgb", "color", "spectrum", "blackbody"], name) else {
            return Ok(None);
        };
        let (kind, span, values) = (param.kind.clone(), param.span.clone(), param.values.clone());
        let fault = |message: &str| Err(Fault::new(&span, format!("`{name}` {message}")));
        let given = match (kind.as_str(), values) {
            ("rgb" | "color", Values::Numbers(x)) => {
                let [r, g, b] = x[..] else { return fault("must have three numbers") };
                Given::Rgb(self.state.space.to_srgb([r, g, b]))
            }
            ("blackbody", Values::Numbers(x)) => {
                let [kelvin] = x[..] else { return fault("must be one temperature, in kelvin") };
                if !(kelvin > 0.0 && kelvin < 1e7) {
                    return fault("is no temperature that shines");
                }
                Given::Blackbody(kelvin)
            }
            ("spectrum", Values::Numbers(x)) => match x[..] {
                // One number: the same at all wavelengths.
                [value] => Given::Spectrum(Spectrum(vec![[550.0, value]])),
                _ => Given::Spectrum(spectrum_of(&x, name, &span)?),
            },
            ("spectrum", Values::Strings(words)) => {
                let [word] = &words[..] else { return fault("must be one name or file") };
                match spectrum::named(word) {
                    Some(named) => Given::Named(named),
                    None => Given::Spectrum(self.spectrum_file(word, &span)?),
                }
            }
            _ => return fault("has values of another type"),
        };
        Ok(Some((given, span)))
    }

    fn spectrum_file(&mut self, name: &str, span: &Span) -> Result<Spectrum> {
        let path = self.sources.resolve(name, span)?;
        if !self.sources.is_file(&path) {
            let message = format!("there is no spectrum \"{name}\", by name or as a file");
            return Err(Fault::new(span, message));
        }
        let text = self.sources.read(&path, span)?;
        let mut numbers = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or("");
            for word in line.split_ascii_whitespace() {
                match word.parse::<f64>() {
                    Ok(x) if x.is_finite() => numbers.push(x),
                    _ => {
                        let message =
                            format!("{} line {}: `{word}` is no number", path.display(), i + 1);
                        return Err(Fault::new(span, message));
                    }
                }
            }
        }
        spectrum_of(&numbers, name, span)
    }

    /// Colour of emitted light: as it is, if it is RGB; with a luminance of 1 if not.
    pub(crate) fn light_color(&mut self, params: &Params, name: &str) -> Result<Option<Rgb>> {
        Ok(match self.given(params, name)? {
            None => None,
            Some((Given::Rgb(rgb), _)) => Some(rgb),
            Some((Given::Blackbody(kelvin), _)) => Some(spectrum::blackbody_rgb(kelvin)),
            Some((Given::Named(Named::Illuminant(kelvin)), _)) => {
                Some(spectrum::blackbody_rgb(kelvin))
            }
            Some((Given::Spectrum(s), _)) => Some(spectrum::emission_rgb(|lambda| s.at(lambda))),
            Some((Given::Named(_), span)) => {
                return Err(Fault::new(&span, format!("`{name}` must be the spectrum of a light")));
            }
        })
    }

    /// Colour of a share of light, or of a coefficient.
    pub(crate) fn share_color(&mut self, params: &Params, name: &str) -> Result<Option<Rgb>> {
        Ok(match self.given(params, name)? {
            None => None,
            Some((Given::Rgb(rgb), _)) => Some(rgb.map(|x| x.max(0.0))),
            Some((Given::Spectrum(s), _)) => {
                Some(spectrum::reflectance_rgb(|lambda| s.at(lambda)).map(|x| x.max(0.0)))
            }
            Some((Given::Blackbody(_) | Given::Named(_), span)) => {
                return Err(Fault::new(&span, format!("`{name}` must be a reflectance")));
            }
        })
    }

    /// A share of light that may be a texture.
    pub(crate) fn color(&mut self, params: &Params, name: &str, default: Rgb) -> Result<ColorDesc> {
        if let Some(texture) = params.texture(name)? {
            let texture = self.texture_name(texture, false, &params.span)?;
            return Ok(ColorDesc::Texture(texture));
        }
        let rgb = self.share_color(params, name)?.unwrap_or(default);
        Ok(ColorDesc::Solid(rgb.map(|x| x.min(1.0))))
    }

    /// A number that may be a texture.
    pub(crate) fn scalar(&mut self, params: &Params, name: &str) -> Result<Option<ScalarDesc>> {
        if let Some(texture) = params.texture(name)? {
            let texture = self.texture_name(texture, true, &params.span)?;
            return Ok(Some(ScalarDesc::Texture(texture)));
        }
        Ok(params.float(name)?.map(ScalarDesc::Value))
    }

    fn roughness(&mut self, params: &Params, prefix: &str) -> Result<RoughnessDesc> {
        let both = self.scalar(params, &format!("{prefix}roughness"))?;
        let u = self.scalar(params, &format!("{prefix}uroughness"))?;
        let v = self.scalar(params, &format!("{prefix}vroughness"))?;
        let both = both.unwrap_or(ScalarDesc::Value(0.0));
        let remap = params.bool("remaproughness")?.unwrap_or(true);
        let u = u.unwrap_or_else(|| both.clone());
        let v = v.unwrap_or(both);
        Ok(RoughnessDesc {
            v: (v != u).then_some(v),
            u,
            map: if remap { RoughnessMap::Sqrt } else { RoughnessMap::Alpha },
        })
    }

    fn ior(&mut self, params: &Params, name: &str, default: f64) -> Result<f64> {
        if let Some(x) = params.float(name)? {
            return Ok(x);
        }
        Ok(match self.given(params, name)? {
            None => default,
            Some((Given::Spectrum(s), _)) => spectrum::dielectric_index(&s),
            Some((Given::Named(Named::Glass(n)), _)) => n,
            Some((Given::Named(Named::Metal { eta, .. }), _)) => eta[1],
            Some((_, span)) => {
                return Err(Fault::new(&span, format!("`{name}` must be an index of refraction")));
            }
        })
    }

    fn conductor(&mut self, params: &Params, prefix: &str) -> Result<ConductorDesc> {
        if params.all.iter().any(|p| p.name == "reflectance") {
            let reflectance = self.color(params, "reflectance", [0.5; 3])?;
            return Ok(ConductorDesc::Reflectance { reflectance });
        }
        let (eta_name, k_name) = (format!("{prefix}eta"), format!("{prefix}k"));
        let eta = self.given(params, &eta_name)?;
        let k = self.given(params, &k_name)?;
        let copper = || {
            spectrum::named("metal-Cu-eta").map(|named| (Given::Named(named), params.span.clone()))
        };
        let (Some((eta, span)), Some((k, _))) = (eta.or_else(copper), k.or_else(copper)) else {
            return Err(Fault::new(&params.span, "a conductor needs `eta` and `k`"));
        };
        let (eta, k) = match (eta, k) {
            (Given::Spectrum(eta), Given::Spectrum(k)) => spectrum::conductor_index(&eta, &k),
            (eta, k) => {
                let rgb = |given: Given, is_k: bool| match given {
                    Given::Rgb(rgb) => Ok(rgb),
                    Given::Spectrum(s) => Ok(spectrum::reflectance_rgb(|lambda| s.at(lambda))),
                    Given::Named(Named::Metal { eta, k }) => Ok(if is_k { k } else { eta }),
                    Given::Named(Named::Glass(n)) => Ok([if is_k { 0.0 } else { n }; 3]),
                    _ => Err(Fault::new(&span, "this is no index of refraction")),
                };
                (rgb(eta, false)?, rgb(k, true)?)
            }
        };
        Ok(ConductorDesc::Index { eta: eta.map(|x| x.max(1e-3)), k: k.map(|x| x.max(0.0)) })
    }

    fn coat(&mut self, params: &Params, prefix: &str) -> Result<CoatDesc> {
        let roughness = self.roughness(params, prefix)?;
        let ior_name = if prefix.is_empty() { "eta" } else { "interface.eta" };
        let ior = self.ior(params, ior_name, 1.5)?;
        let thickness = params.float(&format!("{prefix}thickness"))?;
        let albedo = self.share_color(params, "albedo")?;
        Ok(CoatDesc {
            roughness,
            ior,
            thickness: thickness.or(params.float("thickness")?).unwrap_or(0.01),
            albedo: albedo.unwrap_or([0.0; 3]).map(|x| x.min(1.0)),
            g: params.float("g")?.unwrap_or(0.0),
            max_depth: params.integer("maxdepth")?.unwrap_or(10).clamp(1, 1000) as u32,
            n_samples: params.integer("nsamples")?.unwrap_or(1).clamp(1, 1000) as u32,
        })
    }

    /// Makes a material of this name.
    pub(crate) fn material(
        &mut self,
        name: &str,
        kind: &str,
        at: &Span,
        params: &Params,
    ) -> Result<()> {
        params.ignore(&["type"]);
        let nearest = |importer: &mut Self, what: &str| {
            importer.warn(at, format!("material \"{kind}\" is rendered as {what}"));
        };
        let material = match kind {
            "diffuse" => {
                MaterialDesc::Lambertian { color: self.color(params, "reflectance", [0.5; 3])? }
            }
            "conductor" => {
                let metal = self.conductor(params, "")?;
                MaterialDesc::Conductor { metal, roughness: self.roughness(params, "")? }
            }
            "dielectric" => {
                let ior = self.ior(params, "eta", 1.5)?;
                let roughness = self.roughness(params, "")?;
                if roughness.is_smooth() {
                    MaterialDesc::Dielectric { ior, fresnel: FresnelDesc::Exact }
                } else {
                    MaterialDesc::RoughDielectric { ior, roughness }
                }
            }
            "thindielectric" => MaterialDesc::ThinDielectric { ior: self.ior(params, "eta", 1.5)? },
            "diffusetransmission" => {
                let scale = params.float("scale")?.unwrap_or(1.0);
                if scale != 1.0 {
                    self.warn(at, "`scale` of diffusetransmission is not read");
                }
                MaterialDesc::DiffuseTransmission {
                    reflectance: self.color(params, "reflectance", [0.25; 3])?,
                    transmittance: self.color(params, "transmittance", [0.25; 3])?,
                }
            }
            "coateddiffuse" => {
                let color = self.color(params, "reflectance", [0.5; 3])?;
                MaterialDesc::CoatedDiffuse { color, coat: self.coat(params, "")? }
            }
            "coatedconductor" => {
                let metal = self.conductor(params, "conductor.")?;
                let metal_roughness = self.roughness(params, "conductor.")?;
                MaterialDesc::CoatedConductor {
                    metal,
                    metal_roughness,
                    coat: self.coat(params, "interface.")?,
                }
            }
            "mix" => {
                let names = params.strings("materials")?.unwrap_or_default().to_vec();
                let [a, b] = &names[..] else {
                    return Err(Fault::new(at, "a mix needs the names of two `materials`"));
                };
                let mut parts = Vec::new();
                for part in [a, b] {
                    if !self.desc.materials.contains_key(&named(part)) {
                        return Err(Fault::new(at, format!("there is no material \"{part}\"")));
                    }
                    parts.push(self.scattering(&named(part)));
                }
                let amount = self.scalar(params, "amount")?.unwrap_or(ScalarDesc::Value(0.5));
                let Ok(materials) = <[String; 2]>::try_from(parts) else {
                    return Err(Fault::new(at, "a mix needs two `materials`"));
                };
                MaterialDesc::Mix { materials, amount }
            }
            "interface" | "" | "none" => MaterialDesc::Interface,
            "hair" => {
                nearest(self, "a brown diffuse one");
                MaterialDesc::Lambertian { color: [0.25, 0.15, 0.08].into() }
            }
            "measured" => {
                nearest(self, "a grey diffuse one");
                MaterialDesc::Lambertian { color: [0.5; 3].into() }
            }
            "subsurface" => {
                nearest(self, "a diffuse one under a dielectric coat");
                let color = self.color(params, "reflectance", [0.7; 3])?;
                MaterialDesc::CoatedDiffuse { color, coat: self.coat(params, "")? }
            }
            _ => {
                let fault = Fault::new(at, format!("unknown material \"{kind}\""));
                let near = zrak_scene::suggest::closest(kind, MATERIALS.iter().copied());
                return Err(match near {
                    Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                    None => fault.help(format!("there are {}", MATERIALS.join(", "))),
                });
            }
        };
        if matches!(kind, "hair" | "measured" | "subsurface") {
            // What they say is not looked at, and one warning is enough.
            let names: Vec<&str> = params.all.iter().map(|p| p.name.as_str()).collect();
            params.ignore(&names);
        }
        // Bumps and normal maps are the surface's.
        let bump = self.scalar(params, "displacement")?;
        let normal_map = match params.string("normalmap")? {
            Some(file) => Some(self.normal_map(file, at)?),
            None => None,
        };
        if bump.is_none() && normal_map.is_none() {
            self.desc.materials.insert(name.to_owned(), material);
            return Ok(());
        }
        let base = self.fresh("base");
        self.desc.materials.insert(base.clone(), material);
        let mut surface = MaterialDesc::surface(base);
        if let MaterialDesc::Surface { bump: b, normal_map: n, .. } = &mut surface {
            *b = bump;
            *n = normal_map;
        }
        self.desc.materials.insert(name.to_owned(), surface);
        Ok(())
    }

    /// Name of the material that scatters, of one that may have more to its surface.
    fn scattering(&self, name: &str) -> String {
        match self.desc.materials.get(name) {
            Some(MaterialDesc::Surface { base, .. }) => base.clone(),
            _ => name.to_owned(),
        }
    }

    pub(crate) fn medium(&mut self, name: &str, at: &Span, params: &Params) -> Result<()> {
        let kind = params.string("type")?.unwrap_or("homogeneous").to_owned();
        let scale = params.float("scale")?.unwrap_or(1.0);
        if params.string("preset")?.is_some() {
            self.warn(at, "presets of media are not known: sigma_a and sigma_s are read");
        }
        let mut sigma_a = self.share_color(params, "sigma_a")?.unwrap_or([1.0; 3]);
        let mut sigma_s = self.share_color(params, "sigma_s")?.unwrap_or([1.0; 3]);
        if kind != "homogeneous" {
            self.warn(at, format!("medium \"{kind}\" is not rendered yet: it is empty"));
            (sigma_a, sigma_s) = ([0.0; 3], [0.0; 3]);
            let names: Vec<&str> = params.all.iter().map(|p| p.name.as_str()).collect();
            params.ignore(&names);
        }
        let g = params.float("g")?.unwrap_or(0.0);
        if self.share_color(params, "Le")?.is_some() {
            self.warn(at, "media do not shine: Le is not read");
            params.ignore(&["Lescale"]);
        }
        let medium = MediumDesc {
            sigma_a: sigma_a.map(|x| x * scale),
            sigma_s: sigma_s.map(|x| x * scale),
            g: g.clamp(-0.999, 0.999),
        };
        self.desc.media.insert(name.to_owned(), medium);
        Ok(())
    }
}

fn spectrum_of(numbers: &[f64], name: &str, span: &Span) -> Result<Spectrum> {
    if numbers.is_empty() || !numbers.len().is_multiple_of(2) {
        let message = format!("spectrum `{name}` must be pairs of a wavelength and a value");
        return Err(Fault::new(span, message));
    }
    let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|c| [c[0], c[1]]).collect();
    if points.windows(2).any(|w| w[0][0] >= w[1][0]) {
        let message = format!("the wavelengths of spectrum `{name}` must increase");
        return Err(Fault::new(span, message));
    }
    Ok(Spectrum(points))
}
