//! Tests.

mod dielectric;
mod diffuse;
mod metal;
mod principled;
mod surface;

use super::{Response, respond};
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3};
use crate::sampler::Sampler;
use crate::scene::{MaterialKind, MaterialRef, SceneView};
use crate::testing::{D3, cross, double, unit};

/// A surface through the origin.
fn surface(n: Vec3, material: MaterialKind) -> SurfaceInteraction {
    let material = MaterialRef::new(material, 0);
    SurfaceInteraction {
        uv: [0.5; 2],
        ..SurfaceInteraction::plain(Vec3::ZERO, Vec3::splat(1e-7), n, material)
    }
}

/// Responses of many samples to light along `d`.
fn responses<'a>(
    scene: &'a SceneView<'_>,
    surface: &'a SurfaceInteraction,
    d: Vec3,
    n: u32,
) -> impl Iterator<Item = Response> + 'a {
    (0..n).map(move |i| respond(scene, surface, d, &Sampler::new(11, i % 100, 3, i / 100)))
}

/// Coordinates of `w` along two tangents of the unit vector `n` and `n` itself.
fn local(n: D3, w: Vec3) -> D3 {
    let helper = if n[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let t = unit(cross(helper, n));
    let b = cross(n, t);
    let w = double(w);
    [t, b, n].map(|axis| crate::testing::dot(axis, w))
}

/// Number of the sector of the angle around the normal.
fn sector(w: D3, n: usize) -> usize {
    let turn = w[1].atan2(w[0]) / std::f64::consts::TAU + 0.5;
    ((turn * n as f64) as usize).min(n - 1)
}

const WHITE: Color = Color::WHITE;
