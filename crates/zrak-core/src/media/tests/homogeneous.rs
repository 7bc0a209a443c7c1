//! Homogeneous media: flights and phase functions.

use crate::math::{Color, vec3};
use crate::media::{HomogeneousMedium, henyey_greenstein};
use crate::testing::{ChiSquared, Rng, cross, dot, double, length, unit};

fn medium(sigma_a: [f32; 3], sigma_s: [f32; 3], g: f32) -> HomogeneousMedium {
    let (sigma_a, sigma_s) = (Color::from_array(sigma_a), Color::from_array(sigma_s));
    HomogeneousMedium { sigma_a, g, sigma_s, _pad: 0 }
}

/// Weights average to the share of light that passes, and to that which is scattered on the way in each of
/// some intervals, channel by channel.
#[test]
fn flights_are_unbiased() {
    let mut rng = Rng::new(1);
    const BINS: usize = 6;
    for (sigma_a, sigma_s) in [
        ([0.1, 0.2, 0.4], [2.0, 1.6, 1.2]),
        ([0.0, 0.0, 0.0], [0.5, 0.5, 0.5]),
        ([1.0, 0.0, 3.0], [0.0, 2.0, 0.5]),
        ([1.0, 0.5, 3.0], [0.0, 0.0, 0.0]),
        ([0.0, 5.0, 0.1], [0.0, 0.3, 8.0]),
    ] {
        let medium = medium(sigma_a, sigma_s, 0.0);
        let t_end = 1.5_f64;
        let n = 200_000;
        let mut sums = [[[0.0_f64; 2]; 3]; BINS + 1];
        for _ in 0..n {
            let flight = medium.sample(t_end as f32, rng.unit_f32(), rng.unit_f32());
            let bin = match flight.collision {
                Some(t) => ((f64::from(t) / t_end * BINS as f64) as usize).min(BINS - 1),
                None => BINS,
            };
            for (sum, w) in sums[bin].iter_mut().zip(flight.weight.to_array()) {
                let w = f64::from(w);
                assert!(w.is_finite() && w >= 0.0);
                *sum = [sum[0] + w, sum[1] + w * w];
            }
        }
        for (bin, sums) in sums.iter().enumerate() {
            for (c, sum) in sums.iter().enumerate() {
                let (a, s) = (f64::from(sigma_a[c]), f64::from(sigma_s[c]));
                let passed = |t: f64| (-(a + s) * t).exp();
                let exact = if bin == BINS {
                    passed(t_end)
                } else if a + s == 0.0 {
                    0.0
                } else {
                    let at = |i: usize| passed(t_end * i as f64 / BINS as f64);
                    s / (a + s) * (at(bin) - at(bin + 1))
                };
                let mean = sum[0] / f64::from(n);
                let error = ((sum[1] / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
                assert!(
                    (mean - exact).abs() < 5.0 * error + 1e-5,
                    "{sigma_a:?} {sigma_s:?}, bin {bin}, channel {c}: {mean} +- {error}, {exact}"
                );
            }
        }
    }
}

#[test]
fn transmittance_falls_exponentially() {
    let medium = medium([0.1, 0.0, 3.0], [0.4, 0.0, 2.0], 0.0);
    for t in [0.0_f32, 0.1, 1.0, 10.0] {
        let got = medium.transmittance(t).to_array().map(f64::from);
        for (got, sigma) in got.into_iter().zip([0.5, 0.0, 5.0]) {
            let exact = (-sigma * f64::from(t)).exp();
            assert!((got - exact).abs() < 2e-6 * exact + 1e-9, "{got} {exact}");
        }
    }
    assert_eq!(medium.transmittance(f32::INFINITY).to_array(), [0.0, 1.0, 0.0]);
}

/// Directions have the density of the phase function, around any axis, and its integral is 1.
#[test]
fn phase_functions_are_sampled_as_they_are() {
    let mut rng = Rng::new(2);
    let (n_bands, n_sectors, n) = (40, 8, 200_000);
    let test = ChiSquared { n_tests: 6 };
    for (g, d) in [
        (0.0_f32, vec3(0.0, 0.0, 1.0)),
        (5e-4, vec3(1.0, 0.0, 0.0)),
        (0.6, rng.direction()),
        (-0.4, rng.direction()),
        (0.9, vec3(0.0, 0.0, -1.0)),
        (-0.95, rng.direction()),
    ] {
        let medium = medium([0.0; 3], [1.0; 3], g);
        let axis = double(d);
        let helper = if axis[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let t = unit(cross(helper, axis));
        let b = cross(axis, t);
        let mut counts = vec![0_u64; n_bands * n_sectors];
        for _ in 0..n {
            let w = double(medium.scatter(d, rng.unit_f32(), rng.unit_f32()));
            assert!((length(w) - 1.0).abs() < 1e-6);
            let band = ((dot(w, axis) * 0.5 + 0.5) * n_bands as f64) as usize;
            let turn = dot(w, b).atan2(dot(w, t)) / std::f64::consts::TAU + 0.5;
            let sector = ((turn * n_sectors as f64) as usize).min(n_sectors - 1);
            counts[band.min(n_bands - 1) * n_sectors + sector] += 1;
        }
        // The density of the cosine, by midpoints.
        const FINE: usize = 2000;
        let mut all = 0.0;
        let mut expected = vec![0.0; n_bands * n_sectors];
        for i in 0..n_bands * FINE {
            let cos = (i as f64 + 0.5) / (n_bands * FINE) as f64 * 2.0 - 1.0;
            let gd = f64::from(g);
            let exact = (1.0 - gd * gd)
                / (4.0 * std::f64::consts::PI * (1.0 + gd * gd - 2.0 * gd * cos).powf(1.5));
            let got = f64::from(henyey_greenstein(g, cos as f32));
            assert!((got / exact - 1.0).abs() < 2e-4, "g {g}, cos {cos}: {got} {exact}");
            let share = exact * std::f64::consts::TAU * 2.0 / (n_bands * FINE) as f64;
            all += share;
            for sector in 0..n_sectors {
                expected[i / FINE * n_sectors + sector] += share * f64::from(n) / n_sectors as f64;
            }
        }
        assert!((all - 1.0).abs() < 1e-4, "g {g}: {all}");
        test.check(&format!("g {g}"), &counts, &expected);
    }
}
