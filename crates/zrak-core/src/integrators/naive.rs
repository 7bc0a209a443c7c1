//! The naive estimator: follow a path until it is absorbed or leaves, add what it meets on the way.
//!
//! With L = E + T L (emission E, transport T), radiance is the sum of T^k E. A path x0 x1 ... with
//! throughput b_k, the product of f cos / pdf at its first k vertices, gives the unbiased estimate
//! sum of b_k E(x_k): emission is added where the path meets it, by chance alone. Only lights that no
//! path can meet, those without a surface, are looked at from each vertex: one of them, chosen
//! uniformly. Every other integrator must converge to the same picture.
//!
//! Rays to lights take their turn in the same loop as the others, so that there is one traversal for
//! all: a path that looks at a light remembers how it will go on.

use crate::accel::Accel;
use crate::interaction::{Hit, SurfaceInteraction};
use crate::lights::LightSample;
use crate::materials::{Scatter, evaluate, medium_towards, resolve, respond};
use crate::math::{Color, Vec3, dot};
use crate::media::{HomogeneousMedium, VACUUM};
use crate::ray::Ray;
use crate::sampler::{BounceDim, Sampler};
use crate::scene::{Feature, MaterialKind, PrimKind, SceneView, TextureKind};
use crate::shapes::surface_interaction;

/// Most holes that a path may pass before it is given up.
const MAX_HOLES: u32 = 4096;

/// How a path goes on once it has looked at a light.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// Whether it does.
    goes_on: bool,
    /// Along which ray.
    ray: Ray,
    /// In which medium.
    medium: u32,
}

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
    /// Those of them that do not count as segments: beyond holes, and to lights.
    n_extra: u32,
    /// Medium that the ray is in, of those that surfaces bound.
    medium: u32,
    /// Length of the path, for the footprint of its cone of rays.
    length: f32,
    /// Whether the ray is one to a light.
    to_light: bool,
    /// How far it goes.
    t_max: f32,
    /// What it brings if nothing is in the way.
    light: Color,
    pending: Pending,
}

/// Where light is scattered.
enum Vertex {
    Surface(SurfaceInteraction),
    /// In a medium that surfaces bound.
    Bounded(HomogeneousMedium),
    /// In a medium of constant density.
    Constant,
}

impl Path {
    /// Path of a sample of the pixel (`x`, `y`), before its first ray.
    #[inline(always)]
    #[must_use]
    pub fn start(scene: &SceneView, x: u32, y: u32, sample: u32) -> Self {
        let sampler = Sampler::new(scene.globals.seed(), x, y, sample);
        let ray = scene.globals.camera.ray(x, y, &sampler);
        let medium = scene.globals.camera_medium;
        Self {
            ray,
            sampler,
            throughput: Color::WHITE,
            radiance: Color::BLACK,
            n_rays: 0,
            n_extra: 0,
            medium,
            length: 0.0,
            to_light: false,
            t_max: f32::INFINITY,
            light: Color::BLACK,
            pending: Pending { goes_on: false, ray, medium },
        }
    }

    /// Traces one ray and prepares the next; false if the path has ended.
    #[inline(always)]
    pub fn advance(&mut self, scene: &SceneView, accel: impl Accel) -> bool {
        let has_lights = scene.kinds.has_feature(Feature::Lights);
        let sampler =
            if has_lights && self.to_light { self.sampler.toward_light() } else { self.sampler };
        let t_max = if has_lights { self.t_max } else { f32::INFINITY };
        self.n_rays += 1;
        let hit = accel.closest_hit(scene, &self.ray, &sampler, t_max);
        self.shade(scene, hit, &sampler, t_max)
    }

