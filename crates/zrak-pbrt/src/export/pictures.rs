//! Pictures: copied as they are, or made of what is looked at of them.

use std::path::Path;

use zrak_image::{
    Format, Limits, Picture, Texels, TextureImage, Transfer, decode_texture, srgb8_to_linear_table,
    srgb16_to_linear,
};
use zrak_scene::desc::ImageChannel;
use zrak_scene::error::SceneError;
use zrak_scene::lower::{Assets, EMBEDDED};

use super::{Writer, failure};

impl Writer<'_, '_> {
    /// The bytes of a picture.
    fn picture_bytes(&self, path: &str) -> Result<Vec<u8>, SceneError> {
        if let Some(name) = Assets::builtin_name(path) {
            let bytes = Assets::bytes(name).map(<[u8]>::to_vec);
            return bytes.ok_or_else(|| failure(&format!("there is no built-in picture '{name}'")));
        }
        if let Some(name) = path.strip_prefix(EMBEDDED) {
            let bytes = self.embedded.get(name).map(|bytes| bytes.to_vec());
            return bytes.ok_or_else(|| failure(&format!("there is no picture '{name}' inside")));
        }
        let limits = zrak_mesh::Limits { max_bytes: self.options.max_bytes };
        zrak_mesh::read_file(&self.base_dir.join(path), &limits)
            .map_err(|error| failure(&error.to_string()))
    }

    /// Path of a copy of a picture.
    pub(super) fn copied(&mut self, path: &str) -> Result<String, SceneError> {
        if let Some(known) = self.pictures.get(path) {
            return Ok(known.clone());
        }
        let bytes = self.picture_bytes(path)?;
        // pbrt looks at the name's end to know what is in a file.
        let wanted = Path::new(path.rsplit(':').next().unwrap_or(path));
        let stem = wanted.file_stem().map_or("picture".into(), |stem| stem.to_string_lossy());
        let extension = extension_of(&bytes);
        let name = (self.sink)(&format!("{stem}.{extension}"), &bytes)?;
        self.pictures.insert(path.to_owned(), name.clone());
        Ok(name)
    }

    fn decoded(&self, path: &str) -> Result<TextureImage, SceneError> {
        let bytes = self.picture_bytes(path)?;
        let limits = Limits { max_bytes: self.options.max_bytes, ..Limits::default() };
        decode_texture(&bytes, Path::new(path), &limits)
            .map_err(|error| failure(&error.to_string()))
    }

    /// Path of a picture of which pbrt looks up the same number as zrak: a copy, or what is looked at,
    /// as a picture of its own in linear numbers. Says whether it is that.
    pub(super) fn of_channel(
        &mut self,
        path: &str,
        channel: ImageChannel,
        is_srgb: bool,
        is_float: bool,
    ) -> Result<(String, bool), SceneError> {
        if channel == ImageChannel::Color && !is_float {
            return Ok((self.copied(path)?, false));
        }
        let key = format!("{path}|{channel:?}|{is_srgb}|{is_float}");
        if let Some(known) = self.pictures.get(&key) {
            return Ok((known.clone(), true));
        }
        let image = self.decoded(path)?;
        if is_float && is_looked_up_the_same(&image, channel) {
            return Ok((self.copied(path)?, false));
        }
        let picture = Picture {
            width: image.width,
            height: image.height,
            pixels: channel_of(&image, channel, is_srgb).into_iter().map(|x| [x; 3]).collect(),
        };
        let bytes = zrak_image::encode(Format::Exr, &picture, None, Transfer::Srgb)
            .map_err(|error| failure(&error.to_string()))?;
        let stem = Path::new(path.rsplit(':').next().unwrap_or(path)).file_stem();
        let stem = stem.map_or("picture".into(), |stem| stem.to_string_lossy());
        let name = (self.sink)(&format!("{stem}-{channel:?}.exr").to_lowercase(), &bytes)?;
        self.pictures.insert(key, name.clone());
        Ok((name, true))
    }
}

/// How the name of a picture must end, by how its bytes begin.
fn extension_of(bytes: &[u8]) -> &'static str {
    let magics: [(&[u8], &str); 5] = [
        (b"\x89PNG", "png"),
        (b"\xff\xd8", "jpg"),
        (b"#?", "hdr"),
        (b"\x76\x2f\x31\x01", "exr"),
        (b"P", "pfm"),
    ];
    magics.iter().find(|(magic, _)| bytes.starts_with(magic)).map_or("png", |(_, name)| name)
}

/// Whether pbrt's number is zrak's: the mean of red, green and blue, or alpha where it is not all 1.
fn is_looked_up_the_same(image: &TextureImage, channel: ImageChannel) -> bool {
    let (is_grey, is_opaque) = match &image.texels {
        Texels::Srgb8(texels) => (
            texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]),
            texels.iter().all(|t| t[3] == u8::MAX),
        ),
        Texels::Srgb16(texels) => (
            texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]),
            texels.iter().all(|t| t[3] == u16::MAX),
        ),
        Texels::Linear(texels) => (texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]), true),
    };
    match channel {
        ImageChannel::A => !is_opaque,
        _ => is_grey && is_opaque,
    }
}

/// One channel in linear numbers.
fn channel_of(image: &TextureImage, channel: ImageChannel, is_srgb: bool) -> Vec<f32> {
    let pick = |rgb: [f32; 3], alpha: f32| match channel {
        ImageChannel::Color => 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2],
        ImageChannel::R => rgb[0],
        ImageChannel::G => rgb[1],
        ImageChannel::B => rgb[2],
        ImageChannel::A => alpha,
    };
    match &image.texels {
        Texels::Srgb8(texels) => {
            let table = srgb8_to_linear_table();
            let linear = |v: u8| if is_srgb { table[usize::from(v)] } else { f32::from(v) / 255.0 };
            texels
                .iter()
                .map(|&[r, g, b, a]| pick([r, g, b].map(linear), f32::from(a) / 255.0))
                .collect()
        }
        Texels::Srgb16(texels) => {
            let linear =
                |v: u16| if is_srgb { srgb16_to_linear(v) } else { f32::from(v) / 65535.0 };
            texels
                .iter()
                .map(|&[r, g, b, a]| pick([r, g, b].map(linear), f32::from(a) / 65535.0))
                .collect()
        }
        Texels::Linear(texels) => texels.iter().map(|&rgb| pick(rgb, 1.0)).collect(),
    }
}
