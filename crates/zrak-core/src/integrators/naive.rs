//! The naive estimator: follow a path until it is absorbed or leaves, add what it meets on the way.
//!
//! With L = E + T L (emission E, transport T), radiance is the sum of T^k E. A path x0 x1 ... with
//! throughput b_k, the product of f cos / pdf at its first k vertices, gives the unbiased estimate
//! sum of b_k E(x_k): emission is added where the path meets it, by chance alone. Every other
//! integrator must converge to the same picture.

use crate::accel::Accel;
use crate::materials::respond;
use crate::math::Color;
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{PrimKind, SceneView};
use crate::shapes::surface_interaction;

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
        }
    }

    /// Traces one ray and prepares the next; false if the path has ended.
    #[inline(always)]
    pub fn advance(&mut self, scene: &SceneView, accel: impl Accel) -> bool {
        self.n_rays += 1;
        let Some(hit) = accel.closest_hit(scene, &self.ray, &self.sampler) else {
            // Left the scene.
            self.radiance += self.throughput * scene.globals.background.radiance(self.ray.d);
            return false;
        };
        let scatter = if scene.kinds.has_prim(PrimKind::Medium)
            && hit.prim.kind() == Some(PrimKind::Medium)
        {
            // Collided in a medium.
            let medium = scene.media.get(hit.prim.index());
            let p = self.ray.at(hit.t);
            let phase = scene.isotropics.get(medium.material.index());
            let scatter = phase.scatter(scene, p, &self.sampler);
            self.ray = Ray { o: p, d: scatter.wi, time: self.ray.time };
            scatter
        } else {
            // Met a surface.
            let surface = surface_interaction(scene, hit.prim, &self.ray, hit.t);
            let response = respond(scene, &surface, self.ray.d, &self.sampler);
            self.radiance += self.throughput * response.emitted;
            let Some(scatter) = response.scatter else {
                return false;
            };
            self.ray = surface.spawn(scatter.wi, self.ray.time);
            scatter
        };
        self.throughput *= scatter.attenuation;
        self.sampler.next_bounce();
        self.n_rays < scene.globals.max_depth
    }
}
