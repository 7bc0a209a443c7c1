//! Perlin's gradient noise.
//!
//! Perlin, *An Image Synthesizer*, SIGGRAPH 1985. The gradients are unit vectors hashed from the
//! lattice point, so there is no table and no period below 2^32; they are blended by Hermite cubics.

use crate::math::{Vec3, dot, floor, max, min, pcg3d, sqrt, vec3};

/// Gradient at a lattice point: a unit vector.
#[inline(always)]
fn gradient(x: i32, y: i32, z: i32, seed: u32) -> Vec3 {
    let h = pcg3d([x as u32 ^ seed, (y as u32).wrapping_add(seed), z as u32]);
    // In (-1, 1), never all zero: the half keeps each away from it.
    let signed = |bits: u32| ((bits >> 8) as i32 - 0x80_0000) as f32 + 0.5;
    let g = vec3(signed(h[0]), signed(h[1]), signed(h[2]));
    g * (1.0 / sqrt(dot(g, g)))
}

/// Noise in (-1, 1) with one feature per unit; 0 at lattice points.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn perlin(p: Vec3, seed: u32) -> f32 {
    let (ix, iy, iz) = (floor(p.x), floor(p.y), floor(p.z));
    // Where the cell's number does not fit, every number is a whole one: a lattice point.
    let within = |x: f32, i: i32| max(0.0, min(1.0, x - i as f32));
    let f = vec3(within(p.x, ix), within(p.y, iy), within(p.z, iz));
    let smooth = f.map(|t| t * t * (3.0 - 2.0 * t));
    let mut sum = 0.0;
    for corner in 0..8_i32 {
        let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
        let to_corner = f - vec3(dx as f32, dy as f32, dz as f32);
        let weight = |bit: i32, s: f32| if bit == 1 { s } else { 1.0 - s };
        let w = weight(dx, smooth.x) * weight(dy, smooth.y) * weight(dz, smooth.z);
        let g = gradient(ix.wrapping_add(dx), iy.wrapping_add(dy), iz.wrapping_add(dz), seed);
        sum += w * dot(g, to_corner);
    }
    sum
}

/// |sum over octaves i of noise(2^i p) / 2^i|.
#[cfg_attr(target_arch = "nvptx64", inline(always))]
#[must_use]
pub fn turbulence(p: Vec3, octaves: u32, seed: u32) -> f32 {
    let mut sum = 0.0;
    let mut weight = 1.0;
    let mut q = p;
    for _ in 0..octaves {
        sum += weight * perlin(q, seed);
        weight *= 0.5;
        q = q * 2.0;
    }
    sum.abs()
}
