//! Textures and the pictures in them.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, ScalarDesc, TextureDesc,
    Triple, WrapMode,
};

use crate::buffers::element;
use crate::error::{Error, ErrorKind, Warnings};
use crate::json::{Sampler, TextureInfo};
use crate::names::Names;
use crate::primitive::Source;
use crate::uri::{self, Target};

/// What the path of a picture inside the glTF file starts with; the rest is its name in the assets.
pub const EMBEDDED: &str = "embedded:";

/// The textures that materials have asked for.
pub(crate) struct Textures<'a> {
    source: &'a Source<'a>,
    allow_external: bool,
    pub(crate) textures: BTreeMap<String, TextureDesc>,
    pub(crate) assets: BTreeMap<String, Arc<[u8]>>,
    /// Paths of the images; none if one cannot be used.
    paths: HashMap<usize, Option<String>>,
    /// Names of the textures, by what they are.
    known: HashMap<String, String>,
    names: Names,
    asset_names: Names,
}

/// How a texture is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub(crate) encoding: ImageEncoding,
    pub(crate) channel: ImageChannel,
    pub(crate) scale: f64,
}

impl Look {
    /// Red, green and blue of a colour.
    pub(crate) const COLOR: Self =
        Self { encoding: ImageEncoding::Srgb, channel: ImageChannel::Color, scale: 1.0 };

    /// A number times `scale`.
    pub(crate) fn number(channel: ImageChannel, scale: f64) -> Self {
        Self { encoding: ImageEncoding::Linear, channel, scale }
    }
}

impl<'a> Textures<'a> {
    pub(crate) fn new(source: &'a Source<'a>, allow_external: bool) -> Self {
        Self {
            source,
            allow_external,
            textures: BTreeMap::new(),
            assets: BTreeMap::new(),
            paths: HashMap::new(),
            known: HashMap::new(),
            names: Names::default(),
            asset_names: Names::default(),
        }
    }

    /// The name of a texture; none if its picture cannot be used.
    pub(crate) fn image(
        &mut self,
        info: &TextureInfo,
        look: Look,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<String>, Error> {
        let root = self.source.root;
        let texture = element(&root.textures, "textures", info.index, at)?;
        let location = format!("textures[{}]", info.index);
        let default_sampler = Sampler::default();
        let sampler = match texture.sampler {
            Some(i) => element(&root.samplers, "samplers", i, format_args!("{location}.sampler"))?,
            None => &default_sampler,
        };
        let Some(source) = texture.source else {
            let extensions = &texture.extensions;
            let what = match extensions {
                e if e.basisu.is_some() => "a KTX2 picture (KHR_texture_basisu)",
                e if e.webp.is_some() => "a WebP picture (EXT_texture_webp)",
                e if e.avif.is_some() => "an AVIF picture (EXT_texture_avif)",
                e if e.dds.is_some() => "a DDS picture (MSFT_texture_dds)",
                _ => "no picture",
            };
            warnings.note(location, format!("the texture has {what} and is left out"));
            return Ok(None);
        };
        let image_at = format!("{location}.source");
        let image = element(&root.images, "images", source, &image_at)?;
        let Some(path) = self.path(source, warnings)? else { return Ok(None) };
        let fallback = format!("image {source}");
        let name = image.name.as_deref().unwrap_or(&fallback).to_owned();
        let desc = TextureDesc::Image {
            path,
            filter: filter(sampler),
            wrap_u: wrap(sampler.wrap_s, &location, warnings),
            wrap_v: wrap(sampler.wrap_t, &location, warnings),
            encoding: look.encoding,
            channel: look.channel,
            scale: look.scale,
            invert: false,
            mapping: mapping(info),
        };
        Ok(Some(self.add(desc, &name)))
    }

    /// The name of a texture that is this; `wanted` if it is a new one.
    pub(crate) fn add(&mut self, desc: TextureDesc, wanted: &str) -> String {
        let key = format!("{desc:?}");
        if let Some(name) = self.known.get(&key) {
            return name.clone();
        }
        let name = self.names.unique(Some(wanted), "texture");
        self.known.insert(key, name.clone());
        self.textures.insert(name.clone(), desc);
        name
    }

    /// A colour times a texture.
    pub(crate) fn times(&mut self, factor: Triple, texture: Option<String>) -> ColorDesc {
        match texture {
            None => ColorDesc::Solid(factor),
            Some(name) if factor == [1.0; 3] => ColorDesc::Texture(name),
            Some(name) => {
                let wanted = format!("{name} times");
                self.product(ColorDesc::Texture(name), ColorDesc::Solid(factor), &wanted)
            }
        }
    }

    /// The product of two colours.
    pub(crate) fn product(&mut self, a: ColorDesc, b: ColorDesc, wanted: &str) -> ColorDesc {
        ColorDesc::Texture(self.add(TextureDesc::Multiply { a, b }, wanted))
    }

    /// A number times a channel of a texture.
    pub(crate) fn scalar(
        &mut self,
        factor: f64,
        info: Option<&TextureInfo>,
        channel: ImageChannel,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<ScalarDesc, Error> {
        if factor == 0.0 {
            return Ok(ScalarDesc::Value(0.0));
        }
        let Some(info) = info else { return Ok(ScalarDesc::Value(factor)) };
        let name = self.image(info, Look::number(channel, factor), at, warnings)?;
        Ok(name.map_or(ScalarDesc::Value(factor), ScalarDesc::Texture))
    }

    /// The path of a picture: a file's, or that of an asset.
    fn path(&mut self, index: usize, warnings: &mut Warnings) -> Result<Option<String>, Error> {
        if let Some(path) = self.paths.get(&index) {
            return Ok(path.clone());
        }
        let path = self.find_path(index, warnings)?;
        self.paths.insert(index, path.clone());
        Ok(path)
    }

    fn find_path(
        &mut self,
        index: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<String>, Error> {
        let source = self.source;
        let image = &source.root.images[index];
        let at = format!("images[{index}]");
        let (bytes, media_type): (Arc<[u8]>, &str) = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                let uri_at = format!("{at}.uri");
                if uri.len() as u64 > source.budget.left() {
                    return Err(source.budget.exceeded(&uri_at));
                }
                match uri::parse(uri, self.allow_external) {
                    Ok(Target::File(path)) => {
                        if let Some(what) = unreadable_file(&path) {
                            let message = format!("zrak does not read {what}: it is left out");
                            warnings.note(uri_at, message);
                            return Ok(None);
                        }
                        return Ok(Some(path));
                    }
                    Ok(Target::Data { media_type, bytes }) => {
                        source.budget.spend(&uri_at, bytes.len() as u64, 1)?;
                        (bytes.into(), media_type)
                    }
                    Err((message, help)) => {
                        return Err(Error::new(ErrorKind::Invalid, uri_at, message, help));
                    }
                }
            }
            (None, Some(view)) => {
                let view_at = format!("{at}.bufferView");
                let bytes = source.buffers.view(view, &view_at)?.bytes;
                source.budget.spend(&view_at, bytes.len() as u64, 1)?;
                (bytes.into(), image.mime_type.as_deref().unwrap_or(""))
            }
            (None, None) => {
                warnings
                    .note(at, "the image has neither a `uri` nor a `bufferView`: it is left out");
                return Ok(None);
            }
        };
        let extension = match extension(&bytes) {
            Some(extension) => extension,
            None => {
                let message = format!(
                    "zrak reads PNG, JPEG, HDR and EXR pictures, not this of type \
                     {media_type:?}: it is left out"
                );
                warnings.note(at, message);
                return Ok(None);
            }
        };
        let fallback = format!("image {index}");
        let stem = image.name.as_deref().unwrap_or(&fallback);
        let stem = stem.strip_suffix(&format!(".{extension}")).unwrap_or(stem);
        let name = self.asset_names.unique(Some(&format!("{stem}.{extension}")), "image");
        let path = format!("{EMBEDDED}{name}");
        self.assets.insert(name, bytes);
        Ok(Some(path))
    }
}

/// The extension of a picture that zrak reads, by how it begins.
pub(crate) fn extension(bytes: &[u8]) -> Option<&'static str> {
    let starts: [(&[u8], &str); 5] = [
        (b"\x89PNG", "png"),
        (b"\xff\xd8\xff", "jpg"),
        (b"#?", "hdr"),
        (b"\x76\x2f\x31\x01", "exr"),
        (b"PF", "pfm"),
    ];
    starts.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, extension)| *extension)
}

