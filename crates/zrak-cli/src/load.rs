//! Options of loading scenes, for every subcommand that does.

use std::path::Path;

use clap::{Args, ValueEnum};
use zrak::{Error, GltfOptions, LoadOptions, LoadProgress, LoweredScene, MissingTextures, Scene};

use crate::loading::Loading;
use crate::terminal;

/// What of a scene may be read, and how.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Scene")]
pub(crate) struct LoadArgs {
    /// Read files outside of the scene's folder, too
    #[arg(long)]
    pub(crate) allow_external: bool,
    /// Most bytes of a scene's files, unpacked, and of the data made of them: 500M, 16G, ...
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes, default_value = "16G")]
    pub(crate) max_bytes: u64,
    /// What to do about textures whose image cannot be read
    #[arg(long, value_name = "WHAT", default_value = "error")]
    pub(crate) missing_textures: MissingName,
    /// Camera of a glTF file: its name, its node's name, or its number from 0 [default: the first]
    #[arg(long, value_name = "NAME")]
    pub(crate) camera: Option<String>,
    /// Scene of a glTF file: its name, or its number from 0 [default: the file's]
    #[arg(long, value_name = "NAME")]
    pub(crate) gltf_scene: Option<String>,
    /// Luminous efficacy that makes watts of the candela and lux of a glTF file's lights
    #[arg(
        long, value_name = "X", value_parser = parse_efficacy, allow_negative_numbers = true,
        default_value_t = GltfOptions::default().lumens_per_watt, hide_short_help = true
    )]
    pub(crate) lumens_per_watt: f64,
    /// Make the backs of a glTF file's single-sided surfaces holes, as viewers show them
    #[arg(long, hide_short_help = true)]
    pub(crate) cull_back_faces: bool,
}

/// [`MissingTextures`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MissingName {
    /// Refuse the scene
    Error,
    /// Say so, and put mid grey in their place
    Warn,
}

/// A scene on its way to be rendered, and what shows how far it is.
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    loading: Loading,
}

/// More warnings than this are counted, not shown.
const WARNINGS_MAX: usize = 20;

impl LoadArgs {
    /// The options of the library.
    pub(crate) fn options(&self, progress: &LoadProgress) -> LoadOptions {
        LoadOptions {
            allow_external: self.allow_external,
            max_bytes: self.max_bytes,
            missing_textures: match self.missing_textures {
                MissingName::Error => MissingTextures::Error,
                MissingName::Warn => MissingTextures::Warn,
            },
            camera: self.camera.clone(),
            gltf: GltfOptions {
                scene: self.gltf_scene.clone(),
                lumens_per_watt: self.lumens_per_watt,
                cull_back_faces: self.cull_back_faces,
            },
            progress: progress.clone(),
        }
    }

    /// Loads a scene; says what was not read as it stands, unless nobody wants to know.
    pub(crate) fn load(&self, scene: &Path, is_quiet: bool) -> Result<Loaded, Error> {
        let progress = LoadProgress::default();
        let loading = Loading::start(&progress, is_quiet);
        let scene = zrak::load_scene_with(scene, &self.options(&progress))?;
        loading.warn(&scene.warnings);
        Ok(Loaded { scene, loading })
    }
}

impl Loaded {
    /// Makes it ready to render; says what had to be left out or replaced.
    pub(crate) fn lower(self) -> Result<(Scene, LoweredScene), Error> {
        let lowered = self.scene.lower_with_warnings()?;
        self.loading.warn(&lowered.warnings);
        Ok((self.scene, lowered))
    }

    /// The scene alone.
    pub(crate) fn into_scene(self) -> Scene {
        self.scene
    }
}

impl Loading {
    /// Shows warnings, unless nobody wants to know.
    fn warn(&self, warnings: &[String]) {
        let shown = warnings.iter().take(WARNINGS_MAX);
        let mut lines: Vec<String> = shown.map(|warning| format!("warning: {warning}")).collect();
        if warnings.len() > WARNINGS_MAX {
            lines.push(format!("warning: and {} more", warnings.len() - WARNINGS_MAX));
        }
        for line in lines {
            // What comes from a file could disturb a terminal.
            let line: String =
                line.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
            self.note(&line);
        }
    }
}

/// Says warnings of something that is done.
pub(crate) fn warn(warnings: &[String]) {
    for warning in warnings.iter().take(WARNINGS_MAX) {
        terminal::note(&format!("warning: {warning}"));
    }
    if warnings.len() > WARNINGS_MAX {
        terminal::note(&format!("warning: and {} more", warnings.len() - WARNINGS_MAX));
    }
}

/// A number of bytes, with the unit after it: 1024, 500M, 1.5G.
fn parse_bytes(text: &str) -> Result<u64, String> {
    let wrong =
        || format!("'{text}' is not a size, such as 500M or 16G (units are of 1024: K, M, G, T)");
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let exponent = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "" | "B" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        "T" | "TB" | "TIB" => 40,
        _ => return Err(wrong()),
    };
    let number: f64 = digits.parse().map_err(|_| wrong())?;
    let bytes = number * f64::from(1_u32 << (exponent / 2)) * f64::from(1_u32 << (exponent / 2));
    if !(bytes >= 1.0 && bytes <= (1_u64 << 50) as f64) {
        return Err("a size is from 1 byte to 1024T".to_owned());
    }
    Ok(bytes as u64)
}

fn parse_efficacy(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        Ok(_) => Err("an efficacy is more than 0".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in [
            ("1", 1),
            ("1024", 1024),
            ("4k", 4096),
            ("1.5M", 3 << 19),
            ("16G", 16 << 30),
            ("2GiB", 2 << 30),
            ("1T", 1 << 40),
        ] {
            assert_eq!(parse_bytes(text), Ok(bytes), "{text}");
        }
        for text in ["", "0", "-1", "G", "1X", "1 G", "nan", "inf", "1e30", "5000T"] {
            assert!(parse_bytes(text).is_err(), "{text}");
        }
    }

    #[test]
    fn defaults_are_those_of_the_library() {
        use clap::Parser;
        #[derive(Parser)]
        struct Only {
            #[command(flatten)]
            load: LoadArgs,
        }
        let options = Only::parse_from(["zrak"]).load.options(&LoadProgress::default());
        assert_eq!(format!("{options:?}"), format!("{:?}", LoadOptions::default()));
    }
}
