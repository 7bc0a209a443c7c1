//! The clear sky: sunlight scattered in a spherical atmosphere of air, ozone and aerosols.
//!
//! Single scattering is integrated along each direction as in Nishita et al., *Display of the Earth
//! Taking into Account Atmospheric Scattering*, SIGGRAPH 1993, with the ozone of Bruneton and Neyret's
//! model; what is scattered more than once is the geometric series of Hillaire, *A Scalable and
//! Production Ready Sky and Atmosphere Rendering Technique*, EGSR 2020. All at 16 wavelengths, with the
//! sun as a black body of 5778 K and Wyman et al.'s fits of the colour-matching functions (JCGT 2013).
//!
//! The sky is computed once as an equirectangular picture, in a space where +y is up and the sun is
//! above -z, and one unit of radiance is 10,000 cd/m^2.

use rayon::prelude::*;

use crate::desc::Triple;

/// Width of the picture; twice its height.
pub(super) const WIDTH: usize = 512;
/// Height of the picture.
pub(super) const HEIGHT: usize = 256;

/// Number of wavelengths.
const N: usize = 16;
/// First wavelength and step, in nanometres.
const FIRST_NM: f64 = 390.0;
const STEP_NM: f64 = 24.0;
/// In metres.
const GROUND: f64 = 6_360e3;
const TOP: f64 = 6_460e3;
const AIR_HEIGHT: f64 = 8_000.0;
const AEROSOL_HEIGHT: f64 = 1_200.0;
/// Ozone is between 10 and 40 km, most at 25.
const OZONE_MIDDLE: f64 = 25e3;
const OZONE_REACH: f64 = 15e3;
/// Height of the eye.
const EYE: f64 = 2.0;
/// Luminance of one unit of radiance, in cd/m^2.
const UNIT: f64 = 10_000.0;
/// Asymmetry of scattering by aerosols.
const G: f64 = 0.76;
/// Share of the light that aerosols scatter, of what they take away.
const AEROSOL_ALBEDO: f64 = 0.9;
const PI: f64 = std::f64::consts::PI;

/// The sun and the sky.
pub(super) struct Sky {
    /// Linear RGB, rows from the top.
    pub(super) pixels: Vec<[f32; 3]>,
    /// Irradiance of the sun itself on a surface that faces it.
    pub(super) sun: Triple,
}

type Spectrum = [f64; N];

/// Per metre, at the ground.
struct Atmosphere {
    air: Spectrum,
    aerosol: Spectrum,
    ozone: Spectrum,
    /// Irradiance above the atmosphere, in W / (m^2 nm).
    sun: Spectrum,
    ground_albedo: f64,
}

/// Column densities, in metres of the density at the ground.
#[derive(Clone, Copy, Default)]
struct Depth {
    air: f64,
    aerosol: f64,
    ozone: f64,
}

/// Light along a ray.
#[derive(Clone, Copy)]
struct Along {
    /// Scattered on the way.
    scattered: Spectrum,
    /// Share that is scattered again if light comes evenly from all around.
    again: Spectrum,
    /// Light of the sun that the ground at its end would reflect if it were white.
    ground: Spectrum,
    hits_ground: bool,
}

impl Sky {
    /// The sky for a sun at this cosine of the angle from the zenith.
    pub(super) fn new(cos_zenith: f64, turbidity: f64, ground_albedo: Triple) -> Self {
        let atmosphere = Atmosphere::new(turbidity, ground_albedo);
        let to_sun = [0.0, cos_zenith, -(1.0 - cos_zenith * cos_zenith).max(0.0).sqrt()];
        let eye = [0.0, GROUND + EYE, 0.0];
        // Twice scattered light depends on the height alone for a sun that stands still.
        let again: Vec<Spectrum> =
            (0..HEIGHTS).into_par_iter().map(|i| atmosphere.multiple(i, to_sun)).collect();
        let half = WIDTH / 2;
        let rows: Vec<Vec<[f32; 3]>> = (0..HEIGHT)
            .into_par_iter()
            .map(|y| {
                let theta = PI * (y as f64 + 0.5) / HEIGHT as f64;
                let pixel = |x: usize| {
                    let phi = 2.0 * PI * ((x as f64 + 0.5) / WIDTH as f64 - 0.5);
                    let (s, c) = (libm::sin(theta), libm::cos(theta));
                    let d = [s * libm::sin(phi), c, -s * libm::cos(phi)];
                    let along = atmosphere.march(eye, d, to_sun, 24, Some(&again));
                    let sky = rgb(&along.scattered);
                    let ground = rgb(&along.ground);
                    std::array::from_fn(|i| (sky[i] + ground[i] * ground_albedo[i]) as f32)
                };
                // The sun is above the middle: the left half mirrors the right one.
                let right: Vec<[f32; 3]> = (half..WIDTH).map(pixel).collect();
                right.iter().rev().chain(&right).copied().collect()
            })
            .collect();
        let mut sun = [0.0; 3];
        if let Some(depth) = depth_to_sun(eye, to_sun) {
            let through = atmosphere.transmittance(&depth);
            sun = rgb(&std::array::from_fn(|i| atmosphere.sun[i] * through[i]));
        }
        Self { pixels: rows.concat(), sun }
    }
}

