//! Materials: glTF's metallic-roughness model and its extensions as the OpenPBR surface, wrapped into a
//! `surface` where there is more than scattering.

mod layers;

use std::collections::{BTreeMap, HashMap};

use zrak_scene::desc::{
    ColorDesc, ImageChannel, LightSides, MaterialDesc, MediumDesc, MediumInterfaceDesc,
    PrincipledDesc, ScalarDesc, TextureDesc, Triple,
};

use crate::buffers::element;
use crate::error::{Error, Warnings};
use crate::json::{Material, TextureInfo};
use crate::names::Names;
use crate::primitive::Source;
use crate::textures::{Look, Textures};

/// The materials that primitives have asked for.
pub(crate) struct Materials<'a> {
    source: &'a Source<'a>,
    pub(crate) textures: Textures<'a>,
    pub(crate) materials: BTreeMap<String, MaterialDesc>,
    pub(crate) media: BTreeMap<String, MediumDesc>,
    /// Whether a material shines enough to light a scene.
    pub(crate) has_light: bool,
    cull_back_faces: bool,
    done: HashMap<(Option<usize>, bool), Translated>,
    names: Names,
}

/// A material, and what primitives must know of it.
#[derive(Clone, Debug)]
pub(crate) struct Translated {
    pub(crate) name: String,
    pub(crate) uv_set: usize,
    pub(crate) needs_uv: bool,
}

/// What is being translated.
struct Work<'m> {
    material: &'m Material,
    /// `materials[3]`.
    at: String,
    has_colors: bool,
}

impl<'a> Materials<'a> {
    pub(crate) fn new(source: &'a Source<'a>, textures: Textures<'a>, cull_back: bool) -> Self {
        Self {
            source,
            textures,
            materials: BTreeMap::new(),
            media: BTreeMap::new(),
            has_light: false,
            cull_back_faces: cull_back,
            done: HashMap::new(),
            names: Names::default(),
        }
    }

    /// The material of this index, or glTF's default one, for meshes with or without colours.
    pub(crate) fn get(
        &mut self,
        index: Option<usize>,
        has_colors: bool,
        location: &str,
        warnings: &mut Warnings,
    ) -> Result<Translated, Error> {
        if let Some(done) = self.done.get(&(index, has_colors)) {
            return Ok(done.clone());
        }
        let default_material = Material::default();
        let (material, at) = match index {
            Some(i) => {
                let at = format!("{location}.material");
                let material = element(&self.source.root.materials, "materials", i, at)?;
                (material, format!("materials[{i}]"))
            }
            None => (&default_material, "the default material".to_owned()),
        };
        let used = used_textures(material);
        let uv_set = used.first().map_or(0, |(_, info)| uv_set(info));
        for (key, info) in &used {
            if uv_set != self::uv_set(info) {
                let message = format!(
                    "it is on TEXCOORD_{}, another texture of the material on TEXCOORD_{uv_set}: \
                     zrak has one set, and takes the latter",
                    self::uv_set(info)
                );
                warnings.note(format_args!("{at}.{key}"), message);
            }
        }
        let fallback = index.map_or("default".to_owned(), |i| format!("material {i}"));
        let name = self.names.unique(material.name.as_deref(), &fallback);
        let work = Work { material, at, has_colors };
        self.translate(&work, &name, warnings)?;
        let done = Translated { name, uv_set, needs_uv: !used.is_empty() };
        self.done.insert((index, has_colors), done.clone());
        Ok(done)
    }

