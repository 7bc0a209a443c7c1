//! Participating media.

use zrak_scene::desc::MediumDesc;

use crate::color::Rgb;
use crate::error::{Fault, Result, Span};
use crate::facts::MEDIA;
use crate::params::Params;
use crate::state::Importer;

const KINDS: [&str; 5] = ["homogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"];

/// Scattering and absorption of a medium that pbrt knows by name, per millimetre.
pub(crate) fn preset(name: &str, span: &Span) -> Result<(Rgb, Rgb)> {
    if let Some((_, sigma_s, sigma_a)) = MEDIA.iter().find(|(known, ..)| *known == name) {
        return Ok((*sigma_s, *sigma_a));
    }
    let names: Vec<&str> = MEDIA.iter().map(|(known, ..)| *known).collect();
    Err(Fault::unknown(span, "measured medium", name, &names))
}

impl Importer {
    pub(crate) fn medium(&mut self, name: &str, at: &Span, params: &Params) -> Result<()> {
        let kind = match params.string("type")? {
            Some(kind) => kind.to_owned(),
            None => {
                let fault = Fault::new(at, "the medium has no \"string type\"");
                return Err(fault.help("such as \"string type\" \"homogeneous\""));
            }
        };
        if !KINDS.contains(&kind.as_str()) {
            return Err(Fault::unknown(&params.span_of("type"), "medium", &kind, &KINDS));
        }
        if kind != "homogeneous" {
            self.warn(at, format!("medium \"{kind}\" is not rendered: there is nothing in it"));
            params.ignore_all();
            let nothing = MediumDesc { sigma_a: [0.0; 3], sigma_s: [0.0; 3], g: 0.0 };
            self.desc.media.insert(name.to_owned(), nothing);
            return Ok(());
        }
        let scale = params.float("scale")?.unwrap_or(1.0);
        if !(scale >= 0.0) {
            let message = format!("`scale` must be at least 0, is {scale}");
            return Err(Fault::new(&params.span_of("scale"), message));
        }
        let (sigma_s, sigma_a) = match params.string("preset")? {
            Some(preset_name) => {
                let found = preset(preset_name, &params.span_of("preset"))?;
                params.ignore(&["sigma_a", "sigma_s"]);
                found
            }
            None => (
                self.coefficients(params, "sigma_s")?.unwrap_or([1.0; 3]),
                self.coefficients(params, "sigma_a")?.unwrap_or([1.0; 3]),
            ),
        };
        let g = self.mean_cosine(params, params.float("g")?.unwrap_or(0.0))?;
        if self.light_color(params, "Le")?.is_some_and(|le| le.iter().any(|&x| x > 0.0)) {
            self.warn(&params.span_of("Le"), "media do not shine: Le is not read");
        }
        params.ignore(&["Lescale"]);
        let medium = MediumDesc {
            sigma_a: sigma_a.map(|x| x * scale),
            sigma_s: sigma_s.map(|x| x * scale),
            g,
        };
        self.desc.media.insert(name.to_owned(), medium);
        Ok(())
    }
}
