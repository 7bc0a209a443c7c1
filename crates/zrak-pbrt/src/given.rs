//! Parameters that are colours, spectra, numbers or textures, as descriptions have them.

use zrak_scene::desc::{ColorDesc, ScalarDesc, TextureDesc};

use crate::color::Rgb;
use crate::error::{Fault, Result, Span};
use crate::params::{Params, Values};
use crate::spectrum::{self, Named, Spectrum};
use crate::state::Importer;

/// What a parameter of type spectrum is.
pub(crate) enum Given {
    Rgb(Rgb),
    Spectrum(Spectrum),
    /// Light of this chromaticity.
    Light([f64; 2]),
    Blackbody(f64),
}

impl Importer {
    /// A parameter that may be a colour or a spectrum.
    pub(crate) fn given(&mut self, params: &Params, name: &str) -> Result<Option<(Given, Span)>> {
        let Some(param) = params.find(&["rgb", "color", "spectrum", "blackbody"], name) else {
            return Ok(None);
        };
        let (kind, span) = (param.kind.as_str(), param.span.clone());
        let fault = |message: &str| Err(Fault::new(&span, format!("`{name}` {message}")));
        let given = match (kind, &param.values) {
            ("rgb" | "color", Values::Numbers(x)) => {
                let [r, g, b] = x[..] else { return fault("must have three numbers") };
                Given::Rgb(self.state.space.to_srgb([r, g, b]))
            }
            ("blackbody", Values::Numbers(x)) => {
                let [kelvin] = x[..] else { return fault("must be one temperature, in kelvin") };
                if !(100.0..1e7).contains(&kelvin) {
                    return fault(
                        "is no temperature that shines: it must be from 100 to 1e7 kelvin",
                    );
                }
                Given::Blackbody(kelvin)
            }
            ("spectrum", Values::Numbers(x)) => match x[..] {
                // One number: the same at all wavelengths.
                [value] => Given::Spectrum(Spectrum(vec![[550.0, value]])),
                _ => Given::Spectrum(spectrum_of(x, name, &span)?),
            },
            ("spectrum", Values::Strings(words)) => {
                let [word] = &words[..] else { return fault("must be one name or file") };
                match spectrum::named(word) {
                    Some(Named::Spectrum(spectrum)) => Given::Spectrum(spectrum),
                    Some(Named::Light(xy)) => Given::Light(xy),
                    None => Given::Spectrum(self.spectrum_file(word, &span)?),
                }
            }
            _ => return fault("has values of another type"),
        };
        Ok(Some((given, span)))
    }