    fn translate(
        &mut self,
        work: &Work<'_>,
        name: &str,
        warnings: &mut Warnings,
    ) -> Result<(), Error> {
        let Work { material, at, .. } = work;
        let extensions = &material.extensions;
        let base = self.base_color(work, warnings)?;
        let is_unlit = extensions.unlit.is_some();
        let scatters = if is_unlit {
            MaterialDesc::Lambertian { color: ColorDesc::Solid([0.0; 3]) }
        } else {
            let surface = self.principled(work, base.clone(), warnings)?;
            MaterialDesc::Principled { surface: Box::new(surface) }
        };
        let mut wrapped = MaterialDesc::surface("");
        let MaterialDesc::Surface {
            emission,
            emission_strength,
            emission_sides,
            alpha,
            alpha_cutoff,
            normal_map,
            normal_scale,
            medium,
            one_sided,
            ..
        } = &mut wrapped
        else {
            return Ok(());
        };
        if is_unlit {
            *emission = Some(base);
            self.has_light = true;
        } else if let Some((color, strength)) = self.emission(work, warnings)? {
            // Textures of small lamps and screens light no scene.
            self.has_light |= matches!(color, ColorDesc::Solid(_)) || strength > 1.0;
            *emission = Some(color);
            *emission_strength = strength;
            if !material.double_sided {
                *emission_sides = LightSides::Front;
            }
        }
        match material.alpha_mode.as_deref() {
            None | Some("OPAQUE") => {}
            Some(mode @ ("MASK" | "BLEND")) => {
                let share = self.alpha(work, warnings)?;
                *alpha = (share != ScalarDesc::Value(1.0)).then_some(share);
                if mode == "MASK" && alpha.is_some() {
                    *alpha_cutoff = Some(material.alpha_cutoff.unwrap_or(0.5));
                }
            }
            Some(mode) => {
                let message = format!("{mode:?} is unknown: the surface is opaque");
                warnings.note(format_args!("{at}.alphaMode"), message);
            }
        }
        if let Some(info) = &material.normal_texture {
            let at = format!("{at}.normalTexture.index");
            let look = Look::number(ImageChannel::Color, 1.0);
            *normal_map = self.textures.image(info, look, &at, warnings)?;
            *normal_scale = info.scale;
        }
        if !is_unlit && let Some(absorbing) = absorption(material) {
            let medium_name = format!("inside {name}");
            self.media.insert(medium_name.clone(), absorbing);
            *medium = Some(MediumInterfaceDesc { inside: Some(medium_name), outside: None });
        }
        *one_sided = self.cull_back_faces && !material.double_sided;
        if wrapped == MaterialDesc::surface("") {
            self.materials.insert(name.to_owned(), scatters);
            return Ok(());
        }
        let inner = self.names.unique(Some(&format!("{name} (base)")), "base");
        if let MaterialDesc::Surface { base, .. } = &mut wrapped {
            base.clone_from(&inner);
        }
        self.materials.insert(inner, scatters);
        self.materials.insert(name.to_owned(), wrapped);
        Ok(())
    }

    /// Factor, texture and the colours of vertices.
    fn base_color(&mut self, work: &Work<'_>, warnings: &mut Warnings) -> Result<ColorDesc, Error> {
        let (factor, info, key) = base_color_of(work.material);
        let factor = [0, 1, 2].map(|i| unit(factor[i]));
        let texture = match info {
            Some(info) => {
                let at = format!("{}.{key}.index", work.at);
                self.textures.image(info, Look::COLOR, &at, warnings)?
            }
            None => None,
        };
        let color = self.textures.times(factor, texture);
        if !work.has_colors {
            return Ok(color);
        }
        let vertices = TextureDesc::VertexColor { channel: ImageChannel::Color };
        let vertices = ColorDesc::Texture(self.textures.add(vertices, "vertex colors"));
        if color == ColorDesc::Solid([1.0; 3]) {
            return Ok(vertices);
        }
        Ok(self.textures.product(color, vertices, "times vertex colors"))
    }

    fn alpha(&mut self, work: &Work<'_>, warnings: &mut Warnings) -> Result<ScalarDesc, Error> {
        let (factor, info, key) = base_color_of(work.material);
        let at = format!("{}.{key}.index", work.at);
        let alpha = self.textures.scalar(unit(factor[3]), info, ImageChannel::A, &at, warnings)?;
        if !work.has_colors {
            return Ok(alpha);
        }
        let vertices = TextureDesc::VertexColor { channel: ImageChannel::A };
        let vertices = self.textures.add(vertices, "vertex alpha");
        let alpha = match alpha {
            ScalarDesc::Value(1.0) => return Ok(ScalarDesc::Texture(vertices)),
            ScalarDesc::Value(x) => ColorDesc::Solid([x; 3]),
            ScalarDesc::Texture(name) => ColorDesc::Texture(name),
        };
        match self.textures.product(alpha, ColorDesc::Texture(vertices), "times vertex alpha") {
            ColorDesc::Texture(name) => Ok(ScalarDesc::Texture(name)),
            ColorDesc::Solid([x, ..]) => Ok(ScalarDesc::Value(x)),
        }
    }

    /// Colour and factor of the emitted radiance, if there is any.
    fn emission(
        &mut self,
        work: &Work<'_>,
        warnings: &mut Warnings,
    ) -> Result<Option<(ColorDesc, f64)>, Error> {
        let material = work.material;
        let factor = material.emissive_factor.map(|x| x.max(0.0));
        let strength = &material.extensions.emissive_strength;
        let strength = strength.as_ref().map_or(1.0, |s| s.emissive_strength.max(0.0));
        if factor == [0.0; 3] || strength == 0.0 {
            return Ok(None);
        }
        let texture = match &material.emissive_texture {
            Some(info) => {
                let at = format!("{}.emissiveTexture.index", work.at);
                self.textures.image(info, Look::COLOR, &at, warnings)?
            }
            None => None,
        };
        Ok(Some((self.textures.times(factor, texture), strength)))
    }

