//! One picture: the same bytes on any number of threads, with any tree, in any parts and any order,
//! in one run or several. Compared with `==`.

mod common;

use std::sync::Arc;

use common::scenes::{
    cuboid, glass, group, in_box, in_sphere, isotropic, lambertian, light, medium, metal,
    moving_sphere, quad, scene, sphere, triangle_cube,
};
use common::{arena, render, render_part, whole};
use proptest::prelude::*;
use zrak_cpu::{CpuBackend, Tree};
use zrak_render::{
    Backend, BackendError, BackendInfo, Control, Film, Region, Rendered, SampleRange, Times,
};
use zrak_scene::arena::SceneArena;
use zrak_scene::builtin;
use zrak_scene::desc::{
    ColorDesc, FresnelDesc, LightSides, MaterialDesc, NoisePattern, SceneDesc, TextureDesc,
    TransformStep,
};

/// A little of everything: each shape, material, texture and medium; shapes that touch, overlap and
/// coincide; depth of field and motion.
fn everything(size: [u32; 2]) -> SceneDesc {
    let mut desc = scene(size, 0.4);
    desc.camera.defocus_angle_deg = 1.0;
    desc.camera.look_from = [1.0, 1.5, 5.0];
    let checker = TextureDesc::Checker {
        scale: 0.4,
        even: ColorDesc::Solid([0.9, 0.2, 0.1]),
        odd: ColorDesc::Texture("marble".to_owned()),
    };
    let marble = TextureDesc::Noise {
        scale: 4.0,
        pattern: NoisePattern::Marble,
        octaves: 5,
        seed: 3,
        low: [0.1; 3],
        high: [0.9; 3],
    };
    let earth = TextureDesc::image("builtin:earth.png", zrak_scene::desc::ImageFilter::Bilinear);
    for (name, texture) in [("checker", checker), ("marble", marble), ("earth", earth)] {
        desc.textures.insert(name.to_owned(), texture);
    }
    let textured =
        |name: &str| MaterialDesc::Lambertian { color: ColorDesc::Texture(name.to_owned()) };
    for (name, material) in [
        ("white", lambertian(0.8)),
        ("checker", textured("checker")),
        ("marble", textured("marble")),
        ("earth", textured("earth")),
        ("steel", metal(0.8, 0.2)),
        ("glass", glass(1.5, FresnelDesc::Schlick)),
        ("water", glass(1.33, FresnelDesc::Exact)),
        ("light", light(4.0, LightSides::Front)),
        ("mist", isotropic(0.9)),
        ("smoke", isotropic(0.2)),
    ] {
        desc.materials.insert(name.to_owned(), material);
    }
    let turn = |angle: f64, by: [f64; 3]| {
        vec![TransformStep::RotateYDeg(angle), TransformStep::Translate(by)]
    };
    desc.objects = vec![
        quad([-3.0, -1.0, -3.0], [0.0, 0.0, 6.0], [6.0, 0.0, 0.0], "checker"),
        quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], "light"),
        sphere([-1.2, -0.5, 0.0], 0.5, "earth"),
        sphere([0.0, -0.5, 0.5], 0.5, "glass"),
        sphere([0.0, -0.5, 0.5], 0.5, "glass"),
        medium(in_sphere([0.0, -0.5, 0.5], 0.5), 2.0, "smoke"),
        moving_sphere([1.2, -0.5, 0.0], [1.4, -0.2, 0.0], 0.5, "steel"),
        group(vec![cuboid([-0.4; 3], [0.4; 3], "marble")], turn(30.0, [-0.4, -0.6, -1.2])),
        group(triangle_cube("water"), {
            let mut steps = vec![TransformStep::Scale(zrak_scene::desc::ScaleDesc::Uniform(0.3))];
            steps.extend(turn(20.0, [0.8, -0.7, 1.2]));
            steps
        }),
        medium(in_box([-3.0, -1.0, -3.0], [3.0, 2.0, 3.0]), 0.1, "mist"),
        cuboid([1.0, -1.0, -1.5], [1.5, 0.0, -1.0], "white"),
        cuboid([1.0, -1.0, -1.5], [1.5, 0.0, -1.0], "checker"),
    ];
    desc
}

