//! Light that reaches a vertex from lights without a surface.

use crate::accel::Accel;
use crate::materials::{medium_towards, resolve};
use crate::math::{Color, Vec3};
use crate::media::VACUUM;
use crate::ray::Ray;
use crate::sampler::{BounceDim, Sampler};
use crate::scene::{Feature, MaterialKind, PrimKind, SceneView};
use crate::shapes::surface_interaction;

/// Most holes that a ray to a light may pass.
const MAX_HOLES: u32 = 256;

/// Estimates the sum over all lights without a surface of f |cos| times their irradiance at a vertex,
/// from one of them, chosen uniformly. `f_cos` is f |cos| for a direction, `spawn` makes the ray
/// that leaves the vertex in it, and `medium` says which medium that ray is in.
#[inline(always)]
#[must_use]
pub(super) fn light_from_points(
    scene: &SceneView,
    accel: impl Accel,
    p: Vec3,
    f_cos: &impl Fn(Vec3) -> Color,
    spawn: impl Fn(Vec3) -> Ray,
    medium: impl Fn(Vec3) -> u32,
    sampler: &Sampler,
) -> Color {
    let n_lights = scene.lights.len();
    if n_lights == 0 {
        return Color::BLACK;
    }
    let chosen = (sampler.at_bounce(BounceDim::Light) * n_lights as f32) as u32;
    let light = scene.lights.get(chosen.min(n_lights - 1)).sample(p);
    let light_here = f_cos(light.wi) * light.irradiance * n_lights as f32;
    if light_here == Color::BLACK {
        return Color::BLACK;
    }
    let ray = spawn(light.wi);
    light_here
        * transmittance(
            scene,
            accel,
            ray,
            light.distance,
            medium(light.wi),
            &sampler.toward_light(),
        )
}

/// Share of light that passes along a ray up to `t_max`: none if a surface is in the way.
#[inline(always)]
#[must_use]
fn transmittance(
    scene: &SceneView,
    accel: impl Accel,
    ray: Ray,
    t_max: f32,
    medium: u32,
    sampler: &Sampler,
) -> Color {
    let kinds = scene.kinds;
    let may_pass =
        kinds.has_material(MaterialKind::Surface) || kinds.has_material(MaterialKind::Interface);
    let (mut ray, mut t_max, mut medium, mut sampler) = (ray, t_max, medium, *sampler);
    let mut share = Color::WHITE;
    let mut n_holes = 0;
    let mut going = true;
    while going {
        let hit = accel.closest_hit(scene, &ray, &sampler, t_max);
        if kinds.has_feature(Feature::Media) && medium != VACUUM {
            let t_end = match hit {
                Some(hit) => hit.t,
                None => t_max,
            };
            share *= scene.homogeneous_media.get(medium).transmittance(t_end);
        }
        going = false;
        if let Some(hit) = hit {
            let mut passes = false;
            let is_medium =
                kinds.has_prim(PrimKind::Medium) && hit.prim.kind() == Some(PrimKind::Medium);
            if may_pass && !is_medium && n_holes < MAX_HOLES {
                let mut surface = surface_interaction(scene, &hit, &ray);
                let resolved = resolve(scene, &mut surface, ray.d, &sampler);
                if resolved.is_hole {
                    if let Some(media) = resolved.media {
                        medium = medium_towards(media, surface.n, ray.d);
                    }
                    ray = surface.spawn(ray.d, ray.time);
                    t_max -= hit.t;
                    sampler.next_bounce();
                    n_holes += 1;
                    passes = true;
                }
            }
            going = passes;
            if !passes {
                share = Color::BLACK;
            }
        }
    }
    share
}
