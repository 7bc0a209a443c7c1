//! Lights without a surface, and media that surfaces bound.

use super::checker::Checker;
use crate::desc::LightDesc;

pub(super) fn check(checker: &mut Checker<'_>) {
    let scene = checker.scene;
    checker.enter("lights", |checker| {
        for (i, light) in scene.lights.iter().enumerate() {
            checker.enter(i, |checker| one(checker, light));
        }
    });
    checker.enter("media", |checker| {
        for (name, medium) in &scene.media {
            checker.enter(name.as_str(), |checker| {
                for (key, sigma) in [("sigma_a", medium.sigma_a), ("sigma_s", medium.sigma_s)] {
                    if checker.triple(key, sigma) && sigma.iter().any(|&x| x < 0.0) {
                        let message = format!("`{key}` must have numbers from 0 on");
                        checker.note(key, message, None);
                    }
                }
                let ok = |g: f64| g.abs() < 1.0;
                checker.require("g", medium.g, ok, "between -1 and 1, both excluded", None);
            });
        }
    });
}

fn one(checker: &mut Checker<'_>, light: &LightDesc) {
    match *light {
        LightDesc::Point { position, intensity } => {
            checker.triple("position", position);
            checker.radiance("intensity", intensity);
        }
        LightDesc::Spot {
            position,
            direction,
            intensity,
            cone_angle_deg,
            falloff_start_deg,
            falloff: _,
        } => {
            checker.triple("position", position);
            checker.direction("direction", direction);
            checker.radiance("intensity", intensity);
            let ok = |x: f64| x > 0.0 && x <= 180.0;
            let rule = "more than 0 and at most 180 degrees";
            let has_cone = checker.require("cone_angle_deg", cone_angle_deg, ok, rule, None);
            let ok = |x: f64| x >= 0.0 && !(has_cone && x > cone_angle_deg);
            let rule = "from 0 to `cone_angle_deg`";
            checker.require("falloff_start_deg", falloff_start_deg, ok, rule, None);
        }
        LightDesc::Distant { direction, irradiance } => {
            checker.direction("direction", direction);
            checker.radiance("irradiance", irradiance);
        }
    }
}
