//! Draws the map: equirectangular, row 0 at the north pole, column 0 at longitude -180.
//!
//! Outlines are filled at three times the resolution and roughened by noise. Land is coloured by
//! latitude and by hand-placed deserts and rainforests, raised by mountain ranges and lit from
//! the north-west. Everything is computed in f64 by plain arithmetic and `libm`, so that the map is
//! the same on every machine.

use std::f64::consts::PI;

use zrak_image::{Picture, srgb8_to_linear_table};

use crate::noise::fbm;
use crate::outlines::{LAKES, LAND, RANGES, Ring};

pub(crate) const WIDTH: usize = 1024;
pub(crate) const HEIGHT: usize = 512;
/// Samples of the land mask per pixel and axis.
const FINE: usize = 3;

/// sRGB colours, as numbers that can be mixed.
type Colour = [f64; 3];
const DEEP_SEA: Colour = [9.0, 28.0, 68.0];
const OPEN_SEA: Colour = [14.0, 44.0, 92.0];
const SHELF: Colour = [44.0, 104.0, 142.0];
const DESERT: Colour = [211.0, 182.0, 128.0];
const SAVANNA: Colour = [126.0, 131.0, 66.0];
const RAINFOREST: Colour = [34.0, 76.0, 30.0];
const TEMPERATE: Colour = [84.0, 116.0, 54.0];
const TAIGA: Colour = [52.0, 80.0, 50.0];
const TUNDRA: Colour = [126.0, 120.0, 94.0];
const ROCK: Colour = [122.0, 102.0, 80.0];
const ICE: Colour = [240.0, 245.0, 250.0];

/// Ellipses of climate: longitude, latitude, half-axes in degrees.
type Region = (f64, f64, f64, f64);
const DESERTS: &[Region] = &[
    (-6.0, 23.5, 15.0, 8.5),
    (12.0, 23.5, 18.0, 9.0),
    (28.0, 24.0, 10.0, 9.0),
    (46.0, 23.0, 13.0, 9.0),
    (57.0, 31.0, 10.0, 5.5),
    (69.0, 27.5, 7.0, 4.0),
    (61.0, 42.0, 13.0, 4.5),
    (83.0, 39.5, 9.0, 3.0),
    (104.0, 42.5, 12.0, 3.8),
    (89.0, 34.0, 9.0, 3.0),
    (46.0, 6.5, 6.0, 5.0),
    (127.0, -25.0, 14.0, 7.0),
    (138.0, -26.0, 9.0, 6.5),
    (19.0, -24.5, 6.5, 6.5),
    (-110.0, 31.5, 8.0, 5.5),
    (-115.5, 38.5, 4.5, 4.0),
    (-103.0, 27.0, 4.0, 4.5),
    (-70.0, -22.0, 3.0, 8.5),
    (-68.5, -44.0, 4.0, 8.0),
];
const RAINFORESTS: &[Region] = &[
    (-63.0, -4.0, 15.0, 9.5),
    (-52.0, -1.0, 8.0, 6.0),
    (20.0, -0.5, 12.0, 5.5),
    (-4.0, 6.2, 12.0, 2.6),
    (113.0, 0.0, 20.0, 8.0),
    (141.0, -5.0, 12.0, 5.0),
    (101.0, 16.0, 9.0, 9.0),
    (95.5, 24.0, 4.0, 4.0),
    (75.2, 12.0, 1.8, 5.0),
    (123.0, 12.0, 5.0, 7.0),
    (-85.0, 12.5, 8.0, 5.5),
    (-49.0, -22.5, 7.0, 5.0),
    (49.0, -17.0, 2.0, 7.0),
];

/// The whole map, as linear radiance.
pub(crate) fn draw() -> Picture {
    let mask = land_mask();
    let coverage = coverage(&mask);
    // How much land there is around: what makes a shelf.
    let near = blur(&coverage, 5);
    let far = blur(&near, 14);
    // Nothing of the open sea's height is seen.
    let height = |i: usize| if near[i] > 0.0 { relief(at(i).0, at(i).1) } else { 0.0 };
    let relief: Vec<f64> = (0..WIDTH * HEIGHT).map(height).collect();

    let table = srgb8_to_linear_table();
    let pixels = (0..WIDTH * HEIGHT).map(|i| {
        let (lon, lat) = at(i);
        let sea = sea_colour(lon, lat, near[i], far[i]);
        let (x, y) = (i % WIDTH, i / WIDTH);
        // Light from the north-west: the slope towards it.
        let west = relief[y * WIDTH + (x + WIDTH - 1) % WIDTH];
        let north = relief[y.saturating_sub(1) * WIDTH + x];
        let slope = (relief[i] - west) + (relief[i] - north);
        let land = land_colour(lon, lat, relief[i], slope);
        let colour = mix(sea, land, coverage[i]);
        // Steps of four codes are not seen, and halve the file.
        colour.map(|v| table[((v / 4.0).round() * 4.0).clamp(0.0, 252.0) as usize])
    });
    Picture { width: WIDTH as u32, height: HEIGHT as u32, pixels: pixels.collect() }
}

