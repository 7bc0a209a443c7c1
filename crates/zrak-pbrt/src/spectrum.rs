//! Spectra as colours.
//!
//! A reflectance is seen under white: its colour is the ratio of the light it reflects of an even
//! spectrum, integrated with the colour matching functions, to that of a white surface. Emitted light
//! is normalised to a luminance of 1, as pbrt does with everything but its RGB values, and takes its
//! chromaticity from its spectrum.

use crate::color::{LAMBDA, Rgb, xyz, xyz_to_srgb};

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

/// Colour of a reflectance: white for one that is 1 everywhere, whatever the white of the space.
pub(crate) fn reflectance_rgb(f: impl Fn(f64) -> f64) -> Rgb {
    let (seen, even) = (integrate(f), integrate(|_| 1.0));
    // Under the even spectrum white is not sRGB's: scale XYZ from one to the other.
    let white = white_xyz();
    xyz_to_srgb(std::array::from_fn(|i| seen[i] / even[i] * white[i]))
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
    // Colours beyond what sRGB can show are brought to its rim.
    let rgb = xyz_to_srgb(seen.map(|x| x / seen[1])).map(|x| x.max(0.0));
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Named {
    /// eta and k of a metal at the wavelengths of red, green and blue.
    Metal { eta: Rgb, k: Rgb },
    /// Index of refraction at the sodium line.
    Glass(f64),
    /// Light of a black body of this temperature in kelvin, or near enough.
    Illuminant(f64),
}

/// A spectrum that pbrt knows by name; of metals, `metal-X-eta` and `metal-X-k` are the same.
///
/// Metals: Johnson and Christy, *Optical Constants of the Noble Metals*, 1972, and Rakic, *Algorithm
/// for the determination of intrinsic optical constants of metal films*, 1995, at 650, 550 and 450 nm.
/// Glasses: the makers' data sheets.
pub(crate) fn named(name: &str) -> Option<Named> {
    let metal = |eta, k| Some(Named::Metal { eta, k });
    if let Some(rest) = name.strip_prefix("metal-") {
        let (symbol, _) = rest.rsplit_once('-')?;
        return match symbol {
            "Au" => metal([0.143, 0.375, 1.442], [3.983, 2.386, 1.603]),
            "Ag" => metal([0.155, 0.117, 0.138], [4.828, 3.122, 2.147]),
            "Al" => metal([1.657, 0.880, 0.521], [9.224, 6.270, 4.837]),
            "Cu" => metal([0.200, 0.924, 1.102], [3.912, 2.452, 2.142]),
            "CuZn" => metal([0.444, 0.527, 1.094], [3.695, 2.765, 1.829]),
            "MgO" => metal([1.735, 1.740, 1.752], [0.0; 3]),
            "TiO2" => metal([2.574, 2.649, 2.847], [0.0; 3]),
            _ => None,
        };
    }
    let glass = |n| Some(Named::Glass(n));
    let light = |kelvin| Some(Named::Illuminant(kelvin));
    match name {
        "glass-BK7" => glass(1.5167),
        "glass-BAF10" => glass(1.6700),
        "glass-FK51A" => glass(1.4866),
        "glass-LASF9" => glass(1.8503),
        "glass-F5" | "glass-SF5" => glass(1.6727),
        "glass-F10" | "glass-SF10" => glass(1.7283),
        "glass-F11" | "glass-SF11" => glass(1.7847),
        "stdillum-A" => light(2856.0),
        "stdillum-D50" => light(5003.0),
        "stdillum-D65" => light(6504.0),
        "stdillum-F1" => light(6430.0),
        "stdillum-F2" => light(4230.0),
        "stdillum-F3" => light(3450.0),
        "stdillum-F4" => light(2940.0),
        "stdillum-F5" => light(6350.0),
        "stdillum-F6" => light(4150.0),
        "stdillum-F7" => light(6500.0),
        "stdillum-F8" => light(5000.0),
        "stdillum-F9" => light(4150.0),
        "stdillum-F10" => light(5000.0),
        "stdillum-F11" => light(4000.0),
        "stdillum-F12" => light(3000.0),
        _ => None,
    }
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
