//! Lights without a surface: no path meets them by chance, so every integrator looks at them.
//!
//! # To add a light
//! 1. Add a kind and what it needs to [`Light`], and an arm to [`Light::sample`], with a test.
//! 2. On the host: describe it (`zrak-scene`, `desc/lights.rs`), validate it, lower it.

mod environment;

pub use environment::{ENVIRONMENT_EQUAL_AREA, ENVIRONMENT_EQUIRECT, Environment};

use bytemuck::{Pod, Zeroable};

use crate::math::{Color, Vec3, dot, max, min, sqrt};

/// Shines evenly from a point.
pub const LIGHT_POINT: u32 = 0;
/// Shines from a point into a cone.
pub const LIGHT_SPOT: u32 = 1;
/// Shines from infinitely far away.
pub const LIGHT_DISTANT: u32 = 2;

/// A spot falls off as x^2 (3 - 2 x), as in pbrt.
pub const FALLOFF_SMOOTHSTEP: u32 = 0;
/// A spot falls off as x^2, as glTF recommends.
pub const FALLOFF_SQUARE: u32 = 1;

/// A light without a surface.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Light {
    /// Where it is, in world space.
    pub position: Vec3,
    /// [`LIGHT_POINT`], [`LIGHT_SPOT`] or [`LIGHT_DISTANT`].
    pub kind: u32,
    /// Unit vector along which it shines: the axis of a spot, the direction of distant light.
    pub direction: Vec3,
    /// Cosine of a spot's angle where it begins to get darker.
    pub cos_start: f32,
    /// Radiant intensity (power per steradian); irradiance on a surface that faces distant light.
    pub intensity: Color,
    /// Cosine of a spot's angle where it is dark.
    pub cos_rim: f32,
    /// [`FALLOFF_SMOOTHSTEP`] or [`FALLOFF_SQUARE`].
    pub falloff: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Light>() == 64);

/// Light that arrives at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector towards the light.
    pub wi: Vec3,
    /// Distance to it; infinite if it is infinitely far away.
    pub distance: f32,
    /// Irradiance on a surface that faces it, if nothing is in between.
    pub irradiance: Color,
}

impl Light {
    /// Light that arrives at the world-space point `p`.
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, p: Vec3) -> LightSample {
        if self.kind == LIGHT_DISTANT {
            return LightSample {
                wi: -self.direction,
                distance: f32::INFINITY,
                irradiance: self.intensity,
            };
        }
        let to_light = self.position - p;
        // At the light itself it would be infinite; nobody is closer than this.
        let d2 = max(to_light.length_squared(), 1e-30);
        let distance = sqrt(d2);
        let wi = to_light * (1.0 / distance);
        let share =
            if self.kind == LIGHT_SPOT { self.falloff(-dot(wi, self.direction)) } else { 1.0 };
        LightSample { wi, distance, irradiance: self.intensity * (share / d2) }
    }

    /// Share of the intensity at an angle from the axis with this cosine.
    #[inline(always)]
    fn falloff(&self, cos: f32) -> f32 {
        if cos >= self.cos_start {
            return 1.0;
        }
        if cos <= self.cos_rim {
            return 0.0;
        }
        let x = max(0.0, min(1.0, (cos - self.cos_rim) / (self.cos_start - self.cos_rim)));
        if self.falloff == FALLOFF_SQUARE { x * x } else { x * x * (3.0 - 2.0 * x) }
    }
}

#[cfg(test)]
mod tests;
