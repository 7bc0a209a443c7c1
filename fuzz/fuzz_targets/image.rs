//! Any bytes are an image or an error, in every format; an image has the texels that it says.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{init_with_exr, show};
use zrak_image::{Limits, Texels, decode_texture};

/// Enough for every seed, and little enough that one input cannot take long.
const LIMITS: Limits = Limits { max_width: 2048, max_height: 2048, max_bytes: 4 << 20 };

fuzz_target!(init: init_with_exr(), |bytes: &[u8]| {
    let image = match decode_texture(bytes, Path::new("fuzz"), &LIMITS) {
        Ok(image) => image,
        Err(error) => return show(|| error.to_string()),
    };
    let n_texels = match &image.texels {
        Texels::Srgb8(texels) => texels.len(),
        Texels::Srgb16(texels) => texels.len(),
        Texels::Linear(texels) => {
            assert!(texels.iter().flatten().all(|x| x.is_finite() && *x >= 0.0));
            texels.len()
        }
    };
    assert_eq!(n_texels, image.width as usize * image.height as usize);
    assert!(image.width <= LIMITS.max_width && image.height <= LIMITS.max_height && n_texels > 0);
});
