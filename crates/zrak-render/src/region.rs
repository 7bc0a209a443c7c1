//! Parts of a render: a rectangle of pixels and a range of samples.

/// Rectangle of pixels, counted from the upper left of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

impl Region {
    /// The whole of a picture.
    #[must_use]
    pub const fn whole(width: u32, height: u32) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Number of pixels.
    #[must_use]
    pub const fn n_pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether it lies inside `other`.
    #[must_use]
    pub const fn is_inside(&self, other: &Self) -> bool {
        self.x >= other.x
            && self.y >= other.y
            && self.x as u64 + self.width as u64 <= other.x as u64 + other.width as u64
            && self.y as u64 + self.height as u64 <= other.y as u64 + other.height as u64
    }

    /// Cut into tiles of at most `size` x `size` pixels, row by row.
    pub fn tiles(self, size: u32) -> impl Iterator<Item = Self> {
        (0..self.height.div_ceil(size)).flat_map(move |ty| {
            (0..self.width.div_ceil(size)).map(move |tx| Self {
                x: self.x + tx * size,
                y: self.y + ty * size,
                width: size.min(self.width - tx * size),
                height: size.min(self.height - ty * size),
            })
        })
    }
}

/// Samples `first` to `first + count` of every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleRange {
    /// Index of the first sample.
    pub first: u32,
    /// Number of samples.
    pub count: u32,
}
