//! How two pictures differ: the numbers behind `zrak compare`.
//!
//! Whether pixels *differ* is decided by their bits, which is zrak's promise for renders; how
//! *much* is measured over all channels of all pixels, in f64 and in one fixed order.

use crate::{Error, ErrorKind, Picture};

/// The difference of two pictures of one size, in linear radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Largest absolute difference of a channel.
    pub max_abs: f64,
    /// Mean absolute difference over all channels.
    pub mean_abs: f64,
    /// Square root of the mean squared difference over all channels.
    pub rmse: f64,
    /// Peak signal-to-noise ratio for a peak of 1.0, in decibels; infinite when `rmse` is zero.
    pub psnr_db: f64,
    /// Pixels with a channel that differs in any bit.
    pub n_differing_pixels: u64,
    /// Pixels in all.
    pub n_pixels: u64,
    /// Column and row of the first differing pixel, going right and then down.
    pub first_difference: Option<(u32, u32)>,
}

/// Compares two pictures of the same size.
///
/// Channels whose bits are equal count as no difference, also when both are infinite or NaN. A
/// NaN against anything else makes `max_abs`, `mean_abs` and `rmse` NaN: it is never hidden.
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison, Error> {
    a.validate()?;
    b.validate()?;
    if (a.width, a.height) != (b.width, b.height) {
        return Err(Error::new(
            ErrorKind::SizeMismatch,
            format!(
                "cannot compare a picture of {}x{} pixels with one of {}x{}; \
                 render both at one size",
                a.width, a.height, b.width, b.height
            ),
        ));
    }

    let mut max_abs = 0.0f64;
    let mut sum_abs = 0.0f64;
    let mut sum_squared = 0.0f64;
    let mut n_differing_pixels = 0;
    let mut first_difference = None;
    for (pixel_idx, (a_pixel, b_pixel)) in a.pixels.iter().zip(&b.pixels).enumerate() {
        if a_pixel.map(f32::to_bits) == b_pixel.map(f32::to_bits) {
            continue;
        }
        n_differing_pixels += 1;
        first_difference.get_or_insert_with(|| {
            let width = a.width as usize;
            ((pixel_idx % width) as u32, (pixel_idx / width) as u32)
        });
        for (&a_value, &b_value) in a_pixel.iter().zip(b_pixel) {
            if a_value.to_bits() == b_value.to_bits() {
                continue;
            }
            let abs = (f64::from(a_value) - f64::from(b_value)).abs();
            // Unlike f64::max, this keeps a NaN once there is one.
            if abs > max_abs || abs.is_nan() {
                max_abs = abs;
            }
            sum_abs += abs;
            sum_squared += abs * abs;
        }
    }

    let n_pixels = a.pixels.len() as u64;
    let n_values = 3.0 * n_pixels as f64;
    let rmse = (sum_squared / n_values).sqrt();
    Ok(Comparison {
        max_abs,
        mean_abs: sum_abs / n_values,
        rmse,
        psnr_db: if rmse == 0.0 { f64::INFINITY } else { -20.0 * libm::log10(rmse) },
        n_differing_pixels,
        n_pixels,
        first_difference,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, height: u32, value: f32) -> Picture {
        Picture { width, height, pixels: vec![[value; 3]; (width * height) as usize] }
    }

    #[test]
    fn equal_pictures_have_no_difference() {
        for value in [0.5, f32::NAN, f32::INFINITY] {
            let a = picture(3, 2, value);
            assert_eq!(
                compare(&a, &a).unwrap(),
                Comparison {
                    max_abs: 0.0,
                    mean_abs: 0.0,
                    rmse: 0.0,
                    psnr_db: f64::INFINITY,
                    n_differing_pixels: 0,
                    n_pixels: 6,
                    first_difference: None,
                }
            );
        }
    }

    #[test]
    fn differences_are_measured_over_all_channels() {
        let a = picture(4, 3, 1.0);
        let mut b = a.clone();
        b.pixels[6] = [1.0, 1.5, 1.0];
        b.pixels[11] = [1.0, 1.0, -1.0];
        let c = compare(&a, &b).unwrap();
        assert_eq!(c.max_abs, 2.0);
        assert_eq!(c.mean_abs, 2.5 / 36.0);
        assert_eq!(c.rmse, (4.25f64 / 36.0).sqrt());
        assert!((c.psnr_db - 10.0 * (36.0f64 / 4.25).log10()).abs() < 1e-12);
        assert_eq!((c.n_differing_pixels, c.n_pixels), (2, 12));
        assert_eq!(c.first_difference, Some((2, 1)));
    }

    #[test]
    fn bits_decide_what_differs() {
        let c = compare(&picture(1, 1, 0.0), &picture(1, 1, -0.0)).unwrap();
        assert_eq!((c.n_differing_pixels, c.max_abs, c.psnr_db), (1, 0.0, f64::INFINITY));
    }

    #[test]
    fn nan_is_never_hidden() {
        let a = picture(2, 1, 0.0);
        let mut b = a.clone();
        b.pixels[0][1] = f32::NAN;
        b.pixels[1][1] = 9.0;
        let c = compare(&a, &b).unwrap();
        assert!(c.max_abs.is_nan() && c.mean_abs.is_nan() && c.rmse.is_nan());
    }

    #[test]
    fn different_sizes_are_an_error_naming_both() {
        let error = compare(&picture(4, 3, 0.0), &picture(3, 4, 0.0)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::SizeMismatch);
        assert!(error.to_string().contains("4x3") && error.to_string().contains("3x4"));
    }

    #[test]
    fn a_picture_with_missing_pixels_is_an_error() {
        let mut a = picture(4, 3, 0.0);
        a.pixels.pop();
        let error = compare(&a, &picture(4, 3, 0.0)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
}
