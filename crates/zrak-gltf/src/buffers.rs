//! Buffers, and the views of them.

use std::borrow::Cow;
use std::fmt::Display;

use crate::budget::Budget;
use crate::error::{Error, ErrorKind};
use crate::json::Root;
use crate::meshopt;
use crate::uri::{self, Target};

/// Reads a file, by its path relative to the glTF file and the most bytes that it may have; the error
/// is a cause.
pub type Resolver<'a> = dyn Fn(&str, u64) -> Result<Vec<u8>, String> + 'a;

/// All bytes of a file.
pub(crate) struct Buffers<'a> {
    root: &'a Root,
    buffers: Vec<Option<Cow<'a, [u8]>>>,
    /// The views that were compressed.
    decoded: Vec<Option<Vec<u8>>>,
}

/// A view of a buffer.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) stride: Option<u64>,
}

/// The element of a list of the file.
pub(crate) fn element<'a, T>(
    list: &'a [T],
    what: &str,
    index: usize,
    location: impl Display,
) -> Result<&'a T, Error> {
    list.get(index).ok_or_else(|| {
        let n = list.len();
        Error::invalid(location, format!("there is no {what}[{index}]; the file has {n} {what}"))
    })
}

/// Bytes `offset` to `offset + length`.
pub(crate) fn range(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    bytes.get(start..end)
}

impl<'a> Buffers<'a> {
    pub(crate) fn load(
        root: &'a Root,
        bin: Option<&'a [u8]>,
        resolver: &Resolver<'_>,
        allow_external: bool,
        budget: &Budget,
    ) -> Result<Self, Error> {
        let mut is_used = vec![false; root.buffers.len()];
        for (i, view) in root.buffer_views.iter().enumerate() {
            // A compressed view's own buffer is only for those who cannot read the other.
            let (buffer, key) = match &view.extensions.meshopt {
                Some(meshopt) => (meshopt.buffer, "extensions.EXT_meshopt_compression.buffer"),
                None => (view.buffer, "buffer"),
            };
            element(&root.buffers, "buffers", buffer, format_args!("bufferViews[{i}].{key}"))?;
            is_used[buffer] = true;
        }
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (i, is_used) in is_used.into_iter().enumerate() {
            let bin = if i == 0 { bin } else { None };
            buffers.push(match is_used {
                true => Some(load_one(root, i, bin, resolver, allow_external, budget)?),
                false => None,
            });
        }
        let mut this = Self { root, buffers, decoded: Vec::new() };
        this.decoded = (0..root.buffer_views.len())
            .map(|i| match &root.buffer_views[i].extensions.meshopt {
                None => Ok(None),
                Some(compressed) => {
                    let location = format!("bufferViews[{i}].extensions.EXT_meshopt_compression");
                    let bytes = this.part(
                        compressed.buffer,
                        compressed.byte_offset,
                        compressed.byte_length,
                        &location,
                    )?;
                    budget.spend(&location, compressed.count, compressed.byte_stride)?;
                    meshopt::decode(compressed, bytes)
                        .map(Some)
                        .map_err(|cause| Error::invalid(&location, cause))
                }
            })
            .collect::<Result<_, _>>()?;
        Ok(this)
    }

    fn part(&self, buffer: usize, offset: u64, length: u64, at: &str) -> Result<&[u8], Error> {
        let bytes = self.buffers.get(buffer).and_then(Option::as_deref).unwrap_or(&[]);
        range(bytes, offset, length).ok_or_else(|| {
            let n = bytes.len();
            let message = format!(
                "{length} bytes from byte {offset} on reach beyond the {n} bytes of \
                 buffers[{buffer}]"
            );
            Error::invalid(at, message)
        })
    }

    /// The view of this index, which stands at `location`.
    pub(crate) fn view(&self, index: usize, location: impl Display) -> Result<View<'_>, Error> {
        let view = element(&self.root.buffer_views, "bufferViews", index, location)?;
        let at = || format!("bufferViews[{index}]");
        let stride = view.byte_stride;
        if let Some(bytes) = &self.decoded[index] {
            if bytes.len() as u64 != view.byte_length {
                let n = bytes.len();
                let message = format!(
                    "byteLength is {}, the compressed data has {n} bytes",
                    view.byte_length
                );
                return Err(Error::invalid(at(), message));
            }
            return Ok(View { bytes, stride });
        }
        let bytes = self.part(view.buffer, view.byte_offset, view.byte_length, &at())?;
        Ok(View { bytes, stride })
    }
}

fn load_one<'a>(
    root: &'a Root,
    index: usize,
    bin: Option<&'a [u8]>,
    resolver: &Resolver<'_>,
    allow_external: bool,
    budget: &Budget,
) -> Result<Cow<'a, [u8]>, Error> {
    let buffer = &root.buffers[index];
    let location = format!("buffers[{index}]");
    let bytes: Cow<'a, [u8]> = match (&buffer.uri, bin) {
        (None, Some(bin)) => bin.into(),
        (None, None) => {
            let message = "the buffer has no `uri`, and is not the chunk of a binary file";
            return Err(Error::invalid(&location, message));
        }
        (Some(uri), _) => {
            let at = format!("{location}.uri");
            if uri.len() as u64 > budget.left() {
                return Err(budget.exceeded(&at));
            }
            let bytes = match uri::parse(uri, allow_external) {
                Ok(Target::Data { bytes, .. }) => bytes,
                Ok(Target::File(path)) => resolver(&path, budget.left()).map_err(|cause| {
                    let message = format!("cannot read '{path}': {cause}");
                    let help = "put the file beside the glTF file, under the name it asks for";
                    Error::new(ErrorKind::Io, &at, message, help)
                })?,
                Err((message, help)) => {
                    return Err(Error::new(ErrorKind::Invalid, &at, message, help));
                }
            };
            budget.spend(&at, bytes.len() as u64, 1)?;
            bytes.into()
        }
    };
    let n = bytes.len();
    if buffer.byte_length > n as u64 {
        let message = format!("byteLength is {}, but there are {n} bytes", buffer.byte_length);
        return Err(Error::invalid(location, message));
    }
    let length = buffer.byte_length as usize;
    Ok(match bytes {
        Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[..length]),
        Cow::Owned(mut bytes) => {
            bytes.truncate(length);
            Cow::Owned(bytes)
        }
    })
}
