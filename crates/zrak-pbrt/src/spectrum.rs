//! Spectra as colours.
//!
//! A reflectance is seen under daylight (D65), the white of sRGB: its colour is that of the light it
//! reflects, integrated with the colour matching functions, as one of a white surface. Emitted light
//! is normalised to a luminance of 1, as pbrt does with everything but its RGB values, and takes its
//! chromaticity from its spectrum.

use crate::color::{LAMBDA, Rgb, xyz, xyz_to_srgb};
use crate::facts::{D65, GLASSES, ILLUMINANTS, METAL_LAMBDA, METALS};

/// A spectrum: values at wavelengths in nanometres, in increasing order, linear in between and constant
/// beyond both ends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spectrum(pub(crate) Vec<[f64; 2]>);

impl Spectrum {
    /// Value at a wavelength.
    pub(crate) fn at(&self, lambda: f64) -> f64 {
        let points = &self.0;
        let i = points.partition_point(|p| p[0] < lambda);
        match (i.checked_sub(1).and_then(|i| points.get(i)), points.get(i)) {
            (Some(a), Some(b)) => {
                let t = (lambda - a[0]) / (b[0] - a[0]);
                a[1] + (b[1] - a[1]) * t
            }
            (Some(a), None) => a[1],
            (None, Some(b)) => b[1],
            (None, None) => 0.0,
        }
    }
}

fn wavelengths() -> impl Iterator<Item = f64> {
    let [from, to, step] = LAMBDA;
    (0..=((to - from) / step) as u32).map(move |i| from + f64::from(i) * step)
}

/// XYZ of the light of a spectrum, not normalised.
fn integrate(f: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for lambda in wavelengths() {
        let (m, x) = (xyz(lambda), f(lambda));
        (0..3).for_each(|i| sum[i] += m[i] * x);
    }
    sum
}

/// Planck's law, up to a factor; temperature in kelvin.
fn planck(lambda_nm: f64, kelvin: f64) -> f64 {
    // Second radiation constant, in nm K.
    const C2: f64 = 1.438_776_877e7;
    let x = lambda_nm / 500.0;
    1.0 / (x * x * x * x * x * libm::expm1(C2 / (lambda_nm * kelvin)))
}

/// Relative power of daylight, CIE's D65.
fn daylight(lambda: f64) -> f64 {
    let at = ((lambda - 380.0) / 10.0).clamp(0.0, 39.999);
    let (i, t) = (at as usize, at.fract());
    D65[i] + (D65[i + 1] - D65[i]) * t
}

/// Colour of a reflectance under daylight: white for one that is 1 everywhere.
pub(crate) fn reflectance_rgb(f: impl Fn(f64) -> f64) -> Rgb {
    let (seen, all) = (integrate(|lambda| f(lambda) * daylight(lambda)), integrate(daylight));
    // The fitted matching functions see D65 a little off sRGB's white: scale XYZ from one to the other.
    let white = white_xyz();
    xyz_to_srgb(std::array::from_fn(|i| seen[i] / all[i] * white[i]))
}

/// XYZ of sRGB's white at Y = 1.
fn white_xyz() -> [f64; 3] {
    [0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290]
}

/// Colour of light, with a luminance of 1; black of none.
pub(crate) fn emission_rgb(f: impl Fn(f64) -> f64) -> Rgb {
    let seen = integrate(f);
    if seen[1] <= 0.0 {
        return [0.0; 3];
    }
    on_rim(seen.map(|x| x / seen[1]))
}

/// Colour of light of a chromaticity, with a luminance of 1.
pub(crate) fn chromaticity_rgb([x, y]: [f64; 2]) -> Rgb {
    on_rim([x / y, 1.0, (1.0 - x - y) / y])
}

/// Colours beyond what sRGB can show are brought to its rim.
fn on_rim(xyz: [f64; 3]) -> Rgb {
    let rgb = xyz_to_srgb(xyz).map(|x| x.max(0.0));
    let luminance = 0.212_639 * rgb[0] + 0.715_169 * rgb[1] + 0.072_192 * rgb[2];
    rgb.map(|x| x / luminance)
}

/// Colour of a black body, with a luminance of 1.
pub(crate) fn blackbody_rgb(kelvin: f64) -> Rgb {
    emission_rgb(|lambda| planck(lambda, kelvin))
}

/// Complex index of refraction for red, green and blue of a metal that is given by spectra: eta is that
/// of the channel's wavelengths, and k makes the reflectance at right angles that of the spectra.
pub(crate) fn conductor_index(eta: &Spectrum, k: &Spectrum) -> (Rgb, Rgb) {
    let reflectance = |lambda: f64| {
        let (n, k) = (eta.at(lambda), k.at(lambda));
        ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
    };
    let seen = reflectance_rgb(reflectance).map(|r| r.clamp(0.0, 0.999));
    let mean = reflectance_rgb(|lambda| eta.at(lambda)).map(|n| n.max(0.01));
    let k = std::array::from_fn(|i| {
        let (r, n) = (seen[i], mean[i]);
        let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
        k2.max(0.0).sqrt()
    });
    (mean, k)
}

