//! The sampler's numbers are uniform, and those of different dimensions, samples, pixels, bounces,
//! media and seeds are independent: pairs of them fill the square evenly.

use super::{BounceDim, CameraDim, Sampler};
use crate::testing::ChiSquared;

const CAMERA_DIMS: [CameraDim; 5] =
    [CameraDim::PixelX, CameraDim::PixelY, CameraDim::LensU, CameraDim::LensV, CameraDim::Time];
const BOUNCE_DIMS: [BounceDim; 3] = [BounceDim::DirectionU, BounceDim::DirectionV, BounceDim::Lobe];

/// What a draw is for.
#[derive(Clone, Copy)]
enum Draw {
    Camera(CameraDim),
    Bounce(u32, BounceDim),
    Flight(u32, u32),
}

fn draw(mut sampler: Sampler, what: Draw) -> f32 {
    let skip = |sampler: &mut Sampler, bounce| (0..bounce).for_each(|_| sampler.next_bounce());
    let x = match what {
        Draw::Camera(dim) => sampler.camera(dim),
        Draw::Bounce(bounce, dim) => {
            skip(&mut sampler, bounce);
            sampler.at_bounce(dim)
        }
        Draw::Flight(bounce, medium) => {
            skip(&mut sampler, bounce);
            sampler.free_flight(medium)
        }
    };
    assert!((0.0..1.0).contains(&x));
    x
}

fn all_draws() -> Vec<Draw> {
    let mut all: Vec<Draw> = CAMERA_DIMS.map(Draw::Camera).to_vec();
    for bounce in [0, 1, 2, 49, 5000] {
        all.extend(BOUNCE_DIMS.map(|dim| Draw::Bounce(bounce, dim)));
        all.extend([0, 1, 2, 1000].map(|medium| Draw::Flight(bounce, medium)));
    }
    all
}

/// The sampler of number `i` of a little render: neighbouring pixels, and all their samples.
fn nth(i: u32) -> Sampler {
    Sampler::new(7, i % 20, i / 20 % 20, i / 400)
}

#[test]
fn every_dimension_is_uniform() {
    let draws = all_draws();
    let test = ChiSquared { n_tests: draws.len() as u32 };
    for (i, &what) in draws.iter().enumerate() {
        let mut counts = [0_u64; 512];
        for k in 0..40_000 {
            counts[(draw(nth(k), what) * 512.0) as usize] += 1;
        }
        test.check_uniform(&format!("draw {i}"), &counts);
    }
}

/// Whether pairs are spread evenly over 24 x 24 cells.
fn check_pairs(test: &ChiSquared, name: &str, pairs: impl Iterator<Item = (f32, f32)>) {
    let mut counts = vec![0_u64; 24 * 24];
    for (a, b) in pairs {
        counts[(a * 24.0) as usize * 24 + (b * 24.0) as usize] += 1;
    }
    test.check_uniform(name, &counts);
}

#[test]
fn dimensions_are_independent_of_each_other() {
    let draws = all_draws();
    let n = draws.len() as u32;
    let test = ChiSquared { n_tests: n * (n - 1) / 2 };
    let values: Vec<Vec<f32>> =
        draws.iter().map(|&what| (0..20_000).map(|k| draw(nth(k), what)).collect()).collect();
    for (i, a) in values.iter().enumerate() {
        for (j, b) in values.iter().enumerate().skip(i + 1) {
            let pairs = a.iter().copied().zip(b.iter().copied());
            check_pairs(&test, &format!("draws {i} and {j}"), pairs);
        }
    }
}

#[test]
fn samples_pixels_and_seeds_are_independent_of_each_other() {
    type Neighbour = (&'static str, fn(u32) -> (Sampler, Sampler));
    let neighbours: [Neighbour; 9] = [
        ("next sample", |i| (Sampler::new(0, 3, 4, i), Sampler::new(0, 3, 4, i + 1))),
        ("sample 2^16 on", |i| (Sampler::new(0, 3, 4, i), Sampler::new(0, 3, 4, i + (1 << 16)))),
        ("pixel to the right", |i| {
            let (x, y) = (i % 200, i / 200);
            (Sampler::new(0, x, y, 0), Sampler::new(0, x + 1, y, 0))
        }),
        ("pixel below", |i| {
            let (x, y) = (i % 200, i / 200);
            (Sampler::new(0, x, y, 5), Sampler::new(0, x, y + 1, 5))
        }),
        ("pixel and its mirror image", |i| {
            let (x, y) = (i % 200, 300 + i / 200);
            (Sampler::new(0, x, y, 0), Sampler::new(0, y, x, 0))
        }),
        ("sample and pixel exchanged", |i| {
            let (x, s) = (i % 200, 300 + i / 200);
            (Sampler::new(0, x, 0, s), Sampler::new(0, s, 0, x))
        }),
        ("next seed", |i| {
            (Sampler::new(u64::from(i), 3, 4, 0), Sampler::new(u64::from(i) + 1, 3, 4, 0))
        }),
        ("upper half of the seed", |i| {
            let seed = u64::from(i);
            (Sampler::new(seed, 3, 4, 0), Sampler::new(seed | 1 << 32, 3, 4, 0))
        }),
        ("seed and sample exchanged", |i| {
            let (a, b) = (i % 200, 300 + i / 200);
            (Sampler::new(u64::from(a), 1, 1, b), Sampler::new(u64::from(b), 1, 1, a))
        }),
    ];
    let draws = [
        Draw::Camera(CameraDim::PixelX),
        Draw::Bounce(0, BounceDim::DirectionU),
        Draw::Bounce(3, BounceDim::Lobe),
        Draw::Flight(0, 0),
    ];
    let test = ChiSquared { n_tests: neighbours.len() as u32 * draws.len() as u32 };
    for (name, pair) in neighbours {
        for (i, &what) in draws.iter().enumerate() {
            let pairs = (0..40_000).map(|k| {
                let (a, b) = pair(k);
                (draw(a, what), draw(b, what))
            });
            check_pairs(&test, &format!("{name}, draw {i}"), pairs);
        }
    }
}

#[test]
fn streams_do_not_repeat_each_other() {
    // Two samplers of one render draw the same number twice no more often than chance lets them.
    let mut seen = std::collections::HashSet::new();
    let mut n_equal = 0;
    for i in 0..100_000 {
        let sampler = nth(i);
        let word = CAMERA_DIMS.map(|dim| sampler.camera(dim).to_bits());
        n_equal += u32::from(!seen.insert(word));
    }
    assert_eq!(n_equal, 0);
}

#[test]
fn draws_are_pure_functions_of_their_keys() {
    let mut a = Sampler::new(1 << 40, 65_535, 65_535, u32::MAX);
    let first = a.at_bounce(BounceDim::Lobe);
    assert_eq!(first, a.at_bounce(BounceDim::Lobe));
    a.next_bounce();
    assert_ne!(first, a.at_bounce(BounceDim::Lobe));
    assert_eq!(first, Sampler::new(1 << 40, 65_535, 65_535, u32::MAX).at_bounce(BounceDim::Lobe));
    // Pixels of the largest picture have samplers of their own.
    let mut seen = std::collections::HashSet::new();
    for x in [0, 1, 65_534, 65_535] {
        for y in [0, 1, 65_534, 65_535] {
            assert!(seen.insert(Sampler::new(0, x, y, 0).key));
        }
    }
}
