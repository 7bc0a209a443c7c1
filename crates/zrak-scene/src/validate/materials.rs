//! Materials: their parameters, and that none reflects more light than it gets.

use std::collections::BTreeSet;

use super::checker::Checker;
use super::limits::LENGTH_MIN;
use super::textures;
use crate::desc::{ColorDesc, MaterialDesc};

pub(super) fn check(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    // Textures that something reflects by, each looked at once.
    let mut reflected = BTreeSet::new();
    checker.enter("materials", |checker| {
        for (name, material) in &scene.materials {
            checker.enter(name.as_str(), |checker| match material {
                MaterialDesc::Lambertian { color } | MaterialDesc::Isotropic { color } => {
                    reflected.extend(albedo(checker, color));
                }
                MaterialDesc::Metal { color, fuzz } => {
                    reflected.extend(albedo(checker, color));
                    let ok = |x: f64| (0.0..=1.0).contains(&x);
                    checker.require("fuzz", *fuzz, ok, "from 0 (a mirror) to 1", None);
                }
                MaterialDesc::Dielectric { ior, fresnel: _ } => {
                    let help = "water has 1.33, glass 1.5, air inside glass 1/1.5 = 0.6667";
                    let ok = |x: f64| x >= LENGTH_MIN;
                    checker.require("ior", *ior, ok, "more than 0", Some(help));
                }
                MaterialDesc::DiffuseLight { color, sides: _ } => match color {
                    ColorDesc::Solid(color) => checker.radiance("color", *color),
                    ColorDesc::Texture(name) => textures::reference(checker, "color", name),
                },
                _ => checker.note("kind", "this kind of material is not rendered yet", None),
            });
        }
    });

    let mut bad = BTreeSet::new();
    for texture in reflected {
        for (path, color) in textures::colors(scene, texture) {
            // Negative and infinite colours are noted where textures are checked.
            if color.iter().any(|&x| x > 1.0 && x.is_finite()) && bad.insert(path.to_string()) {
                checker.albedo_at(&path, color);
            }
        }
    }
}

/// Checks a reflected share; a texture's name is given back to be looked at once for all.
fn albedo<'a>(checker: &mut Checker<'_>, color: &'a ColorDesc) -> Option<&'a str> {
    match color {
        ColorDesc::Solid(color) => {
            let path = checker.path_of("color");
            checker.albedo_at(&path, *color);
            None
        }
        ColorDesc::Texture(name) => {
            textures::reference(checker, "color", name);
            Some(name)
        }
    }
}
