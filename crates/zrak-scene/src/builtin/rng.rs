//! The generator that places things in the built-in scenes.
//!
//! SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA
//! 2014): 64 bits of state, integer arithmetic only, so a scene is the same on every platform. It
//! has nothing to do with the random numbers of rendering.

/// SplitMix64.
pub(super) struct Rng {
    state: u64,
}

impl Rng {
    /// A generator whose stream is chosen by `seed`.
    pub(super) fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), of 53 bits.
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform in [low, high).
    pub(super) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Three numbers, each uniform in [low, high).
    pub(super) fn triple(&mut self, low: f64, high: f64) -> [f64; 3] {
        [self.range(low, high), self.range(low, high), self.range(low, high)]
    }
}

#[cfg(test)]
mod tests {
    use super::Rng;

    #[test]
    fn matches_the_published_stream() {
        // The values of Vigna's splitmix64.c for seed 1234567.
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        let mut rng = Rng::new(1_234_567);
        assert_eq!(expected.map(|_| rng.bits()), expected);
    }

    #[test]
    fn stays_in_range_and_has_the_right_mean() {
        let mut rng = Rng::new(7);
        let n = 100_000;
        let mut sum = 0.0;
        for _ in 0..n {
            let x = rng.range(2.0, 4.0);
            assert!((2.0..4.0).contains(&x));
            sum += x;
        }
        // The standard error of the mean is (4 - 2) / sqrt(12 n).
        assert!((sum / f64::from(n) - 3.0).abs() < 5.0 * 2.0 / (12.0 * f64::from(n)).sqrt());
    }
}