/// Heights at which multiple scattering is known, evenly in the square root of the height.
const HEIGHTS: usize = 24;

fn height_of(i: usize) -> f64 {
    let x = i as f64 / (HEIGHTS - 1) as f64;
    (TOP - GROUND - 20.0) * x * x + 10.0
}

impl Atmosphere {
    fn new(turbidity: f64, ground_albedo: Triple) -> Self {
        let per_nm = |f: &dyn Fn(f64) -> f64| -> Spectrum {
            std::array::from_fn(|i| f(FIRST_NM + STEP_NM * i as f64))
        };
        let rayleigh = |nm: f64| 1.240_62e-6 * libm::pow(nm / 1000.0, -4.0);
        // Angstrom's law with the coefficient that Preetham et al. give a turbidity (*A Practical Analytic
        // Model for Daylight*, SIGGRAPH 1999, appendix A1).
        let beta = (0.046_08 * turbidity - 0.045_86).max(0.0) / AEROSOL_HEIGHT;
        Self {
            air: per_nm(&rayleigh),
            aerosol: per_nm(&|nm| beta * libm::pow(nm / 1000.0, -1.3)),
            // The Chappuis band, whose cross-section has its maximum of 5.1e-25 m^2 near 603 nm; with
            // 300 Dobson units between 10 and 40 km.
            ozone: per_nm(&|nm| {
                let x = (nm - 603.0) / 60.0;
                5.1e-25 * libm::exp(-0.5 * x * x) * (300.0 * 2.687e20) / OZONE_REACH
            }),
            sun: per_nm(&|nm| {
                let (h, c, k) = (6.626_07e-34, 2.997_92e8, 1.380_65e-23);
                let l = nm * 1e-9;
                let b = 2.0 * h * c * c
                    / (l * l * l * l * l)
                    / (libm::exp(h * c / (l * k * 5778.0)) - 1.0);
                // The sun takes up 6.8e-5 steradians.
                b * 1e-9 * 6.794e-5
            }),
            ground_albedo: luminance(ground_albedo),
        }
    }

    fn transmittance(&self, depth: &Depth) -> Spectrum {
        std::array::from_fn(|i| {
            let taken = self.air[i] * depth.air
                + self.aerosol[i] * depth.aerosol
                + self.ozone[i] * depth.ozone;
            libm::exp(-taken)
        })
    }

