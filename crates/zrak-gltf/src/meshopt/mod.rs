//! Views compressed by EXT_meshopt_compression, as its specification's appendices describe them.

mod attributes;
mod filters;
mod indices;

use crate::json::MeshoptCompression;

/// Decodes a view; the error is a cause. The caller has made sure that count times stride bytes may be
/// taken.
pub(crate) fn decode(desc: &MeshoptCompression, data: &[u8]) -> Result<Vec<u8>, String> {
    let MeshoptCompression { byte_stride, count, mode, filter, .. } = desc;
    let stride = usize::try_from(*byte_stride).unwrap_or(0);
    let count = usize::try_from(*count).map_err(|_| "count is too large")?;
    let filter = filter.as_deref().unwrap_or("NONE");
    match mode.as_str() {
        "ATTRIBUTES" => {
            if !(4..=256).contains(&stride) || !stride.is_multiple_of(4) {
                return Err(format!("byteStride is {stride}, not a multiple of 4 up to 256"));
            }
            let apply: fn(&mut [u8]) = match (filter, stride) {
                ("NONE", _) => |_| {},
                ("OCTAHEDRAL", 4) => filters::octahedral8,
                ("OCTAHEDRAL", 8) => filters::octahedral16,
                ("QUATERNION", 8) => filters::quaternion,
                ("EXPONENTIAL", _) => filters::exponential,
                ("OCTAHEDRAL" | "QUATERNION", _) => {
                    return Err(format!(
                        "the filter {filter} cannot have a byteStride of {stride}"
                    ));
                }
                _ => return Err(format!("the filter {filter:?} is unknown")),
            };
            let mut bytes = attributes::decode(data, count, stride)?;
            apply(&mut bytes);
            Ok(bytes)
        }
        "TRIANGLES" | "INDICES" => {
            if filter != "NONE" {
                return Err(format!("{mode} cannot have the filter {filter:?}"));
            }
            let indices = match mode.as_str() {
                "TRIANGLES" => indices::triangles(data, count)?,
                _ => indices::sequence(data, count)?,
            };
            match stride {
                2 => Ok(indices.into_iter().flat_map(|i| (i as u16).to_le_bytes()).collect()),
                4 => Ok(indices.into_iter().flat_map(u32::to_le_bytes).collect()),
                _ => Err(format!("byteStride is {stride}; indices have 2 or 4 bytes")),
            }
        }
        _ => Err(format!("the mode {mode:?} is unknown")),
    }
}

#[cfg(test)]
mod tests;
