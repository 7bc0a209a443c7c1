//! Materials: their parameters, and that none reflects more light than it gets.

use std::collections::BTreeSet;

use super::checker::Checker;
use super::limits::{LENGTH_MIN, MIX_NESTING_MAX};
use super::problem::KeyPath;
use super::textures;
use crate::desc::{CoatDesc, ColorDesc, ConductorDesc, MaterialDesc, RoughnessDesc, ScalarDesc};

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
                MaterialDesc::Mix { materials, amount } => {
                    checker.enter("materials", |checker| {
                        for (i, name) in materials.iter().enumerate() {
                            checker.enter(i, |checker| part(checker, "", name));
                        }
                    });
                    scalar(checker, "amount", amount, Some([0.0, 1.0]));
                }
                MaterialDesc::Interface => {}
                MaterialDesc::Surface { .. } => surface(checker, material),
                MaterialDesc::Conductor { metal, roughness } => {
                    reflected.extend(conductor(checker, metal));
                    rough(checker, "roughness", roughness);
                }
                MaterialDesc::RoughDielectric { ior, roughness } => {
                    index(checker, *ior);
                    rough(checker, "roughness", roughness);
                }
                MaterialDesc::ThinDielectric { ior } => index(checker, *ior),
                MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                    reflected.extend(albedo_in(checker, "reflectance", reflectance));
                    reflected.extend(albedo_in(checker, "transmittance", transmittance));
                    if let (ColorDesc::Solid(r), ColorDesc::Solid(t)) = (reflectance, transmittance)
                        && (0..3).any(|i| r[i] + t[i] > 1.0 + 1e-9)
                    {
                        let message = "`reflectance` and `transmittance` are together more than 1";
                        checker.note("transmittance", message, None);
                    }
                }
                MaterialDesc::CoatedDiffuse { color, coat } => {
                    reflected.extend(albedo(checker, color));
                    coat_of(checker, coat);
                }
                MaterialDesc::CoatedConductor { metal, metal_roughness, coat } => {
                    reflected.extend(conductor(checker, metal));
                    rough(checker, "metal_roughness", metal_roughness);
                    coat_of(checker, coat);
                }
                MaterialDesc::Principled { .. } => {
                    checker.note("kind", "this kind of material is not rendered yet", None);
                }
            });
        }
    });

    mixes(checker);
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

/// Checks a metal; a texture's name is given back.
fn conductor<'a>(checker: &mut Checker<'_>, metal: &'a ConductorDesc) -> Option<&'a str> {
    checker.enter("metal", |checker| match metal {
        ConductorDesc::Index { eta, k } => {
            if checker.triple("eta", *eta) && eta.iter().any(|&x| x < 1e-6) {
                checker.note("eta", "`eta` must have numbers of at least 1e-6", None);
            }
            if checker.triple("k", *k) && k.iter().any(|&x| x < 0.0) {
                checker.note("k", "`k` must have numbers from 0 on", None);
            }
            None
        }
        ConductorDesc::Reflectance { reflectance } => {
            albedo_in(checker, "reflectance", reflectance)
        }
    })
}

fn rough(checker: &mut Checker<'_>, key: &str, roughness: &RoughnessDesc) {
    checker.enter(key, |checker| {
        scalar(checker, "u", &roughness.u, Some([0.0, 1.0]));
        if let Some(v) = &roughness.v {
            scalar(checker, "v", v, Some([0.0, 1.0]));
        }
    });
}

fn index(checker: &mut Checker<'_>, ior: f64) {
    let help = "water has 1.33, glass 1.5, air inside glass 1/1.5 = 0.6667";
    checker.require("ior", ior, |x| x >= LENGTH_MIN, "more than 0", Some(help));
}

fn coat_of(checker: &mut Checker<'_>, coat: &CoatDesc) {
    checker.enter("coat", |checker| {
        rough(checker, "roughness", &coat.roughness);
        index(checker, coat.ior);
        checker.require("thickness", coat.thickness, |x| x >= 0.0, "at least 0", None);
        let path = checker.path_of("albedo");
        checker.albedo_at(&path, coat.albedo);
        let ok = |g: f64| g.abs() < 1.0;
        checker.require("g", coat.g, ok, "between -1 and 1, both excluded", None);
        for (key, n) in [("max_depth", coat.max_depth), ("n_samples", coat.n_samples)] {
            if !(1..=1000).contains(&n) {
                checker.note(key, format!("`{key}` must be from 1 to 1000, is {n}"), None);
            }
        }
    });
}