const TREES: [Tree; 3] = [Tree::Wide, Tree::Binary, Tree::BruteForce];

fn check_all_ways(name: &str, scene: &Arc<SceneArena>, n_samples: u32) {
    let reference = render(scene, 1, Tree::BruteForce, n_samples);
    for tree in TREES {
        for n_threads in [1, 2, 5] {
            let film = render(scene, n_threads, tree, n_samples);
            assert!(film == reference, "{name}: {tree:?} on {n_threads} threads differs");
        }
    }
}

#[test]
fn trees_and_threads_do_not_change_a_bit() {
    check_all_ways("everything", &arena(&everything([50, 37])), 6);
}

#[test]
fn built_in_scenes_are_the_same_with_every_tree() {
    for builtin in builtin::all() {
        let mut desc = (builtin.build)();
        // The largest scenes are slow without a tree.
        let size = if desc.objects.len() > 100 { 12 } else { 32 };
        (desc.camera.width, desc.camera.height) = (size, size);
        let scene = arena(&desc);
        let reference = render(&scene, 2, Tree::BruteForce, 2);
        assert!(reference.pixels.iter().any(|p| p.radiance[0].to_f64() > 0.0), "{}", builtin.name);
        for tree in [Tree::Wide, Tree::Binary] {
            assert!(render(&scene, 2, tree, 2) == reference, "{}: {tree:?}", builtin.name);
        }
    }
}

#[test]
fn seeds_make_different_pictures() {
    let mut desc = everything([16, 16]);
    let one = render(&arena(&desc), 1, Tree::Wide, 2);
    desc.render.seed += 1 << 32;
    assert!(render(&arena(&desc), 1, Tree::Wide, 2) != one);
}

/// A part of a render and who renders it.
#[derive(Clone, Debug)]
struct Part {
    region: Region,
    samples: SampleRange,
    tree: Tree,
    n_threads: usize,
}

/// Cuts a render at random, as often as there are cuts.
fn split(whole: Region, n_samples: u32, cuts: &[(u32, u32, u32)]) -> Vec<Part> {
    let samples = SampleRange { first: 0, count: n_samples };
    let mut parts = vec![Part { region: whole, samples, tree: Tree::Wide, n_threads: 1 }];
    for &(which, kind, at) in cuts {
        let index = which as usize % parts.len();
        let mut a = parts[index].clone();
        let mut b = a.clone();
        match kind % 3 {
            0 if a.region.width > 1 => {
                a.region.width = 1 + at % (a.region.width - 1);
                b.region.x += a.region.width;
                b.region.width -= a.region.width;
            }
            1 if a.region.height > 1 => {
                a.region.height = 1 + at % (a.region.height - 1);
                b.region.y += a.region.height;
                b.region.height -= a.region.height;
            }
            2 if a.samples.count > 1 => {
                a.samples.count = 1 + at % (a.samples.count - 1);
                b.samples.first += a.samples.count;
                b.samples.count -= a.samples.count;
            }
            _ => continue,
        }
        b.tree = TREES[(at / 7) as usize % 3];
        b.n_threads = 1 + (at / 3) as usize % 3;
        parts[index] = a;
        parts.push(b);
    }
    parts
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_split_merged_in_any_order_is_the_whole(
        cuts in prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>()), 0..12),
        order in any::<u64>(),
    ) {
        let scene = arena(&everything([33, 21]));
        let n_samples = 5;
        let expected = render(&scene, 1, Tree::Wide, n_samples);
        let mut parts = split(whole(&scene), n_samples, &cuts);
        // A shuffle by a multiplicative hash.
        parts.sort_by_key(|part| {
            let words = [part.region.x, part.region.y, part.samples.first];
            words.iter().fold(order, |h, &w| {
                (h ^ u64::from(w)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
            })
        });
        let mut film = Film::new(whole(&scene));
        for part in &parts {
            let mut backend =
                CpuBackend::new(Arc::clone(&scene), Some(part.n_threads), part.tree).unwrap();
            film.merge(&render_part(&mut backend, part.region, part.samples));
        }
        prop_assert!(film == expected, "{parts:?}");
    }
}

