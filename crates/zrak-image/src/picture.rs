//! The picture that a render yields.

use crate::{Error, ErrorKind};

/// Linear sRGB radiance (Rec. 709 primaries, D65 white), three `f32` per pixel.
///
/// Rows follow one another without padding; row 0 is at the top, column 0 at the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// `width * height` pixels of red, green and blue; pixel (x, y) is at `y * width + x`.
    pub pixels: Vec<[f32; 3]>,
}

impl Picture {
    /// Fails unless there is a pixel, and there are as many as the size says.
    pub(crate) fn validate(&self) -> Result<(), Error> {
        let Self { width, height, .. } = *self;
        let n_pixels = self.pixels.len();
        if n_pixels == 0 || n_pixels as u64 != u64::from(width) * u64::from(height) {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                format!(
                    "a {width}x{height} picture with {n_pixels} pixels is not a picture; \
                     give one pixel or more, width x height in all"
                ),
            ));
        }
        Ok(())
    }

    /// The rows from top to bottom.
    pub(crate) fn rows(&self) -> std::slice::ChunksExact<'_, [f32; 3]> {
        self.pixels.chunks_exact(self.width as usize)
    }
}
