//! The pictures of materials.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use zrak_scene::desc::{
    ColorDesc, ImageChannel, ImageEncoding, ImageFilter, MappingDesc, ScalarDesc, TextureDesc,
    Triple, WrapMode,
};

use crate::mtl::Map;

/// The textures that materials have asked for.
pub(crate) struct Textures<'a> {
    /// Folder of the scene.
    base_dir: &'a Path,
    pub(crate) textures: BTreeMap<String, TextureDesc>,
    /// Names, by what the textures are.
    known: HashMap<String, String>,
    /// How often each name was asked for.
    counts: HashMap<String, u32>,
}

impl<'a> Textures<'a> {
    pub(crate) fn new(base_dir: &'a Path) -> Self {
        Self { base_dir, textures: BTreeMap::new(), known: HashMap::new(), counts: HashMap::new() }
    }

    /// The name of a texture that is this; something like `wanted` if it is a new one.
    pub(crate) fn add(&mut self, desc: TextureDesc, wanted: &str) -> String {
        let key = format!("{desc:?}");
        if let Some(name) = self.known.get(&key) {
            return name.clone();
        }
        let mut name = wanted.to_owned();
        while self.textures.contains_key(&name) {
            // The count only grows, so many equal names take no longer than different ones.
            let count = self.counts.entry(wanted.to_owned()).or_insert(1);
            *count += 1;
            name = format!("{wanted} {count}");
        }
        self.known.insert(key, name.clone());
        self.textures.insert(name.clone(), desc);
        name
    }

    /// The name of the texture of a map in an MTL file in `folder`, relative to the scene's; `scale` is a
    /// factor of its values.
    pub(crate) fn image(
        &mut self,
        map: &Map,
        folder: &str,
        encoding: ImageEncoding,
        channel: ImageChannel,
        scale: f64,
        warn: &mut dyn FnMut(usize, String),
    ) -> String {
        let path = self.path(map, folder, warn);
        let mut scale = scale * map.gain;
        let mut invert = false;
        if map.base == 1.0 && map.gain == -1.0 {
            (scale, invert) = (-scale, true);
        } else if map.base != 0.0 || map.gain < 0.0 {
            warn(map.line, "the base value of a map, in `-mm`, is left out".to_owned());
            scale = scale.abs();
        }
        let wrap = if map.clamps { WrapMode::Clamp } else { WrapMode::Repeat };
        let limit = |x: f64| x.clamp(-1e6, 1e6);
        let (s, o) = (map.scale.map(limit), map.offset.map(limit));
        let mapping = if (s, o) == ([1.0; 2], [0.0; 2]) {
            MappingDesc::Uv
        } else {
            MappingDesc::UvAffine { matrix: [[s[0], 0.0, o[0]], [0.0, s[1], o[1]]] }
        };
        let name = Path::new(&path).file_name().map(|n| n.to_string_lossy().into_owned());
        let desc = TextureDesc::Image {
            path,
            filter: ImageFilter::Trilinear,
            wrap_u: wrap,
            wrap_v: wrap,
            encoding,
            channel: map.channel.unwrap_or(channel),
            scale: scale.clamp(0.0, 1e6),
            invert,
            mapping,
        };
        self.add(desc, name.as_deref().unwrap_or("map"))
    }

    /// A colour times a map.
    pub(crate) fn color(
        &mut self,
        factor: Triple,
        map: Option<&Map>,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> ColorDesc {
        let Some(map) = map else { return ColorDesc::Solid(factor) };
        let (encoding, channel) = (ImageEncoding::Auto, ImageChannel::Color);
        let name = self.image(map, folder, encoding, channel, 1.0, warn);
        self.times(ColorDesc::Texture(name), factor)
    }

    /// A colour times another.
    pub(crate) fn times(&mut self, color: ColorDesc, factor: Triple) -> ColorDesc {
        match color {
            ColorDesc::Texture(name) if factor != [1.0; 3] => {
                let wanted = format!("{name} times");
                let (a, b) = (ColorDesc::Texture(name), ColorDesc::Solid(factor));
                ColorDesc::Texture(self.add(TextureDesc::Multiply { a, b }, &wanted))
            }
            other => other,
        }
    }

    /// A number times a map.
    pub(crate) fn scalar(
        &mut self,
        factor: f64,
        map: Option<&Map>,
        folder: &str,
        warn: &mut dyn FnMut(usize, String),
    ) -> ScalarDesc {
        let Some(map) = map else { return ScalarDesc::Value(factor) };
        let (encoding, channel) = (ImageEncoding::Linear, ImageChannel::Color);
        ScalarDesc::Texture(self.image(map, folder, encoding, channel, factor, warn))
    }

    /// Path of a picture, relative to the scene's folder if the file says it so.
    fn path(&self, map: &Map, folder: &str, warn: &mut dyn FnMut(usize, String)) -> String {
        // Exporters on Windows write its separators.
        let path = map.path.replace('\\', "/");
        let has_drive = path.as_bytes().get(1) == Some(&b':');
        if path.starts_with('/') || has_drive {
            // The place on the disk of who made the file; the picture may have come along.
            let name = path.rsplit('/').next().unwrap_or_default();
            let beside = join(folder, name);
            if !name.is_empty() && self.base_dir.join(&beside).is_file() {
                warn(map.line, format!("`{path}` is taken from the file's own folder"));
                return beside;
            }
            return path;
        }
        join(folder, &path)
    }
}

/// A path in a folder, which may be none.
fn join(folder: &str, path: &str) -> String {
    if folder.is_empty() { path.to_owned() } else { format!("{folder}/{path}") }
}