    /// What follows from the closest hit before `t_max`, if there is one.
    ///
    /// A call on the processor, so that it is compiled once and not with every tree and instruction
    /// set; on the GPU a part of the kernel, which leaves out what its scenes do not have.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    #[cfg_attr(not(target_arch = "nvptx64"), inline(never))]
    fn shade(
        &mut self,
        scene: &SceneView,
        hit: Option<Hit>,
        sampler: &Sampler,
        t_max: f32,
    ) -> bool {
        let kinds = scene.kinds;
        let has_lights = kinds.has_feature(Feature::Lights);
        let has_holes = kinds.has_material(MaterialKind::Surface)
            || kinds.has_material(MaterialKind::Interface);
        let has_media = kinds.has_feature(Feature::Media);
        let to_light = has_lights && self.to_light;
        let t_end = match hit {
            Some(hit) => hit.t,
            None => t_max,
        };
        let d = self.ray.d;
        // Where the path is scattered, and a point in a medium if it is there.
        let mut p = self.ray.o;
        let mut vertex = None;
        if has_media && self.medium != VACUUM {
            let medium = scene.homogeneous_media.get(self.medium);
            if to_light {
                self.light *= medium.transmittance(t_end);
            } else {
                let u_channel = sampler.at_bounce(BounceDim::Channel);
                let flight = medium.sample(t_end, u_channel, sampler.at_bounce(BounceDim::Flight));
                self.throughput *= flight.weight;
                if let Some(t) = flight.collision {
                    p = self.ray.at(t);
                    self.length += t;
                    vertex = Some(Vertex::Bounded(medium));
                }
            }
        }
        let mut emitted = Color::BLACK;
        let mut media = None;
        if vertex.is_none() {
            let Some(hit) = hit else {
                if to_light {
                    self.radiance += self.light;
                    return self.resume();
                }
                // Left the scene.
                self.radiance += self.throughput * scene.radiance_from_beyond(d);
                return false;
            };
            if !to_light {
                self.length += hit.t;
            }
            if kinds.has_prim(PrimKind::Medium) && hit.prim.kind() == Some(PrimKind::Medium) {
                if to_light {
                    return self.resume();
                }
                p = self.ray.at(hit.t);
                let phase =
                    scene.isotropics.get(scene.media.get(hit.prim.index()).material.index());
                self.throughput *= phase.albedo_at(scene, p);
                vertex = Some(Vertex::Constant);
            } else {
                if to_light && !has_holes {
                    return self.resume();
                }
                let mut surface = surface_interaction(scene, &hit, &self.ray);
                if kinds.has_texture(TextureKind::Image) || kinds.has_texture(TextureKind::Program)
                {
                    surface.footprint = scene.globals.camera.spread * self.length;
                }
                let resolved = resolve(scene, &mut surface, d, sampler);
                if has_holes && resolved.is_hole {
                    self.n_extra += 1;
                    self.ray = surface.spawn(d, self.ray.time);
                    if let Some(media) = resolved.media {
                        self.medium = medium_towards(media, surface.n, d);
                    }
                    if has_lights {
                        self.t_max -= hit.t;
                    }
                    self.sampler.next_bounce();
                    return self.n_extra < MAX_HOLES;
                }
                if to_light {
                    return self.resume();
                }
                emitted = resolved.emitted;
                media = resolved.media;
                vertex = Some(Vertex::Surface(surface));
            }
        }
        let Some(vertex) = vertex else { return false };
        self.scatter(scene, &vertex, p, emitted, media)
    }

