//! What a surface has besides the material that scatters: light of its own, holes, bumps, media; and
//! the choice between mixed materials.

use bytemuck::{Pod, Zeroable};

use super::{SIDES_BOTH, SIDES_FRONT};
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3, cross, dot, max, vec3};
use crate::media::VACUUM;
use crate::sampler::{BounceDim, Sampler};
use crate::scene::{MaterialKind, MaterialRef, SceneView, TextureRef};
use crate::textures::{ColorInput, ScalarInput, TextureContext};

/// Flag of a surface with an alpha.
pub const SURFACE_ALPHA: u32 = 1;
/// Flag of a surface whose alpha is compared with a cutoff.
pub const SURFACE_CUTOFF: u32 = 2;
/// Flag of a surface with a normal map.
pub const SURFACE_NORMAL_MAP: u32 = 4;
/// Flag of a surface with bumps.
pub const SURFACE_BUMP: u32 = 8;
/// Flag of a surface that bounds media.
pub const SURFACE_MEDIUM: u32 = 16;
/// Flag of a surface whose back is a hole.
pub const SURFACE_ONE_SIDED: u32 = 32;
/// Flag of a surface that emits.
pub const SURFACE_EMISSION: u32 = 64;

/// A material with more about its surface.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Surface {
    /// Emitted radiance.
    pub emission: ColorInput,
    /// Factor of the emitted radiance.
    pub emission_strength: f32,
    /// [`SIDES_BOTH`] or [`SIDES_FRONT`].
    pub emission_sides: u32,
    /// The material that scatters: not itself a surface.
    pub base: MaterialRef,
    /// Which of the things below there are.
    pub flags: u32,
    /// How much of the surface is there.
    pub alpha: ScalarInput,
    /// Below this alpha is a hole.
    pub alpha_cutoff: f32,
    /// Factor of the normal map's x and y.
    pub normal_scale: f32,
    /// Height in world units.
    pub bump: ScalarInput,
    /// Normals in tangent space, as (n + 1) / 2.
    pub normal_map: TextureRef,
    /// Index of the medium behind the surface, or [`VACUUM`].
    pub inside: u32,
    /// Index of the medium before the surface, or [`VACUUM`].
    pub outside: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Surface>() == 80);

/// One of two materials at random.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Mix {
    /// Chance of the second.
    pub amount: ScalarInput,
    /// The two; if they are mixes themselves, ones with a smaller index.
    pub materials: [MaterialRef; 2],
}

const _: () = assert!(size_of::<Mix>() == 16);

/// What is found at a point of a surface before anything is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolved {
    /// Radiance emitted towards where the path came from.
    pub emitted: Color,
    /// Whether light goes straight through.
    pub is_hole: bool,
    /// Media behind and before the surface, if it bounds any.
    pub media: Option<[u32; 2]>,
}

/// Finds out what is at a point that is looked at along `d`, and leaves in `surface` the material
/// that scatters and the normal for it.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn resolve(
    scene: &SceneView,
    surface: &mut SurfaceInteraction,
    d: Vec3,
    sampler: &Sampler,
) -> Resolved {
    let mut resolved = Resolved { emitted: Color::BLACK, is_hole: false, media: None };
    let has = |kind| scene.kinds.has_material(kind);
    if has(MaterialKind::Surface) && surface.material.kind() == Some(MaterialKind::Surface) {
        let record = scene.surfaces.get(surface.material.index());
        record.apply(scene, surface, d, sampler, &mut resolved);
        surface.material = record.base;
    }
    if has(MaterialKind::Mix) {
        let at = surface.texture_context();
        // One number serves all choices: what is left of it after each is uniform again.
        let mut u = sampler.at_bounce(BounceDim::Mix);
        while surface.material.kind() == Some(MaterialKind::Mix) {
            let mix = scene.mixes.get(surface.material.index());
            let amount = max(0.0, crate::math::min(1.0, mix.amount.evaluate(scene, &at)));
            let second = u < amount;
            u = if second { u / amount } else { (u - amount) / (1.0 - amount) };
            surface.material = mix.materials[usize::from(second)];
        }
    }
    if has(MaterialKind::Interface) && surface.material.kind() == Some(MaterialKind::Interface) {
        resolved.is_hole = true;
    }
    resolved
}

impl Surface {
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn apply(
        &self,
        scene: &SceneView,
        surface: &mut SurfaceInteraction,
        d: Vec3,
        sampler: &Sampler,
        resolved: &mut Resolved,
    ) {
        let at = surface.texture_context();
        let is_front = surface.is_front(d);
        if self.flags & SURFACE_MEDIUM != 0 {
            resolved.media = Some([self.inside, self.outside]);
        }
        if self.flags & SURFACE_ALPHA != 0 {
            let alpha = self.alpha.evaluate(scene, &at);
            resolved.is_hole = if self.flags & SURFACE_CUTOFF != 0 {
                alpha < self.alpha_cutoff
            } else {
                sampler.at_bounce(BounceDim::Alpha) >= alpha
            };
        }
        if self.flags & SURFACE_ONE_SIDED != 0 && !is_front {
            resolved.is_hole = true;
        }
        if resolved.is_hole {
            return;
        }
        if self.flags & SURFACE_EMISSION != 0
            && (self.emission_sides == SIDES_BOTH
                || (self.emission_sides == SIDES_FRONT && is_front))
        {
            resolved.emitted = self.emission.evaluate(scene, &at) * self.emission_strength;
        }
        if self.flags & SURFACE_BUMP != 0 {
            self.bump(scene, surface, &at);
        }
        if self.flags & SURFACE_NORMAL_MAP != 0 {
            self.map_normal(scene, surface, &at);
        }
    }

