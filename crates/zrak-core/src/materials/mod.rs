//! Materials: how a surface scatters or emits light.
//!
//! # To add a material
//! 1. Write its record and its `respond` in a file of its own here, with tests against a closed form.
//! 2. Add its array to [`crate::for_each_scene_array!`] and its kind to [`MaterialKind`].
//! 3. Add it to the `match`es of [`respond`] and [`evaluate`] and to `SceneView::kinds_in_use`.
//! 4. On the host: describe it (`zrak-scene`, `desc.rs`), validate it, lower it, and check its handles
//!    (`arena/check.rs`).
//!
//! Directions are unit vectors in world space; `d` is the ray's own direction, towards the surface.

mod dielectric;
mod diffuse_light;
mod isotropic;
mod lambertian;
mod metal;
mod surface;

#[cfg(test)]
mod tests;

pub use dielectric::{
    Dielectric, FRESNEL_EXACT, FRESNEL_SCHLICK, fresnel_dielectric, refract, schlick,
};
pub use diffuse_light::{DiffuseLight, SIDES_BOTH, SIDES_FRONT};
pub use isotropic::Isotropic;
pub use lambertian::Lambertian;
pub use metal::{Metal, reflect};
pub use surface::{
    Frame, Mix, Resolved, SURFACE_ALPHA, SURFACE_BUMP, SURFACE_CUTOFF, SURFACE_EMISSION,
    SURFACE_MEDIUM, SURFACE_NORMAL_MAP, SURFACE_ONE_SIDED, Surface, medium_towards, resolve,
};

use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3};
use crate::sampler::Sampler;
use crate::scene::{MaterialKind, SceneView};

/// A direction drawn from a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// The direction in which the path goes on: unit length.
    pub wi: Vec3,
    /// f(wo, wi) |cos| / pdf(wi): what the light from there is multiplied with.
    pub attenuation: Color,
}

/// What a surface does to a path that meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Radiance emitted towards where the path came from.
    pub emitted: Color,
    /// How the path goes on; it ends if it does not.
    pub scatter: Option<Scatter>,
}

impl Response {
    const ABSORBED: Self = Self { emitted: Color::BLACK, scatter: None };

    #[inline(always)]
    const fn scattered(wi: Vec3, attenuation: Color) -> Self {
        Self { emitted: Color::BLACK, scatter: Some(Scatter { wi, attenuation }) }
    }
}

/// f(wo, wi) |cos| for light that arrives along `wi` (towards where it comes from) and leaves against
/// `d`; black for deltas. Both directions are unit vectors in world space.
#[inline(always)]
#[must_use]
pub fn evaluate(scene: &SceneView, surface: &SurfaceInteraction, d: Vec3, wi: Vec3) -> Color {
    let i = surface.material.index();
    let has = |kind| scene.kinds.has_material(kind);
    match surface.material.kind() {
        Some(kind @ MaterialKind::Lambertian) if has(kind) => {
            scene.lambertians.get(i).evaluate(scene, surface, d, wi)
        }
        Some(kind @ MaterialKind::Metal) if has(kind) => {
            scene.metals.get(i).evaluate(scene, surface, d, wi)
        }
        _ => Color::BLACK,
    }
}

/// Response of a surface, once resolved, to a path that arrives along `d`.
#[inline(always)]
#[must_use]
pub fn respond(
    scene: &SceneView,
    surface: &SurfaceInteraction,
    d: Vec3,
    sampler: &Sampler,
) -> Response {
    let i = surface.material.index();
    let has = |kind| scene.kinds.has_material(kind);
    match surface.material.kind() {
        Some(kind @ MaterialKind::Lambertian) if has(kind) => {
            scene.lambertians.get(i).respond(scene, surface, d, sampler)
        }
        Some(kind @ MaterialKind::Metal) if has(kind) => {
            scene.metals.get(i).respond(scene, surface, d, sampler)
        }
        Some(kind @ MaterialKind::Dielectric) if has(kind) => {
            scene.dielectrics.get(i).respond(surface, d, sampler)
        }
        Some(kind @ MaterialKind::DiffuseLight) if has(kind) => {
            scene.diffuse_lights.get(i).respond(scene, surface, d)
        }
        // A phase function on a surface: the host refuses it.
        _ => Response::ABSORBED,
    }
}
