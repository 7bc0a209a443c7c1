//! Images that scenes refer to.

use std::path::Path;

use zrak_image::{Error, Limits, TextureImage, decode_texture, read_texture};

/// What the paths of pictures inside zrak start with.
const BUILTIN: &str = "builtin:";

/// The pictures inside zrak.
pub struct Assets;

impl Assets {
    /// Names and contents.
    const ALL: &'static [(&'static str, &'static [u8])] = &[
        ("earth.png", include_bytes!("../../../../assets/earth.png")),
        ("gradient.pfm", include_bytes!("../../../../assets/gradient.pfm")),
    ];

    /// Name of the built-in picture that `path` means, if it means one.
    #[must_use]
    pub fn builtin_name(path: &str) -> Option<&str> {
        path.strip_prefix(BUILTIN)
    }

    /// Names of all built-in pictures.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.iter().map(|(name, _)| *name)
    }
}

/// Reads the image at `path`, relative to `base_dir` or built in.
pub(super) fn read(path: &str, base_dir: &Path, limits: &Limits) -> Result<TextureImage, Error> {
    match Assets::builtin_name(path) {
        Some(name) => match Assets::ALL.iter().find(|(known, _)| *known == name) {
            Some((_, bytes)) => decode_texture(bytes, Path::new(path), limits),
            None => {
                let known: Vec<_> = Assets::names().collect();
                Err(Error::new(
                    zrak_image::ErrorKind::Io,
                    format!(
                        "there is no built-in picture '{name}'; there is: {}",
                        known.join(", ")
                    ),
                ))
            }
        },
        None => read_texture(&base_dir.join(path), limits),
    }
}