    fn spectrum_file(&mut self, name: &str, span: &Span) -> Result<Spectrum> {
        let path = self.sources.resolve(name, span)?;
        if !self.sources.is_file(&path) {
            let message = format!("there is no spectrum \"{name}\", by name or as a file");
            let fault = Fault::new(span, message);
            return Err(match zrak_scene::suggest::closest(name, spectrum::names()) {
                Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                None => fault.help(format!("it would be {}", path.display())),
            });
        }
        let text = self.sources.read(&path, span)?;
        let mut numbers = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or("");
            for word in line.split_ascii_whitespace() {
                match word.parse::<f64>() {
                    Ok(x) if x.is_finite() => numbers.push(x),
                    _ => {
                        let message =
                            format!("{} line {}: `{word}` is no number", path.display(), i + 1);
                        return Err(Fault::new(span, message));
                    }
                }
            }
        }
        spectrum_of(&numbers, name, span)
    }

    /// Colour of emitted light: as it is, if it is RGB; with a luminance of 1 if not.
    pub(crate) fn light_color(&mut self, params: &Params, name: &str) -> Result<Option<Rgb>> {
        Ok(self.given(params, name)?.map(|(given, _)| match given {
            Given::Rgb(rgb) => rgb,
            Given::Blackbody(kelvin) => spectrum::blackbody_rgb(kelvin),
            Given::Light(xy) => spectrum::chromaticity_rgb(xy),
            Given::Spectrum(s) => spectrum::emission_rgb(|lambda| s.at(lambda)),
        }))
    }

    /// A colour of coefficients, which may be above 1.
    pub(crate) fn coefficients(&mut self, params: &Params, name: &str) -> Result<Option<Rgb>> {
        Ok(match self.given(params, name)? {
            None => None,
            Some((Given::Rgb(rgb), _)) => Some(rgb.map(|x| x.max(0.0))),
            Some((Given::Spectrum(s), _)) => {
                Some(spectrum::reflectance_rgb(|lambda| s.at(lambda)).map(|x| x.max(0.0)))
            }
            Some((Given::Blackbody(_) | Given::Light(_), span)) => {
                let fault = Fault::new(&span, format!("`{name}` cannot be a light"));
                return Err(fault.help("give an rgb colour, or a spectrum of values"));
            }
        })
    }

    /// Colour of a share of light: at most 1.
    pub(crate) fn share(&mut self, params: &Params, name: &str) -> Result<Option<Rgb>> {
        let Some(rgb) = self.coefficients(params, name)? else { return Ok(None) };
        if rgb.iter().any(|&x| x > 1.0 + 1e-6) {
            let span = params.span_of(name);
            self.warn(&span, format!("`{name}` is more than all light; it is cut off at 1"));
        }
        Ok(Some(rgb.map(|x| x.min(1.0))))
    }

    /// A share of light that may be a texture.
    pub(crate) fn color(&mut self, params: &Params, name: &str, default: Rgb) -> Result<ColorDesc> {
        if let Some((texture, span)) = params.texture(name)? {
            return Ok(ColorDesc::Texture(self.texture_name(texture, false, span)?));
        }
        Ok(ColorDesc::Solid(self.share(params, name)?.unwrap_or(default)))
    }

    /// A share of light that cannot be a texture here: that of a texture of one colour, or the default.
    pub(crate) fn plain_color(&mut self, params: &Params, name: &str, default: Rgb) -> Result<Rgb> {
        let key = match self.color(params, name, default)? {
            ColorDesc::Solid(color) => return Ok(color),
            ColorDesc::Texture(key) => key,
        };
        if let Some(TextureDesc::Solid { color }) = self.desc.textures.get(&key) {
            return Ok(*color);
        }
        let span = params.span_of(name);
        self.warn(&span, format!("`{name}` is not read from a texture: it is {default:?}"));
        Ok(default)
    }

    /// A number that may be a texture.
    pub(crate) fn scalar(&mut self, params: &Params, name: &str) -> Result<Option<ScalarDesc>> {
        if let Some((texture, span)) = params.texture(name)? {
            return Ok(Some(ScalarDesc::Texture(self.texture_name(texture, true, span)?)));
        }
        Ok(params.float(name)?.map(ScalarDesc::Value))
    }

    /// A number from 0 to 1 that may be a texture.
    pub(crate) fn part(&mut self, params: &Params, name: &str) -> Result<Option<ScalarDesc>> {
        Ok(match self.scalar(params, name)? {
            Some(ScalarDesc::Value(x)) if !(0.0..=1.0).contains(&x) => {
                let span = params.span_of(name);
                let cut = x.clamp(0.0, 1.0);
                self.warn(&span, format!("`{name}` must be from 0 to 1; it is taken as {cut}"));
                Some(ScalarDesc::Value(cut))
            }
            other => other,
        })
    }

    /// A number that cannot be a texture here: that of a texture of one value, or the default.
    pub(crate) fn plain(&mut self, params: &Params, name: &str, default: f64) -> Result<f64> {
        match self.scalar(params, name)? {
            None => Ok(default),
            Some(ScalarDesc::Value(x)) => Ok(x),
            Some(ScalarDesc::Texture(key)) => {
                if let Some(TextureDesc::Solid { color }) = self.desc.textures.get(&key) {
                    return Ok(color[0]);
                }
                let span = params.span_of(name);
                self.warn(&span, format!("`{name}` is not read from a texture: it is {default}"));
                Ok(default)
            }
        }
    }
}

/// Points of a spectrum from pairs of a wavelength and a value.
fn spectrum_of(numbers: &[f64], name: &str, span: &Span) -> Result<Spectrum> {
    if numbers.is_empty() || !numbers.len().is_multiple_of(2) {
        let message = format!("spectrum `{name}` must be pairs of a wavelength and a value");
        return Err(Fault::new(span, message));
    }
    let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|c| [c[0], c[1]]).collect();
    if let Some(w) = points.windows(2).find(|w| w[0][0] >= w[1][0]) {
        let message = format!(
            "the wavelengths of spectrum `{name}` must increase: {} comes after {}",
            w[1][0], w[0][0]
        );
        return Err(Fault::new(span, message));
    }
    Ok(Spectrum(points))
}
