//! Triangles to build trees over: a terrain, as meshes are, and a soup, as they are not.

use zrak_core::math::{Bounds, Vec3, pcg3d, unit_f32, vec3};
use zrak_core::scene::{PrimKind, PrimRef};

/// Bounds of about `n` triangles of the scene of this name, if there is one.
pub(crate) fn by_name(name: &str, n: u32) -> Option<Vec<(PrimRef, Bounds)>> {
    match name {
        "terrain" => Some(terrain(n)),
        "soup" => Some(soup(n)),
        _ => None,
    }
}

/// A height field: two triangles to a cell of a square grid.
fn terrain(n: u32) -> Vec<(PrimRef, Bounds)> {
    let side = (f64::from(n) / 2.0).sqrt() as u32;
    let cell = 1.0 / side as f32;
    let corner = |i: u32, k: u32| {
        let (x, z) = (i as f32 * cell, k as f32 * cell);
        // Hills, and hills on the hills; x and z are in [0, 1].
        let waves = |f: f32| (x * f).sin() * (z * f * 1.3 + 1.0).cos() / f;
        vec3(x, waves(7.0) + waves(23.0) + waves(101.0), z)
    };
    let triangle = |i: u32| {
        let (x, z) = (i / 2 % side, i / 2 / side);
        let tip = if i.is_multiple_of(2) { corner(x, z) } else { corner(x + 1, z + 1) };
        around([corner(x + 1, z), corner(x, z + 1), tip])
    };
    numbered((0..2 * side * side).map(triangle))
}

/// Small triangles of any direction, uniform in the unit cube, with a few large ones.
fn soup(n: u32) -> Vec<(PrimRef, Bounds)> {
    let in_cube = |i, k| Vec3::from_array(pcg3d([i, k, 5]).map(unit_f32));
    let triangle = |i: u32| {
        let size = if i.is_multiple_of(1000) { 0.1 } else { 0.005 };
        let p = in_cube(i, 0);
        around([p, p + in_cube(i, 1) * size, p + in_cube(i, 2) * size])
    };
    numbered((0..n).map(triangle))
}

fn around(p: [Vec3; 3]) -> Bounds {
    let all = Bounds::of_points(p[0], p[1]).union(Bounds::of_points(p[2], p[2]));
    all.padded(0.0)
}

fn numbered(bounds: impl Iterator<Item = Bounds>) -> Vec<(PrimRef, Bounds)> {
    let prim = |i| PrimRef::new(PrimKind::Triangle, i as u32);
    bounds.enumerate().map(|(i, bounds)| (prim(i), bounds)).collect()
}
