//! The OpenPBR surface as a metallic-roughness material with extensions.

use serde_json::{Value, json};
use zrak_scene::desc::{ColorDesc, ImageChannel, PrincipledDesc, ScalarDesc};

use super::Export;
use super::materials::{Draft, Materials};
use super::textures::{Color, Picture, Scalar};

impl Materials {
    pub(super) fn principled(
        &mut self,
        export: &mut Export<'_>,
        draft: &mut Draft<'_>,
        s: &PrincipledDesc,
    ) {
        let is_transparent = s.transmission_weight != ScalarDesc::Value(0.0);
        let base = if is_transparent && s.base_metalness == ScalarDesc::Value(0.0) {
            &s.transmission_color
        } else {
            &s.base_color
        };
        let Color { factor, picture, has_vertices } = self.textures.color(export, base);
        let weight = self.constant(export, draft, "base_weight", &s.base_weight);
        let factor = factor.map(|x| (x * weight).clamp(0.0, 1.0));
        draft.has_colors |= has_vertices;
        let [r, g, b] = factor;
        let pbr = &mut draft.json["pbrMetallicRoughness"];
        pbr["baseColorFactor"] = json!([r, g, b, 1.0]);
        if let Some(picture) = picture {
            pbr["baseColorTexture"] = picture.info;
        }
        self.metallic_roughness(export, draft, s);
        let f = |x: f64| json!(x.clamp(0.0, 1.0));
        if s.specular_ior != 1.5 {
            if s.specular_ior < 1.0 {
                let message = "glTF has no index of refraction below 1: it is 1";
                export.warnings.note(&draft.at, message);
            }
            draft
                .extensions
                .insert("KHR_materials_ior".into(), json!({"ior": s.specular_ior.max(1.0)}));
        }
        let is_white = s.specular_color == ColorDesc::Solid([1.0; 3]);
        if s.specular_weight != ScalarDesc::Value(1.0) || !is_white {
            let color = self.textures.color(export, &s.specular_color);
            let weight = self.textures.scalar(export, &s.specular_weight);
            let mut json = json!({"specularFactor": f(weight.factor),
                                  "specularColorFactor": color.factor});
            set(&mut json, "specularColorTexture", color.picture);
            self.set_channel(
                export,
                draft,
                &mut json,
                "specularTexture",
                weight.picture,
                ImageChannel::A,
            );
            draft.extensions.insert("KHR_materials_specular".into(), json);
        }
        if is_transparent {
            let weight = self.textures.scalar(export, &s.transmission_weight);
            let mut json = json!({"transmissionFactor": f(weight.factor)});
            let key = "transmissionTexture";
            self.set_channel(export, draft, &mut json, key, weight.picture, ImageChannel::R);
            draft.extensions.insert("KHR_materials_transmission".into(), json);
            if !s.geometry_thin_walled {
                let volume = json!({"thicknessFactor": 1.0});
                draft.extensions.insert("KHR_materials_volume".into(), volume);
            }
        }
        if s.coat_weight != ScalarDesc::Value(0.0) {
            let weight = self.textures.scalar(export, &s.coat_weight);
            let roughness = self.textures.scalar(export, &s.coat_roughness);
            let mut json = json!({"clearcoatFactor": f(weight.factor),
                                  "clearcoatRoughnessFactor": f(roughness.factor)});
            let key = "clearcoatTexture";
            self.set_channel(export, draft, &mut json, key, weight.picture, ImageChannel::R);
            let key = "clearcoatRoughnessTexture";
            self.set_channel(export, draft, &mut json, key, roughness.picture, ImageChannel::G);
            draft.extensions.insert("KHR_materials_clearcoat".into(), json);
            if s.coat_color != ColorDesc::Solid([1.0; 3]) {
                export.warnings.note(&draft.at, "glTF's coats are clear: the colour is left out");
            }
        }
        if s.fuzz_weight != ScalarDesc::Value(0.0) {
            let weight = self.constant(export, draft, "fuzz_weight", &s.fuzz_weight);
            let color = self.textures.color(export, &s.fuzz_color);
            let roughness = self.textures.scalar(export, &s.fuzz_roughness);
            let mut json = json!({"sheenColorFactor": color.factor.map(|x| (x * weight).clamp(0.0, 1.0)),
                                  "sheenRoughnessFactor": f(roughness.factor)});
            set(&mut json, "sheenColorTexture", color.picture);
            let key = "sheenRoughnessTexture";
            self.set_channel(export, draft, &mut json, key, roughness.picture, ImageChannel::A);
            draft.extensions.insert("KHR_materials_sheen".into(), json);
        }
        if s.thin_film_weight != ScalarDesc::Value(0.0) {
            let weight = self.textures.scalar(export, &s.thin_film_weight);
            let thickness =
                self.constant(export, draft, "thin_film_thickness", &s.thin_film_thickness);
            let mut json = json!({"iridescenceFactor": f(weight.factor),
                                  "iridescenceIor": s.thin_film_ior,
                                  "iridescenceThicknessMaximum": thickness * 1000.0});
            let key = "iridescenceTexture";
            self.set_channel(export, draft, &mut json, key, weight.picture, ImageChannel::R);
            draft.extensions.insert("KHR_materials_iridescence".into(), json);
        }
        if s.subsurface_weight != ScalarDesc::Value(0.0) {
            export.warnings.note(&draft.at, "glTF has no light below the surface: it is left out");
        }
    }

