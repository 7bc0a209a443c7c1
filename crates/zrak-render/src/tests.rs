//! Regions, films, and the progressive loop with a backend of our own.

use proptest::prelude::*;
use zrak_core::film::PixelSum;
use zrak_core::math::Color;

use crate::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, Region, Rendered,
    SampleRange, Times, render,
};

fn region() -> impl Strategy<Value = Region> {
    (0_u32..50, 0_u32..50, 1_u32..40, 1_u32..40).prop_map(|(x, y, width, height)| Region {
        x,
        y,
        width,
        height,
    })
}

/// What sample `s` of a pixel is worth here: different for each.
fn sample(x: u32, y: u32, s: u32) -> (Color, u32) {
    let value = (x * 10_007 + y * 101 + s) as f32 * 0.37;
    (Color::new(value, value * value, 1.0 / (1.0 + value)), x % 5 + s % 3)
}

fn expose(film: &mut Film, samples: SampleRange) {
    let Region { x, y, width, .. } = film.region;
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let (px, py) = (x + i as u32 % width, y + i as u32 / width);
        for s in samples.first..samples.first + samples.count {
            let (radiance, n_rays) = sample(px, py, s);
            pixel.add_sample(radiance, n_rays);
        }
    }
}

fn exposed(region: Region, first: u32, count: u32) -> Film {
    let mut film = Film::new(region);
    expose(&mut film, SampleRange { first, count });
    film
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn tiles_cover_every_pixel_once(region in region(), size in 1_u32..20) {
        let mut counts = vec![0; region.n_pixels()];
        let mut last = None;
        for tile in region.tiles(size) {
            prop_assert!(tile.is_inside(&region));
            prop_assert!((1..=size).contains(&tile.width) && (1..=size).contains(&tile.height));
            prop_assert!(last.is_none_or(|last| last < (tile.y, tile.x)), "row by row");
            last = Some((tile.y, tile.x));
            for y in tile.y..tile.y + tile.height {
                for x in tile.x..tile.x + tile.width {
                    counts[((y - region.y) * region.width + x - region.x) as usize] += 1;
                }
            }
        }
        prop_assert!(counts.iter().all(|&count| count == 1));
    }

    #[test]
    fn films_of_tiles_and_samples_merge_to_the_whole(
        region in region(), size in 1_u32..20, cut in 0_u32..=6, reverse in any::<bool>(),
    ) {
        let expected = exposed(region, 0, 6);
        let mut parts: Vec<Film> = region
            .tiles(size)
            .flat_map(|tile| [exposed(tile, 0, cut), exposed(tile, cut, 6 - cut)])
            .collect();
        if reverse {
            parts.reverse();
        }
        // Some merge among themselves first.
        let mut film = Film::new(region);
        for pair in parts.chunks(2) {
            let mut both = Film::new(region);
            pair.iter().for_each(|part| both.merge(part));
            film.merge(&both);
        }
        prop_assert_eq!(film, expected);
    }

    #[test]
    fn inside_is_what_every_corner_says(a in region(), b in region()) {
        let holds = |x: u32, y: u32| {
            (b.x..b.x + b.width).contains(&x) && (b.y..b.y + b.height).contains(&y)
        };
        let corners = holds(a.x, a.y) && holds(a.x + a.width - 1, a.y + a.height - 1);
        prop_assert_eq!(a.is_inside(&b), corners);
    }
}

#[test]
#[should_panic(expected = "a part of itself")]
fn films_do_not_take_in_what_is_outside() {
    let outside = Region { x: 3, y: 0, width: 2, height: 1 };
    Film::new(Region::whole(4, 4)).merge(&Film::new(outside));
}

#[test]
fn regions_at_the_end_of_the_numbers_do_not_overflow() {
    let far = Region { x: u32::MAX, y: 0, width: 2, height: 1 };
    assert!(!far.is_inside(&Region::whole(u32::MAX, 1)));
    assert!(far.is_inside(&far));
}

#[test]
fn pictures_are_the_means() {
    let film = exposed(Region { x: 2, y: 3, width: 4, height: 5 }, 0, 3);
    let picture = film.to_picture();
    assert_eq!((picture.width, picture.height), (4, 5));
    for (pixel, sum) in picture.pixels.iter().zip(&film.pixels) {
        assert_eq!(*pixel, sum.mean().to_array());
    }
    assert_eq!(film.n_rays(), film.pixels.iter().map(|p| p.n_rays).sum::<u64>());
    let mut cleared = film;
    cleared.clear();
    assert!(cleared.pixels.iter().all(|p| *p == PixelSum::ZERO));
}

