//! The background and lights without a surface.

use std::fmt::Write;

use zrak_core::lights::LIGHT_DISTANT;
use zrak_core::math::equal_area_square_to_sphere;
use zrak_image::{Format, Picture, Transfer};
use zrak_scene::desc::{
    BackgroundDesc, EnvironmentMapping, LightDesc, SceneDesc, SpotFalloff, Triple,
};
use zrak_scene::error::SceneError;
use zrak_scene::lower::{LowerOptions, Transform, lower};

use super::text::{param, transform, word};
use super::{Writer, failure};

/// Texels to a side of the pictures of backgrounds that pbrt has no light for.
const BAKED_SIDE: u32 = 512;

impl Writer<'_, '_> {
    pub(super) fn background(&mut self) -> Result<(), SceneError> {
        let desc = self.desc;
        match &desc.background {
            BackgroundDesc::Constant { color } => {
                if *color != [0.0; 3] {
                    let light = param("rgb", "L", *color);
                    let _ = writeln!(self.out, "LightSource \"infinite\"{light}");
                }
            }
            BackgroundDesc::Image {
                path,
                mapping: EnvironmentMapping::EqualArea,
                strength,
                tint: [r, g, b],
                transform: steps,
            } if r == g && g == b => {
                let name = self.copied(path)?;
                let map = transform(&Transform::of_steps(steps));
                let light =
                    word("string", "filename", &name) + &param("float", "scale", [strength * r]);
                let _ = writeln!(
                    self.out,
                    "AttributeBegin\n{map}LightSource \"infinite\"{light}\nAttributeEnd"
                );
            }
            other => self.baked(other)?,
        }
        Ok(())
    }

    /// Writes a background as a picture of all directions.
    fn baked(&mut self, background: &BackgroundDesc) -> Result<(), SceneError> {
        let alone = SceneDesc { background: background.clone(), ..SceneDesc::default() };
        let options = LowerOptions {
            allow_external: true,
            embedded: self.embedded.clone(),
            ..LowerOptions::new(self.base_dir)
        };
        let arena = lower(&alone, &options).map_err(|problems| {
            failure(&problems.first().map_or_else(String::new, ToString::to_string))
        })?;
        let view = arena.view();
        let n = BAKED_SIDE;
        let at = |i: u32| (i as f32 + 0.5) / n as f32;
        let texel = |i: u32| {
            let d = equal_area_square_to_sphere(at(i % n), at(i / n));
            view.radiance_from_beyond(d).to_array()
        };
        let picture = Picture { width: n, height: n, pixels: (0..n * n).map(texel).collect() };
        let bytes = zrak_image::encode(Format::Exr, &picture, None, Transfer::Srgb)
            .map_err(|error| failure(&error.to_string()))?;
        let name = (self.sink)("background.exr", &bytes)?;
        let light = word("string", "filename", &name);
        let _ = writeln!(self.out, "LightSource \"infinite\"{light}");
        self.warn(format!("the background is written as a picture of {n} x {n} texels"));
        // The sun of a sky is a light of its own.
        for light in (0..view.lights.len()).map(|i| view.lights.get(i)) {
            if light.kind == LIGHT_DISTANT {
                let single = |v: [f32; 3]| v.map(f64::from);
                let d = single(light.direction.to_array());
                self.distant(d, single(light.intensity.to_array()));
            }
        }
        Ok(())
    }

    fn distant(&mut self, direction: Triple, irradiance: Triple) {
        let light = param("point3", "from", [0.0; 3])
            + &param("point3", "to", direction)
            + &param("rgb", "L", irradiance);
        let _ = writeln!(self.out, "LightSource \"distant\"{light}");
    }

    pub(super) fn lights(&mut self) {
        let desc = self.desc;
        for light in &desc.lights {
            match light {
                LightDesc::Point { position, intensity } => {
                    let light = param("point3", "from", *position) + &param("rgb", "I", *intensity);
                    let _ = writeln!(self.out, "LightSource \"point\"{light}");
                }
                LightDesc::Spot {
                    position,
                    direction,
                    intensity,
                    cone_angle_deg,
                    falloff_start_deg,
                    falloff,
                } => {
                    if *falloff != SpotFalloff::Smoothstep {
                        self.warn("the falloff of spots is smooth in pbrt, not square");
                    }
                    let to = [0, 1, 2].map(|i| position[i] + direction[i]);
                    let light = param("point3", "from", *position)
                        + &param("point3", "to", to)
                        + &param("rgb", "I", *intensity)
                        + &param("float", "coneangle", [*cone_angle_deg])
                        + &param("float", "conedeltaangle", [cone_angle_deg - falloff_start_deg]);
                    let _ = writeln!(self.out, "LightSource \"spot\"{light}");
                }
                LightDesc::Distant { direction, irradiance } => {
                    self.distant(*direction, *irradiance);
                }
            }
        }
    }
}
