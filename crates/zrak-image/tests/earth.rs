//! The committed map of the Earth is what its generator draws, and is where it says it is.

#[path = "../examples/make_earth/map.rs"]
mod map;
#[path = "../examples/make_earth/noise.rs"]
mod noise;
#[path = "../examples/make_earth/outlines.rs"]
mod outlines;

use std::path::Path;

use zrak_image::{Limits, Texels, compare, read_picture, read_texture};

fn path() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/earth.png")
}

#[test]
fn the_committed_map_is_the_generated_one() {
    let difference = compare(&read_picture(&path()).unwrap(), &map::draw()).unwrap();
    assert_eq!(
        difference.n_differing_pixels, 0,
        "run `cargo run -p zrak-image --example make_earth -- assets/earth.png`"
    );
}

#[test]
fn places_have_their_colours() {
    let image = read_texture(&path(), &Limits::default()).unwrap();
    let Texels::Srgb8(texels) = image.texels else { panic!("a PNG of 8 bits") };
    let colour = |lon: f64, lat: f64| {
        let x = ((lon + 180.0) / 360.0 * f64::from(image.width)) as usize;
        let y = ((90.0 - lat) / 180.0 * f64::from(image.height)) as usize;
        texels[y * image.width as usize + x]
    };
    let is_sea = |c: [u8; 4]| c[2] > c[0] + 30 && c[2] > c[1];
    let is_sand = |c: [u8; 4]| c[0] > 150 && c[0] > c[2] + 40;
    let is_green = |c: [u8; 4]| c[1] > c[0] && c[1] > c[2];
    let is_white = |c: [u8; 4]| c[0] > 200 && c[2] > 200;
    for (place, lon, lat, looks) in [
        ("Pacific", -150.0, 0.0, &is_sea as &dyn Fn([u8; 4]) -> bool),
        ("Atlantic", -35.0, 30.0, &is_sea),
        ("Mediterranean", 18.5, 35.0, &is_sea),
        ("Black Sea", 34.0, 43.2, &is_sea),
        ("Hudson Bay", -86.0, 60.0, &is_sea),
        ("Gulf of Mexico", -91.0, 25.5, &is_sea),
        ("Sahara", 10.0, 24.0, &is_sand),
        ("Arabia", 46.0, 22.0, &is_sand),
        ("Australian interior", 128.0, -25.0, &is_sand),
        ("Amazon", -62.0, -5.0, &is_green),
        ("Congo", 22.0, 0.0, &is_green),
        ("Germany", 10.0, 51.0, &is_green),
        ("Greenland", -42.0, 73.0, &is_white),
        ("Antarctica", 60.0, -80.0, &is_white),
    ] {
        assert!(looks(colour(lon, lat)), "{place} is {:?}", colour(lon, lat));
    }
}
