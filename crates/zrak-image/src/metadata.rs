//! How a picture was made: enough to make it again.
//!
//! PNG carries it as text chunks, EXR as attributes and HDR as comments in its header; JPEG and
//! PFM carry none.

/// The render that made a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Metadata {
    /// The scene's name or path.
    pub scene: String,
    /// The seed of every random number.
    pub seed: u64,
    /// Samples per pixel.
    pub samples_per_pixel: u32,
    /// The backend that rendered, such as `cpu` or `cuda`.
    pub backend: String,
    /// The device's name, such as the processor's model.
    pub device: String,
    /// The version of zrak.
    pub version: String,
    /// Time that the render took, in seconds.
    pub render_time_s: f64,
}

impl Metadata {
    /// Name and value of every field as text, in one fixed order.
    ///
    /// The names are those of the EXR attributes. The seed is text in EXR, too: it has 64 bits,
    /// and no EXR attribute type holds such an integer.
    pub(crate) fn to_text(&self) -> [(&'static str, String); 7] {
        [
            ("scene", plain(&self.scene)),
            ("seed", self.seed.to_string()),
            ("samplesPerPixel", self.samples_per_pixel.to_string()),
            ("backend", plain(&self.backend)),
            ("device", plain(&self.device)),
            ("version", plain(&self.version)),
            ("renderTime", self.render_time_s.to_string()),
        ]
    }
}

/// `text` in one line, without what would end a string or a header line early.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
