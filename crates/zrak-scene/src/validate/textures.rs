//! Textures: their parameters, and what they are made of.

use super::checker::Checker;
use super::limits::{LENGTH_MIN, OCTAVES_MAX, TEXTURE_NESTING_MAX};
use super::problem::KeyPath;
use super::transforms;
use crate::desc::{
    ColorDesc, MappingDesc, ScalarDesc, SceneDesc, TextureDesc, TransformStep, Triple,
};
use crate::lower::Transform;

/// Checks every texture by itself, then how they are nested.
pub(super) fn check(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    checker.enter("textures", |checker| {
        for (name, texture) in &scene.textures {
            checker.enter(name.as_str(), |checker| parameters(checker, texture));
        }
        for name in scene.textures.keys() {
            checker.enter(name.as_str(), |checker| nesting(checker, name));
        }
    });
}

fn parameters(checker: &mut Checker<'_>, texture: &TextureDesc) {
    match texture {
        TextureDesc::Solid { color } => solid(checker, "color", *color),
        TextureDesc::Checker { scale, even, odd } => {
            checker.require("scale", *scale, |x| x >= LENGTH_MIN, "more than 0", None);
            part(checker, "even", even);
            part(checker, "odd", odd);
        }
        TextureDesc::Noise { scale, octaves, low, high, pattern: _, seed: _ } => {
            checker.require("scale", *scale, |x| x >= LENGTH_MIN, "more than 0", None);
            octaves_in_range(checker, *octaves);
            solid(checker, "low", *low);
            solid(checker, "high", *high);
        }
        TextureDesc::Fractal { scale, octaves, roughness, low, high, pattern: _, seed: _ } => {
            checker.require("scale", *scale, |x| x >= LENGTH_MIN, "more than 0", None);
            octaves_in_range(checker, *octaves);
            checker.require(
                "roughness",
                *roughness,
                |x| (0.0..=1.0).contains(&x),
                "from 0 to 1",
                None,
            );
            solid(checker, "low", *low);
            solid(checker, "high", *high);
        }
        TextureDesc::Image { path, scale, mapping, .. } => {
            if path.is_empty() {
                let help = "name a picture's file, relative to the scene file";
                checker.note("path", "`path` is empty", Some(help));
            }
            checker.number("scale", *scale);
            mapping_of(checker, mapping);
        }
        TextureDesc::UvChecker { even, odd, mapping } => {
            part(checker, "even", even);
            part(checker, "odd", odd);
            mapping_of(checker, mapping);
        }
        TextureDesc::Dots { inside, outside, mapping } => {
            part(checker, "inside", inside);
            part(checker, "outside", outside);
            mapping_of(checker, mapping);
        }
        TextureDesc::Bilerp { corners, mapping } => {
            checker.enter("corners", |checker| {
                for (i, corner) in corners.iter().enumerate() {
                    checker.enter(i, |checker| solid(checker, "", *corner));
                }
            });
            mapping_of(checker, mapping);
        }
        TextureDesc::Mix { a, b, amount } => {
            part(checker, "a", a);
            part(checker, "b", b);
            match amount {
                ScalarDesc::Value(x) => {
                    let is_share = |x| (0.0..=1.0).contains(&x);
                    checker.require("amount", *x, is_share, "from 0 to 1", None);
                }
                ScalarDesc::Texture(name) => reference(checker, "amount", name),
            }
        }
        TextureDesc::Multiply { a, b } => {
            part(checker, "a", a);
            part(checker, "b", b);
        }
        TextureDesc::Placed { texture, transform } => {
            part(checker, "texture", texture);
            steps(checker, transform);
        }
        TextureDesc::VertexColor { channel: _ } => {}
    }
}

/// A part of a texture.
fn part(checker: &mut Checker<'_>, key: &str, part: &ColorDesc) {
    match part {
        ColorDesc::Solid(color) => solid(checker, key, *color),
        ColorDesc::Texture(name) => reference(checker, key, name),
    }
}

fn octaves_in_range(checker: &mut Checker<'_>, octaves: u32) {
    if !(1..=OCTAVES_MAX).contains(&octaves) {
        let message = format!("`octaves` must be from 1 to {OCTAVES_MAX}, is {octaves}");
        checker.note("octaves", message, None);
    }
}

fn mapping_of(checker: &mut Checker<'_>, mapping: &MappingDesc) {
    checker.enter("mapping", |checker| match mapping {
        MappingDesc::Uv => {}
        MappingDesc::UvAffine { matrix } => matrix_of(checker, matrix.as_flattened()),
        MappingDesc::Planar { matrix } => matrix_of(checker, matrix.as_flattened()),
        MappingDesc::Spherical { transform } | MappingDesc::Cylindrical { transform } => {
            steps(checker, transform);
        }
    });
}

fn matrix_of(checker: &mut Checker<'_>, entries: &[f64]) {
    for entry in entries {
        checker.number("matrix", *entry);
    }
}

/// The steps of a map that must be one of three dimensions.
fn steps(checker: &mut Checker<'_>, steps: &[TransformStep]) {
    transforms::check(checker, steps, Some(Transform::IDENTITY));
}

