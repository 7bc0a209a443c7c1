//! The file formats: chosen by extension when writing, recognised by content when reading.

use std::path::Path;

use crate::{Error, ErrorKind};

/// A picture file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics, 8 bits per channel: for screens.
    Png,
    /// JPEG at quality 95: for screens, lossy.
    Jpeg,
    /// Radiance HDR: linear, 8 bits of mantissa and one exponent shared by a pixel's channels.
    Hdr,
    /// OpenEXR: linear, 32-bit float, exact. The format for further work.
    Exr,
    /// Portable float map: linear, 32-bit float, exact, uncompressed; trivial to parse.
    Pfm,
}

impl Format {
    /// The format that a path's extension (in any case) names.
    pub fn from_path(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "jpg" | "jpeg" => Ok(Self::Jpeg),
            "hdr" => Ok(Self::Hdr),
            "exr" => Ok(Self::Exr),
            "pfm" => Ok(Self::Pfm),
            _ => Err(Error::new(
                ErrorKind::UnknownFormat,
                format!(
                    "the extension of '{}' names no picture format; \
                     use one of .png, .jpg, .jpeg, .hdr, .exr, .pfm",
                    path.display()
                ),
            )),
        }
    }

    /// The format whose signature `bytes` begin with.
    pub(crate) fn sniff(bytes: &[u8]) -> Option<Self> {
        const SIGNATURES: [(&[u8], Format); 7] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"#?RADIANCE", Format::Hdr),
            (b"#?RGBE", Format::Hdr),
            (b"\x76\x2f\x31\x01", Format::Exr),
            (b"PF", Format::Pfm),
            (b"Pf", Format::Pfm),
        ];
        SIGNATURES.iter().find(|(signature, _)| bytes.starts_with(signature)).map(|found| found.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_name_formats_in_any_case() {
        for (path, format) in [
            ("a.png", Format::Png),
            ("b/c.JPG", Format::Jpeg),
            ("d.e.Jpeg", Format::Jpeg),
            ("f.hdr", Format::Hdr),
            ("g.EXR", Format::Exr),
            (".hidden.pfm", Format::Pfm),
        ] {
            assert_eq!(Format::from_path(Path::new(path)).unwrap(), format, "{path}");
        }
    }

    #[test]
    fn unknown_extensions_list_the_known_ones() {
        for path in ["", "a", "a.", "a.tiff", "png", ".png", "a.png/"] {
            match Format::from_path(Path::new(path)) {
                Err(error) => {
                    assert_eq!(error.kind(), ErrorKind::UnknownFormat);
                    assert!(error.to_string().contains(".png, .jpg, .jpeg, .hdr, .exr, .pfm"));
                }
                // A trailing slash is not part of the name; the writer finds the folder.
                Ok(format) => assert_eq!((path, format), ("a.png/", Format::Png)),
            }
        }
    }
}
