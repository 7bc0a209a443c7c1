//! Shapes as records, under the maps that their types allow.

use zrak_core::math::{Vec3, vec3};
use zrak_core::scene::MaterialRef;
use zrak_core::shapes::{Disk, PartialSphere, Placement, Quad, Triangle};

use super::transform::Transform;
use crate::desc::Triple;

pub(super) fn single(v: Triple) -> Vec3 {
    let [x, y, z] = v.map(|x| x as f32);
    vec3(x, y, z)
}

pub(super) fn placement_of(to_world: &Transform) -> Placement {
    // Validation refuses maps that cannot be inverted.
    let back = to_world.inverse().unwrap_or(Transform::IDENTITY);
    Placement { world_from_object: to_world.to_affine(), object_from_world: back.to_affine() }
}

pub(super) fn quad(
    corner: Triple,
    u: Triple,
    v: Triple,
    material: MaterialRef,
    to_world: &Transform,
) -> Quad {
    let (u, v) = (single(to_world.vector(u)), single(to_world.vector(v)));
    let mut quad = Quad::new(single(to_world.point(corner)), u, v, material);
    // A reflection turns u x v around, but the side that shines is still the same one.
    if to_world.determinant() < 0.0 {
        quad.normal = -quad.normal;
    }
    quad
}

/// A part of a sphere about the origin.
pub(super) fn partial_sphere(
    radius: f64,
    [z_min, z_max]: [f64; 2],
    phi_max_deg: f64,
    material: MaterialRef,
) -> PartialSphere {
    let theta = |z: f64| libm::acos((z / radius).clamp(-1.0, 1.0));
    // Where nothing is cut off, rounding must not do it.
    PartialSphere {
        radius: radius as f32,
        z_min: if z_min > -radius { z_min } else { -2.0 * radius } as f32,
        z_max: if z_max < radius { z_max } else { 2.0 * radius } as f32,
        phi_max: phi_max_deg.to_radians() as f32,
        theta_low: theta(z_min) as f32,
        theta_span: (theta(z_max) - theta(z_min)) as f32,
        material,
        _pad: 0,
    }
}

pub(super) fn triangle(
    vertices: [Triple; 3],
    uv: [[f64; 2]; 3],
    material: MaterialRef,
    to_world: &Transform,
) -> Triangle {
    let mut vertices = vertices.map(|p| single(to_world.point(p)));
    let mut uv = uv.map(|c| c.map(|x| x as f32));
    // A reflection turns the order of the corners around.
    if to_world.determinant() < 0.0 {
        vertices.swap(1, 2);
        uv.swap(1, 2);
    }
    Triangle { vertices, uv, material }
}

pub(super) fn disk(
    [height, radius, inner_radius, phi_max_deg]: [f64; 4],
    material: MaterialRef,
    to_world: &Transform,
) -> Disk {
    let scaled = |a: Triple, s: f64| a.map(|x| x * s);
    let dot = |a: Triple, b: Triple| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: Triple, b: Triple| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let u = to_world.vector([radius, 0.0, 0.0]);
    let v = to_world.vector([0.0, radius, 0.0]);
    let across = cross(u, v);
    let area = dot(across, across).sqrt();
    let n = scaled(across, 1.0 / area);
    let side = if to_world.determinant() < 0.0 { -1.0 } else { 1.0 };
    Disk {
        center: single(to_world.point([0.0, 0.0, height])),
        material,
        normal: single(scaled(n, side)),
        inner: (inner_radius / radius) as f32,
        x_axis: single(scaled(cross(v, n), 1.0 / area)),
        phi_max: phi_max_deg.to_radians() as f32,
        y_axis: single(scaled(cross(n, u), 1.0 / area)),
        _pad0: 0,
        u: single(u),
        _pad1: 0,
        v: single(v),
        _pad2: 0,
    }
}
