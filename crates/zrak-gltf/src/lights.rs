//! KHR_lights_punctual.

use zrak_scene::desc::{LightDesc, SpotFalloff};
use zrak_scene::lower::Transform;

use crate::buffers::element;
use crate::error::{Error, Warnings};
use crate::json::Root;

/// The light of this index, at a node. Candela and lux are divided by `lumens_per_watt`.
pub(crate) fn place(
    root: &Root,
    index: usize,
    at: &str,
    world: &Transform,
    lumens_per_watt: f64,
    warnings: &mut Warnings,
) -> Result<Option<LightDesc>, Error> {
    let lights = root.extensions.lights.as_ref().map_or(&[][..], |l| &l.lights);
    let light = element(lights, "extensions.KHR_lights_punctual.lights", index, at)?;
    let location = format!("extensions.KHR_lights_punctual.lights[{index}]");
    let position = [world.rows[0][3], world.rows[1][3], world.rows[2][3]];
    let direction = world.vector([0.0, 0.0, -1.0]);
    let intensity =
        light.color.map(|c| (c.max(0.0) * light.intensity.max(0.0) / lumens_per_watt).min(1e9));
    if intensity == [0.0; 3] {
        return Ok(None);
    }
    Ok(match light.kind.as_str() {
        "point" => Some(LightDesc::Point { position, intensity }),
        "directional" => Some(LightDesc::Distant { direction, irradiance: intensity }),
        "spot" => {
            let default_spot = Default::default();
            let spot = light.spot.as_ref().unwrap_or(&default_spot);
            let outer = spot.outer_cone_angle.to_degrees();
            if !(outer > 0.0 && outer <= 180.0) {
                let message = format!("outerConeAngle is {} radians", spot.outer_cone_angle);
                return Err(Error::invalid(format_args!("{location}.spot"), message));
            }
            Some(LightDesc::Spot {
                position,
                direction,
                intensity,
                cone_angle_deg: outer,
                falloff_start_deg: spot.inner_cone_angle.to_degrees().clamp(0.0, outer),
                falloff: SpotFalloff::Square,
            })
        }
        kind => {
            warnings.note(location, format!("lights of type {kind:?} are left out"));
            None
        }
    })
}
