//! Homogeneous media bounded by surfaces, with the Henyey-Greenstein phase function.
//!
//! A path knows which of them it is in: surfaces with a medium interface say what is on their two
//! sides. The distance to a collision is drawn from one of the three channels' exponential
//! distributions, chosen at random; the weight divides by the mean density of the three, which is
//! the balance heuristic. Pharr, Jakob, Humphreys, *Physically Based Rendering*, 3rd ed., 15.2.1.

use bytemuck::{Pod, Zeroable};

use crate::math::{Color, Vec3, abs, cross, exp, ln, max, min, sin_cos_turns, sqrt, vec3};

/// Index that stands for a vacuum.
pub const VACUUM: u32 = u32::MAX;

/// Homogeneous medium.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct HomogeneousMedium {
    /// Absorption coefficient per world unit.
    pub sigma_a: Color,
    /// Mean cosine of the scattering angle.
    pub g: f32,
    /// Scattering coefficient per world unit.
    pub sigma_s: Color,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<HomogeneousMedium>() == 32);

/// What becomes of light on a segment of a path in a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Where it collides, if it does before the end of the segment.
    pub collision: Option<f32>,
    /// What the light is multiplied with: the albedo of the collision is in it.
    pub weight: Color,
}

impl HomogeneousMedium {
    /// Share of light that passes a distance.
    #[inline(always)]
    #[must_use]
    pub fn transmittance(&self, distance: f32) -> Color {
        let one = |a: f32, s: f32| {
            let sigma_t = a + s;
            // Infinitely far there is nothing left, but where there is nothing in the way all of it.
            if sigma_t == 0.0 { 1.0 } else { exp(-sigma_t * distance) }
        };
        Color::new(
            one(self.sigma_a.r, self.sigma_s.r),
            one(self.sigma_a.g, self.sigma_s.g),
            one(self.sigma_a.b, self.sigma_s.b),
        )
    }

    /// Draws what happens before `t_end`. `u_channel` and `u` are uniform in [0, 1).
    #[inline(always)]
    #[must_use]
    pub fn sample(&self, t_end: f32, u_channel: f32, u: f32) -> Flight {
        let s = self.sigma_s;
        if s.r == 0.0 && s.g == 0.0 && s.b == 0.0 {
            return Flight { collision: None, weight: self.transmittance(t_end) };
        }
        let sigma_t = [self.sigma_a.r + s.r, self.sigma_a.g + s.g, self.sigma_a.b + s.b];
        let chosen = if u_channel < 1.0 / 3.0 {
            sigma_t[0]
        } else if u_channel < 2.0 / 3.0 {
            sigma_t[1]
        } else {
            sigma_t[2]
        };
        let t = if chosen > 0.0 { -ln(1.0 - u) / chosen } else { f32::INFINITY };
        if t < t_end {
            let passed = self.transmittance(t);
            let density = (sigma_t[0] * passed.r + sigma_t[1] * passed.g + sigma_t[2] * passed.b)
                * (1.0 / 3.0);
            let scale = if density > 0.0 { 1.0 / density } else { 0.0 };
            Flight { collision: Some(t), weight: passed * s * scale }
        } else {
            let passed = self.transmittance(t_end);
            let chance = (passed.r + passed.g + passed.b) * (1.0 / 3.0);
            let scale = if chance > 0.0 { 1.0 / chance } else { 0.0 };
            Flight { collision: None, weight: passed * scale }
        }
    }

    /// Density of scattering from direction `d` into `wi`, per steradian; its integral is 1.
    #[inline(always)]
    #[must_use]
    pub fn phase(&self, cos: f32) -> f32 {
        henyey_greenstein(self.g, cos)
    }

    /// Direction after a collision of light that travels along the unit vector `d`.
    #[inline(always)]
    #[must_use]
    pub fn scatter(&self, d: Vec3, u: f32, v: f32) -> Vec3 {
        let cos = sample_henyey_greenstein(self.g, u);
        let sin = sqrt(max(0.0, 1.0 - cos * cos));
        let (s, c) = sin_cos_turns(v);
        let (tangent, bitangent) = tangents(d);
        (tangent * (sin * c) + bitangent * (sin * s) + d * cos).normalized()
    }
}

/// Henyey and Greenstein, *Diffuse radiation in the galaxy*, 1941; `cos` is that of the angle by which
/// light is turned.
#[inline(always)]
#[must_use]
pub fn henyey_greenstein(g: f32, cos: f32) -> f32 {
    let denominator = max(1.0 + g * g - 2.0 * g * cos, 1e-12);
    (1.0 - g * g) / (denominator * sqrt(denominator)) * (0.25 * core::f32::consts::FRAC_1_PI)
}

/// Cosine of the angle by which light is turned, for a uniform `u`.
#[inline(always)]
#[must_use]
pub fn sample_henyey_greenstein(g: f32, u: f32) -> f32 {
    if abs(g) < 1e-3 {
        return 1.0 - 2.0 * u;
    }
    let ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    max(-1.0, min(1.0, (1.0 + g * g - ratio * ratio) / (2.0 * g)))
}

/// Two unit vectors perpendicular to the unit vector `n` and each other. Duff et al., *Building an
/// Orthonormal Basis, Revisited*, JCGT 6(1), 2017.
#[inline(always)]
#[must_use]
pub fn tangents(n: Vec3) -> (Vec3, Vec3) {
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    let t = vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    (t, cross(n, t))
}
