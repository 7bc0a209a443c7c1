//! The naive estimator: follow a path until it is absorbed or leaves, add what it meets on the way.
//!
//! With L = E + T L (emission E, transport T), radiance is the sum of T^k E. A path x0 x1 ... with
//! throughput b_k, the product of f cos / pdf at its first k vertices, gives the unbiased estimate
//! sum of b_k E(x_k): emission is added where the path meets it, by chance alone. Only lights that no
//! path can meet, those without a surface, are looked at from each vertex: one of them, chosen
//! uniformly. Every other integrator must converge to the same picture.

use super::direct::light_from_points;
use crate::accel::Accel;
use crate::materials::{medium_towards, resolve, respond};
use crate::math::Color;
use crate::media::VACUUM;
use crate::ray::Ray;
use crate::sampler::{BounceDim, Sampler};
use crate::scene::{Feature, MaterialKind, PrimKind, SceneView, TextureKind};
use crate::shapes::surface_interaction;

/// Most holes that a path may pass before it is given up.
const MAX_HOLES: u32 = 4096;

/// A path on its way.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    ray: Ray,
    sampler: Sampler,
    throughput: Color,
    /// Radiance gathered so far.
    pub radiance: Color,
    /// Rays traced so far.
    pub n_rays: u32,
    /// Those of them that went on through holes, and do not count as segments.
    n_holes: u32,
    /// Medium that the path is in, of those that surfaces bound.
    medium: u32,
    /// Length of the path, for the footprint of its cone of rays.
    length: f32,
}

impl Path {
    /// Path of a sample of the pixel (`x`, `y`), before its first ray.
    #[inline(always)]
    #[must_use]
    pub fn start(scene: &SceneView, x: u32, y: u32, sample: u32) -> Self {
        let sampler = Sampler::new(scene.globals.seed(), x, y, sample);
        Self {
            ray: scene.globals.camera.ray(x, y, &sampler),
            sampler,
            throughput: Color::WHITE,
            radiance: Color::BLACK,
            n_rays: 0,
            n_holes: 0,
            medium: scene.globals.camera_medium,
            length: 0.0,
        }
    }

    /// Traces one ray and prepares the next; false if the path has ended.
    #[inline(always)]
    pub fn advance(&mut self, scene: &SceneView, accel: impl Accel) -> bool {
        let kinds = scene.kinds;
        self.n_rays += 1;
        // A ray to a light is a segment, too.
        let looks_at_lights = kinds.has_feature(Feature::Lights)
            && self.n_rays - self.n_holes < scene.globals.max_depth;
        let hit = accel.closest_hit(scene, &self.ray, &self.sampler, f32::INFINITY);
        if kinds.has_feature(Feature::Media) && self.medium != VACUUM {
            // Does it collide on the way?
            let medium = scene.homogeneous_media.get(self.medium);
            let t_end = match hit {
                Some(hit) => hit.t,
                None => f32::INFINITY,
            };
            let u_channel = self.sampler.at_bounce(BounceDim::Channel);
            let u = self.sampler.at_bounce(BounceDim::Flight);
            let flight = medium.sample(t_end, u_channel, u);
            self.throughput *= flight.weight;
            if let Some(t) = flight.collision {
                let p = self.ray.at(t);
                if looks_at_lights {
                    let f = |wi| Color::grey(medium.phase(crate::math::dot(self.ray.d, wi)));
                    self.radiance += self.throughput
                        * light_from_points(
                            scene,
                            accel,
                            p,
                            &f,
                            |wi| Ray { o: p, d: wi, time: self.ray.time },
                            |_| self.medium,
                            &self.sampler,
                        );
                }
                let u = self.sampler.at_bounce(BounceDim::DirectionU);
                let v = self.sampler.at_bounce(BounceDim::DirectionV);
                self.length += t;
                self.ray = Ray { o: p, d: medium.scatter(self.ray.d, u, v), time: self.ray.time };
                return self.go_on(scene);
            }
        }
        let Some(hit) = hit else {
            // Left the scene.
            self.radiance += self.throughput * scene.globals.background.radiance(self.ray.d);
            return false;
        };
        self.length += hit.t;
        if kinds.has_prim(PrimKind::Medium) && hit.prim.kind() == Some(PrimKind::Medium) {
            // Collided in a medium of constant density.
            let medium = scene.media.get(hit.prim.index());
            let p = self.ray.at(hit.t);
            let phase = scene.isotropics.get(medium.material.index());
            let scatter = phase.scatter(scene, p, &self.sampler);
            self.throughput *= scatter.attenuation;
            if looks_at_lights {
                let f = |_| Color::grey(0.25 * core::f32::consts::FRAC_1_PI);
                self.radiance += self.throughput
                    * light_from_points(
                        scene,
                        accel,
                        p,
                        &f,
                        |wi| Ray { o: p, d: wi, time: self.ray.time },
                        |_| self.medium,
                        &self.sampler,
                    );
            }
            self.ray = Ray { o: p, d: scatter.wi, time: self.ray.time };
            return self.go_on(scene);
        }
        // Met a surface.
        let mut surface = surface_interaction(scene, &hit, &self.ray);
        if kinds.has_texture(TextureKind::Image) {
            surface.footprint = scene.globals.camera.spread * self.length;
        }
        let d = self.ray.d;
        let resolved = resolve(scene, &mut surface, d, &self.sampler);
        self.radiance += self.throughput * resolved.emitted;
        if (kinds.has_material(MaterialKind::Surface)
            || kinds.has_material(MaterialKind::Interface))
            && resolved.is_hole
        {
            self.n_holes += 1;
            self.ray = surface.spawn(d, self.ray.time);
            if let Some(media) = resolved.media {
                self.medium = medium_towards(media, surface.n, d);
            }
            self.sampler.next_bounce();
            return self.n_holes < MAX_HOLES;
        }
        let medium_at = |wi| match resolved.media {
            Some(media) if kinds.has_feature(Feature::Media) => {
                medium_towards(media, surface.n, wi)
            }
            _ => self.medium,
        };
        if looks_at_lights {
            let f = |wi| crate::materials::evaluate(scene, &surface, d, wi);
            self.radiance += self.throughput
                * light_from_points(
                    scene,
                    accel,
                    surface.p,
                    &f,
                    |wi| surface.spawn(wi, self.ray.time),
                    medium_at,
                    &self.sampler,
                );
        }
        let response = respond(scene, &surface, d, &self.sampler);
        self.radiance += self.throughput * response.emitted;
        let Some(scatter) = response.scatter else {
            return false;
        };
        let medium = medium_at(scatter.wi);
        self.medium = medium;
        self.ray = surface.spawn(scatter.wi, self.ray.time);
        self.throughput *= scatter.attenuation;
        self.go_on(scene)
    }

    /// Goes on to the next bounce, if the path may have one.
    #[inline(always)]
    fn go_on(&mut self, scene: &SceneView) -> bool {
        self.sampler.next_bounce();
        self.n_rays - self.n_holes < scene.globals.max_depth
    }
}
