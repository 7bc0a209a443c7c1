//! Points, directions and normals.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use bytemuck::{Pod, Zeroable};

use super::scalar::{abs, max, sqrt};

/// Three numbers: a point or a direction in the space that the context names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vec3 {
    /// First component.
    pub x: f32,
    /// Second component.
    pub y: f32,
    /// Third component.
    pub z: f32,
}

/// Vector of three components.
#[inline(always)]
#[must_use]
pub const fn vec3(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3 { x, y, z }
}

/// Scalar product, summed from left to right.
#[inline(always)]
#[must_use]
pub fn dot(a: Vec3, b: Vec3) -> f32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Vector product, right-handed.
#[inline(always)]
#[must_use]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

impl Vec3 {
    /// All components zero.
    pub const ZERO: Self = vec3(0.0, 0.0, 0.0);

    /// All components `v`.
    #[inline(always)]
    #[must_use]
    pub const fn splat(v: f32) -> Self {
        vec3(v, v, v)
    }

    /// From an array.
    #[inline(always)]
    #[must_use]
    pub const fn from_array(v: [f32; 3]) -> Self {
        vec3(v[0], v[1], v[2])
    }

    /// As an array.
    #[inline(always)]
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }

    /// Squared Euclidean length.
    #[inline(always)]
    #[must_use]
    pub fn length_squared(self) -> f32 {
        dot(self, self)
    }

    /// Euclidean length.
    #[inline(always)]
    #[must_use]
    pub fn length(self) -> f32 {
        sqrt(self.length_squared())
    }

    /// Same direction, length one. The length must be above 1e-18 and below 1e18.
    #[inline(always)]
    #[must_use]
    pub fn normalized(self) -> Self {
        self * (1.0 / self.length())
    }

    /// Absolute value of each component.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        vec3(abs(self.x), abs(self.y), abs(self.z))
    }

    /// Largest component.
    #[inline(always)]
    #[must_use]
    pub fn max_component(self) -> f32 {
        max(self.x, max(self.y, self.z))
    }

    /// Applies `f` to each component.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        vec3(f(self.x), f(self.y), f(self.z))
    }

    /// Applies `f` to each pair of components.
    #[inline(always)]
    #[must_use]
    pub fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        vec3(f(self.x, other.x), f(self.y, other.y), f(self.z, other.z))
    }
}

impl Add for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        vec3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl AddAssign for Vec3 {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Sub for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        vec3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Mul for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        vec3(self.x * o.x, self.y * o.y, self.z * o.z)
    }
}

impl Mul<f32> for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f32) -> Self {
        vec3(self.x * s, self.y * s, self.z * s)
    }
}

impl Div<f32> for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn div(self, s: f32) -> Self {
        vec3(self.x / s, self.y / s, self.z / s)
    }
}

impl Neg for Vec3 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        vec3(-self.x, -self.y, -self.z)
    }
}
