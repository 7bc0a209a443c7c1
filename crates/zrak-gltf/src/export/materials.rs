//! Materials as metallic-roughness ones with extensions.

use std::collections::HashMap;

use serde_json::{Map, Value, json};
use zrak_scene::desc::{
    ColorDesc, ConductorDesc, ImageChannel, LightSides, MaterialDesc, PrincipledDesc,
    RoughnessDesc, RoughnessMap, ScalarDesc,
};

use super::Export;
use super::textures::{Color, Scalar, Textures};
use crate::error::{Error, ErrorKind};

/// A material that is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    pub(super) index: usize,
    /// Whether it looks at the colours of vertices.
    pub(super) has_colors: bool,
}

#[derive(Default)]
pub(super) struct Materials {
    pub(super) textures: Textures,
    /// None for what is not there.
    written: HashMap<String, Option<Material>>,
}

/// A material that is being made.
pub(super) struct Draft<'a> {
    pub(super) at: String,
    pub(super) json: Value,
    pub(super) extensions: Map<String, Value>,
    pub(super) has_colors: bool,
    desc: &'a MaterialDesc,
}

impl Materials {
    /// The material of this name; none if surfaces of it are not there.
    pub(super) fn get(
        &mut self,
        export: &mut Export<'_>,
        name: &str,
        at: &str,
    ) -> Result<Option<Material>, Error> {
        if let Some(done) = self.written.get(name) {
            return Ok(*done);
        }
        let desc = find(export, name, at)?;
        let done = self.write(export, name, desc)?;
        self.written.insert(name.to_owned(), done);
        Ok(done)
    }

    fn write(
        &mut self,
        export: &mut Export<'_>,
        name: &str,
        desc: &MaterialDesc,
    ) -> Result<Option<Material>, Error> {
        let at = format!("materials.{name}");
        // zrak's surfaces have two sides, unless they say otherwise.
        let json = json!({"name": name, "doubleSided": true, "pbrMetallicRoughness": {}});
        let extensions = Map::new();
        let mut draft = Draft { at, json, extensions, has_colors: false, desc };
        if let MaterialDesc::Surface { base, .. } = desc {
            let scatters = find(export, base, &draft.at)?;
            if !self.scattering(export, &mut draft, scatters) {
                return Ok(None);
            }
            self.surface(export, &mut draft);
        } else if !self.scattering(export, &mut draft, desc) {
            return Ok(None);
        }
        // The specification wants closed surfaces around media, which have one outside.
        if draft.extensions.contains_key("KHR_materials_volume") {
            draft.json["doubleSided"] = json!(false);
        }
        for extension in draft.extensions.keys() {
            if let Some(known) = WRITTEN.iter().find(|known| *known == extension) {
                export.file.uses(known);
            }
        }
        if !draft.extensions.is_empty() {
            draft.json["extensions"] = Value::Object(draft.extensions);
        }
        let index = export.file.push("materials", draft.json);
        Ok(Some(Material { index, has_colors: draft.has_colors }))
    }