/// What the backend does in one pass.
#[derive(Clone, Copy)]
enum Pass {
    /// Renders this many samples.
    Whole(u32),
    /// Leaves half of the pixels without, as one that was stopped.
    Stopped,
    /// Leaves half of the pixels without, and fails.
    Failed,
}

/// Does as it is told, pass by pass.
struct Scripted {
    passes: Vec<Pass>,
    ranges: Vec<SampleRange>,
}

impl Scripted {
    fn new(passes: &[Pass]) -> Self {
        Self { passes: passes.iter().rev().copied().collect(), ranges: Vec::new() }
    }
}

impl Backend for Scripted {
    fn info(&self) -> BackendInfo {
        BackendInfo { name: "scripted", device: "a test".to_owned() }
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        _: &Control,
    ) -> Result<u32, BackendError> {
        assert!(film.pixels.iter().all(|p| *p == PixelSum::ZERO), "a film without samples");
        self.ranges.push(samples);
        let mut spoil = || {
            let half = film.pixels.len() / 2;
            film.pixels[..half].iter_mut().for_each(|p| p.add_sample(Color::WHITE, 99));
        };
        match self.passes.pop().expect("no more passes than in the script") {
            Pass::Whole(count) => {
                let count = count.min(samples.count);
                expose(film, SampleRange { first: samples.first, count });
                Ok(count)
            }
            Pass::Stopped => {
                spoil();
                Ok(0)
            }
            Pass::Failed => {
                spoil();
                Err(BackendError::new(BackendErrorKind::Failed, "as told"))
            }
        }
    }

    fn times(&self) -> Times {
        Times::default()
    }
}

const WHOLE: Region = Region { x: 0, y: 0, width: 5, height: 3 };

fn nothing() -> Rendered {
    Rendered { film: Film::new(WHOLE), n_samples: 0 }
}

#[test]
fn passes_add_up() {
    for script in [
        vec![Pass::Whole(10)],
        vec![Pass::Whole(3), Pass::Whole(7)],
        vec![Pass::Whole(1), Pass::Whole(1), Pass::Whole(5), Pass::Whole(100)],
    ] {
        let mut backend = Scripted::new(&script);
        let done = render(&mut backend, nothing(), 10, &Control::default()).unwrap();
        assert_eq!((done.n_samples, &done.film), (10, &exposed(WHOLE, 0, 10)));
        // Each pass starts where the one before ended, and may take all of the rest.
        let mut first = 0;
        for (range, pass) in backend.ranges.iter().zip(&script) {
            assert_eq!(*range, SampleRange { first, count: 10 - first });
            if let Pass::Whole(n) = pass {
                first += n;
            }
        }
    }
}

#[test]
fn a_spoilt_pass_leaves_no_trace() {
    for (script, n) in [
        (vec![Pass::Stopped], 0),
        (vec![Pass::Whole(4), Pass::Stopped], 4),
        (vec![Pass::Whole(4), Pass::Whole(3), Pass::Stopped], 7),
    ] {
        let done = render(&mut Scripted::new(&script), nothing(), 10, &Control::default()).unwrap();
        assert_eq!((done.n_samples, &done.film), (n, &exposed(WHOLE, 0, n)));
        // And it goes on from there, with a pass that fails and another one.
        let failing = &[Pass::Whole(1), Pass::Failed];
        let interrupted =
            render(&mut Scripted::new(failing), done, 10, &Control::default()).unwrap_err();
        assert_eq!(interrupted.to_string(), "as told");
        assert_eq!(interrupted.error.kind(), BackendErrorKind::Failed);
        let done = interrupted.finished;
        assert_eq!((done.n_samples, &done.film), (n + 1, &exposed(WHOLE, 0, n + 1)));
        let done =
            render(&mut Scripted::new(&[Pass::Whole(99)]), done, 10, &Control::default()).unwrap();
        assert_eq!((done.n_samples, &done.film), (10, &exposed(WHOLE, 0, 10)));
    }
}

#[test]
fn nothing_is_rendered_when_stopped_or_done() {
    let control = Control::default();
    control.stop();
    let done = render(&mut Scripted::new(&[]), nothing(), 10, &control).unwrap();
    assert_eq!(done.n_samples, 0);
    let finished = Rendered { film: exposed(WHOLE, 0, 10), n_samples: 10 };
    let done = render(&mut Scripted::new(&[]), finished, 10, &Control::default()).unwrap();
    assert_eq!(done.film, exposed(WHOLE, 0, 10));
}

#[test]
fn control_counts() {
    let control = Control::default();
    assert!(!control.is_stopped());
    control.count_samples(5);
    control.count_samples(7);
    assert_eq!(control.n_samples(), 12);
    control.stop();
    assert!(control.is_stopped());
}
