//! What the tests share: random numbers, statistics, vectors in `f64`, and scenes of a few records.

use crate::accel::{Accel, BruteForce, Node};
use crate::accessor::Array;
use crate::camera::Camera;
use crate::interaction::Hit;
use crate::math::{Affine, Color, Vec3, vec3};
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::{
    Background, Globals, MaterialKind, MaterialRef, PrimKind, PrimRef, SceneView, TextureRef,
};
use crate::shapes::{Instance, NO_MOTION, Placement, Quad, primitive_bounds};
use crate::textures::ColorInput;

/// Random numbers for tests: independent of the code under test. SplitMix64.
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: u32) -> u32 {
        (self.bits() % u64::from(n)) as u32
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// In [0, 1), with few bits, as the sampler's numbers are.
    pub(crate) fn unit_f32(&mut self) -> f32 {
        (self.bits() >> 40) as f32 * (1.0 / (1_u32 << 24) as f32)
    }

    pub(crate) fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Uniform in the exponent.
    pub(crate) fn log_range(&mut self, lo: f64, hi: f64) -> f64 {
        self.range(lo.ln(), hi.ln()).exp()
    }

    pub(crate) fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    /// Uniform in the cube of side 2 `size` around the origin.
    pub(crate) fn in_cube(&mut self, size: f64) -> Vec3 {
        vec3(
            self.range(-size, size) as f32,
            self.range(-size, size) as f32,
            self.range(-size, size) as f32,
        )
    }

    /// Unit vector, uniform; now and then along an axis or in a plane of two.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let mut v = [self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0)];
            let length = length(v);
            if !(0.01..=1.0).contains(&length) {
                continue;
            }
            if self.chance(0.05) {
                v[self.below(3) as usize] = 0.0;
            }
            if self.chance(0.02) {
                v[self.below(3) as usize] = 0.0;
            }
            if v != [0.0; 3] {
                return single(scaled(v, 1.0 / self::length(v)));
            }
        }
    }
}

/// Point or direction in `f64`.
pub(crate) type D3 = [f64; 3];

pub(crate) fn double(v: Vec3) -> D3 {
    v.to_array().map(f64::from)
}

pub(crate) fn single(v: D3) -> Vec3 {
    Vec3::from_array(v.map(|x| x as f32))
}

pub(crate) fn add(a: D3, b: D3) -> D3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: D3, b: D3) -> D3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scaled(v: D3, s: f64) -> D3 {
    v.map(|x| x * s)
}

pub(crate) fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: D3, b: D3) -> D3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(v: D3) -> f64 {
    dot(v, v).sqrt()
}

pub(crate) fn unit(v: D3) -> D3 {
    scaled(v, 1.0 / length(v))
}

/// Ray along the direction from `o` to `to`, of unit length.
pub(crate) fn ray_to(o: Vec3, to: Vec3) -> Ray {
    Ray { o, d: single(unit(sub(double(to), double(o)))), time: 0.0 }
}

