//! BSDFs: how much light a point of a surface scatters from one direction into another.
//!
//! Everything here is in the local frame: z is the shading normal on the outside, `wo` points to the
//! viewer and `wi` to the light, both of unit length. What is transported is basic radiance, radiance
//! over the square of the index of refraction, so that crossing a surface between dielectrics only takes
//! Fresnel's share; paths that end where they began, in the air, give the same either way.
//!
//! # To add a BSDF
//! Write a struct with its parameters, `sample` and `eval` in a file of its own, and test it in `tests.rs`:
//! chi-squared of `sample` against the density, white furnace, reciprocity.

mod conductor;
mod dielectric;
mod diffuse;
mod fresnel;
mod layered;
mod trowbridge_reitz;

#[cfg(test)]
mod tests;

pub use conductor::ConductorBsdf;
pub use dielectric::{DielectricBsdf, Lobes, thin_dielectric};
pub use diffuse::{DiffuseTransmissionBsdf, cosine_hemisphere};
pub use fresnel::{fresnel_conductor, reflectance_to_k};
pub use layered::{Coat, CoatedBase, LayeredBsdf};
pub use trowbridge_reitz::TrowbridgeReitz;

use crate::math::{Color, Vec3};

/// A direction drawn from a BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The direction.
    pub wi: Vec3,
    /// f(wo, wi) |cos wi| over the density of `wi`.
    pub weight: Color,
    /// Density of `wi` per steradian; 0 where it is a delta.
    pub pdf: f32,
}

/// What a BSDF is for a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue {
    /// f(wo, wi) |cos wi|.
    pub f_cos: Color,
    /// Density with which `sample` gives `wi`, per steradian.
    pub pdf: f32,
}

impl BsdfValue {
    /// No light is scattered from one direction into the other.
    pub const ZERO: Self = Self { f_cos: Color::BLACK, pdf: 0.0 };
}

/// `w` mirrored at the microfacet normal `wm`.
#[inline(always)]
#[must_use]
pub(crate) fn reflect_about(w: Vec3, wm: Vec3) -> Vec3 {
    wm * (2.0 * crate::math::dot(w, wm)) - w
}