    /// Writes how a material scatters; false if it is not there.
    fn scattering(
        &mut self,
        export: &mut Export<'_>,
        draft: &mut Draft<'_>,
        desc: &MaterialDesc,
    ) -> bool {
        let approximate = |export: &mut Export<'_>, draft: &Draft<'_>, how: &str| {
            export.warnings.note(&draft.at, format!("glTF has no such material: {how}"));
        };
        let mut surface =
            PrincipledDesc { specular_roughness: 1.0.into(), ..PrincipledDesc::default() };
        match desc {
            MaterialDesc::Principled { surface: given } => surface = (**given).clone(),
            MaterialDesc::Lambertian { color } => {
                surface.base_color = color.clone();
                surface.specular_weight = 0.0.into();
            }
            MaterialDesc::Metal { color, fuzz } => {
                surface.base_color = color.clone();
                surface.base_metalness = 1.0.into();
                surface.specular_roughness = fuzz.clamp(0.0, 1.0).sqrt().into();
                if *fuzz > 0.0 {
                    approximate(export, draft, "its fuzz becomes a roughness");
                }
            }
            MaterialDesc::Dielectric { ior, .. } => glass(&mut surface, *ior, 0.0.into()),
            MaterialDesc::RoughDielectric { ior, roughness } => {
                let roughness = roughness_of(export, draft, roughness);
                glass(&mut surface, *ior, roughness);
            }
            MaterialDesc::ThinDielectric { ior } => {
                glass(&mut surface, *ior, 0.0.into());
                surface.geometry_thin_walled = true;
            }
            MaterialDesc::Conductor { metal, roughness } => {
                surface.base_color = metal_color(metal);
                surface.base_metalness = 1.0.into();
                surface.specular_roughness = roughness_of(export, draft, roughness);
            }
            MaterialDesc::CoatedDiffuse { color, coat } => {
                approximate(export, draft, "the coat becomes a clear one");
                surface.base_color = color.clone();
                surface.specular_weight = 0.0.into();
                surface.coat_weight = 1.0.into();
                surface.coat_roughness = roughness_of(export, draft, &coat.roughness);
            }
            MaterialDesc::CoatedConductor { metal, metal_roughness, coat } => {
                approximate(export, draft, "the coat becomes a clear one");
                surface.base_color = metal_color(metal);
                surface.base_metalness = 1.0.into();
                surface.specular_roughness = roughness_of(export, draft, metal_roughness);
                surface.coat_weight = 1.0.into();
                surface.coat_roughness = roughness_of(export, draft, &coat.roughness);
            }
            MaterialDesc::DiffuseTransmission { reflectance, .. } => {
                approximate(export, draft, "only what it reflects is written");
                surface.base_color = reflectance.clone();
                surface.specular_weight = 0.0.into();
            }
            MaterialDesc::Mix { materials, amount } => {
                approximate(export, draft, "the larger part of the mix is written");
                let second = matches!(amount, ScalarDesc::Value(x) if *x > 0.5);
                let part = export.desc.materials.get(&materials[usize::from(second)]);
                // A mix of mixes is looked into no further.
                match part.filter(|part| !matches!(part, MaterialDesc::Mix { .. })) {
                    Some(part) => return self.scattering(export, draft, part),
                    None => surface.base_color = ColorDesc::Solid([0.5; 3]),
                }
            }
            MaterialDesc::DiffuseLight { color, sides } => {
                surface.base_color = ColorDesc::Solid([0.0; 3]);
                surface.specular_weight = 0.0.into();
                self.emission(export, draft, color, 1.0);
                draft.json["doubleSided"] = json!(*sides == LightSides::Both);
            }
            MaterialDesc::Interface | MaterialDesc::Isotropic { .. } => {
                export.warnings.note(&draft.at, "surfaces of it are not there: they are left out");
                return false;
            }
            MaterialDesc::Surface { .. } => {
                export.warnings.note(&draft.at, "a surface of a surface is grey");
            }
        }
        self.principled(export, draft, &surface);
        true
    }

    /// What a `surface` has besides its base.
    fn surface(&mut self, export: &mut Export<'_>, draft: &mut Draft<'_>) {
        let MaterialDesc::Surface {
            emission,
            emission_strength,
            emission_sides,
            alpha,
            alpha_cutoff,
            normal_map,
            normal_scale,
            bump,
            medium,
            one_sided,
            ..
        } = draft.desc
        else {
            return;
        };
        if let Some(color) = emission {
            self.emission(export, draft, color, *emission_strength);
            draft.json["doubleSided"] = json!(*emission_sides == LightSides::Both);
        }
        if *one_sided {
            draft.json["doubleSided"] = json!(false);
        }
        if let Some(alpha) = alpha {
            let Scalar { factor, picture, has_vertices } = self.textures.scalar(export, alpha);
            draft.has_colors |= has_vertices;
            let pbr = &mut draft.json["pbrMetallicRoughness"];
            pbr["baseColorFactor"][3] = json!(factor.clamp(0.0, 1.0));
            let is_same = picture.as_ref().is_none_or(|picture| {
                picture.channel == ImageChannel::A && pbr["baseColorTexture"] == picture.info
            });
            if !is_same {
                let message = "glTF's holes are in the alpha of the base colour's picture: they are \
                               left out";
                export.warnings.note(&draft.at, message);
            }
            draft.json["alphaMode"] = json!(if alpha_cutoff.is_some() { "MASK" } else { "BLEND" });
            if let Some(cutoff) = alpha_cutoff {
                draft.json["alphaCutoff"] = json!(cutoff.max(0.0));
            }
        }
        if let Some(name) = normal_map {
            let input = ColorDesc::Texture(name.clone());
            if let Some(mut picture) = self.textures.color(export, &input).picture {
                picture.info["scale"] = json!(normal_scale);
                draft.json["normalTexture"] = picture.info;
            }
        }
        if bump.is_some() {
            export.warnings.note(&draft.at, "glTF has no bumps: they are left out");
        }
        if let Some(medium) = medium {
            let inside = medium.inside.as_ref().and_then(|name| export.desc.media.get(name));
            let absorbs = inside.filter(|m| m.sigma_s == [0.0; 3] && medium.outside.is_none());
            match (absorbs, draft.extensions.get_mut("KHR_materials_volume")) {
                (Some(absorbs), Some(volume)) => {
                    // The distance at which the colour that absorbs most is down to 1/e.
                    let largest = absorbs.sigma_a.iter().fold(1e-12_f64, |m, &x| m.max(x));
                    let color = absorbs.sigma_a.map(|sigma| libm::exp(-sigma / largest));
                    volume["attenuationDistance"] = json!(1.0 / largest);
                    volume["attenuationColor"] = json!(color);
                }
                _ => {
                    let message = "glTF has only absorbing media in transparent surfaces: the \
                                   medium is left out";
                    export.warnings.note(&draft.at, message);
                }
            }
        }
    }

