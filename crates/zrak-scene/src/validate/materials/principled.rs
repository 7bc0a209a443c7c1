//! The OpenPBR surface: every weight, colour and roughness from 0 to 1, indices that matter can have.

use super::{albedo_in, scalar};
use crate::desc::PrincipledDesc;
use crate::validate::checker::Checker;

/// Checks the parameters; gives back the names of textures that something is reflected by.
pub(super) fn check<'a>(checker: &mut Checker<'_>, desc: &'a PrincipledDesc) -> Vec<&'a str> {
    let shares = [
        ("base_weight", &desc.base_weight),
        ("base_metalness", &desc.base_metalness),
        ("base_diffuse_roughness", &desc.base_diffuse_roughness),
        ("specular_weight", &desc.specular_weight),
        ("specular_roughness", &desc.specular_roughness),
        ("specular_roughness_anisotropy", &desc.specular_roughness_anisotropy),
        ("transmission_weight", &desc.transmission_weight),
        ("subsurface_weight", &desc.subsurface_weight),
        ("coat_weight", &desc.coat_weight),
        ("coat_roughness", &desc.coat_roughness),
        ("coat_roughness_anisotropy", &desc.coat_roughness_anisotropy),
        ("coat_darkening", &desc.coat_darkening),
        ("fuzz_weight", &desc.fuzz_weight),
        ("fuzz_roughness", &desc.fuzz_roughness),
        ("thin_film_weight", &desc.thin_film_weight),
    ];
    let colors = [
        ("base_color", &desc.base_color),
        ("specular_color", &desc.specular_color),
        ("transmission_color", &desc.transmission_color),
        ("subsurface_color", &desc.subsurface_color),
        ("coat_color", &desc.coat_color),
        ("fuzz_color", &desc.fuzz_color),
    ];
    checker.enter("surface", |checker| {
        for (key, share) in shares {
            scalar(checker, key, share, Some([0.0, 1.0]));
        }
        scalar(checker, "thin_film_thickness", &desc.thin_film_thickness, Some([0.0, 1000.0]));
        let help = "water has 1.33, glass 1.5, air inside glass 1/1.5 = 0.6667";
        let rule = "at least 0.01";
        checker.require("specular_ior", desc.specular_ior, |x| x >= 0.01, rule, Some(help));
        for (key, ior) in [("coat_ior", desc.coat_ior), ("thin_film_ior", desc.thin_film_ior)] {
            checker.require(key, ior, |x| x >= 1.0, "at least 1", None);
        }
        colors.into_iter().filter_map(|(key, color)| albedo_in(checker, key, color)).collect()
    })
}
