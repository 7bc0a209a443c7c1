//! Materials.

use zrak_scene::desc::{
    CoatDesc, ColorDesc, ConductorDesc, FresnelDesc, MaterialDesc, RoughnessDesc, RoughnessMap,
    ScalarDesc, TextureDesc,
};

use crate::error::{Fault, Result, Span};
use crate::given::Given;
use crate::media;
use crate::params::Params;
use crate::references::What;
use crate::spectrum::{self, Named};
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

impl Importer {
    fn roughness(&mut self, params: &Params, prefix: &str) -> Result<RoughnessDesc> {
        let both = self.part(params, &format!("{prefix}roughness"))?;
        let u = self.part(params, &format!("{prefix}uroughness"))?;
        let v = self.part(params, &format!("{prefix}vroughness"))?;
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
        let (ior, span) = match params.float(name)? {
            Some(x) => (x, params.span_of(name)),
            None => match self.given(params, name)? {
                None => return Ok(default),
                Some((Given::Spectrum(s), span)) => (spectrum::dielectric_index(&s), span),
                Some((_, span)) => {
                    let message = format!("`{name}` must be an index of refraction");
                    let fault = Fault::new(&span, message);
                    return Err(fault.help("give a number or the spectrum of a glass"));
                }
            },
        };
        if (1e-3..=1e3).contains(&ior) {
            return Ok(ior);
        }
        Err(Fault::new(&span, format!("`{name}` must be from 0.001 to 1000, is {ior}")))
    }

    fn conductor(&mut self, params: &Params, prefix: &str) -> Result<ConductorDesc> {
        let (eta_name, k_name) = (format!("{prefix}eta"), format!("{prefix}k"));
        if params.has("reflectance") {
            if params.has(&eta_name) || params.has(&k_name) {
                let fault = Fault::new(
                    &params.span_of("reflectance"),
                    format!("a conductor has a `reflectance`, or `{eta_name}` and `{k_name}`"),
                );
                return Err(fault.help("leave out one of them"));
            }
            let reflectance = self.color(params, "reflectance", [0.5; 3])?;
            return Ok(ConductorDesc::Reflectance { reflectance });
        }
        let mut read = |name: &str, copper: &str| -> Result<Given> {
            if params.texture(name)?.is_some() {
                let span = params.span_of(name);
                self.warn(&span, format!("`{name}` is not read from a texture: it is copper's"));
            }
            match self.given(params, name)? {
                None => match spectrum::named(copper) {
                    Some(Named::Spectrum(s)) => Ok(Given::Spectrum(s)),
                    _ => Ok(Given::Rgb([1.0; 3])),
                },
                Some((Given::Light(_) | Given::Blackbody(_), span)) => {
                    let message = format!("`{name}` must be an index of refraction");
                    Err(Fault::new(&span, message))
                }
                Some((given, _)) => Ok(given),
            }
        };
        let (eta, k) = (read(&eta_name, "metal-Cu-eta")?, read(&k_name, "metal-Cu-k")?);
        let (eta, k) = match (eta, k) {
            (Given::Spectrum(eta), Given::Spectrum(k)) => spectrum::conductor_index(&eta, &k),
            (eta, k) => {
                let rgb = |given: Given| match given {
                    Given::Rgb(rgb) => rgb,
                    Given::Spectrum(s) => spectrum::reflectance_rgb(|lambda| s.at(lambda)),
                    Given::Light(_) | Given::Blackbody(_) => [1.0; 3],
                };
                (rgb(eta), rgb(k))
            }
        };
        Ok(ConductorDesc::Index {
            eta: eta.map(|x| x.clamp(1e-3, 1e3)),
            k: k.map(|x| x.clamp(0.0, 1e3)),
        })
    }

    /// The coat of a layered material; prefixes are those of the roughness and of the index.
    fn coat(&mut self, params: &Params, prefix: &str, default_ior: f64) -> Result<CoatDesc> {
        let roughness = self.roughness(params, prefix)?;
        let ior = self.ior(params, &format!("{prefix}eta"), default_ior)?;
        let thickness = self.plain(params, "thickness", 0.01)?;
        let g = self.plain(params, "g", 0.0)?;
        if !(0.0..=1e6).contains(&thickness) {
            let message = format!("`thickness` must be from 0 to 1e6, is {thickness}");
            return Err(Fault::new(&params.span_of("thickness"), message));
        }
        Ok(CoatDesc {
            roughness,
            ior,
            thickness,
            albedo: self.plain_color(params, "albedo", [0.0; 3])?,
            g: self.mean_cosine(params, g)?,
            max_depth: params.integer("maxdepth")?.unwrap_or(10).clamp(1, 1000) as u32,
            n_samples: params.integer("nsamples")?.unwrap_or(1).clamp(1, 1000) as u32,
        })
    }