/// Natural logarithm of the gamma function. Lanczos' approximation, relative error below 1e-14.
fn ln_gamma(x: f64) -> f64 {
    const C: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    let x = x - 1.0;
    let t = x + 7.5;
    let sum = (1..9).fold(C[0], |sum, i| sum + C[i] / (x + i as f64));
    0.5 * (2.0 * std::f64::consts::PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

/// Regularised upper incomplete gamma function Q(a, x), by its series or its continued fraction.
pub(crate) fn upper_gamma(a: f64, x: f64) -> f64 {
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x <= 0.0 {
        1.0
    } else if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for n in 1..100_000 {
            term *= x / (a + f64::from(n));
            sum += term;
            if term < sum * 1e-16 {
                break;
            }
        }
        1.0 - front * sum
    } else {
        // Lentz's method.
        let mut b = x + 1.0 - a;
        let (mut c, mut d) = (1e300, 1.0 / b);
        let mut h = d;
        for n in 1..100_000 {
            let an = -f64::from(n) * (f64::from(n) - a);
            b += 2.0;
            d = 1.0 / (an * d + b);
            c = b + an / c;
            h *= d * c;
            if (d * c - 1.0).abs() < 1e-16 {
                break;
            }
        }
        front * h
    }
}

/// Chance that counts as far from the expected ones as these, or farther, come about by chance:
/// Pearson's chi-squared test. Bins with less than 5 expected are taken together.
pub(crate) fn chi_squared_p(counts: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(counts.len(), expected.len());
    let (mut statistic, mut n_bins) = (0.0, 0);
    let (mut rest, mut rest_expected) = (0.0, 0.0);
    for (&count, &expected) in counts.iter().zip(expected) {
        if expected < 5.0 {
            rest += count as f64;
            rest_expected += expected;
        } else {
            statistic += (count as f64 - expected).powi(2) / expected;
            n_bins += 1;
        }
    }
    if rest_expected >= 5.0 {
        statistic += (rest - rest_expected).powi(2) / rest_expected;
        n_bins += 1;
    } else if rest_expected > 0.0 {
        // Too few to say much, but many counts where none should be are wrong.
        assert!(rest < 30.0, "{rest} where {rest_expected} are expected");
    } else {
        assert!(rest == 0.0, "{rest} where none can be");
    }
    upper_gamma(f64::from(n_bins - 1) * 0.5, statistic * 0.5)
}

/// A family of chi-squared tests with a joint chance of one in a thousand to reject what is right
/// (Bonferroni). The numbers are always the same ones, so what passes once passes forever.
pub(crate) struct ChiSquared {
    pub(crate) n_tests: u32,
}

impl ChiSquared {
    const SIGNIFICANCE: f64 = 1e-3;

    pub(crate) fn accepts(&self, counts: &[u64], expected: &[f64]) -> bool {
        chi_squared_p(counts, expected) >= Self::SIGNIFICANCE / f64::from(self.n_tests)
    }

    pub(crate) fn check(&self, what: &str, counts: &[u64], expected: &[f64]) {
        let p = chi_squared_p(counts, expected);
        assert!(p >= Self::SIGNIFICANCE / f64::from(self.n_tests), "{what}: p = {p:e}");
    }

    /// All bins alike.
    pub(crate) fn check_uniform(&self, what: &str, counts: &[u64]) {
        let n: u64 = counts.iter().sum();
        let expected = vec![n as f64 / counts.len() as f64; counts.len()];
        self.check(what, counts, &expected);
    }
}

/// Largest difference between the distribution of `samples` and `cdf`, times sqrt(n): Kolmogorov's
/// statistic. Above 1.95 in one of a thousand cases, above 2.5 in one of 130,000.
pub(crate) fn kolmogorov(samples: &mut [f64], cdf: impl Fn(f64) -> f64) -> f64 {
    samples.sort_by(f64::total_cmp);
    let n = samples.len() as f64;
    let distance = samples.iter().enumerate().fold(0.0, |largest: f64, (i, &x)| {
        let c = cdf(x);
        largest.max(c - i as f64 / n).max((i + 1) as f64 / n - c)
    });
    distance * n.sqrt()
}

macro_rules! define_test_scene {
    ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
        /// The arrays of a scene, filled by hand.
        #[derive(Default)]
        pub(crate) struct TestScene {
            $(pub(crate) $name: Vec<$record>,)*
        }

        impl TestScene {
            pub(crate) fn view_with(&self, globals: Globals) -> SceneView<'_> {
                SceneView { globals, kinds: crate::scene::Kinds::ALL, $($name: Array::new(&self.$name),)* }
            }
        }
    };
}

crate::for_each_scene_array!(define_test_scene);

/// Camera at the origin that looks down -z, 90 degrees high, with an open shutter.
pub(crate) fn camera(width: u32, height: u32) -> Camera {
    Camera {
        origin: Vec3::ZERO,
        shutter_open_s: 0.0,
        corner: vec3(-1.0, 1.0, -1.0),
        shutter_close_s: 1.0,
        pixel_dx: vec3(2.0 / width as f32, 0.0, 0.0),
        width,
        pixel_dy: vec3(0.0, -2.0 / height as f32, 0.0),
        height,
        lens_u: Vec3::ZERO,
        has_lens: 0,
        lens_v: Vec3::ZERO,
        spread: 0.0,
        forward: vec3(0.0, 0.0, -1.0),
        projection: crate::camera::PROJECTION_PERSPECTIVE,
    }
}

pub(crate) fn globals() -> Globals {
    Globals {
        camera: camera(1, 1),
        background: Background { bottom: Color::WHITE, top: Color::WHITE },
        max_depth: 1000,
        seed_lo: 0,
        seed_hi: 0,
        camera_medium: crate::media::VACUUM,
        rr_depth: u32::MAX,
        _pad: 0,
    }
}

