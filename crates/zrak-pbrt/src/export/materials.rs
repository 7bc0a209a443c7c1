//! Materials, each as a named one.

use zrak_scene::desc::{
    CoatDesc, ColorDesc, ConductorDesc, FresnelDesc, MaterialDesc, PrincipledDesc, RoughnessDesc,
    RoughnessMap, ScalarDesc,
};
use zrak_scene::error::SceneError;
use zrak_scene::lower::Transform;

use super::Writer;
use super::text::{param, quoted, word};

type Result<T> = std::result::Result<T, SceneError>;

impl Writer<'_, '_> {
    /// Name of a material that scatters.
    pub(super) fn material(&mut self, name: &str) -> Result<String> {
        if let Some(known) = self.materials.get(name) {
            return Ok(known.clone());
        }
        let written = self.material_with(name, name, "")?;
        self.materials.insert(name.to_owned(), written.clone());
        Ok(written)
    }

    /// Writes a material under a name of its own, with more parameters.
    pub(super) fn material_with(&mut self, name: &str, wanted: &str, more: &str) -> Result<String> {
        let desc = self.desc;
        let params = match desc.materials.get(name) {
            Some(material) => self.material_params(material)?,
            None => kind("diffuse"),
        };
        let written = self.unique_name("material", wanted);
        self.out += &format!("MakeNamedMaterial {}{params}{more}\n", quoted(&written));
        Ok(written)
    }

    fn material_params(&mut self, material: &MaterialDesc) -> Result<String> {
        Ok(match material {
            MaterialDesc::Lambertian { color } => {
                kind("diffuse") + &self.color("reflectance", color)?
            }
            MaterialDesc::Metal { color, fuzz } => {
                self.warn(
                    "fuzzy metals are written as rough conductors, which darken and spread light \
                     in another way",
                );
                kind("conductor")
                    + &self.color("reflectance", color)?
                    + &param("float", "roughness", [*fuzz])
                    + " \"bool remaproughness\" false"
            }
            MaterialDesc::Dielectric { ior, fresnel } => {
                if *fresnel == FresnelDesc::Schlick {
                    self.warn("dielectrics reflect by Fresnel's equations, not Schlick's");
                }
                kind("dielectric") + &param("float", "eta", [*ior])
            }
            MaterialDesc::RoughDielectric { ior, roughness } => {
                let rough = self.roughness(&[("", roughness)])?;
                kind("dielectric") + &param("float", "eta", [*ior]) + &rough
            }
            MaterialDesc::ThinDielectric { ior } => {
                kind("thindielectric") + &param("float", "eta", [*ior])
            }
            MaterialDesc::Isotropic { .. } | MaterialDesc::DiffuseLight { .. } => black(),
            MaterialDesc::Conductor { metal, roughness } => {
                let metal = self.metal(metal, "")?;
                kind("conductor") + &metal + &self.roughness(&[("", roughness)])?
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                kind("diffusetransmission")
                    + &self.color("reflectance", reflectance)?
                    + &self.color("transmittance", transmittance)?
            }
            MaterialDesc::CoatedDiffuse { color, coat } => {
                let rough = self.roughness(&[("", &coat.roughness)])?;
                kind("coateddiffuse")
                    + &self.color("reflectance", color)?
                    + &rough
                    + &of_coat(coat, "")
            }
            MaterialDesc::CoatedConductor { metal, metal_roughness, coat } => {
                let rough = self.roughness(&[
                    ("conductor.", metal_roughness),
                    ("interface.", &coat.roughness),
                ])?;
                let metal = self.metal(metal, "conductor.")?;
                kind("coatedconductor") + &metal + &rough + &of_coat(coat, "interface.")
            }
            MaterialDesc::Mix { materials: [a, b], amount } => {
                let (a, b) = (self.material(a)?, self.material(b)?);
                kind("mix")
                    + &format!(" \"string materials\" [ {} {} ]", quoted(&a), quoted(&b))
                    + &self.scalar("amount", amount)?
            }
            MaterialDesc::Interface => kind("interface"),
            MaterialDesc::Principled { surface } => self.principled(surface)?,
            // Nothing is made of surfaces but shapes.
            MaterialDesc::Surface { .. } => kind("diffuse"),
        })
    }

    fn metal(&mut self, metal: &ConductorDesc, prefix: &str) -> Result<String> {
        match metal {
            ConductorDesc::Index { eta, k } => Ok(param("rgb", &format!("{prefix}eta"), *eta)
                + &param("rgb", &format!("{prefix}k"), *k)),
            ConductorDesc::Reflectance { reflectance } => self.color("reflectance", reflectance),
        }
    }

