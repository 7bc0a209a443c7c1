//! What a file says about the making of the picture: options, pixel filter, integrator.

use crate::error::{Fault, Result, Span};
use crate::params::Params;
use crate::state::Importer;

/// Options that pbrt has; those that this reader does not look at are about pbrt's own ways.
const OPTIONS: [&str; 12] = [
    "disablepixeljitter",
    "disabletexturefiltering",
    "disablewavelengthjitter",
    "displacementedgescale",
    "forcediffuse",
    "msereferenceimage",
    "msereferenceout",
    "pixelstats",
    "rendercoordsys",
    "seed",
    "wavefront",
    "gpu",
];

const FILTERS: [&str; 5] = ["box", "gaussian", "mitchell", "sinc", "triangle"];

const INTEGRATORS: [&str; 11] = [
    "path",
    "volpath",
    "bdpt",
    "mlt",
    "sppm",
    "lightpath",
    "simplepath",
    "simplevolpath",
    "randomwalk",
    "ambientocclusion",
    "function",
];

impl Importer {
    pub(crate) fn option(&mut self, params: &Params) -> Result<()> {
        if let Some(seed) = params.integer("seed")? {
            self.desc.render.seed = seed as u64;
        }
        for param in &params.all {
            let name: String = param.name.chars().filter(|&c| c != '_').collect();
            let name = name.to_ascii_lowercase();
            if !OPTIONS.contains(&name.as_str()) {
                return Err(Fault::unknown(&param.span, "option", &param.name, &OPTIONS));
            }
            let changes_picture = ["disablepixeljitter", "disabletexturefiltering", "forcediffuse"];
            if changes_picture.contains(&name.as_str())
                && params.bool(&param.name).ok().flatten() == Some(true)
            {
                self.warn(&param.span, format!("option \"{}\" is not followed", param.name));
            }
        }
        Ok(())
    }

    pub(crate) fn pixel_filter(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        if !FILTERS.contains(&kind) {
            return Err(Fault::unknown(at, "pixel filter", kind, &FILTERS));
        }
        let radius = [params.float("xradius")?, params.float("yradius")?];
        if kind != "box" || radius.iter().flatten().any(|&r| r != 0.5) {
            let message = "every pixel is the mean over its own square: the filter is not applied";
            self.warn(at, message);
        }
        Ok(())
    }

    pub(crate) fn integrator(&mut self, kind: &str, at: &Span, params: &Params) -> Result<()> {
        if !INTEGRATORS.contains(&kind) {
            return Err(Fault::unknown(at, "integrator", kind, &INTEGRATORS));
        }
        if kind == "ambientocclusion" || kind == "function" {
            let message =
                format!("integrator \"{kind}\" does not follow light: all light is rendered");
            self.warn(at, message);
        }
        if let Some(n) = params.integer("maxdepth")? {
            // Theirs counts vertices after the first, ours segments.
            self.desc.render.max_depth = n.clamp(0, 65_000) as u32 + 1;
        }
        if params.bool("regularize")? == Some(true) {
            self.warn(at, "paths are not regularized: what they find is noisier, and unbiased");
        }
        Ok(())
    }
}