impl TestScene {
    /// Places a primitive under a map, given with its inverse.
    pub(crate) fn place(&mut self, target: PrimRef, map: Affine, back: Affine) -> PrimRef {
        let bounds = primitive_bounds(&self.view(), target, [0.0, 1.0]);
        let mut node = Node::<2>::EMPTY;
        for axis in 0..3 {
            node.lo[axis][0] = bounds.lo.to_array()[axis];
            node.hi[axis][0] = bounds.hi.to_array()[axis];
        }
        node.children[0] = target;
        self.nodes2.push(node);
        self.instances.push(Instance {
            placement: Placement { world_from_object: map, object_from_world: back },
            root2: self.nodes2.len() as u32 - 1,
            root8: 0,
            motion: NO_MOTION,
            _pad: 0,
        });
        prim(PrimKind::Instance, self.instances.len() - 1)
    }

    pub(crate) fn view(&self) -> SceneView<'_> {
        self.view_with(globals())
    }
}

/// Where a ray hits one primitive or instance.
pub(crate) fn hit_of(scene: &SceneView, prim: PrimRef, ray: &Ray) -> Option<Hit> {
    let sampler = Sampler::new(0, 0, 0, 0);
    let prims = [prim];
    let all = BruteForce { prims: Array::new(&prims) };
    all.closest_hit(scene, ray, &sampler, f32::INFINITY)
}

/// Input of one colour.
pub(crate) fn solid(color: Color) -> ColorInput {
    ColorInput { solid: color, texture: TextureRef::default() }
}

/// A material for shapes whose material does not matter.
pub(crate) const ANY_MATERIAL: MaterialRef = MaterialRef::new(MaterialKind::Lambertian, 0);

pub(crate) const fn prim(kind: PrimKind, index: usize) -> PrimRef {
    PrimRef::new(kind, index as u32)
}

pub(crate) fn quad(corner: Vec3, u: Vec3, v: Vec3) -> Quad {
    Quad::new(corner, u, v, ANY_MATERIAL)
}

#[test]
fn incomplete_gamma_has_known_values() {
    // Q(1, x) = exp(-x); Q(1/2, x) = erfc(sqrt(x)), erfc(1) = 0.157299207050285...
    for x in [0.01, 0.5, 1.0, 3.0, 20.0_f64] {
        assert!((upper_gamma(1.0, x) - (-x).exp()).abs() < 1e-13);
    }
    assert!((upper_gamma(0.5, 1.0) - 0.157_299_207_050_285).abs() < 1e-13);
    // The 95% quantile of chi-squared with 10 degrees of freedom is 18.307.
    assert!((upper_gamma(5.0, 18.307 / 2.0) - 0.05).abs() < 1e-5);
    assert!((upper_gamma(500.0, 500.0) - 0.494_053).abs() < 1e-5);
}

#[test]
fn chi_squared_accepts_what_is_right_and_rejects_what_is_wrong() {
    let mut rng = Rng::new(1);
    let test = ChiSquared { n_tests: 1 };
    let n = 100_000;
    let mut fair = [0_u64; 50];
    let mut skewed = [0_u64; 50];
    for _ in 0..n {
        fair[(rng.unit() * 50.0) as usize] += 1;
        // Density 0.95 + 0.1 x.
        let x = loop {
            let x = rng.unit();
            if rng.unit() * 1.05 < 0.95 + 0.1 * x {
                break x;
            }
        };
        skewed[(x * 50.0) as usize] += 1;
    }
    let expected = [f64::from(n) / 50.0; 50];
    assert!(test.accepts(&fair, &expected));
    assert!(!test.accepts(&skewed, &expected));
    // And p-values of what is right are uniform.
    let mut below_tenth = 0;
    for _ in 0..1000 {
        let mut counts = [0_u64; 20];
        (0..2000).for_each(|_| counts[rng.below(20) as usize] += 1);
        below_tenth += u32::from(chi_squared_p(&counts, &[100.0; 20]) < 0.1);
    }
    assert!((60..140).contains(&below_tenth), "{below_tenth} of 1000");
}

#[test]
fn kolmogorov_accepts_what_is_right_and_rejects_what_is_wrong() {
    let mut rng = Rng::new(2);
    let mut samples: Vec<f64> = (0..100_000).map(|_| rng.unit()).collect();
    assert!(kolmogorov(&mut samples, |x| x) < 2.0);
    assert!(kolmogorov(&mut samples, |x| x.powf(1.05)) > 3.0);
}
