//! Files as bytes, unpacked if they are gzip-ed.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::Error;

/// How much a reader may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most bytes of a file once it is unpacked, and of the mesh that is made of it.
    pub max_bytes: u64,
}

impl Default for Limits {
    /// 16 GiB: more than the largest meshes in use.
    fn default() -> Self {
        Self { max_bytes: 16 << 30 }
    }
}

/// What gzip files begin with.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// The bytes of a file, unpacked if it is gzip-ed.
///
/// # Errors
/// If it cannot be read, or is larger than the limits allow.
pub fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, Error> {
    let shown = path.display();
    let failed = |error: std::io::Error| Error::new(format!("cannot read {shown}: {error}"));
    let mut file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if !metadata.is_file() {
        return Err(Error::new(format!("{shown} is not a file")));
    }
    if metadata.len() > limits.max_bytes {
        return Err(too_large(path, limits));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    // The file may be growing meanwhile.
    (&mut file).take(limits.max_bytes).read_to_end(&mut bytes).map_err(failed)?;
    unpack(bytes, path, limits)
}

/// The bytes of a file that was read, unpacked if they are gzip-ed; `path` is what errors call it.
///
/// # Errors
/// If it is damaged, or larger than the limits allow.
pub fn unpack(bytes: Vec<u8>, path: &Path, limits: &Limits) -> Result<Vec<u8>, Error> {
    let shown = path.display();
    let too_large = || too_large(path, limits);
    if bytes.len() as u64 > limits.max_bytes {
        return Err(too_large());
    }
    if !bytes.starts_with(&GZIP_MAGIC) {
        return Ok(bytes);
    }
    let mut unpacked = Vec::new();
    let mut decoder =
        MultiGzDecoder::new(bytes.as_slice()).take(limits.max_bytes.saturating_add(1));
    decoder
        .read_to_end(&mut unpacked)
        .map_err(|error| Error::new(format!("{shown} is damaged: {error}")))?;
    if unpacked.len() as u64 > limits.max_bytes {
        return Err(too_large());
    }
    Ok(unpacked)
}

fn too_large(path: &Path, limits: &Limits) -> Error {
    Error::new(format!(
        "{} is larger than the limit of {} bytes; raise the limit if the file is meant",
        path.display(),
        limits.max_bytes
    ))
}