    /// Turns the shading normal by the normal map, in the frame of the texture's directions.
    #[cfg_attr(target_arch = "nvptx64", inline(always))]
    fn map_normal(&self, scene: &SceneView, surface: &mut SurfaceInteraction, at: &TextureContext) {
        let ns = surface.ns;
        let along_u = surface.dpdu - ns * dot(ns, surface.dpdu);
        let length = along_u.length();
        if length > 0.0 {
            let t = along_u / length;
            let side = cross(ns, t);
            let b = if dot(side, surface.dpdv) < 0.0 { -side } else { side };
            let input = ColorInput { solid: Color::grey(0.5), texture: self.normal_map };
            let c = input.evaluate(scene, at);
            let x = (c.r * 2.0 - 1.0) * self.normal_scale;
            let y = (c.g * 2.0 - 1.0) * self.normal_scale;
            let z = max(c.b * 2.0 - 1.0, 1e-3);
            surface.ns = (t * x + b * y + ns * z).normalized();
        }
    }

    /// Turns the shading normal by the slope of the height: Blinn, *Simulation of Wrinkled Surfaces*,
    /// 1978, with central differences over half the ray's footprint. Differences to one side would move
    /// the bumps to the other.
    #[inline(always)]
    fn bump(&self, scene: &SceneView, surface: &mut SurfaceInteraction, at: &TextureContext) {
        let step = |footprint: f32| max(0.5 * footprint, 5e-4);
        let (du, dv) = (step(at.duv[0]), step(at.duv[1]));
        let shifted = |u: f32, v: f32| TextureContext {
            p: at.p + surface.dpdu * u + surface.dpdv * v,
            uv: [at.uv[0] + u, at.uv[1] + v],
            ..*at
        };
        let (half_u, half_v) = (0.5 * du, 0.5 * dv);
        let right = self.bump.evaluate(scene, &shifted(half_u, 0.0));
        let left = self.bump.evaluate(scene, &shifted(-half_u, 0.0));
        let above = self.bump.evaluate(scene, &shifted(0.0, half_v));
        let below = self.bump.evaluate(scene, &shifted(0.0, -half_v));
        let slope_u = (right - left) / du;
        let slope_v = (above - below) / dv;
        let ns = surface.ns;
        let n = cross(surface.dpdu + ns * slope_u, surface.dpdv + ns * slope_v);
        let length = n.length();
        if length > 1e-30 {
            let n = n / length;
            surface.ns = if dot(n, ns) < 0.0 { -n } else { n };
        }
    }
}

/// Index of the medium that a path along `w` goes on in, of [behind, before] the surface.
#[inline(always)]
#[must_use]
pub fn medium_towards(media: [u32; 2], n: Vec3, w: Vec3) -> u32 {
    if dot(n, w) > 0.0 { media[1] } else { media[0] }
}

/// A surface that is only a material.
impl Default for Surface {
    fn default() -> Self {
        let none = ScalarInput::solid(0.0);
        Self {
            emission: ColorInput { solid: Color::BLACK, texture: TextureRef::default() },
            emission_strength: 1.0,
            emission_sides: SIDES_BOTH,
            base: MaterialRef::default(),
            flags: 0,
            alpha: ScalarInput::solid(1.0),
            alpha_cutoff: 0.5,
            normal_scale: 1.0,
            bump: none,
            normal_map: TextureRef::default(),
            inside: VACUUM,
            outside: VACUUM,
            _pad: [0; 3],
        }
    }
}

/// Unit vectors along u and v of a shading frame, and its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Along the change of the point with u.
    pub s: Vec3,
    /// Perpendicular to both others, right-handed.
    pub t: Vec3,
    /// Shading normal.
    pub n: Vec3,
}

impl Frame {
    /// The shading frame of a point.
    #[inline(always)]
    #[must_use]
    pub fn of(surface: &SurfaceInteraction) -> Self {
        let n = surface.ns;
        let along = surface.dpdu - n * dot(n, surface.dpdu);
        let length = along.length();
        let s = if length > 0.0 { along / length } else { crate::media::tangents(n).0 };
        Self { s, t: cross(n, s), n }
    }

    /// Coordinates of a world-space vector in the frame.
    #[inline(always)]
    #[must_use]
    pub fn to_local(&self, w: Vec3) -> Vec3 {
        vec3(dot(w, self.s), dot(w, self.t), dot(w, self.n))
    }

    /// World-space vector with these coordinates, of unit length if they are.
    #[inline(always)]
    #[must_use]
    pub fn to_world(&self, w: Vec3) -> Vec3 {
        (self.s * w.x + self.t * w.y + self.n * w.z).normalized()
    }
}