    /// Roughnesses, which pbrt maps all or none of a material's.
    fn roughness(&mut self, all: &[(&str, &RoughnessDesc)]) -> Result<String> {
        let is_mapped = all.iter().any(|(_, r)| r.map == RoughnessMap::Sqrt)
            && all.iter().all(|(_, r)| r.is_smooth() || r.map == RoughnessMap::Sqrt);
        let mut out = String::new();
        for (prefix, roughness) in all {
            let map = if is_mapped { RoughnessMap::Alpha } else { roughness.map };
            let mut one = |writer: &mut Self, key: &str, value: &ScalarDesc| -> Result<()> {
                let value = writer.mapped_roughness(value, map)?;
                out += &writer.scalar(&format!("{prefix}{key}"), &value)?;
                Ok(())
            };
            match &roughness.v {
                None => one(self, "roughness", &roughness.u)?,
                Some(v) => {
                    one(self, "uroughness", &roughness.u)?;
                    one(self, "vroughness", v)?;
                }
            }
        }
        out += if is_mapped {
            " \"bool remaproughness\" true"
        } else {
            " \"bool remaproughness\" false"
        };
        Ok(out)
    }

    fn mapped_roughness(&mut self, value: &ScalarDesc, map: RoughnessMap) -> Result<ScalarDesc> {
        Ok(match (value, map) {
            (ScalarDesc::Value(x), RoughnessMap::Sqrt) => ScalarDesc::Value(x.sqrt()),
            (ScalarDesc::Value(x), RoughnessMap::Square) => ScalarDesc::Value(x * x),
            (ScalarDesc::Texture(_), RoughnessMap::Sqrt | RoughnessMap::Square) => {
                self.warn("roughness from a texture is taken as it is, neither squared nor rooted");
                value.clone()
            }
            (_, RoughnessMap::Alpha) => value.clone(),
        })
    }

    /// The nearest thing to a principled surface: glass, metal, or something under a coat.
    fn principled(&mut self, p: &PrincipledDesc) -> Result<String> {
        self.warn(
            "principled surfaces are written as glass, metal, or diffuse ones under a clear coat, \
             whichever is nearest",
        );
        let is_most = |x: &ScalarDesc| matches!(x, ScalarDesc::Value(x) if *x >= 0.5);
        let rough =
            RoughnessDesc { u: p.specular_roughness.clone(), v: None, map: RoughnessMap::Square };
        let rough = self.roughness(&[("", &rough)])?;
        let eta = param("float", "eta", [p.specular_ior]);
        if is_most(&p.transmission_weight) {
            if p.geometry_thin_walled {
                return Ok(kind("thindielectric") + &eta);
            }
            return Ok(kind("dielectric") + &eta + &rough);
        }
        let weight = match p.base_weight {
            ScalarDesc::Value(x) => x,
            ScalarDesc::Texture(_) => 1.0,
        };
        let color = match &p.base_color {
            ColorDesc::Solid(color) => ColorDesc::Solid(color.map(|x| x * weight)),
            texture @ ColorDesc::Texture(_) => texture.clone(),
        };
        let color = self.color("reflectance", &color)?;
        if is_most(&p.base_metalness) {
            return Ok(kind("conductor") + &color + &rough);
        }
        if p.specular_weight == ScalarDesc::Value(0.0) {
            return Ok(kind("diffuse") + &color);
        }
        Ok(kind("coateddiffuse") + &color + &rough + &eta)
    }

    /// Parameters of bumps and normal maps.
    pub(super) fn bumps(
        &mut self,
        bump: Option<&ScalarDesc>,
        normal_map: Option<&str>,
        normal_scale: f64,
    ) -> Result<String> {
        let mut out = String::new();
        match bump {
            Some(ScalarDesc::Texture(name)) => {
                let name = self.texture(name, true, &Transform::IDENTITY)?;
                out += &word("texture", "displacement", &name);
            }
            // All of it is as high: no bump.
            Some(ScalarDesc::Value(_)) | None => {}
        }
        if let Some(name) = normal_map {
            let desc = self.desc;
            match desc.textures.get(name) {
                Some(zrak_scene::desc::TextureDesc::Image { path, .. }) => {
                    let path = self.copied(path)?;
                    out += &word("string", "normalmap", &path);
                    if normal_scale != 1.0 {
                        self.warn("normal maps are not scaled in pbrt");
                    }
                }
                _ => self.warn("normal maps that are no pictures are not written"),
            }
        }
        Ok(out)
    }
}

fn kind(name: &str) -> String {
    word("string", "type", name)
}

fn black() -> String {
    kind("diffuse") + &param("rgb", "reflectance", [0; 3])
}

fn of_coat(coat: &CoatDesc, prefix: &str) -> String {
    param("float", &format!("{prefix}eta"), [coat.ior])
        + &param("float", "thickness", [coat.thickness])
        + &param("rgb", "albedo", coat.albedo)
        + &param("float", "g", [coat.g])
        + &param("integer", "maxdepth", [coat.max_depth])
        + &param("integer", "nsamples", [coat.n_samples])
}