    /// The parameter `g` of a phase function, if it can be that.
    pub(crate) fn mean_cosine(&self, params: &Params, g: f64) -> Result<f64> {
        if g.abs() < 1.0 {
            return Ok(g);
        }
        Err(Fault::new(&params.span_of("g"), format!("`g` must be between -1 and 1, is {g}")))
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
                let scale = params.float("scale")?.unwrap_or(1.0).max(0.0);
                let mut reflectance = self.color(params, "reflectance", [0.25; 3])?;
                let mut transmittance = self.color(params, "transmittance", [0.25; 3])?;
                self.no_more_than_all(at, [&mut reflectance, &mut transmittance], scale);
                MaterialDesc::DiffuseTransmission { reflectance, transmittance }
            }
            "coateddiffuse" => {
                let color = self.color(params, "reflectance", [0.5; 3])?;
                MaterialDesc::CoatedDiffuse { color, coat: self.coat(params, "", 1.5)? }
            }
            "coatedconductor" => {
                let metal = self.conductor(params, "conductor.")?;
                let metal_roughness = self.roughness(params, "conductor.")?;
                MaterialDesc::CoatedConductor {
                    metal,
                    metal_roughness,
                    coat: self.coat(params, "interface.", 1.5)?,
                }
            }
            "mix" => {
                let names = params.strings("materials")?.unwrap_or_default().to_vec();
                let [a, b] = &names[..] else {
                    return Err(Fault::new(at, "a mix needs the names of two `materials`"));
                };
                for part in [a, b] {
                    self.refer(What::Material, part, &params.span_of("materials"));
                }
                let materials = [named(a), named(b)];
                let amount = self.part(params, "amount")?.unwrap_or(ScalarDesc::Value(0.5));
                MaterialDesc::Mix { materials, amount }
            }
            "interface" | "" | "none" => MaterialDesc::Interface,
            "hair" => {
                nearest(self, "a diffuse one");
                let name = if params.has("color") { "color" } else { "reflectance" };
                MaterialDesc::Lambertian { color: self.color(params, name, [0.25, 0.15, 0.08])? }
            }
            "measured" => {
                nearest(self, "a grey diffuse one");
                MaterialDesc::Lambertian { color: [0.5; 3].into() }
            }
            "subsurface" => {
                nearest(self, "a diffuse one under a dielectric coat");
                let color = self.subsurface_color(params)?;
                MaterialDesc::CoatedDiffuse { color, coat: self.coat(params, "", 1.33)? }
            }
            _ => {
                return Err(Fault::unknown(at, "material", kind, &MATERIALS));
            }
        };
        if matches!(kind, "hair" | "measured" | "subsurface") {
            // What they say is not looked at, and one warning is enough.
            params.ignore_all();
        }
        // Bumps and normal maps are the surface's.
        let bump = self.scalar(params, "displacement")?;
        let normal_map = match params.string("normalmap")? {
            Some(file) => Some(self.normal_map(file, &params.span_of("normalmap"))?),
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

    /// Reflectance and transmittance times `scale`, and not more than all light together.
    fn no_more_than_all(&mut self, at: &Span, shares: [&mut ColorDesc; 2], scale: f64) {
        let mut factor = scale;
        if let [ColorDesc::Solid(r), ColorDesc::Solid(t)] = &shares {
            let most = (0..3).map(|i| (r[i] + t[i]) * scale).fold(0.0, f64::max);
            if most > 1.0 {
                let message = "reflectance and transmittance are more than all light together; \
                               they are made less";
                self.warn(at, message);
                factor /= most * (1.0 + 1e-9);
            }
        }
        if factor == 1.0 {
            return;
        }
        for share in shares {
            match share {
                ColorDesc::Solid(color) => *color = color.map(|x| x * factor),
                ColorDesc::Texture(texture) => {
                    let a = ColorDesc::Texture(std::mem::take(texture));
                    let b = ColorDesc::Solid([factor; 3]);
                    *texture = self.fresh("scaled");
                    self.desc.textures.insert(texture.clone(), TextureDesc::Multiply { a, b });
                }
            }
        }
    }

    /// The diffuse albedo of a medium below a surface: given, or that of a half-space of it.
    fn subsurface_color(&mut self, params: &Params) -> Result<ColorDesc> {
        if params.has("reflectance") {
            return self.color(params, "reflectance", [0.5; 3]);
        }
        let (mut sigma_s, mut sigma_a) = ([2.55, 3.21, 3.77], [0.0011, 0.0024, 0.014]);
        if let Some(name) = params.string("name")? {
            (sigma_s, sigma_a) = media::preset(name, &params.span_of("name"))?;
        } else {
            let g = params.float("g")?.unwrap_or(0.0).clamp(-0.999, 0.999);
            if let Some(s) = self.coefficients(params, "sigma_s")? {
                sigma_s = s.map(|x| x * (1.0 - g));
            }
            if let Some(a) = self.coefficients(params, "sigma_a")? {
                sigma_a = a;
            }
        }
        // Diffusion in a half-space whose index is that outside: Jensen et al. 2001.
        let albedo = |i: usize| {
            let all = sigma_s[i] + sigma_a[i];
            let alpha: f64 = if all > 0.0 { sigma_s[i] / all } else { 0.0 };
            let root = (3.0 * (1.0 - alpha)).sqrt();
            0.5 * alpha * (1.0 + libm::exp(-4.0 / 3.0 * root)) * libm::exp(-root)
        };
        Ok(ColorDesc::Solid(std::array::from_fn(albedo)))
    }
}
