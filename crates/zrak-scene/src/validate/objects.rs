//! Objects: that each has a size, a place, and a material that suits it.

use super::checker::Checker;
use super::limits::{GROUP_NESTING_MAX, LENGTH_MIN, NUMBER_MAX};
use super::transforms;
use super::{are_parallel, length, sub};
use crate::desc::{BoundaryDesc, MaterialDesc, ObjectDesc, Triple};
use crate::lower::Transform;

pub(super) fn check(checker: &mut Checker<'_>, objects: &[ObjectDesc]) {
    check_all(checker, objects, Some(Transform::IDENTITY), 0);
}

/// The same for the members of a prototype.
pub(super) fn check_prototype(checker: &mut Checker<'_>, objects: &[ObjectDesc]) {
    checker.in_prototype = true;
    check(checker, objects);
    checker.in_prototype = false;
}

/// `outer` is the map of the groups around, none if that is degenerate.
fn check_all(
    checker: &mut Checker<'_>,
    objects: &[ObjectDesc],
    outer: Option<Transform>,
    n_groups: usize,
) {
    for (i, object) in objects.iter().enumerate() {
        checker.enter(i, |checker| check_one(checker, object, outer, n_groups));
    }
}

fn check_one(
    checker: &mut Checker<'_>,
    object: &ObjectDesc,
    outer: Option<Transform>,
    n_groups: usize,
) {
    match object {
        ObjectDesc::Sphere {
            center,
            center_end,
            radius,
            z_min,
            z_max,
            phi_max_deg,
            material,
            transform,
        } => {
            let corners = sphere(checker, *center, *center_end, *radius);
            sphere_part(checker, *radius, *z_min, *z_max, *phi_max_deg);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            reach(checker, map, corners);
        }
        ObjectDesc::Quad { corner, u, v, material, transform } => {
            let corners = quad(checker, *corner, *u, *v);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            reach(checker, map, corners);
        }
        ObjectDesc::Triangle { vertices, uv, material, transform } => {
            let corners = triangle(checker, *vertices);
            checker.enter("uv", |checker| {
                for (i, uv) in uv.iter().enumerate() {
                    checker.enter(i, |checker| checker.numbers(uv));
                }
            });
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            reach(checker, map, corners);
        }
        ObjectDesc::Box { min, max, material, transform } => {
            let corners = cuboid(checker, *min, *max);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            reach(checker, map, corners);
        }
        ObjectDesc::Medium { boundary, density, material, transform } => {
            if checker.in_prototype {
                let message = "a medium of constant density cannot be in a prototype";
                let help = "bound a medium of `[media]` by a `surface` material instead";
                checker.note("", message, Some(help));
            }
            checker.require("density", *density, |x| x >= LENGTH_MIN, "more than 0", None);
            phase_function(checker, material);
            // The boundary's own steps come first, then the medium's, then the groups'.
            let map = transforms::check(checker, transform, outer);
            checker.enter("boundary", |checker| match boundary {
                BoundaryDesc::Sphere { center, center_end, radius, transform } => {
                    let corners = sphere(checker, *center, *center_end, *radius);
                    let map = transforms::check(checker, transform, map);
                    reach(checker, map, corners);
                }
                BoundaryDesc::Box { min, max, transform } => {
                    let corners = cuboid(checker, *min, *max);
                    let map = transforms::check(checker, transform, map);
                    reach(checker, map, corners);
                }
            });
        }
        ObjectDesc::Mesh { mesh, material, group_materials, flip: _, transform } => {
            let meshes = &checker.scene.meshes;
            if !meshes.contains_key(mesh) {
                checker.unknown_name(checker.path_of("mesh"), "mesh", mesh, meshes);
            }
            surface(checker, material);
            checker.enter("group_materials", |checker| {
                for (i, name) in group_materials.iter().enumerate() {
                    checker.enter(i, |checker| surface_at(checker, "", name));
                }
            });
            transforms::check(checker, transform, outer);
        }
        ObjectDesc::Disk { height, radius, inner_radius, phi_max_deg, material, transform } => {
            let more = "more than 0";
            let mut good = checker.number("height", *height);
            good &= checker.require("radius", *radius, |x| x >= LENGTH_MIN, more, None);
            let ok = |x: f64| (0.0..*radius).contains(&x);
            let rule = "from 0 to less than `radius`";
            good &= checker.require("inner_radius", *inner_radius, ok, rule, None);
            good &= angle(checker, *phi_max_deg);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            let corners = [[-radius, -radius, *height], [*radius, *radius, *height]];
            reach(checker, map, good.then(|| corners.to_vec()));
        }
        ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, material, transform } => {
            let more = "more than 0";
            let mut good = checker.number("z_min", *z_min);
            good &= checker.require("radius", *radius, |x| x >= LENGTH_MIN, more, None);
            let ok = |x: f64| x - z_min >= LENGTH_MIN;
            good &= checker.require("z_max", *z_max, ok, "more than `z_min`", None);
            good &= angle(checker, *phi_max_deg);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            let corners = [[-radius, -radius, *z_min], [*radius, *radius, *z_max]];
            reach(checker, map, good.then(|| corners.to_vec()));
        }
        ObjectDesc::Curve { points, widths, form, normals, material, transform } => {
            let corners = super::curves::check(checker, points, *widths, *form, normals);
            surface(checker, material);
            let map = transforms::check(checker, transform, outer);
            reach(checker, map, corners);
        }
        ObjectDesc::Instance { prototype, transform, transform_end } => {
            let prototypes = &checker.scene.prototypes;
            if !prototypes.contains_key(prototype) {
                let path = checker.path_of("prototype");
                checker.unknown_name(path, "prototype", prototype, prototypes);
            }
            transforms::check(checker, transform, outer);
            if let Some(end) = transform_end {
                transforms::check_at(checker, "transform_end", end, outer);
            }
        }
        ObjectDesc::Group { objects, transform } => {
            if n_groups >= GROUP_NESTING_MAX {
                let message = format!("groups are nested more than {GROUP_NESTING_MAX} deep");
                checker.note("", message, None);
                return;
            }
            let map = transforms::check(checker, transform, outer);
            checker.enter("objects", |checker| check_all(checker, objects, map, n_groups + 1));
        }
    }
}