    /// Follows a ray to the ground or out of the atmosphere.
    fn march(
        &self,
        o: Triple,
        d: Triple,
        to_sun: Triple,
        n_steps: usize,
        again: Option<&[Spectrum]>,
    ) -> Along {
        let ground = enter(o, d, GROUND);
        let length = ground.unwrap_or_else(|| leave(o, d, TOP));
        let mu = dot(d, to_sun);
        let phase_air = 3.0 / (16.0 * PI) * (1.0 + mu * mu);
        let phase_aerosol = {
            let scale = 3.0 / (8.0 * PI) * (1.0 - G * G) / (2.0 + G * G);
            scale * (1.0 + mu * mu) / libm::pow(1.0 + G * G - 2.0 * G * mu, 1.5)
        };
        let mut along = Along {
            scattered: [0.0; N],
            again: [0.0; N],
            ground: [0.0; N],
            hits_ground: ground.is_some(),
        };
        let mut depth = Depth::default();
        let edge = |i: usize| {
            // Shorter steps near the eye, where the air is dense.
            let x = i as f64 / n_steps as f64;
            length * x * x
        };
        for i in 0..n_steps {
            let (start, end) = (edge(i), edge(i + 1));
            let p = at(o, d, 0.5 * (start + end));
            let dt = end - start;
            let density = density(p);
            let half = Depth {
                air: depth.air + 0.5 * dt * density.air,
                aerosol: depth.aerosol + 0.5 * dt * density.aerosol,
                ozone: depth.ozone + 0.5 * dt * density.ozone,
            };
            depth.air += dt * density.air;
            depth.aerosol += dt * density.aerosol;
            depth.ozone += dt * density.ozone;
            let through = self.transmittance(&half);
            let lit = depth_to_sun(p, to_sun).map(|depth| self.transmittance(&depth));
            let around = again.map(|table| interpolate(table, length_of(p) - GROUND));
            for k in 0..N {
                let by_air = self.air[k] * density.air;
                let by_aerosol = AEROSOL_ALBEDO * self.aerosol[k] * density.aerosol;
                let mut light = 0.0;
                if let Some(lit) = &lit {
                    // Without a table, multiple scattering is being computed, which forgets directions.
                    let phased = match again {
                        Some(_) => by_air * phase_air + by_aerosol * phase_aerosol,
                        None => (by_air + by_aerosol) / (4.0 * PI),
                    };
                    light += phased * self.sun[k] * lit[k];
                }
                if let Some(around) = &around {
                    light += (by_air + by_aerosol) * around[k];
                }
                along.scattered[k] += through[k] * light * dt;
                along.again[k] += through[k] * (by_air + by_aerosol) * dt;
            }
        }
        if ground.is_some() {
            let p = at(o, d, length);
            let cos = (dot(p, to_sun) / length_of(p)).max(0.0);
            // A little above, so that rounding does not put the point into its own shadow.
            let above = p.map(|x| x * (1.0 + 1e-6));
            let through = self.transmittance(&depth);
            let lit = depth_to_sun(above, to_sun).map(|depth| self.transmittance(&depth));
            let around = again.map(|table| interpolate(table, 0.0));
            for k in 0..N {
                let sun = lit.map_or(0.0, |lit| self.sun[k] * lit[k] * cos);
                // Half of all around is sky; the table has the mean of radiance over the sphere.
                let sky = around.map_or(0.0, |around| PI * around[k]);
                along.ground[k] = through[k] * (sun + sky) / PI;
            }
        }
        along
    }

    /// Mean radiance over all directions of light that was scattered more than once, at a height.
    fn multiple(&self, height: usize, to_sun: Triple) -> Spectrum {
        const SIDE: usize = 8;
        let o = [0.0, GROUND + height_of(height), 0.0];
        let (mut twice, mut again) = ([0.0; N], [0.0; N]);
        for i in 0..SIDE {
            for j in 0..2 * SIDE {
                let cos = 1.0 - 2.0 * (i as f64 + 0.5) / SIDE as f64;
                let sin = (1.0 - cos * cos).sqrt();
                let phi = PI * (j as f64 + 0.5) / SIDE as f64;
                let d = [sin * libm::cos(phi), cos, sin * libm::sin(phi)];
                let along = self.march(o, d, to_sun, 16, None);
                for k in 0..N {
                    let ground =
                        if along.hits_ground { self.ground_albedo * along.ground[k] } else { 0.0 };
                    twice[k] += along.scattered[k] + ground;
                    again[k] += along.again[k];
                }
            }
        }
        let n = (2 * SIDE * SIDE) as f64;
        std::array::from_fn(|k| twice[k] / n / (1.0 - (again[k] / n).min(0.99)))
    }
}

/// Densities at a point over those at the ground.
fn density(p: Triple) -> Depth {
    let height = (length_of(p) - GROUND).max(0.0);
    Depth {
        air: libm::exp(-height / AIR_HEIGHT),
        aerosol: libm::exp(-height / AEROSOL_HEIGHT),
        ozone: (1.0 - (height - OZONE_MIDDLE).abs() / OZONE_REACH).max(0.0),
    }
}

/// Densities on the way to the sun; none if the earth is in between.
fn depth_to_sun(p: Triple, to_sun: Triple) -> Option<Depth> {
    const STEPS: usize = 12;
    if enter(p, to_sun, GROUND).is_some() {
        return None;
    }
    let length = leave(p, to_sun, TOP);
    let mut depth = Depth::default();
    for i in 0..STEPS {
        let edge = |i: usize| {
            let x = i as f64 / STEPS as f64;
            length * x * x
        };
        let (start, end) = (edge(i), edge(i + 1));
        let density = density(at(p, to_sun, 0.5 * (start + end)));
        depth.air += (end - start) * density.air;
        depth.aerosol += (end - start) * density.aerosol;
        depth.ozone += (end - start) * density.ozone;
    }
    Some(depth)
}

fn interpolate(table: &[Spectrum], height: f64) -> Spectrum {
    let x = ((height - 10.0) / (TOP - GROUND - 20.0)).clamp(0.0, 1.0).sqrt() * (HEIGHTS - 1) as f64;
    let i = (x as usize).min(HEIGHTS - 2);
    let t = x - i as f64;
    std::array::from_fn(|k| table[i][k] * (1.0 - t) + table[i + 1][k] * t)
}