fn surface(checker: &mut Checker<'_>, material: &MaterialDesc) {
    let MaterialDesc::Surface {
        base,
        emission,
        emission_strength,
        emission_sides: _,
        alpha,
        alpha_cutoff,
        normal_map,
        normal_scale,
        bump,
        medium,
        one_sided: _,
    } = material
    else {
        return;
    };
    part(checker, "base", base);
    match emission {
        Some(ColorDesc::Solid(color)) => checker.radiance("emission", *color),
        Some(ColorDesc::Texture(name)) => textures::reference(checker, "emission", name),
        None => {}
    }
    let strength = |x: f64| x >= 0.0;
    checker.require("emission_strength", *emission_strength, strength, "at least 0", None);
    if let Some(alpha) = alpha {
        scalar(checker, "alpha", alpha, Some([0.0, 1.0]));
    }
    if let Some(cutoff) = *alpha_cutoff {
        checker.number("alpha_cutoff", cutoff);
    }
    if let Some(name) = normal_map {
        textures::reference(checker, "normal_map", name);
    }
    checker.number("normal_scale", *normal_scale);
    if let Some(bump) = bump {
        scalar(checker, "bump", bump, None);
    }
    if let Some(interface) = medium {
        checker.enter("medium", |checker| {
            for (key, name) in [("inside", &interface.inside), ("outside", &interface.outside)] {
                let media = &checker.scene.media;
                if let Some(name) = name.as_ref().filter(|name| !media.contains_key(*name)) {
                    checker.unknown_name(checker.path_of(key), "medium", name, media);
                }
            }
        });
    }
}

/// Checks a material that another one is made of.
fn part(checker: &mut Checker<'_>, key: &str, name: &str) {
    super::objects::surface_at(checker, key, name);
    if let Some(MaterialDesc::Surface { .. }) = checker.scene.materials.get(name) {
        let message = format!("material `{name}` is a `surface`, of which no other can be made");
        checker.note(key, message, Some("name the material that scatters"));
    }
}

/// Checks a number that may be a texture.
pub(super) fn scalar(
    checker: &mut Checker<'_>,
    key: &str,
    input: &ScalarDesc,
    range: Option<[f64; 2]>,
) {
    match input {
        ScalarDesc::Value(x) => match range {
            Some([lo, hi]) => {
                let rule = format!("from {lo} to {hi}");
                checker.require(key, *x, |x| (lo..=hi).contains(&x), &rule, None);
            }
            None => {
                checker.number(key, *x);
            }
        },
        ScalarDesc::Texture(name) => textures::reference(checker, key, name),
    }
}

/// Notes mixes that are made of themselves.
fn mixes(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    for root in scene.materials.keys() {
        let mut level: Vec<&str> = vec![root];
        let mut n_levels = 0;
        while !level.is_empty() && n_levels <= MIX_NESTING_MAX {
            let parts = |name: &&str| match scene.materials.get(*name) {
                Some(MaterialDesc::Mix { materials, .. }) => {
                    materials.iter().map(String::as_str).collect()
                }
                _ => Vec::new(),
            };
            level = level.iter().flat_map(parts).collect();
            level.sort_unstable();
            level.dedup();
            n_levels += 1;
        }
        if !level.is_empty() {
            let path = KeyPath::default().join("materials").join(root.as_str());
            let message = format!(
                "material `{root}` is made of itself, or of mixes that are nested more than \
                 {MIX_NESTING_MAX} deep"
            );
            checker.note_at(path, message, None);
        }
    }
}

/// Checks a reflected share; a texture's name is given back to be looked at once for all.
fn albedo<'a>(checker: &mut Checker<'_>, color: &'a ColorDesc) -> Option<&'a str> {
    albedo_in(checker, "color", color)
}

/// The same for the field `key`.
fn albedo_in<'a>(checker: &mut Checker<'_>, key: &str, color: &'a ColorDesc) -> Option<&'a str> {
    match color {
        ColorDesc::Solid(color) => {
            let path = checker.path_of(key);
            checker.albedo_at(&path, *color);
            None
        }
        ColorDesc::Texture(name) => {
            textures::reference(checker, key, name);
            Some(name)
        }
    }
}