/// Checks a sphere; gives points that enclose it if it is good. So do the next three.
fn sphere(
    checker: &mut Checker<'_>,
    center: Triple,
    center_end: Option<Triple>,
    radius: f64,
) -> Option<Vec<Triple>> {
    let help = if radius < 0.0 {
        "to make a hollow sphere, put a sphere of relative index 1/ior inside"
    } else {
        "the smallest possible radius is 1e-12"
    };
    let good = checker.triple("center", center)
        & center_end.is_none_or(|end| checker.triple("center_end", end))
        & checker.require("radius", radius, |x| x >= LENGTH_MIN, "more than 0", Some(help));
    let ends = [Some(center), center_end];
    let corners = |c: Triple| [c.map(|x| x - radius), c.map(|x| x + radius)];
    good.then(|| ends.into_iter().flatten().flat_map(corners).collect())
}

/// Checks what there is of a sphere.
fn sphere_part(
    checker: &mut Checker<'_>,
    radius: f64,
    z_min: Option<f64>,
    z_max: Option<f64>,
    phi_max_deg: Option<f64>,
) {
    let help = "both are relative to the centre";
    let low = z_min.unwrap_or(-radius);
    if let Some(z_min) = z_min {
        let ok = |x: f64| x < radius;
        checker.require("z_min", z_min, ok, "less than `radius`", Some(help));
    }
    if let Some(z_max) = z_max {
        let ok = |x: f64| x > -radius && x - low.max(-radius) >= LENGTH_MIN;
        checker.require("z_max", z_max, ok, "more than `z_min` and `-radius`", Some(help));
    }
    if let Some(degrees) = phi_max_deg {
        angle(checker, degrees);
    }
}

fn quad(checker: &mut Checker<'_>, corner: Triple, u: Triple, v: Triple) -> Option<Vec<Triple>> {
    let mut good = checker.triple("corner", corner);
    good &= checker.triple("u", u) & checker.triple("v", v);
    if good && are_parallel(u, v) {
        let help = "its edges `u` and `v` must not be zero, and must point in two directions";
        checker.note("u", "the quad has no area", Some(help));
        return None;
    }
    let add = |a: Triple, b: Triple| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    good.then(|| vec![corner, add(corner, u), add(corner, v), add(add(corner, u), v)])
}

