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

mod conductor;
mod dielectric;
mod diffuse_light;
mod diffuse_transmission;
mod isotropic;
mod lambertian;
mod layered;
mod metal;
mod principled;
mod rough_dielectric;
mod roughness;
mod surface;

#[cfg(test)]
mod tests;

pub use conductor::{Conductor, METAL_INDEX, METAL_REFLECTANCE};
pub use dielectric::{
    Dielectric, FRESNEL_EXACT, FRESNEL_SCHLICK, fresnel_dielectric, refract, schlick,
};
pub use diffuse_light::{DiffuseLight, SIDES_BOTH, SIDES_FRONT};
pub use diffuse_transmission::DiffuseTransmission;
pub use isotropic::Isotropic;
pub use lambertian::Lambertian;
pub use layered::{BASE_DIFFUSE, BASE_METAL, Layered};
pub use metal::{Metal, reflect};
pub use principled::{PRINCIPLED_THIN_WALLED, Principled};
pub use rough_dielectric::{RoughDielectric, ThinDielectric};
pub use roughness::{ROUGHNESS_ALPHA, ROUGHNESS_SQRT, ROUGHNESS_SQUARE, Roughness};
pub use surface::{
    Frame, Mix, Resolved, SURFACE_ALPHA, SURFACE_BUMP, SURFACE_CUTOFF, SURFACE_EMISSION,
    SURFACE_MEDIUM, SURFACE_NORMAL_MAP, SURFACE_ONE_SIDED, Surface, medium_towards, resolve,
};

use crate::bxdfs::{BsdfSample, Lobes, evaluate_principled, sample_principled, thin_dielectric};
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, dot};
use crate::sampler::{BounceDim, Sampler};
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
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn evaluate(
    scene: &SceneView,
    surface: &SurfaceInteraction,
    d: Vec3,
    wi: Vec3,
    sampler: &Sampler,
) -> Color {
    let i = surface.material.index();
    let has = |kind| scene.kinds.has_material(kind);
    if leaks(scene, surface, d, wi) {
        return Color::BLACK;
    }
    match surface.material.kind() {
        Some(kind @ MaterialKind::Lambertian) if has(kind) => {
            scene.lambertians.get(i).evaluate(scene, surface, d, wi)
        }
        Some(kind @ MaterialKind::Metal) if has(kind) => {
            scene.metals.get(i).evaluate(scene, surface, d, wi)
        }
        Some(kind) if has(kind) && is_local(kind) => {
            let frame = Frame::of(surface);
            evaluate_local(scene, surface, kind, frame.to_local(-d), frame.to_local(wi), sampler)
        }
        _ => Color::BLACK,
    }
}

/// Response of a surface, once resolved, to a path that arrives along `d`.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn respond(
    scene: &SceneView,
    surface: &SurfaceInteraction,
    d: Vec3,
    sampler: &Sampler,
) -> Response {
    let i = surface.material.index();
    let has = |kind| scene.kinds.has_material(kind);
    let response = match surface.material.kind() {
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
        Some(kind) if has(kind) && is_local(kind) => {
            let frame = Frame::of(surface);
            match sample_local(scene, surface, kind, frame.to_local(-d), sampler) {
                Some(sample) => Response::scattered(frame.to_world(sample.wi), sample.weight),
                None => Response::ABSORBED,
            }
        }
        // A phase function on a surface: the host refuses it.
        _ => Response::ABSORBED,
    };
    match response.scatter {
        Some(scatter) if leaks(scene, surface, d, scatter.wi) => Response::ABSORBED,
        _ => response,
    }
}

/// Whether light from `wi` would come through a surface that is opaque: the shading normal, turned by a
/// map or a mesh, has a part of its upper half below the surface itself.
#[inline(always)]
fn leaks(scene: &SceneView, surface: &SurfaceInteraction, d: Vec3, wi: Vec3) -> bool {
    if surface.ns == surface.n || dot(surface.n, d) * dot(surface.n, wi) <= 0.0 {
        return false;
    }
    match surface.material.kind() {
        Some(
            MaterialKind::Lambertian
            | MaterialKind::Metal
            | MaterialKind::Conductor
            | MaterialKind::Layered,
        ) => true,
        Some(kind @ MaterialKind::Principled) if scene.kinds.has_material(kind) => {
            scene.principleds.get(surface.material.index()).is_opaque()
        }
        _ => false,
    }
}