/// A colour that may be a reflected share or a radiance, by what will use it.
fn solid(checker: &mut Checker<'_>, key: &str, color: Triple) {
    let path = checker.path_of(key);
    checker.radiance_at(&path, color);
}

/// Checks the name of a texture.
pub(super) fn reference(checker: &mut Checker<'_>, key: &str, name: &str) {
    let textures = &checker.scene.textures;
    if !textures.contains_key(name) {
        let path = checker.path_of(key);
        checker.unknown_name(path, "texture", name, textures);
    }
}

/// The parts of a texture that are textures themselves, with their keys.
fn parts(texture: &TextureDesc) -> impl Iterator<Item = (&'static str, &str)> {
    let (colors, scalar) = match texture {
        TextureDesc::Checker { even, odd, .. } | TextureDesc::UvChecker { even, odd, .. } => {
            ([Some(("even", even)), Some(("odd", odd))], None)
        }
        TextureDesc::Dots { inside, outside, .. } => {
            ([Some(("inside", inside)), Some(("outside", outside))], None)
        }
        TextureDesc::Multiply { a, b } => ([Some(("a", a)), Some(("b", b))], None),
        TextureDesc::Mix { a, b, amount } => {
            ([Some(("a", a)), Some(("b", b))], Some(("amount", amount)))
        }
        TextureDesc::Placed { texture, .. } => ([Some(("texture", texture)), None], None),
        _ => ([None, None], None),
    };
    let colors = colors.into_iter().flatten().filter_map(|(key, part)| match part {
        ColorDesc::Texture(name) => Some((key, name.as_str())),
        ColorDesc::Solid(_) => None,
    });
    let scalars = scalar.into_iter().filter_map(|(key, part)| match part {
        ScalarDesc::Texture(name) => Some((key, name.as_str())),
        ScalarDesc::Value(_) => None,
    });
    colors.chain(scalars)
}

/// Checks that the texture does not contain itself, nor too many levels of others.
///
/// The search takes the textures one level of nesting at a time, each once a level, so it ends and
/// stays small even where checkers share their parts.
fn nesting(checker: &mut Checker<'_>, root: &str) {
    let textures = &checker.scene.textures;
    // Names on this level, each with the key of the root through which it was reached.
    let mut level: Vec<(&'static str, &str)> =
        textures.get(root).into_iter().flat_map(parts).collect();
    for _ in 1..TEXTURE_NESTING_MAX {
        if level.is_empty() {
            return;
        }
        if let Some(&(key, _)) = level.iter().find(|&&(_, name)| name == root) {
            let message = format!("texture `{root}` contains itself");
            checker.note(key, message, Some("give one of the textures in the circle a colour"));
            return;
        }
        let inner = |&(key, name): &(&'static str, _)| {
            let found: Option<&TextureDesc> = textures.get(name);
            found.into_iter().flat_map(parts).map(move |(_, part)| (key, part))
        };
        let mut next: Vec<(&'static str, &str)> = level.iter().flat_map(inner).collect();
        next.sort_unstable();
        next.dedup();
        level = next;
    }
    if !level.is_empty() {
        let message =
            format!("textures are nested more than {TEXTURE_NESTING_MAX} deep, or in a circle");
        checker.note("", message, None);
    }
}

/// The colours that stand in the file and that looking up a texture can give as they are, and where they
/// stand. Not those of products, whose other factor may make up for them.
pub(super) fn colors(scene: &SceneDesc, name: &str) -> Vec<(KeyPath, Triple)> {
    let mut seen = vec![name];
    let mut found = Vec::new();
    let mut next = 0;
    while let Some(&name) = seen.get(next) {
        next += 1;
        let path = |key: &str| KeyPath::default().join("textures").join(name).join(key);
        let Some(texture) = scene.textures.get(name) else { continue };
        let mut part = |key: &str, part: &ColorDesc| {
            if let ColorDesc::Solid(color) = part {
                found.push((path(key), *color));
            }
        };
        match texture {
            TextureDesc::Solid { color } => found.push((path("color"), *color)),
            TextureDesc::Checker { even, odd, .. } | TextureDesc::UvChecker { even, odd, .. } => {
                part("even", even);
                part("odd", odd);
            }
            TextureDesc::Dots { inside, outside, .. } => {
                part("inside", inside);
                part("outside", outside);
            }
            TextureDesc::Mix { a, b, .. } => {
                part("a", a);
                part("b", b);
            }
            TextureDesc::Placed { texture, .. } => part("texture", texture),
            TextureDesc::Noise { low, high, .. } | TextureDesc::Fractal { low, high, .. } => {
                found.extend([(path("low"), *low), (path("high"), *high)]);
            }
            TextureDesc::Bilerp { corners, .. } => {
                let path = |i| path("corners").join(i);
                found.extend(corners.iter().enumerate().map(|(i, c)| (path(i), *c)));
            }
            TextureDesc::Image { .. } | TextureDesc::VertexColor { .. } => {}
            TextureDesc::Multiply { .. } => continue,
        }
        for (key, part) in parts(texture) {
            if key != "amount" && !seen.contains(&part) {
                seen.push(part);
            }
        }
    }
    found
}