fn triangle(checker: &mut Checker<'_>, vertices: [Triple; 3]) -> Option<Vec<Triple>> {
    let good = checker.enter("vertices", |checker| {
        let mut good = true;
        for (i, vertex) in vertices.into_iter().enumerate() {
            good &= checker.enter(i, |checker| checker.numbers(&vertex));
        }
        good
    });
    let [a, b, c] = vertices;
    if good && (are_parallel(sub(b, a), sub(c, a)) || length(sub(c, b)) < LENGTH_MIN) {
        let help = "its corners must be three points that are not on a line";
        checker.note("vertices", "the triangle has no area", Some(help));
        return None;
    }
    good.then(|| vertices.to_vec())
}

fn cuboid(checker: &mut Checker<'_>, min: Triple, max: Triple) -> Option<Vec<Triple>> {
    let mut good = checker.triple("min", min) & checker.triple("max", max);
    if good {
        for (axis, (min, max)) in ["x", "y", "z"].into_iter().zip(min.into_iter().zip(max)) {
            if max - min < LENGTH_MIN {
                good = false;
                let message = format!(
                    "the box's `max` must be more than its `min`; along {axis} they are \
                     {max:?} and {min:?}"
                );
                let help = "a flat box is a quad; swap the corners' numbers if they are reversed";
                checker.note("max", message, Some(help));
            }
        }
    }
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        [pick(0), pick(1), pick(2)]
    };
    good.then(|| (0..8).map(corner).collect())
}

/// Checks that a good shape under a good map stays within reach.
fn reach(checker: &mut Checker<'_>, map: Option<Transform>, corners: Option<Vec<Triple>>) {
    let (Some(map), Some(corners)) = (map, corners) else { return };
    let is_far = |p: Triple| map.point(p).iter().any(|x| x.abs() > NUMBER_MAX);
    if corners.into_iter().any(is_far) {
        let message = "the object reaches further than 1e12 from the origin";
        checker.note("", message, Some("choose a larger unit of length"));
    }
}

/// Checks the material of a surface.
fn surface(checker: &mut Checker<'_>, name: &str) {
    surface_at(checker, "material", name);
}

/// The same for a material that is named in the field `key`.
pub(super) fn surface_at(checker: &mut Checker<'_>, key: &str, name: &str) {
    if let Some(MaterialDesc::Isotropic { .. }) = material_at(checker, key, name) {
        let message = format!("material `{name}` is `isotropic`, which is for media, not surfaces");
        let help = "make the object the `boundary` of a `medium`, or the material a `lambertian`";
        checker.note(key, message, Some(help));
    }
}

/// Checks an angle that a shape covers.
fn angle(checker: &mut Checker<'_>, degrees: f64) -> bool {
    let ok = |x: f64| x > 0.0 && x <= 360.0;
    checker.require("phi_max_deg", degrees, ok, "more than 0 and at most 360 degrees", None)
}

/// Checks the material of a medium.
fn phase_function(checker: &mut Checker<'_>, name: &str) {
    match material(checker, name) {
        Some(MaterialDesc::Isotropic { .. }) | None => {}
        Some(_) => {
            let message = format!("a medium needs an `isotropic` material, which `{name}` is not");
            checker.note("material", message, None);
        }
    }
}

fn material<'a>(checker: &mut Checker<'a>, name: &str) -> Option<&'a MaterialDesc> {
    material_at(checker, "material", name)
}

/// The material of this name, which stands in the field `key`.
pub(super) fn material_at<'a>(
    checker: &mut Checker<'a>,
    key: &str,
    name: &str,
) -> Option<&'a MaterialDesc> {
    let materials = &checker.scene.materials;
    let found = materials.get(name);
    if found.is_none() {
        let path = if key.is_empty() { checker.path() } else { checker.path_of(key) };
        checker.unknown_name(path, "material", name, materials);
    }
    found
}
