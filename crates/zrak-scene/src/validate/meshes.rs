//! Meshes that are written out, and prototypes.

use std::collections::BTreeMap;

use super::checker::Checker;
use super::limits::PROTOTYPE_NESTING_MAX;
use super::objects;
use crate::desc::{MeshDesc, ObjectDesc};

pub(super) fn check_meshes(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    checker.enter("meshes", |checker| {
        for (name, mesh) in &scene.meshes {
            checker.enter(name.as_str(), |checker| mesh_of(checker, mesh));
        }
    });
}

fn mesh_of(checker: &mut Checker<'_>, mesh: &MeshDesc) {
    match mesh {
        MeshDesc::File { path } => {
            if path.is_empty() {
                let help = "name a PLY or OBJ file, relative to the scene file";
                checker.note("path", "`path` is empty", Some(help));
            }
        }
        MeshDesc::Inline { positions, triangles, normals, uvs, colors } => {
            let n = positions.len();
            faces(checker, "triangle", n, triangles);
            attribute(checker, "normals", n, normals);
            attribute(checker, "uvs", n, uvs);
            attribute(checker, "colors", n, colors);
            numbers(checker, "positions", positions);
        }
        MeshDesc::Patches { positions, patches, normals, uvs } => {
            let n = positions.len();
            faces(checker, "patch", n, patches);
            attribute(checker, "normals", n, normals);
            attribute(checker, "uvs", n, uvs);
            numbers(checker, "positions", positions);
        }
        // Importers have checked it.
        MeshDesc::Loaded(_) => {}
    }
}

/// Checks the triangles or patches of a mesh of `n` vertices.
fn faces<const N: usize>(checker: &mut Checker<'_>, what: &str, n: usize, faces: &[[u32; N]]) {
    let key = if N == 3 { "triangles" } else { "patches" };
    if n == 0 || faces.is_empty() {
        checker.note("", format!("the mesh has no {key}"), None);
    }
    let beyond = |corners: &[u32; N]| corners.iter().any(|&v| v as usize >= n);
    if let Some(i) = faces.iter().position(beyond) {
        checker.enter(key, |checker| {
            let message = format!("the {what} has a corner beyond the {n} positions");
            let help = "corners are counted from 0";
            checker.note_at(checker.path().join(i), message, Some(help));
        });
    }
}

/// Checks that there is one value for each of `n` vertices, or none.
fn attribute<const N: usize>(checker: &mut Checker<'_>, key: &str, n: usize, values: &[[f32; N]]) {
    let len = values.len();
    if len != 0 && len != n {
        let message =
            format!("`{key}` must have one entry for each of the {n} positions, has {len}");
        checker.note(key, message, None);
    }
    numbers(checker, key, values);
}

fn numbers<const N: usize>(checker: &mut Checker<'_>, key: &str, values: &[[f32; N]]) {
    let is_bad = |v: &[f32; N]| v.iter().any(|x| !(-1e12..=1e12).contains(x));
    if let Some(i) = values.iter().position(is_bad) {
        checker.enter(key, |checker| {
            let message = "numbers must lie in [-1e12, 1e12]";
            checker.note_at(checker.path().join(i), message, None);
        });
    }
}

pub(super) fn check_prototypes(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    checker.enter("prototypes", |checker| {
        for (name, members) in &scene.prototypes {
            checker.enter(name.as_str(), |checker| {
                objects::check_prototype(checker, members);
                if !nests(&scene.prototypes, name) {
                    let message = format!(
                        "prototype `{name}` contains itself, or is nested more than \
                         {PROTOTYPE_NESTING_MAX} deep"
                    );
                    checker.note(
                        "",
                        message,
                        Some("an instance in it must be of another prototype"),
                    );
                }
            });
        }
    });
}

/// Whether the instances in a prototype lead to an end.
fn nests(prototypes: &BTreeMap<String, Vec<ObjectDesc>>, root: &str) -> bool {
    let mut level = vec![root];
    for _ in 0..PROTOTYPE_NESTING_MAX {
        let mut next: Vec<&str> = level
            .iter()
            .filter_map(|name| prototypes.get(*name))
            .flat_map(|o| instances(o))
            .collect();
        next.sort_unstable();
        next.dedup();
        if next.is_empty() {
            return true;
        }
        level = next;
    }
    false
}

/// Names of the prototypes that are placed by these objects and the groups among them.
fn instances(objects: &[ObjectDesc]) -> Vec<&str> {
    let mut lists = vec![objects];
    let mut names = Vec::new();
    while let Some(objects) = lists.pop() {
        for object in objects {
            match object {
                ObjectDesc::Instance { prototype, .. } => names.push(prototype.as_str()),
                ObjectDesc::Group { objects, .. } => lists.push(objects),
                _ => {}
            }
        }
    }
    names
}
