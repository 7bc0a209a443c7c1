//! Where bytes are: data URIs, and paths relative to the file.

use std::borrow::Cow;

use base64::Engine as _;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

/// Exporters disagree about the padding of base64.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// What a URI leads to.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Target<'a> {
    /// Bytes in the URI itself, with their media type.
    Data { media_type: &'a str, bytes: Vec<u8> },
    /// A file, with `/` between its parts.
    File(String),
}

/// Reads a URI; the error is a cause and what to do.
pub(crate) fn parse(uri: &str, allow_external: bool) -> Result<Target<'_>, (String, &'static str)> {
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        let (media_type, bytes) = data(&uri[5..])?;
        return Ok(Target::Data { media_type, bytes });
    }
    path(uri, allow_external).map(Target::File)
}

/// Media type and bytes of a data URI (RFC 2397), without its scheme.
fn data(rest: &str) -> Result<(&str, Vec<u8>), (String, &'static str)> {
    let help = "export the file again, with its buffers beside it";
    let (head, body) =
        rest.split_once(',').ok_or(("the data URI has no comma".to_owned(), help))?;
    let media_type = head.split(';').next().unwrap_or("");
    let is_base64 = head.rsplit(';').next().is_some_and(|x| x.eq_ignore_ascii_case("base64"));
    let bytes = if is_base64 {
        // Some exporters escape the three characters of base64 that mean something in URIs.
        let body: Cow<'_, [u8]> = percent_decode_str(body).into();
        BASE64.decode(body).map_err(|e| (format!("the data URI is not base64: {e}"), help))?
    } else {
        percent_decode_str(body).collect()
    };
    Ok((media_type, bytes))
}

/// The path that a URI means.
fn path(uri: &str, allow_external: bool) -> Result<String, (String, &'static str)> {
    const INSIDE: &str = "put the file beside the glTF file, or allow paths outside of its folder";
    let shown = shown(uri);
    if let Some((scheme, _)) = uri.split_once(':') {
        let is_scheme = scheme.len() > 1
            && scheme.bytes().all(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b));
        if is_scheme && uri[scheme.len()..].starts_with("://") {
            let help = "download the file, and name it relative to the glTF file";
            return Err((format!("'{shown}' is not a file: zrak fetches nothing"), help));
        }
    }
    let decoded = percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| (format!("the path '{shown}' is not UTF-8"), "rename the file"))?;
    // Windows' separators are not allowed in URIs, yet exporters write them.
    let path = decoded.replace('\\', "/");
    if path.is_empty() || path.contains('\0') {
        return Err((format!("'{shown}' is not a path"), "name a file beside the glTF file"));
    }
    if allow_external {
        return Ok(path);
    }
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    if path.starts_with('/') || has_drive {
        return Err((format!("'{shown}' is an absolute path"), INSIDE));
    }
    let mut depth = 0_i64;
    for part in path.split('/') {
        depth += match part {
            "" | "." => 0,
            ".." => -1,
            _ => 1,
        };
        if depth < 0 {
            return Err((format!("'{shown}' leaves the folder of the glTF file"), INSIDE));
        }
    }
    Ok(path)
}

/// The beginning of a URI, for messages.
fn shown(uri: &str) -> String {
    let mut shown: String = uri.chars().take(80).filter(|c| !c.is_control()).collect();
    if uri.chars().nth(80).is_some() {
        shown.push_str("...");
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::{Target, parse};

    #[test]
    fn paths_stay_inside() {
        for (uri, expected) in [
            ("a.bin", Some("a.bin")),
            ("sub%20dir/a%2B.bin", Some("sub dir/a+.bin")),
            ("a/../b.bin", Some("a/../b.bin")),
            ("tex\\a.png", Some("tex/a.png")),
            ("a:b.png", None),
            ("../a.bin", None),
            ("a/../../b.bin", None),
            ("%2e%2e/a.bin", None),
            ("..%5ca.bin", None),
            ("/etc/passwd", None),
            ("C:/a.bin", None),
            ("http://example.com/a.bin", None),
            ("file:///a.bin", None),
            ("a%00.bin", None),
            ("%ff.bin", None),
            ("", None),
        ] {
            let parsed = parse(uri, false);
            let path = match &parsed {
                Ok(Target::File(path)) => Some(path.as_str()),
                _ => None,
            };
            assert_eq!(path, expected, "{uri}: {parsed:?}");
        }
        assert_eq!(parse("../a.bin", true), Ok(Target::File("../a.bin".into())));
    }

    #[test]
    fn data_uris_are_decoded() {
        for (uri, expected) in [
            ("data:application/octet-stream;base64,AQID", Some(&[1, 2, 3][..])),
            ("data:;base64,AQ==", Some(&[1])),
            ("data:;base64,AQ", Some(&[1])),
            ("DATA:text/plain;charset=utf-8;BASE64,AQ%3D%3D", Some(&[1])),
            ("data:text/plain,a%20b", Some(b"a b")),
            ("data:;base64,A", None),
            ("data:;base64,A*==", None),
            ("data:base64", None),
        ] {
            let bytes = match parse(uri, false) {
                Ok(Target::Data { bytes, .. }) => Some(bytes),
                _ => None,
            };
            assert_eq!(bytes.as_deref(), expected, "{uri}");
        }
    }
}