/// Longitude and latitude of a pixel's centre, in degrees.
fn at(pixel_idx: usize) -> (f64, f64) {
    let (x, y) = ((pixel_idx % WIDTH) as f64 + 0.5, (pixel_idx / WIDTH) as f64 + 0.5);
    (x / WIDTH as f64 * 360.0 - 180.0, 90.0 - y / HEIGHT as f64 * 180.0)
}

/// Noise at a place on the sphere; `frequency` in features per radius.
fn noise(lon: f64, lat: f64, frequency: f64, n_octaves: u32) -> f64 {
    let (lon, lat) = (lon * PI / 180.0, lat * PI / 180.0);
    let p = [libm::cos(lat) * libm::cos(lon), libm::cos(lat) * libm::sin(lon), libm::sin(lat)];
    fbm(p.map(|v| frequency * (v + 2.0)), n_octaves)
}

/// Whether each fine sample is land.
fn land_mask() -> Vec<bool> {
    let mut mask = vec![false; WIDTH * FINE * HEIGHT * FINE];
    for ring in LAND {
        fill(&mut mask, ring, true);
    }
    for ring in LAKES {
        fill(&mut mask, ring, false);
    }
    mask
}

/// Sets the samples inside a ring, row by row between its crossings.
fn fill(mask: &mut [bool], ring: Ring, value: bool) {
    let width = WIDTH * FINE;
    let to_column = |lon: f64| (lon + 180.0) / 360.0 * width as f64;
    for (row_idx, row) in mask.chunks_exact_mut(width).enumerate() {
        let lat = 90.0 - (row_idx as f64 + 0.5) / (HEIGHT * FINE) as f64 * 180.0;
        let mut crossings = Vec::new();
        for (i, &(lon0, lat0)) in ring.iter().enumerate() {
            let (lon1, lat1) = ring[(i + 1) % ring.len()];
            let [lon0, lat0, lon1, lat1] = [lon0, lat0, lon1, lat1].map(f64::from);
            if (lat0 > lat) != (lat1 > lat) {
                crossings.push(to_column(lon0 + (lat - lat0) / (lat1 - lat0) * (lon1 - lon0)));
            }
        }
        crossings.sort_by(f64::total_cmp);
        for span in crossings.chunks_exact(2) {
            let (start, end) = (span[0].round() as usize, span[1].round() as usize);
            row[start.min(width)..end.min(width)].fill(value);
        }
    }
}

/// The share of land in each pixel, after the coast is roughened by moving samples with noise.
fn coverage(mask: &[bool]) -> Vec<f64> {
    let (width, height) = ((WIDTH * FINE) as f64, (HEIGHT * FINE) as f64);
    let share_of_land = |pixel_idx: usize| {
        let (lon, lat) = at(pixel_idx);
        // Towards the poles a degree of longitude shrinks, and the shift grows with it.
        let stretch = 1.0 / libm::cos(lat * PI / 180.0).max(0.1);
        let dx = 15.0 * stretch * noise(lon, lat, 38.0, 4);
        let dy = 15.0 * noise(lon, lat, 41.0, 4);
        let n_land = (0..FINE * FINE).filter(|sample| {
            let x = (pixel_idx % WIDTH * FINE + sample % FINE) as f64 + dx;
            let y = (pixel_idx / WIDTH * FINE + sample / FINE) as f64 + dy;
            let x = x.rem_euclid(width) as usize % (WIDTH * FINE);
            mask[y.clamp(0.0, height - 1.0) as usize * WIDTH * FINE + x]
        });
        n_land.count() as f64 / (FINE * FINE) as f64
    };
    (0..WIDTH * HEIGHT).map(share_of_land).collect()
}

/// Two box blurs over `2 * radius + 1` pixels, across the map's seam but not its poles.
fn blur(values: &[f64], radius: usize) -> Vec<f64> {
    let mut values = values.to_vec();
    let n_taps = (2 * radius + 1) as f64;
    for _ in 0..2 {
        let wide: Vec<f64> = (0..WIDTH * HEIGHT)
            .map(|i| {
                let (x, row) = (i % WIDTH, &values[i / WIDTH * WIDTH..][..WIDTH]);
                let taps = (0..=2 * radius).map(|tap| row[(x + WIDTH + tap - radius) % WIDTH]);
                taps.sum::<f64>() / n_taps
            })
            .collect();
        values = (0..WIDTH * HEIGHT)
            .map(|i| {
                let (x, y) = (i % WIDTH, i / WIDTH);
                let taps = (0..=2 * radius)
                    .map(|tap| wide[(y + tap).saturating_sub(radius).min(HEIGHT - 1) * WIDTH + x]);
                taps.sum::<f64>() / n_taps
            })
            .collect();
    }
    values
}