    /// Scatters the path at a vertex, and looks at a light from there.
    #[inline(always)]
    fn scatter(
        &mut self,
        scene: &SceneView,
        vertex: &Vertex,
        p: Vec3,
        emitted: Color,
        media: Option<[u32; 2]>,
    ) -> bool {
        let kinds = scene.kinds;
        let (d, time) = (self.ray.d, self.ray.time);
        let sampler = self.sampler;
        let may_go_on = self.n_rays - self.n_extra < scene.globals.max_depth;
        let medium_at = |medium: u32, wi: Vec3| match (vertex, media) {
            (Vertex::Surface(surface), Some(media)) if kinds.has_feature(Feature::Media) => {
                medium_towards(media, surface.n, wi)
            }
            _ => medium,
        };
        let spawn = |wi: Vec3| match vertex {
            Vertex::Surface(surface) => surface.spawn(wi, time),
            _ => Ray { o: p, d: wi, time },
        };
        let before = self.throughput;
        self.radiance += before * emitted;
        let u =
            || (sampler.at_bounce(BounceDim::DirectionU), sampler.at_bounce(BounceDim::DirectionV));
        let scatter = match vertex {
            Vertex::Surface(surface) => {
                let response = respond(scene, surface, d, &sampler);
                self.radiance += before * response.emitted;
                response.scatter
            }
            Vertex::Bounded(medium) => {
                let (u, v) = u();
                Some(Scatter { wi: medium.scatter(d, u, v), attenuation: Color::WHITE })
            }
            Vertex::Constant => {
                let (u, v) = u();
                let wi = crate::math::square_to_uniform_sphere(u, v).normalized();
                Some(Scatter { wi, attenuation: Color::WHITE })
            }
        };
        let mut pending = Pending { goes_on: false, ray: self.ray, medium: self.medium };
        if let Some(scatter) = scatter {
            self.throughput *= scatter.attenuation;
            pending = Pending {
                goes_on: self.survives(scene, &sampler) && may_go_on,
                ray: spawn(scatter.wi),
                medium: medium_at(self.medium, scatter.wi),
            };
        }
        // A ray to a light is a segment, too.
        if kinds.has_feature(Feature::Lights) && may_go_on {
            let from = match vertex {
                Vertex::Surface(surface) => surface.p,
                _ => p,
            };
            if let Some((light, share)) = choose_light(scene, from, &sampler) {
                let f = match vertex {
                    Vertex::Surface(surface) => evaluate(scene, surface, d, light.wi, &sampler),
                    Vertex::Bounded(medium) => Color::grey(medium.phase(dot(d, light.wi))),
                    Vertex::Constant => Color::grey(0.25 * core::f32::consts::FRAC_1_PI),
                };
                let light_here = before * f * light.irradiance * share;
                if light_here != Color::BLACK {
                    self.light = light_here;
                    self.to_light = true;
                    self.t_max = light.distance;
                    self.medium = medium_at(self.medium, light.wi);
                    self.ray = spawn(light.wi);
                    self.n_extra += 1;
                    self.pending = pending;
                    return true;
                }
            }
        }
        self.go_on(pending)
    }

    /// Russian roulette (Arvo and Kirk, *Particle Transport and Image Synthesis*, 1990): a path goes on
    /// with the chance q = min(1, largest channel of the throughput), and what then goes on is worth 1 / q
    /// as much, which leaves the expectation as it is.
    #[inline(always)]
    fn survives(&mut self, scene: &SceneView, sampler: &Sampler) -> bool {
        let q = self.throughput.max_channel();
        if self.n_rays - self.n_extra < scene.globals.rr_depth || q >= 1.0 {
            return true;
        }
        let goes_on = sampler.at_bounce(BounceDim::Roulette) < q;
        if goes_on {
            self.throughput = self.throughput * (1.0 / q);
        }
        goes_on
    }

    /// Takes the path up again after a look at a light.
    #[inline(always)]
    fn resume(&mut self) -> bool {
        self.to_light = false;
        self.t_max = f32::INFINITY;
        let pending = self.pending;
        self.go_on(pending)
    }

    #[inline(always)]
    fn go_on(&mut self, pending: Pending) -> bool {
        self.ray = pending.ray;
        self.medium = pending.medium;
        self.sampler.next_bounce();
        pending.goes_on
    }
}

/// One of the lights without a surface, chosen uniformly, and one over its chance.
#[inline(always)]
fn choose_light(scene: &SceneView, p: Vec3, sampler: &Sampler) -> Option<(LightSample, f32)> {
    let n_lights = scene.lights.len();
    if n_lights == 0 {
        return None;
    }
    let chosen = (sampler.at_bounce(BounceDim::Light) * n_lights as f32) as u32;
    let light = scene.lights.get(chosen.min(n_lights - 1)).sample(p);
    Some((light, n_lights as f32))
}