    fn emission(
        &mut self,
        export: &mut Export<'_>,
        draft: &mut Draft<'_>,
        color: &ColorDesc,
        strength: f64,
    ) {
        let Color { factor, picture, .. } = self.textures.color(export, color);
        let factor = factor.map(|x| x * strength);
        let largest = factor.iter().fold(0.0_f64, |m, &x| m.max(x));
        // Factors go up to 1, the strength takes the rest.
        let scale = largest.max(1.0);
        draft.json["emissiveFactor"] = json!(factor.map(|x| (x / scale).clamp(0.0, 1.0)));
        if scale > 1.0 {
            let json = json!({"emissiveStrength": scale});
            draft.extensions.insert("KHR_materials_emissive_strength".into(), json);
        }
        if let Some(picture) = picture {
            draft.json["emissiveTexture"] = picture.info;
        }
    }
}

/// Every extension of materials that is written.
const WRITTEN: &[&str] = &[
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
];

fn find<'a>(export: &Export<'a>, name: &str, at: &str) -> Result<&'a MaterialDesc, Error> {
    export.desc.materials.get(name).ok_or_else(|| {
        let message = format!("there is no material `{name}`");
        Error::new(ErrorKind::Invalid, at, message, "validate the scene")
    })
}

fn glass(surface: &mut PrincipledDesc, ior: f64, roughness: ScalarDesc) {
    surface.transmission_weight = 1.0.into();
    surface.specular_ior = ior;
    surface.specular_roughness = roughness;
}

/// The roughness whose square is the alpha of this one.
fn roughness_of(export: &mut Export<'_>, draft: &Draft<'_>, desc: &RoughnessDesc) -> ScalarDesc {
    if desc.v.as_ref().is_some_and(|v| *v != desc.u) {
        export.warnings.note(&draft.at, "the roughness along u is written for all directions");
    }
    match &desc.u {
        ScalarDesc::Value(x) => {
            let root = x.max(0.0).sqrt();
            let roughness = match desc.map {
                RoughnessMap::Alpha => root,
                RoughnessMap::Sqrt => root.sqrt(),
                RoughnessMap::Square => *x,
            };
            roughness.min(1.0).into()
        }
        texture => {
            if desc.map != RoughnessMap::Square {
                let message = "the texture of roughness is read as if its square were alpha";
                export.warnings.note(&draft.at, message);
            }
            texture.clone()
        }
    }
}

/// What a metal reflects straight on: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
fn metal_color(metal: &ConductorDesc) -> ColorDesc {
    match metal {
        ConductorDesc::Reflectance { reflectance } => reflectance.clone(),
        ConductorDesc::Index { eta, k } => ColorDesc::Solid([0, 1, 2].map(|i| {
            let k2 = k[i] * k[i];
            let [less, more] = [eta[i] - 1.0, eta[i] + 1.0];
            (less * less + k2) / (more * more + k2)
        })),
    }
}