/// Height of the land from 0 to about 1.2.
fn relief(lon: f64, lat: f64) -> f64 {
    let rough = noise(lon, lat, 24.0, 5);
    let mut height = 0.16 + 0.16 * rough;
    for &(line, half_width, peak) in RANGES {
        let distance = distance_to_line(lon, lat, line) / f64::from(half_width);
        let ridge = libm::exp(-distance * distance) * f64::from(peak);
        height = height.max(ridge * (0.85 + 0.75 * rough));
    }
    height
}

/// Distance to a line, in degrees of latitude.
fn distance_to_line(lon: f64, lat: f64, line: Ring) -> f64 {
    let shrink = libm::cos(lat * PI / 180.0);
    let local = |p: (f32, f32)| ((f64::from(p.0) - lon) * shrink, f64::from(p.1) - lat);
    line.windows(2)
        .map(|ends| {
            let ((ax, ay), (bx, by)) = (local(ends[0]), local(ends[1]));
            let (dx, dy) = (bx - ax, by - ay);
            let t = (-(ax * dx + ay * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            libm::hypot(ax + t * dx, ay + t * dy)
        })
        .fold(f64::INFINITY, f64::min)
}

fn sea_colour(lon: f64, lat: f64, near: f64, far: f64) -> Colour {
    let swirl = noise(lon, lat, 5.0, 3);
    let sea = mix(DEEP_SEA, OPEN_SEA, (0.3 + 0.5 * swirl + 1.6 * far).clamp(0.0, 1.0));
    let shelf = (1.5 * near).clamp(0.0, 1.0);
    let sea = mix(sea, SHELF, 0.75 * shelf);
    // Sea ice, with a ragged edge; the Atlantic side of the Arctic is warmer.
    let atlantic = bump((lon - 15.0) / 50.0);
    let edge = 9.0 * noise(lon, lat, 6.0, 5);
    let north = step(lat + edge, 77.0 + 4.0 * atlantic, 82.0 + 4.0 * atlantic);
    let south = step(-lat + edge, 66.5, 72.0);
    mix(sea, ICE, 0.9 * north.max(south))
}

fn land_colour(lon: f64, lat: f64, height: f64, slope: f64) -> Colour {
    let ragged = noise(lon, lat, 9.0, 5);
    let cold = lat.abs() + 14.0 * ragged;

    // From the equator to the pole.
    let mut colour = mix(SAVANNA, TEMPERATE, step(cold, 24.0, 36.0));
    colour = mix(colour, TAIGA, step(cold, 47.0, 56.0));
    colour = mix(colour, TUNDRA, step(cold, 64.0, 71.0));
    // Dry grassland inside the temperate continents.
    let steppe =
        region(lon, lat, (66.0, 49.0, 26.0, 4.5)).max(region(lon, lat, (-102.0, 41.0, 6.0, 9.0)));
    colour = mix(colour, mix(SAVANNA, DESERT, 0.35), 0.7 * steppe);
    let covered = |regions: &[Region]| {
        let strongest = regions.iter().map(|&r| region(lon, lat, r)).fold(0.0, f64::max);
        // Only the rim is ragged: no holes within, and no patches far away.
        step(strongest + 2.4 * ragged * strongest * (1.0 - strongest), 0.18, 0.45)
    };
    colour = mix(colour, RAINFOREST, covered(RAINFORESTS));
    colour = mix(colour, DESERT, covered(DESERTS));

    // Bare rock, then snow, lower the farther from the equator.
    colour = mix(colour, ROCK, step(height, 0.4, 0.9) * 0.75);
    let snow_line = (1.05 - 0.0085 * (lat.abs() - 15.0).max(0.0)).max(0.4);
    let mut ice = step(height, snow_line, snow_line + 0.22);
    // The ice sheets.
    ice = ice.max(step(-lat, 60.0, 63.0)).max(step(lat + 2.0 * ragged, 79.0, 82.0));
    let greenland = region(lon, lat, (-42.0, 73.5, 19.0, 14.5));
    ice = ice.max(step(greenland + 0.2 * ragged, 0.10, 0.22));
    ice = ice.max(step(region(lon, lat, (-18.0, 64.6, 3.4, 0.9)), 0.3, 0.6));
    colour = mix(colour, ICE, ice);

    // Light and shade; snow and ice scatter, and show less of it.
    let light = 1.0 + (2.2 * slope).clamp(-0.35, 0.35) * (1.0 - 0.75 * ice);
    let mottle = 1.0 + 0.10 * noise(lon, lat, 60.0, 3) * (1.0 - ice);
    colour.map(|v| v * light * mottle)
}

/// 1 at a region's centre, falling to 0.37 at its rim and on to 0.
fn region(lon: f64, lat: f64, (lon0, lat0, rx, ry): Region) -> f64 {
    let (dx, dy) = ((lon - lon0) / rx, (lat - lat0) / ry);
    libm::exp(-dx * dx - dy * dy)
}

/// A bell: 1 at 0.
fn bump(v: f64) -> f64 {
    libm::exp(-v * v)
}

/// Smooth rise from 0 to 1 between two values.
fn step(v: f64, from: f64, to: f64) -> f64 {
    let t = ((v - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn mix(a: Colour, b: Colour, t: f64) -> Colour {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * t)
}
