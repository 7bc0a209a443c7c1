//! The exponential function against `f64`.

use crate::math::exp;
use crate::testing::Rng;

#[test]
fn exp_is_right_to_two_units_in_the_last_place() {
    let mut rng = Rng::new(1);
    for _ in 0..1_000_000 {
        let x = rng.range(-87.2, 88.6) as f32;
        let exact = f64::from(x).exp();
        let error = (f64::from(exp(x)) / exact - 1.0).abs() * f64::from(1_u32 << 24);
        assert!(error < 2.0, "{x}: {error}");
    }
    for (x, e) in [(0.0, 1.0), (-100.0, 0.0), (f32::NEG_INFINITY, 0.0), (100.0, f32::INFINITY)] {
        assert_eq!(exp(x), e);
    }
}