/// Stops the render after a number of passes, in the middle of the last one.
struct Stopping<'a> {
    backend: CpuBackend,
    passes_left: u32,
    control: &'a Control,
}

impl Backend for Stopping<'_> {
    fn info(&self) -> BackendInfo {
        self.backend.info()
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        if self.passes_left == 0 {
            self.control.stop();
        } else {
            self.passes_left -= 1;
        }
        // One sample at a time, so that there are passes to speak of.
        let samples = SampleRange { count: samples.count.min(1), ..samples };
        self.backend.render(film, samples, control)
    }

    fn times(&self) -> Times {
        self.backend.times()
    }
}

#[test]
fn a_stopped_render_has_whole_passes_and_goes_on_as_if_it_had_not_been() {
    let scene = arena(&everything([40, 30]));
    let n_samples = 6;
    let expected = render(&scene, 1, Tree::Wide, n_samples);
    for (first_stop, second_stop) in [(0, 1), (1, 0), (2, 3), (5, 0)] {
        let mut done = Rendered { film: Film::new(whole(&scene)), n_samples: 0 };
        for passes in [first_stop, second_stop] {
            let control = Control::default();
            let backend = CpuBackend::new(Arc::clone(&scene), Some(2), Tree::Wide).unwrap();
            let mut stopping = Stopping { backend, passes_left: passes, control: &control };
            let before = done.n_samples;
            done = zrak_render::render(&mut stopping, done, n_samples, &control).unwrap();
            assert_eq!(done.n_samples, (before + passes).min(n_samples));
            assert!(done.film.pixels.iter().all(|p| p.n_samples == u64::from(done.n_samples)));
            let so_far = render(&scene, 1, Tree::Binary, done.n_samples.max(1));
            assert!(done.n_samples == 0 || done.film == so_far);
        }
        let mut backend = CpuBackend::new(Arc::clone(&scene), Some(1), Tree::Binary).unwrap();
        let control = Control::default();
        let done = zrak_render::render(&mut backend, done, n_samples, &control).unwrap();
        assert_eq!(done.n_samples, n_samples);
        assert!(done.film == expected, "stopped after {first_stop} and {second_stop} passes");
    }
}

#[test]
fn stopping_from_another_thread_leaves_whole_passes() {
    let scene = arena(&everything([64, 64]));
    let control = Control::default();
    let done = std::thread::scope(|scope| {
        scope.spawn(|| {
            while control.n_samples() < 64 * 64 * 3 {
                std::thread::yield_now();
            }
            control.stop();
        });
        let mut backend = CpuBackend::new(Arc::clone(&scene), Some(2), Tree::Wide).unwrap();
        let start = Rendered { film: Film::new(whole(&scene)), n_samples: 0 };
        zrak_render::render(&mut backend, start, u32::MAX, &control).unwrap()
    });
    assert!(control.is_stopped());
    assert!(done.film.pixels.iter().all(|p| p.n_samples == u64::from(done.n_samples)));
    let n_samples = done.n_samples;
    assert!((1..100_000).contains(&n_samples));
    if n_samples < 200 {
        assert!(render(&scene, 1, Tree::Wide, n_samples) == done.film);
    }
}

#[test]
fn absurd_numbers_of_threads_are_refused() {
    let scene = arena(&everything([4, 4]));
    for n_threads in [0, 1 << 20] {
        let result = CpuBackend::new(Arc::clone(&scene), Some(n_threads), Tree::Wide);
        let error = result.err().expect("refused");
        assert_eq!(error.kind(), zrak_render::BackendErrorKind::InvalidOption);
    }
}

#[test]
fn an_empty_scene_is_its_background() {
    let scene = arena(&scene([8, 8], 0.25));
    for tree in TREES {
        let film = render(&scene, 1, tree, 3);
        assert!(film.pixels.iter().all(|p| p.mean().to_array() == [0.25; 3] && p.n_rays == 3));
    }
}