/// Index of refraction of a clear material, which zrak takes as the same for all wavelengths: that at
/// the sodium line.
pub(crate) fn dielectric_index(spectrum: &Spectrum) -> f64 {
    spectrum.at(589.3)
}

/// What is known about a spectrum by its name.
pub(crate) enum Named {
    /// Values: an index of refraction. Of a glass there is one, that at the sodium line.
    Spectrum(Spectrum),
    /// Light of this chromaticity.
    Light([f64; 2]),
}

/// A spectrum that pbrt knows by name.
pub(crate) fn named(name: &str) -> Option<Named> {
    if let Some((symbol, which)) =
        name.strip_prefix("metal-").and_then(|rest| rest.rsplit_once('-'))
    {
        let metal = METALS.iter().find(|metal| metal.symbol == symbol)?;
        let values = match which {
            "eta" => &metal.eta,
            "k" => &metal.k,
            _ => return None,
        };
        let [from, step] = METAL_LAMBDA;
        let point = |(i, value): (usize, &f64)| [from + step * i as f64, *value];
        return Some(Named::Spectrum(Spectrum(values.iter().enumerate().map(point).collect())));
    }
    // pbrt knows some glasses by two names.
    let short = name.replace("glass-SF", "glass-F");
    if let Some((_, n)) = GLASSES.iter().find(|(glass, _)| *glass == short) {
        return Some(Named::Spectrum(Spectrum(vec![[589.3, *n]])));
    }
    ILLUMINANTS.iter().find(|(light, _)| *light == name).map(|(_, xy)| Named::Light(*xy))
}

/// The names that [`named`] knows, for suggestions.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    const METAL_NAMES: [&str; 14] = [
        "metal-Ag-eta",
        "metal-Ag-k",
        "metal-Al-eta",
        "metal-Al-k",
        "metal-Au-eta",
        "metal-Au-k",
        "metal-Cu-eta",
        "metal-Cu-k",
        "metal-CuZn-eta",
        "metal-CuZn-k",
        "metal-MgO-eta",
        "metal-MgO-k",
        "metal-TiO2-eta",
        "metal-TiO2-k",
    ];
    let glasses = GLASSES.iter().map(|(name, _)| *name);
    let lights = ILLUMINANTS.iter().map(|(name, _)| *name);
    METAL_NAMES.into_iter().chain(glasses).chain(lights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflectances_are_seen_under_white() {
        let grey = reflectance_rgb(|_| 0.3);
        assert!(grey.iter().all(|x| (x - 0.3).abs() < 1e-9), "{grey:?}");
        let red = reflectance_rgb(|lambda| if lambda > 600.0 { 0.9 } else { 0.05 });
        assert!(red[0] > 0.7 && red[1] < 0.15 && red[2] < 0.1, "{red:?}");
    }

    #[test]
    fn black_bodies_have_the_known_colours() {
        let luminance = |c: Rgb| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let hot = blackbody_rgb(6504.0);
        assert!((luminance(hot) - 1.0).abs() < 1e-3);
        assert!(hot.iter().all(|x| (x - 1.0).abs() < 0.06), "near white: {hot:?}");
        let warm = blackbody_rgb(2856.0);
        // Illuminant A: chromaticity (0.4476, 0.4074).
        let expected = {
            let (x, y) = (0.4476, 0.4074);
            xyz_to_srgb([x / y, 1.0, (1.0 - x - y) / y])
        };
        for (a, b) in warm.iter().zip(expected) {
            assert!((a - b).abs() < 0.03, "{warm:?} {expected:?}");
        }
    }

    #[test]
    fn metals_reflect_as_their_spectra_do() {
        let eta = Spectrum(vec![[400.0, 1.6], [500.0, 0.9], [600.0, 0.25], [800.0, 0.2]]);
        let k = Spectrum(vec![[400.0, 1.9], [500.0, 1.8], [600.0, 2.9], [800.0, 4.8]]);
        let (n, k_rgb) = conductor_index(&eta, &k);
        let seen = reflectance_rgb(|l| {
            let (n, k) = (eta.at(l), k.at(l));
            ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k)
        });
        for i in 0..3 {
            let (n, k) = (n[i], k_rgb[i]);
            let r = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
            // What is redder than any surface can be in sRGB is brought to its rim.
            assert!((r - seen[i].clamp(0.0, 0.999)).abs() < 1e-9, "{r} {}", seen[i]);
        }
    }
}
