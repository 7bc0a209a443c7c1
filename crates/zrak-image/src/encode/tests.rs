//! What the encoders promise about their bytes; round trips are in `decode/tests.rs`.

use super::*;
use crate::ErrorKind;

fn picture() -> Picture {
    let pixels = (0..37 * 41).map(|i| [i as f32 / 1500.0, (i % 37) as f32 / 37.0, 0.25]).collect();
    Picture { width: 37, height: 41, pixels }
}

fn metadata() -> Metadata {
    Metadata {
        scene: "scenes/cornell.toml".into(),
        seed: u64::MAX,
        samples_per_pixel: 512,
        backend: "cpu".into(),
        device: "Xeon\u{ae} 8 \u{6838}\nsecond line".into(),
        version: "0.1.0".into(),
        render_time_s: 12.625,
    }
}

const FORMATS: [Format; 5] = [Format::Png, Format::Jpeg, Format::Hdr, Format::Exr, Format::Pfm];

#[test]
fn the_same_picture_gives_the_same_bytes() {
    for format in FORMATS {
        let encode = || encode(format, &picture(), Some(&metadata()), Transfer::Srgb).unwrap();
        assert_eq!(encode(), encode(), "{format:?}");
    }
}

#[test]
fn signatures_are_recognised() {
    for format in FORMATS {
        let bytes = encode(format, &picture(), None, Transfer::Srgb).unwrap();
        assert_eq!(Format::sniff(&bytes), Some(format));
    }
}

#[test]
fn values_that_a_format_has_not_are_no_panic() {
    let values = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, f32::MAX, f32::MIN_POSITIVE];
    let pixels = values.iter().flat_map(|&a| values.map(|b| [a, b, 1.0])).collect();
    let picture = Picture { width: 9, height: 4, pixels };
    for format in FORMATS {
        for transfer in [Transfer::Srgb, Transfer::Gamma2] {
            encode(format, &picture, None, transfer).unwrap();
        }
    }
}

#[test]
fn a_picture_without_its_pixels_is_an_error() {
    for (width, height, n_pixels) in [(0, 0, 0), (2, 2, 3), (0, 4, 0), (u32::MAX, u32::MAX, 1)] {
        let picture = Picture { width, height, pixels: vec![[0.0; 3]; n_pixels] };
        for format in FORMATS {
            let error = encode(format, &picture, None, Transfer::Srgb).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput);
        }
    }
}

#[test]
fn a_jpeg_of_too_many_pixels_is_an_error_that_names_another_format() {
    let picture = Picture { width: 65536, height: 1, pixels: vec![[0.0; 3]; 65536] };
    let error = encode(Format::Jpeg, &picture, None, Transfer::Srgb).unwrap_err();
    assert!(error.to_string().contains("write PNG or EXR"), "{error}");
}

#[test]
fn png_says_its_curve_and_its_origin() {
    let bytes = encode(Format::Png, &picture(), Some(&metadata()), Transfer::Srgb).unwrap();
    let reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!(info.srgb, Some(::png::SrgbRenderingIntent::Perceptual));
    let text = |name: &str| {
        let chunk = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == name);
        chunk.map(|chunk| chunk.text.clone())
    };
    assert_eq!(text("scene").unwrap(), "scenes/cornell.toml");
    assert_eq!(text("seed").unwrap(), "18446744073709551615");
    assert_eq!(text("samplesPerPixel").unwrap(), "512");
    assert_eq!(text("renderTime").unwrap(), "12.625");
    // Not ASCII, so in UTF-8; and in one line.
    assert_eq!(info.utf8_text[0].keyword, "device");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "Xeon\u{ae} 8 \u{6838} second line");

    let bytes = encode(Format::Png, &picture(), None, Transfer::Gamma2).unwrap();
    let reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    assert_eq!(reader.info().srgb, None);
    assert_eq!(reader.info().gama_chunk, Some(::png::ScaledFloat::new(0.5)));
}

#[test]
fn exr_attributes_hold_the_metadata() {
    use ::exr::meta::attribute::{AttributeValue, Text};

    let bytes = encode(Format::Exr, &picture(), Some(&metadata()), Transfer::Srgb).unwrap();
    // Pedantic: what OpenEXR's own library would refuse is an error here.
    let meta = ::exr::meta::MetaData::read_from_buffered(&bytes[..], true).unwrap();
    let header = &meta.headers[0];
    let attributes = &header.own_attributes.other;
    let text = |name: &str| match &attributes[&Text::from(name)] {
        AttributeValue::Text(text) => String::from_utf8(text.bytes().to_vec()).unwrap(),
        other => panic!("{name} is {other:?}"),
    };
    assert_eq!(text("scene"), "scenes/cornell.toml");
    assert_eq!(text("seed"), "18446744073709551615");
    assert_eq!(text("device"), "Xeon\u{ae} 8 \u{6838} second line");
    assert_eq!(attributes[&Text::from("samplesPerPixel")], AttributeValue::I32(512));
    assert_eq!(attributes[&Text::from("renderTime")], AttributeValue::F64(12.625));
    assert!(header.shared_attributes.chromaticities.is_some());
    assert_eq!(header.compression, ::exr::compression::Compression::ZIP16);
}

#[test]
fn pfm_is_a_little_endian_header_and_the_bottom_row_first() {
    let picture = Picture { width: 1, height: 2, pixels: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] };
    let bytes = encode(Format::Pfm, &picture, None, Transfer::Srgb).unwrap();
    let floats: Vec<u8> = [4.0f32, 5.0, 6.0, 1.0, 2.0, 3.0].map(f32::to_le_bytes).concat();
    assert_eq!(bytes, [&b"PF\n1 2\n-1.0\n"[..], &floats].concat());
}

#[test]
fn gamma_2_is_the_square_root() {
    let picture = Picture { width: 3, height: 1, pixels: vec![[0.25; 3], [0.0; 3], [1.0; 3]] };
    assert_eq!(quantise(&picture, Transfer::Gamma2)[..4], [128, 128, 128, 0]);
    assert_eq!(quantise(&picture, Transfer::Srgb)[..4], [137, 137, 137, 0]);
}
