//! Options that replace what a scene says of its picture.

use clap::Args;
use zrak::SceneDesc;
use zrak::scene::validate::{Problem, validate};

use crate::exit_codes::Exit;
use crate::failure::Failure;

/// Size and sampling of the picture.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Picture")]
pub(crate) struct Overrides {
    /// Width in pixels; without --height, the height keeps the scene's aspect ratio
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) width: Option<u32>,
    /// Height in pixels; without --width, the width keeps the scene's aspect ratio
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) height: Option<u32>,
    /// Samples per pixel
    #[arg(long, short = 's', value_name = "N", allow_negative_numbers = true)]
    pub(crate) spp: Option<u32>,
    /// Greatest number of ray segments of a path
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) max_depth: Option<u32>,
    /// Ray segments after which paths that carry little may end by chance; 65535 for never
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) rr_depth: Option<u32>,
    /// Seed of every random number, in decimal or as 0x...
    #[arg(long, value_name = "N", value_parser = parse_seed, allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
}

fn parse_seed(text: &str) -> Result<u64, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|error| format!("{error}; a seed is from 0 to 2^64 - 1"))
}

impl Overrides {
    /// Puts the options into a scene that has no problems.
    pub(crate) fn apply(&self, desc: &mut SceneDesc) -> Result<(), Failure> {
        let [old_width, old_height] = [desc.camera.width, desc.camera.height];
        match (self.width, self.height) {
            (None, None) => {}
            (Some(width), None) => {
                desc.camera.width = width;
                desc.camera.height = scaled(old_height, width, old_width);
            }
            (None, Some(height)) => {
                desc.camera.width = scaled(old_width, height, old_height);
                desc.camera.height = height;
            }
            (Some(width), Some(height)) => {
                (desc.camera.width, desc.camera.height) = (width, height);
            }
        }
        let render = &mut desc.render;
        render.samples_per_pixel = self.spp.unwrap_or(render.samples_per_pixel);
        render.max_depth = self.max_depth.unwrap_or(render.max_depth);
        render.rr_depth = self.rr_depth.unwrap_or(render.rr_depth);
        render.seed = self.seed.unwrap_or(render.seed);

        let lines: Vec<String> =
            validate(desc).iter().map(|problem| self.explain(problem)).collect();
        if lines.is_empty() {
            Ok(())
        } else {
            Err(Failure::new(Exit::Usage, lines.join("\n  and ")))
        }
    }

    /// A problem in terms of the option that it comes from: the scene had none before.
    fn explain(&self, problem: &Problem) -> String {
        let path = problem.path.to_string();
        let key = path.rsplit('.').next().unwrap_or_default();
        let option = match (key, self.width, self.height) {
            ("width", None, Some(_)) => "--height', from which the width follows,",
            ("height", Some(_), None) => "--width', from which the height follows,",
            ("width", ..) => "--width'",
            ("height", ..) => "--height'",
            ("samples_per_pixel", ..) => "--spp'",
            ("max_depth", ..) => "--max-depth'",
            ("rr_depth", ..) => "--rr-depth'",
            _ => return problem.to_string(),
        };
        let message = problem.message.replace(&format!("`{key}` must"), &format!("{key} must"));
        format!("invalid value for '{option}: {}", message.replace("_", " "))
    }
}

/// `side` x `numerator` / `denominator`, rounded, and at least one pixel.
fn scaled(side: u32, numerator: u32, denominator: u32) -> u32 {
    let (numerator, denominator) = (u64::from(numerator), u64::from(denominator.max(1)));
    let scaled = (u64::from(side) * numerator + denominator / 2) / denominator;
    u32::try_from(scaled.max(1)).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_keeps_the_aspect_ratio() {
        for (width, height, expected) in [
            (Some(800), None, [800, 450]),
            (None, Some(9), [16, 9]),
            (Some(1), None, [1, 1]),
            (Some(5), Some(7), [5, 7]),
            (None, None, [400, 225]),
        ] {
            let mut desc = zrak::load_scene("earth").unwrap().desc;
            Overrides { width, height, ..Overrides::default() }.apply(&mut desc).unwrap();
            assert_eq!([desc.camera.width, desc.camera.height], expected);
        }
    }

    #[test]
    fn seeds_are_decimal_or_hexadecimal() {
        assert_eq!(parse_seed("18446744073709551615"), Ok(u64::MAX));
        assert_eq!(parse_seed("0xdeadbeefcafe"), Ok(0xdead_beef_cafe));
        assert!(parse_seed("-1").is_err() && parse_seed("0x").is_err());
    }
}
