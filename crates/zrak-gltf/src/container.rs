//! The binary form of glTF (GLB): a header, a chunk of JSON, and perhaps a chunk of bytes.

use crate::error::{Error, ErrorKind};

const MAGIC: &[u8; 4] = b"glTF";
const CHUNK_JSON: u32 = 0x4e4f_534a;
const CHUNK_BIN: u32 = 0x004e_4942;

/// The JSON and the binary chunk of a file of either form.
pub(crate) struct Container<'a> {
    pub(crate) json: &'a [u8],
    pub(crate) bin: Option<&'a [u8]>,
}

pub(crate) fn split(bytes: &[u8]) -> Result<Container<'_>, Error> {
    if !bytes.starts_with(MAGIC) {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if json.iter().find(|b| !b.is_ascii_whitespace()) != Some(&b'{') {
            let message = "this is neither glTF's JSON nor its binary form (.glb)";
            return Err(Error::new(ErrorKind::NotGltf, "", message, "choose a .gltf or .glb file"));
        }
        return Ok(Container { json, bin: None });
    }
    let word = |at: usize| -> Option<u32> {
        let bytes = bytes.get(at..at.checked_add(4)?)?;
        bytes.try_into().ok().map(u32::from_le_bytes)
    };
    let damaged = |message: String| {
        let help = "the file is cut off or damaged: copy or export it again";
        Error::new(ErrorKind::NotGltf, "", message, help)
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(damaged("the header of the binary file ends early".into()));
    };
    if version != 2 {
        let message = format!("this is binary glTF of version {version}; zrak reads version 2");
        return Err(Error::new(ErrorKind::Unsupported, "", message, "export it as glTF 2.0"));
    }
    let length = length as usize;
    if length > bytes.len() {
        let n = bytes.len();
        return Err(damaged(format!("the header says {length} bytes, the file has {n}")));
    }
    let bytes = &bytes[..length];
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    let mut n_chunks = 0;
    while at < bytes.len() {
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else {
            return Err(damaged(format!("the chunk at byte {at} has no header")));
        };
        let Some(chunk) = (at + 8).checked_add(size as usize).and_then(|e| bytes.get(at + 8..e))
        else {
            let message = format!("the chunk at byte {at} says {size} bytes, the file ends before");
            return Err(damaged(message));
        };
        match kind {
            CHUNK_JSON if n_chunks == 0 => json = Some(chunk),
            CHUNK_BIN if n_chunks == 1 => bin = Some(chunk),
            CHUNK_JSON | CHUNK_BIN => {
                return Err(damaged(format!("the chunk at byte {at} is out of order")));
            }
            // The specification lets others be.
            _ => {}
        }
        at += 8 + chunk.len();
        n_chunks += 1;
    }
    let json = json.ok_or_else(|| damaged("the binary file has no chunk of JSON".into()))?;
    Ok(Container { json, bin })
}

/// The binary form of JSON and bytes; none if its sizes do not fit their 32 bits.
pub(crate) fn join(json: &[u8], bin: &[u8]) -> Option<Vec<u8>> {
    let padded = |n: usize| n.div_ceil(4) * 4;
    let total =
        12 + 8 + padded(json.len()) + if bin.is_empty() { 0 } else { 8 + padded(bin.len()) };
    u32::try_from(total).ok()?;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend_from_slice(MAGIC);
    bytes.extend([2, total as u32].into_iter().flat_map(u32::to_le_bytes));
    let mut chunk = |kind: u32, content: &[u8], fill: u8| {
        let size = padded(content.len());
        bytes.extend([size as u32, kind].into_iter().flat_map(u32::to_le_bytes));
        bytes.extend_from_slice(content);
        bytes.resize(bytes.len() + size - content.len(), fill);
    };
    chunk(CHUNK_JSON, json, b' ');
    if !bin.is_empty() {
        chunk(CHUNK_BIN, bin, 0);
    }
    Some(bytes)
}