    /// Metalness and roughness, which glTF has in two channels of one picture.
    fn metallic_roughness(
        &mut self,
        export: &mut Export<'_>,
        draft: &mut Draft<'_>,
        s: &PrincipledDesc,
    ) {
        let metal = self.textures.scalar(export, &s.base_metalness);
        let mut rough = self.textures.scalar(export, &s.specular_roughness);
        let fits = |scalar: &Scalar, channel| {
            scalar.picture.as_ref().is_none_or(|picture| picture.channel == channel)
        };
        let infos = [&metal, &rough].map(|x| x.picture.as_ref().map(|p| p.info.clone()));
        let one_picture = match &infos {
            [Some(a), Some(b)] => a == b,
            // The other channel must not matter.
            [Some(_), None] => rough.factor == 0.0,
            [None, Some(_)] => metal.factor == 0.0,
            [None, None] => true,
        };
        let is_good = one_picture && fits(&metal, ImageChannel::B) && fits(&rough, ImageChannel::G);
        if let ScalarDesc::Value(k) = s.specular_roughness_anisotropy
            && k > 0.0
        {
            self.brushes(draft, &mut rough, k.min(1.0));
        }
        let pbr = &mut draft.json["pbrMetallicRoughness"];
        pbr["metallicFactor"] = json!(metal.factor.clamp(0.0, 1.0));
        pbr["roughnessFactor"] = json!(rough.factor.clamp(0.0, 1.0));
        if is_good {
            if let Some(info) = infos.into_iter().flatten().next() {
                pbr["metallicRoughnessTexture"] = info;
            }
        } else {
            let message = "glTF has metalness and roughness in the channels B and G of one picture: \
                           theirs are left out";
            export.warnings.note(&draft.at, message);
        }
    }

    /// Anisotropy, by which OpenPBR's two alphas are glTF's; see `materials::layers`.
    fn brushes(&mut self, draft: &mut Draft<'_>, rough: &mut Scalar, k: f64) {
        let ratio = 1.0 - k;
        let along = rough.factor * rough.factor * (2.0 / (1.0 + ratio * ratio)).sqrt();
        let across = ratio * along;
        let strength =
            if across < 1.0 { ((along - across) / (1.0 - across)).max(0.0).sqrt() } else { 0.0 };
        rough.factor = across.sqrt();
        let json = json!({"anisotropyStrength": strength.min(1.0)});
        draft.extensions.insert("KHR_materials_anisotropy".into(), json);
    }

    /// A number that glTF has no texture for.
    fn constant(
        &mut self,
        export: &mut Export<'_>,
        draft: &Draft<'_>,
        key: &str,
        input: &ScalarDesc,
    ) -> f64 {
        let Scalar { factor, picture, .. } = self.textures.scalar(export, input);
        if picture.is_some() {
            export.warnings.note(&draft.at, format!("the texture of `{key}` is left out"));
        }
        factor
    }

    /// Sets a texture whose channel glTF prescribes.
    fn set_channel(
        &mut self,
        export: &mut Export<'_>,
        draft: &Draft<'_>,
        json: &mut Value,
        key: &str,
        picture: Option<Picture>,
        channel: ImageChannel,
    ) {
        match picture {
            Some(picture) if picture.channel != channel => {
                let message = format!("glTF's {key} is in channel {channel:?}: it is left out");
                export.warnings.note(&draft.at, message);
            }
            picture => set(json, key, picture),
        }
    }
}

fn set(json: &mut Value, key: &str, picture: Option<Picture>) {
    if let Some(picture) = picture {
        json[key] = picture.info;
    }
}
