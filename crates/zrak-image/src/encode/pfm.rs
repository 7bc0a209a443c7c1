//! Portable float map: a three-line header, then 32-bit floats, bottom row first.
//!
//! The third line is the scale; its negative sign means little-endian.

use crate::Picture;

pub(super) fn encode(picture: &Picture) -> Vec<u8> {
    let mut bytes = format!("PF\n{} {}\n-1.0\n", picture.width, picture.height).into_bytes();
    bytes.reserve_exact(picture.pixels.len() * 12);
    for row in picture.rows().rev() {
        bytes.extend(row.iter().flatten().flat_map(|value| value.to_le_bytes()));
    }
    bytes
}
