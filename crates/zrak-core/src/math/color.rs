//! The one type of colour: estimators use its operations, and never its channels.

use core::ops::{Add, AddAssign, Mul, MulAssign, Sub};

use bytemuck::{Pod, Zeroable};

use super::scalar::{lerp, max, min};

/// Radiance, albedo or attenuation, in linear sRGB.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Color {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Color {
    /// No light.
    pub const BLACK: Self = Self::new(0.0, 0.0, 0.0);
    /// All light passes.
    pub const WHITE: Self = Self::new(1.0, 1.0, 1.0);

    /// Colour of three channels.
    #[inline(always)]
    #[must_use]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// Colour whose channels are all `v`.
    #[inline(always)]
    #[must_use]
    pub const fn grey(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// From an array of red, green, blue.
    #[inline(always)]
    #[must_use]
    pub const fn from_array(v: [f32; 3]) -> Self {
        Self::new(v[0], v[1], v[2])
    }

    /// As an array of red, green, blue.
    #[inline(always)]
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Linear blend: `a` at `t` = 0, `b` at `t` = 1.
    #[inline(always)]
    #[must_use]
    pub fn lerp(t: f32, a: Self, b: Self) -> Self {
        Self::new(lerp(t, a.r, b.r), lerp(t, a.g, b.g), lerp(t, a.b, b.b))
    }

    /// Nearest share of light: each channel brought into [0, 1].
    #[inline(always)]
    #[must_use]
    pub fn to_share(self) -> Self {
        let clamp = |x: f32| max(0.0, min(x, 1.0));
        Self::new(clamp(self.r), clamp(self.g), clamp(self.b))
    }

    /// Applies `f` to each channel.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// Largest channel.
    #[inline(always)]
    #[must_use]
    pub fn max_channel(self) -> f32 {
        max(self.r, max(self.g, self.b))
    }
}

impl Add for Color {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl Sub for Color {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.r - o.r, self.g - o.g, self.b - o.b)
    }
}

impl AddAssign for Color {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Mul for Color {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl MulAssign for Color {
    #[inline(always)]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl Mul<f32> for Color {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f32) -> Self {
        Self::new(self.r * s, self.g * s, self.b * s)
    }
}