/// What a file is that cannot be read, by its name.
fn unreadable_file(path: &str) -> Option<&'static str> {
    let (_, extension) = path.rsplit_once('.')?;
    match extension.to_ascii_lowercase().as_str() {
        "ktx2" | "ktx" => Some("KTX pictures"),
        "webp" => Some("WebP pictures"),
        "avif" => Some("AVIF pictures"),
        "dds" => Some("DDS pictures"),
        _ => None,
    }
}

fn filter(sampler: &Sampler) -> ImageFilter {
    const NEAREST: u32 = 9728;
    match (sampler.mag_filter, sampler.min_filter) {
        (Some(NEAREST), _) => ImageFilter::Nearest,
        // Those that make use of smaller copies.
        (_, Some(9984..=9987)) => ImageFilter::Trilinear,
        _ => ImageFilter::Bilinear,
    }
}

fn wrap(code: Option<u32>, location: &str, warnings: &mut Warnings) -> WrapMode {
    match code {
        None | Some(10497) => WrapMode::Repeat,
        Some(33071) => WrapMode::Clamp,
        Some(33648) => WrapMode::Mirror,
        Some(code) => {
            let message = format!("{code} is no way to wrap a texture: it repeats");
            warnings.note(location, message);
            WrapMode::Repeat
        }
    }
}

/// KHR_texture_transform: scale, then turn counter-clockwise as seen on the picture, then move, all with
/// v downwards. zrak's v is 1 minus glTF's on both sides of the map.
fn mapping(info: &TextureInfo) -> MappingDesc {
    let Some(t) = &info.extensions.transform else { return MappingDesc::Uv };
    let (s, c) = (libm::sin(t.rotation), libm::cos(t.rotation));
    let [sx, sy] = t.scale;
    let [[a, b, tx], [d, e, ty]] = [[c * sx, s * sy, t.offset[0]], [-s * sx, c * sy, t.offset[1]]];
    let matrix = [[a, -b, b + tx], [-d, e, 1.0 - e - ty]];
    if matrix == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        return MappingDesc::Uv;
    }
    MappingDesc::UvAffine { matrix }
}