/// Distance at which a ray from outside of a sphere around the earth's centre enters it.
fn enter(o: Triple, d: Triple, radius: f64) -> Option<f64> {
    let b = dot(o, d);
    let discriminant = b * b - dot(o, o) + radius * radius;
    (discriminant > 0.0).then(|| -b - discriminant.sqrt()).filter(|t| *t > 0.0)
}

/// Distance at which a ray from inside of a sphere leaves it.
fn leave(o: Triple, d: Triple, radius: f64) -> f64 {
    let b = dot(o, d);
    let discriminant = b * b - dot(o, o) + radius * radius;
    (-b + discriminant.max(0.0).sqrt()).max(0.0)
}

fn at(o: Triple, d: Triple, t: f64) -> Triple {
    std::array::from_fn(|i| o[i] + t * d[i])
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length_of(v: Triple) -> f64 {
    dot(v, v).sqrt()
}

fn luminance(c: Triple) -> f64 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

/// Linear sRGB of a spectral radiance in W / (m^2 sr nm), without what the display could not show.
fn rgb(spectrum: &Spectrum) -> Triple {
    let lobe = |nm: f64, mean: f64, below: f64, above: f64| {
        let x = (nm - mean) * if nm < mean { below } else { above };
        libm::exp(-0.5 * x * x)
    };
    let mut xyz = [0.0; 3];
    for (i, value) in spectrum.iter().enumerate() {
        let nm = FIRST_NM + STEP_NM * i as f64;
        let x = 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374)
            - 0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
        let y = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
        let z = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
        for (sum, matching) in xyz.iter_mut().zip([x, y, z]) {
            *sum += 683.0 * STEP_NM * value * matching / UNIT;
        }
    }
    let [x, y, z] = xyz;
    [
        3.240_97 * x - 1.537_383 * y - 0.498_611 * z,
        -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
        0.055_63 * x - 0.203_977 * y + 1.056_972 * z,
    ]
    .map(|c| c.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Irradiance on the ground from the upper half of the picture.
    fn irradiance(sky: &Sky) -> Triple {
        let mut sum = [0.0; 3];
        for (i, pixel) in sky.pixels.iter().enumerate().take(WIDTH * HEIGHT / 2) {
            let theta = PI * ((i / WIDTH) as f64 + 0.5) / HEIGHT as f64;
            let weight = libm::sin(theta)
                * libm::cos(theta)
                * (PI / HEIGHT as f64)
                * (2.0 * PI / WIDTH as f64);
            for (sum, value) in sum.iter_mut().zip(pixel) {
                *sum += weight * f64::from(*value);
            }
        }
        sum
    }

    /// Measured values for clear days: CIE 110-1994 and the tables of the Illuminating Engineering
    /// Society, as lux over the unit.
    #[test]
    fn sun_and_sky_are_as_bright_as_measured() {
        let klux = |c: Triple| luminance(c) * UNIT / 1000.0;
        let high = Sky::new(libm::cos(30.0 * PI / 180.0), 3.0, [0.2; 3]);
        let (sun, sky) = (klux(high.sun), klux(irradiance(&high)));
        assert!((80.0..120.0).contains(&sun), "sun at 60 degrees: {sun} klx");
        assert!((8.0..25.0).contains(&sky), "sky at 60 degrees: {sky} klx");
        let low = Sky::new(libm::cos(85.0 * PI / 180.0), 3.0, [0.2; 3]);
        assert!((2.0..25.0).contains(&klux(low.sun)), "sun at 5 degrees: {} klx", klux(low.sun));
        assert!(low.sun[0] > 1.5 * low.sun[2], "a low sun is red: {:?}", low.sun);
    }

    #[test]
    fn the_zenith_is_blue_and_night_is_dark() {
        let sky = Sky::new(0.7, 2.0, [0.2; 3]);
        let zenith = sky.pixels[0];
        assert!(zenith[2] > 1.5 * zenith[0], "{zenith:?}");
        let horizon = sky.pixels[(HEIGHT / 2 - 1) * WIDTH];
        assert!(luminance(horizon.map(f64::from)) > luminance(zenith.map(f64::from)));
        let night = Sky::new(-0.5, 2.0, [0.2; 3]);
        assert_eq!(night.sun, [0.0; 3]);
        assert!(luminance(irradiance(&night)) < 1e-4 * luminance(irradiance(&sky)));
        // Haze takes light from the sun and gives it to the sky.
        let hazy = Sky::new(0.7, 8.0, [0.2; 3]);
        assert!(luminance(hazy.sun) < 0.8 * luminance(sky.sun));
        assert!(luminance(irradiance(&hazy)) > 1.3 * luminance(irradiance(&sky)));
    }
}