    /// The OpenPBR surface of a material with this base colour.
    fn principled(
        &mut self,
        work: &Work<'_>,
        base_color: ColorDesc,
        warnings: &mut Warnings,
    ) -> Result<PrincipledDesc, Error> {
        let mut surface = PrincipledDesc { base_color, ..PrincipledDesc::default() };
        if let Some(old) = &work.material.extensions.specular_glossiness {
            self.specular_glossiness(work, old, &mut surface, warnings)?;
        } else {
            let pbr = &work.material.pbr_metallic_roughness;
            let at = format!("{}.pbrMetallicRoughness.metallicRoughnessTexture.index", work.at);
            let info = pbr.metallic_roughness_texture.as_ref();
            let mut channel = |factor: f64, channel| {
                self.textures.scalar(unit(factor), info, channel, &at, warnings)
            };
            surface.base_metalness = channel(pbr.metallic_factor, ImageChannel::B)?;
            surface.specular_roughness = channel(pbr.roughness_factor, ImageChannel::G)?;
        }
        self.layers(work, &mut surface, warnings)?;
        Ok(surface)
    }
}

/// Factor, texture and place of the base colour.
fn base_color_of(material: &Material) -> ([f64; 4], Option<&TextureInfo>, &'static str) {
    match &material.extensions.specular_glossiness {
        Some(old) => (
            old.diffuse_factor,
            old.diffuse_texture.as_ref(),
            "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
        ),
        None => {
            let pbr = &material.pbr_metallic_roughness;
            let key = "pbrMetallicRoughness.baseColorTexture";
            (pbr.base_color_factor, pbr.base_color_texture.as_ref(), key)
        }
    }
}

/// The medium that absorbs in a closed surface.
fn absorption(material: &Material) -> Option<MediumDesc> {
    material.extensions.transmission.as_ref()?;
    let volume = material.extensions.volume.as_ref().filter(|v| v.thickness_factor > 0.0)?;
    let distance = volume.attenuation_distance.filter(|&d| d > 0.0)?;
    // Black would need an infinite coefficient.
    let sigma_a: Triple = volume
        .attenuation_color
        .map(|c| (-libm::log(c.clamp(1e-6, 1.0)) / distance).min(1e12) + 0.0);
    (sigma_a != [0.0; 3]).then_some(MediumDesc { sigma_a, sigma_s: [0.0; 3], g: 0.0 })
}

/// The set of texture coordinates of a texture.
fn uv_set(info: &TextureInfo) -> usize {
    info.extensions.transform.as_ref().and_then(|t| t.tex_coord).unwrap_or(info.tex_coord)
}

/// The textures that a material is made of, the most important first.
fn used_textures(material: &Material) -> Vec<(&'static str, &TextureInfo)> {
    let e = &material.extensions;
    let (_, base, base_key) = base_color_of(material);
    if e.unlit.is_some() {
        return base.map(|info| (base_key, info)).into_iter().collect();
    }
    let pbr = &material.pbr_metallic_roughness;
    let mut all = vec![
        (base_key, base),
        ("normalTexture", material.normal_texture.as_ref()),
        ("emissiveTexture", material.emissive_texture.as_ref()),
    ];
    match &e.specular_glossiness {
        None => {
            let info = pbr.metallic_roughness_texture.as_ref();
            all.push(("pbrMetallicRoughness.metallicRoughnessTexture", info));
        }
        Some(old) => {
            let info = old.specular_glossiness_texture.as_ref();
            all.push(("extensions.KHR_materials_pbrSpecularGlossiness", info));
        }
    }
    if let Some(t) = &e.transmission {
        all.push(("extensions.KHR_materials_transmission", t.transmission_texture.as_ref()));
    }
    if let Some(c) = &e.clearcoat {
        all.push(("extensions.KHR_materials_clearcoat", c.clearcoat_texture.as_ref()));
        all.push(("extensions.KHR_materials_clearcoat", c.clearcoat_roughness_texture.as_ref()));
    }
    if let Some(s) = &e.sheen {
        all.push(("extensions.KHR_materials_sheen", s.sheen_color_texture.as_ref()));
        all.push(("extensions.KHR_materials_sheen", s.sheen_roughness_texture.as_ref()));
    }
    if let Some(s) = &e.specular {
        all.push(("extensions.KHR_materials_specular", s.specular_texture.as_ref()));
        all.push(("extensions.KHR_materials_specular", s.specular_color_texture.as_ref()));
    }
    if let Some(i) = &e.iridescence {
        all.push(("extensions.KHR_materials_iridescence", i.iridescence_texture.as_ref()));
        let info = i.iridescence_thickness_texture.as_ref();
        all.push(("extensions.KHR_materials_iridescence", info));
    }
    all.into_iter().filter_map(|(key, info)| Some((key, info?))).collect()
}

/// A factor in the range that the specification gives it.
fn unit(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}
