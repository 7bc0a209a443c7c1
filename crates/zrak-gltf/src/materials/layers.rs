//! What extensions add to the metallic-roughness model.

use zrak_scene::desc::{ColorDesc, ImageChannel, PrincipledDesc, ScalarDesc, TextureDesc};

use super::{Materials, Work, unit};
use crate::error::{Error, Warnings};
use crate::json::TextureInfo;
use crate::textures::Look;

impl Materials<'_> {
    pub(super) fn layers(
        &mut self,
        work: &Work<'_>,
        surface: &mut PrincipledDesc,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let e = &work.material.extensions;
        let at = |extension: &str| format!("{}.extensions.KHR_materials_{extension}", work.at);
        if let Some(ior) = &e.ior {
            surface.specular_ior = ior.ior;
            if ior.ior < 1.0 {
                // 0 stands for a perfect mirror in materials that were converted.
                warnings.note(
                    at("ior"),
                    format!("an index of refraction of {} is taken as 1.5", ior.ior),
                );
                surface.specular_ior = 1.5;
            }
        }
        self.transmission(work, surface, warnings)?;
        self.specular(work, surface, warnings)?;
        if let Some(coat) = &e.clearcoat {
            let at = at("clearcoat");
            let factor = unit(coat.clearcoat_factor);
            let info = coat.clearcoat_texture.as_ref();
            surface.coat_weight =
                self.textures.scalar(factor, info, ImageChannel::R, &at, warnings)?;
            let factor = unit(coat.clearcoat_roughness_factor);
            let info = coat.clearcoat_roughness_texture.as_ref();
            surface.coat_roughness =
                self.textures.scalar(factor, info, ImageChannel::G, &at, warnings)?;
            surface.coat_ior = 1.5;
            // glTF has no light that bounces between coat and base.
            surface.coat_darkening = 0.0.into();
            if coat.clearcoat_normal_texture.is_some() {
                warnings.note(at, "the coat has the base's normals, not those of its own texture");
            }
        }
        if let Some(sheen) = &e.sheen {
            let at = at("sheen");
            let factor = sheen.sheen_color_factor.map(unit);
            let weight = factor.iter().fold(0.0_f64, |m, &x| m.max(x));
            if weight > 0.0 {
                let texture =
                    self.color_texture(sheen.sheen_color_texture.as_ref(), &at, warnings)?;
                surface.fuzz_weight = weight.into();
                surface.fuzz_color = self.textures.times(factor.map(|x| x / weight), texture);
                let factor = unit(sheen.sheen_roughness_factor);
                let info = sheen.sheen_roughness_texture.as_ref();
                surface.fuzz_roughness =
                    self.textures.scalar(factor, info, ImageChannel::A, &at, warnings)?;
            }
        }
        if let Some(film) = &e.iridescence {
            let at = at("iridescence");
            let info = film.iridescence_texture.as_ref();
            let factor = unit(film.iridescence_factor);
            surface.thin_film_weight =
                self.textures.scalar(factor, info, ImageChannel::R, &at, warnings)?;
            surface.thin_film_ior = film.iridescence_ior.max(1.0);
            // glTF counts in nanometres.
            let [min, max] = [
                film.iridescence_thickness_minimum.max(0.0) / 1000.0,
                film.iridescence_thickness_maximum.max(0.0) / 1000.0,
            ];
            let info = film.iridescence_thickness_texture.as_ref();
            surface.thin_film_thickness =
                match self.textures.scalar(1.0, info, ImageChannel::G, &at, warnings)? {
                    ScalarDesc::Value(_) => max.into(),
                    amount => {
                        let (a, b) = (ColorDesc::Solid([min; 3]), ColorDesc::Solid([max; 3]));
                        let mix = TextureDesc::Mix { a, b, amount };
                        ScalarDesc::Texture(self.textures.add(mix, "film thickness"))
                    }
                };
        }
        if let Some(anisotropy) = &e.anisotropy {
            let at = at("anisotropy");
            if anisotropy.anisotropy_texture.is_some() {
                warnings
                    .note(&at, "its texture is ignored: the whole surface has the same strength");
            }
            let half_turns = anisotropy.anisotropy_rotation / std::f64::consts::PI;
            if (half_turns - half_turns.round()).abs() > 1e-3 {
                warnings.note(&at, "its rotation is ignored: brushes run along the tangent");
            }
            stretch(surface, unit(anisotropy.anisotropy_strength));
        }
        if e.dispersion.is_some() {
            warnings.note(at("dispersion"), "zrak has no dispersion: all colours bend alike");
        }
        Ok(())
    }

    fn transmission(
        &mut self,
        work: &Work<'_>,
        surface: &mut PrincipledDesc,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let e = &work.material.extensions;
        let Some(transmission) = &e.transmission else { return Ok(()) };
        let at = format!("{}.extensions.KHR_materials_transmission", work.at);
        let factor = unit(transmission.transmission_factor);
        let info = transmission.transmission_texture.as_ref();
        surface.transmission_weight =
            self.textures.scalar(factor, info, ImageChannel::R, &at, warnings)?;
        surface.transmission_color = surface.base_color.clone();
        surface.geometry_thin_walled = e.volume.as_ref().is_none_or(|v| v.thickness_factor <= 0.0);
        Ok(())
    }

    fn specular(
        &mut self,
        work: &Work<'_>,
        surface: &mut PrincipledDesc,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let Some(specular) = &work.material.extensions.specular else { return Ok(()) };
        // It is only about dielectrics, OpenPBR's also about the rims of metals.
        if surface.base_metalness == ScalarDesc::Value(1.0) {
            return Ok(());
        }
        let at = format!("{}.extensions.KHR_materials_specular", work.at);
        let factor = unit(specular.specular_factor);
        let info = specular.specular_texture.as_ref();
        surface.specular_weight =
            self.textures.scalar(factor, info, ImageChannel::A, &at, warnings)?;
        let mut factor = specular.specular_color_factor.map(|x| x.max(0.0));
        let largest = factor.iter().fold(0.0_f64, |m, &x| m.max(x));
        if largest > 1.0 {
            factor = factor.map(|x| x / largest);
            if surface.transmission_weight == ScalarDesc::Value(0.0) {
                // More than the index gives is what a larger index gives.
                surface.specular_ior = ior_of(largest * reflectance_of(surface.specular_ior));
            } else {
                warnings
                    .note(&at, "a specular colour above 1 is taken as 1 where light goes through");
            }
        }
        let texture =
            self.color_texture(specular.specular_color_texture.as_ref(), &at, warnings)?;
        surface.specular_color = self.textures.times(factor, texture);
        Ok(())
    }

    /// KHR_materials_pbrSpecularGlossiness, an archived extension that many files have.
    pub(super) fn specular_glossiness(
        &mut self,
        work: &Work<'_>,
        old: &crate::json::SpecularGlossiness,
        surface: &mut PrincipledDesc,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let at = format!("{}.extensions.KHR_materials_pbrSpecularGlossiness", work.at);
        warnings.note(&at, "the archived model is approximated by the metallic-roughness one");
        let specular = old.specular_factor.map(unit);
        let largest = specular.iter().fold(0.0_f64, |m, &x| m.max(x));
        let info = old.specular_glossiness_texture.as_ref();
        if info.is_some() {
            // White times a texture says nothing of how much is reflected: most of it is dielectric.
            surface.specular_color = ColorDesc::Solid([1.0; 3]);
        } else if largest > 0.5 {
            surface.base_metalness = 1.0.into();
            surface.base_color = ColorDesc::Solid(specular);
        } else if largest > 0.0 {
            surface.specular_ior = ior_of(largest);
            surface.specular_color = ColorDesc::Solid(specular.map(|x| x / largest));
        } else {
            surface.specular_weight = 0.0.into();
        }
        let gloss = unit(old.glossiness_factor);
        surface.specular_roughness =
            match self.textures.scalar(1.0, info, ImageChannel::A, &at, warnings)? {
                ScalarDesc::Value(_) => (1.0 - gloss).into(),
                amount => {
                    let [a, b] = [1.0, 1.0 - gloss].map(|x| ColorDesc::Solid([x; 3]));
                    let mix = TextureDesc::Mix { a, b, amount };
                    ScalarDesc::Texture(self.textures.add(mix, "roughness of gloss"))
                }
            };
        Ok(())
    }

    fn color_texture(
        &mut self,
        info: Option<&TextureInfo>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<String>, Error> {
        match info {
            Some(info) => self.textures.image(info, Look::COLOR, at, warnings),
            None => Ok(None),
        }
    }
}

