//! Textures: their parameters, and what they are made of.

use super::checker::Checker;
use super::limits::{LENGTH_MIN, OCTAVES_MAX, TEXTURE_NESTING_MAX};
use super::problem::KeyPath;
use crate::desc::{ColorDesc, ImageFilter, SceneDesc, TextureDesc, Triple};

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
            for (key, part) in [("even", even), ("odd", odd)] {
                match part {
                    ColorDesc::Solid(color) => solid(checker, key, *color),
                    ColorDesc::Texture(name) => {
                        reference(checker, key, name);
                    }
                }
            }
        }
        TextureDesc::Noise { scale, octaves, low, high, pattern: _, seed: _ } => {
            checker.require("scale", *scale, |x| x >= LENGTH_MIN, "more than 0", None);
            if !(1..=OCTAVES_MAX).contains(octaves) {
                let message = format!("`octaves` must be from 1 to {OCTAVES_MAX}, is {octaves}");
                checker.note("octaves", message, None);
            }
            solid(checker, "low", *low);
            solid(checker, "high", *high);
        }
        TextureDesc::Image { path, .. } => {
            // Nothing that a picture would then not show is taken without a word.
            let plain = TextureDesc::image(path.clone(), ImageFilter::Bilinear);
            let nearest = TextureDesc::image(path.clone(), ImageFilter::Nearest);
            if *texture != plain && *texture != nearest {
                let message = "of an image's fields, only `path` and `filter` (`bilinear` or \
                               `nearest`) are rendered yet";
                checker.note("", message, Some("leave the other fields out"));
            }
            if path.is_empty() {
                let help = "name a picture's file, relative to the scene file";
                checker.note("path", "`path` is empty", Some(help));
            }
        }
        _ => checker.note("kind", "this kind of texture is not rendered yet", None),
    }
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
    let parts = match texture {
        TextureDesc::Checker { even, odd, .. } => [Some(("even", even)), Some(("odd", odd))],
        _ => [None, None],
    };
    parts.into_iter().flatten().filter_map(|(key, part)| match part {
        ColorDesc::Texture(name) => Some((key, name.as_str())),
        ColorDesc::Solid(_) => None,
    })
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

/// Every colour that looking up a texture can give, and where it stands.
pub(super) fn colors(scene: &SceneDesc, name: &str) -> Vec<(KeyPath, Triple)> {
    let mut seen = vec![name];
    let mut found = Vec::new();
    let mut next = 0;
    while let Some(&name) = seen.get(next) {
        next += 1;
        let path = |key: &str| KeyPath::default().join("textures").join(name).join(key);
        match scene.textures.get(name) {
            Some(TextureDesc::Solid { color }) => found.push((path("color"), *color)),
            Some(texture @ TextureDesc::Checker { even, odd, .. }) => {
                for (key, part) in [("even", even), ("odd", odd)] {
                    if let ColorDesc::Solid(color) = part {
                        found.push((path(key), *color));
                    }
                }
                for (_, part) in parts(texture) {
                    if !seen.contains(&part) {
                        seen.push(part);
                    }
                }
            }
            Some(TextureDesc::Noise { low, high, .. }) => {
                found.extend([(path("low"), *low), (path("high"), *high)]);
            }
            Some(_) | None => {}
        }
    }
    found
}
