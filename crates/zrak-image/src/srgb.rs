//! The sRGB transfer function (IEC 61966-2-1), the same to the last bit on every platform.
//!
//! std's `powf` is the platform's and differs between them, so the curve is computed in f64 by
//! the `libm` crate, which is plain arithmetic. Decoding 8 bits is one table of 256. Encoding
//! to 8 bits counts how many of 255 thresholds a value has reached, which is exact, monotone by
//! construction and as fast as the table's binary search.

use std::sync::LazyLock;

/// Linear values of the 256 sRGB codes: what a renderer puts its 8-bit textures through.
pub fn srgb8_to_linear_table() -> [f32; 256] {
    std::array::from_fn(|code| decode(code as f64 / 255.0) as f32)
}

/// The sRGB code nearest to a linear value, which is clamped to [0, 1]; NaN gives 0.
///
/// "Nearest" is measured along the curve, as everywhere: code c stands for values whose encoded
/// form lies within [c - 1/2, c + 1/2) / 255.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    static ENCODER: LazyLock<Encoder8> = LazyLock::new(|| Encoder8::new(decode));
    ENCODER.encode(linear)
}

/// Linear value of a code of a 16-bit sRGB image.
#[must_use]
pub fn srgb16_to_linear(code: u16) -> f32 {
    static TABLE: LazyLock<Vec<f32>> = LazyLock::new(|| {
        (0..=u16::MAX).map(|code| decode(f64::from(code) / 65535.0) as f32).collect()
    });
    TABLE[usize::from(code)]
}

/// The gamma-2 code nearest to a linear value: the transfer of "Ray Tracing in One Weekend".
pub(crate) fn linear_to_gamma2(linear: f32) -> u8 {
    static ENCODER: LazyLock<Encoder8> = LazyLock::new(|| Encoder8::new(|v| v * v));
    ENCODER.encode(linear)
}

/// Linear value of an encoded one, both in [0, 1].
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Encoder to 8 bits: the linear values at which the code rises by one.
struct Encoder8([f64; 255]);

impl Encoder8 {
    /// An encoder for the monotone curve that `decode` inverts.
    fn new(decode: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|code| decode((code as f64 + 0.5) / 255.0)))
    }

    fn encode(&self, linear: f32) -> u8 {
        // NaN has reached no threshold.
        self.0.partition_point(|&threshold| threshold <= f64::from(linear)) as u8
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn all_codes_survive_a_round_trip() {
        let table = srgb8_to_linear_table();
        for code in 0..=255u8 {
            let linear = table[usize::from(code)];
            assert_eq!(linear_to_srgb8(linear), code);
            assert_eq!(srgb16_to_linear(u16::from(code) * 257), linear);
            assert_eq!(linear_to_gamma2((f32::from(code) / 255.0).powi(2)), code);
        }
    }

    #[test]
    fn table_is_monotone_and_spans_the_unit_interval() {
        let table = srgb8_to_linear_table();
        assert_eq!((table[0], table[255]), (0.0, 1.0));
        assert!(table.is_sorted_by(|a, b| a < b));
    }

    #[test]
    fn table_is_the_same_on_every_platform() {
        let table = srgb8_to_linear_table();
        // Values of the standard's formula, rounded to f32.
        assert_eq!(table[1], (1.0f64 / 255.0 / 12.92) as f32);
        assert_eq!(table[128], 0.215_860_5);
        // The whole table. The hash is that of the formula in 50 decimal digits, rounded to f32.
        let bits = table.iter().flat_map(|v| v.to_bits().to_le_bytes());
        let hash = bits.fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        });
        assert_eq!(hash, 0x63e3_d178_534f_47ca, "{hash:#x}");
    }

    #[test]
    fn out_of_range_values_are_clamped() {
        for (linear, code) in [
            (f32::NAN, 0),
            (f32::NEG_INFINITY, 0),
            (-1.0, 0),
            (-0.0, 0),
            (1.0, 255),
            (2.0, 255),
            (f32::INFINITY, 255),
        ] {
            assert_eq!(linear_to_srgb8(linear), code, "{linear}");
            assert_eq!(linear_to_gamma2(linear), code, "{linear}");
        }
    }

    proptest! {
        #[test]
        fn encoding_is_monotone(a in -0.5f32..1.5, b in -0.5f32..1.5) {
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            prop_assert!(linear_to_srgb8(low) <= linear_to_srgb8(high));
            prop_assert!(linear_to_gamma2(low) <= linear_to_gamma2(high));
        }

        #[test]
        fn encoding_is_the_rounded_formula(linear in 0.0f64..1.0) {
            let linear = linear as f32;
            let v = f64::from(linear);
            let encoded = if v <= 0.0031308 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
            // The two may only part company where the formula is at a half.
            let exact = encoded * 255.0;
            let code = f64::from(linear_to_srgb8(linear));
            prop_assert!((code - exact).abs() <= 0.5 + 1e-4, "{code} for {exact}");
        }
    }
}
