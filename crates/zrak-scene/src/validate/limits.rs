//! How large and how small the numbers of a scene may be.
//!
//! Rendering computes in `f32`, whose range ends near 3.4e38. With lengths in [1e-12, 1e12], a
//! product of three lengths, and the inverse of such a product, stays inside it.

/// Greatest absolute value of a number without a narrower limit of its own.
pub const NUMBER_MAX: f64 = 1e12;
/// Smallest length: of a radius, an edge, a scale.
pub const LENGTH_MIN: f64 = 1e-12;
/// Greatest radiance of a light or a background.
pub const RADIANCE_MAX: f64 = 1e9;
/// Smallest sine of an angle between directions that must not be parallel.
pub const SINE_MIN: f64 = 1e-6;
/// Greatest width and height of a picture.
pub const SIDE_MAX: u32 = 65_536;
/// Greatest number of pixels of a picture.
pub const PIXELS_MAX: u64 = 1 << 28;
/// Greatest number of samples per pixel.
pub const SAMPLES_MAX: u32 = 1 << 24;
/// Greatest depth of a path.
pub const DEPTH_MAX: u32 = 65_535;
/// Most octaves of noise.
pub const OCTAVES_MAX: u32 = 16;
/// How deep checkers may be nested in checkers.
pub const TEXTURE_NESTING_MAX: usize = 16;
/// How deep prototypes may be nested in prototypes.
pub const PROTOTYPE_NESTING_MAX: usize = 32;
/// How deep mixed materials may be nested in mixed materials.
pub const MIX_NESTING_MAX: usize = 16;
/// How deep groups may be nested in groups.
pub const GROUP_NESTING_MAX: usize = 64;