/// Gives the anisotropy for which OpenPBR's two alphas are glTF's.
///
/// With a = roughness^2 and strength s, glTF has alpha_t = a + (1 - a) s^2 and alpha_b = a. OpenPBR, with
/// roughness r and anisotropy k, has alpha_t = r^2 sqrt(2 / (1 + (1 - k)^2)) and alpha_b = (1 - k) alpha_t.
/// So 1 - k = a / alpha_t, and r follows. A texture of roughness keeps the ratio at its factor's.
fn stretch(surface: &mut PrincipledDesc, strength: f64) {
    let roughness = match &surface.specular_roughness {
        ScalarDesc::Value(r) => *r,
        // What the ratio is at a middling roughness.
        ScalarDesc::Texture(_) => 0.5,
    };
    let a = roughness * roughness;
    let alpha_t = a + (1.0 - a) * strength * strength;
    if alpha_t <= 0.0 {
        return;
    }
    let ratio = a / alpha_t;
    surface.specular_roughness_anisotropy = (1.0 - ratio).into();
    if let ScalarDesc::Value(r) = &mut surface.specular_roughness {
        *r = (alpha_t / (2.0 / (1.0 + ratio * ratio)).sqrt()).sqrt().min(1.0);
    }
}

/// How much a dielectric reflects straight on.
pub(crate) fn reflectance_of(ior: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    root * root
}

/// The index of refraction of a dielectric that reflects this straight on.
pub(crate) fn ior_of(reflectance: f64) -> f64 {
    let root = reflectance.clamp(0.0, 0.95).sqrt();
    (1.0 + root) / (1.0 - root)
}