/// What the random numbers of a BSDF that needs many are for.
const STREAM_SAMPLE: u32 = 1;
/// The same for evaluating it.
const STREAM_EVALUATE: u32 = 2;

/// Whether a material is a BSDF in the local frame.
#[inline(always)]
const fn is_local(kind: MaterialKind) -> bool {
    matches!(
        kind,
        MaterialKind::Conductor
            | MaterialKind::RoughDielectric
            | MaterialKind::ThinDielectric
            | MaterialKind::DiffuseTransmission
            | MaterialKind::Layered
            | MaterialKind::Principled
    )
}

/// Draws a direction from such a material.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
fn sample_local(
    scene: &SceneView,
    surface: &SurfaceInteraction,
    kind: MaterialKind,
    wo: Vec3,
    sampler: &Sampler,
) -> Option<BsdfSample> {
    let (i, at) = (surface.material.index(), surface.texture_context());
    let has = |kind| scene.kinds.has_material(kind);
    let u_lobe = sampler.at_bounce(BounceDim::Lobe);
    let u = sampler.at_bounce(BounceDim::DirectionU);
    let v = sampler.at_bounce(BounceDim::DirectionV);
    match kind {
        MaterialKind::Conductor if has(kind) => {
            scene.conductors.get(i).bsdf(scene, &at).sample(wo, u, v)
        }
        MaterialKind::RoughDielectric if has(kind) => {
            let bsdf = scene.rough_dielectrics.get(i).bsdf(scene, &at);
            bsdf.sample(wo, Lobes::BOTH, u_lobe, u, v)
        }
        MaterialKind::ThinDielectric if has(kind) => {
            Some(thin_dielectric(wo, scene.thin_dielectrics.get(i).ior, u_lobe))
        }
        MaterialKind::DiffuseTransmission if has(kind) => {
            scene.diffuse_transmissions.get(i).bsdf(scene, &at).sample(wo, u_lobe, u, v)
        }
        MaterialKind::Layered if has(kind) => {
            let bsdf = scene.layereds.get(i).bsdf(scene, &at);
            bsdf.sample(wo, &mut sampler.stream(STREAM_SAMPLE))
        }
        MaterialKind::Principled if has(kind) => {
            let params = scene.principleds.get(i).evaluate(scene, &at);
            sample_principled(&params, wo, u_lobe, u, v)
        }
        _ => None,
    }
}

/// f |cos wi| of such a material.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
fn evaluate_local(
    scene: &SceneView,
    surface: &SurfaceInteraction,
    kind: MaterialKind,
    wo: Vec3,
    wi: Vec3,
    sampler: &Sampler,
) -> Color {
    let (i, at) = (surface.material.index(), surface.texture_context());
    let has = |kind| scene.kinds.has_material(kind);
    match kind {
        MaterialKind::Conductor if has(kind) => {
            scene.conductors.get(i).bsdf(scene, &at).eval(wo, wi).f_cos
        }
        MaterialKind::RoughDielectric if has(kind) => {
            scene.rough_dielectrics.get(i).bsdf(scene, &at).eval(wo, wi, Lobes::BOTH).f_cos
        }
        MaterialKind::DiffuseTransmission if has(kind) => {
            scene.diffuse_transmissions.get(i).bsdf(scene, &at).eval(wo, wi).f_cos
        }
        MaterialKind::Layered if has(kind) => {
            let bsdf = scene.layereds.get(i).bsdf(scene, &at);
            bsdf.eval(wo, wi, &mut sampler.stream(STREAM_EVALUATE))
        }
        MaterialKind::Principled if has(kind) => {
            let params = scene.principleds.get(i).evaluate(scene, &at);
            evaluate_principled(&params, wo, wi).f_cos
        }
        _ => Color::BLACK,
    }
}
