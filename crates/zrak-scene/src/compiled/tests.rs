//! Compiled scenes: the same picture as the scene, and what hostile files can do, which is nothing.

use std::path::Path;
use std::sync::OnceLock;

use proptest::prelude::*;
use zrak_core::accel::{Bvh2, Bvh8};
use zrak_core::film::PixelSum;
use zrak_core::integrators::render_pixel;

use super::*;
use crate::arena::{ARRAY_TYPES, Lens};
use crate::builtin;
use crate::file;
use crate::lower::{LowerOptions, lower};

/// A scene with one of everything.
fn everything() -> SceneDesc {
    (builtin::find("everything").unwrap().build)()
}

fn lowered(desc: &SceneDesc) -> SceneArena {
    lower(desc, &LowerOptions::new("")).unwrap()
}

fn file_of(desc: &SceneDesc) -> Vec<u8> {
    let mut bytes = Vec::new();
    CompiledScene::new(desc, lowered(desc)).write(&mut bytes).unwrap();
    bytes
}

/// The file of the scene with one of everything, and of one with meshes, instances and lights.
fn files() -> &'static [Vec<u8>; 2] {
    static FILES: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    FILES.get_or_init(|| {
        [everything(), (builtin::find("workshop").unwrap().build)()].map(|mut desc| {
            (desc.camera.width, desc.camera.height) = (6, 6);
            desc.render.max_depth = 5;
            file_of(&desc)
        })
    })
}

/// Every pixel of a scene by both trees.
fn pixels(arena: &SceneArena, n_samples: u32) -> Vec<[PixelSum; 2]> {
    let view = arena.view();
    let (wide, binary) = (Bvh8 { nodes: view.nodes8 }, Bvh2 { nodes: view.nodes2 });
    let (width, height) = (view.globals.camera.width, view.globals.camera.height);
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    all.map(|(x, y)| {
        [
            render_pixel(&view, wide, x, y, 0, n_samples),
            render_pixel(&view, binary, x, y, 0, n_samples),
        ]
    })
    .collect()
}

#[track_caller]
fn refused(bytes: &[u8], kind: SceneErrorKind, words: &str) {
    let error = CompiledScene::parse(bytes, "x.zscene").expect_err("it has to be refused");
    assert_eq!(error.kind(), kind, "{error}");
    assert!(error.to_string().contains(words), "{error} does not say {words:?}");
}

/// Where the arena starts.
fn start_of(bytes: &[u8]) -> usize {
    Header::read(bytes, "").unwrap_or_else(|error| panic!("{error}")).1
}

#[test]
fn what_is_opened_is_what_was_compiled() {
    for builtin in builtin::all() {
        let desc = (builtin.build)();
        let arena = lowered(&desc);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zscene");
        CompiledScene::new(&desc, arena.clone()).write_file(&path).unwrap();
        let opened = CompiledScene::open(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(opened.arena().is_mapped());
        let bytes = std::fs::read(&path).unwrap();
        let parsed = CompiledScene::parse(&bytes, "").unwrap();
        assert!(!parsed.arena().is_mapped());
        for scene in [&opened, &parsed] {
            assert_eq!(scene.arena().globals(), arena.globals(), "{}", builtin.name);
            assert_eq!(scene.arena().spans(), arena.spans());
            assert!(scene.arena().bytes() == arena.bytes());
            assert_eq!(*scene.desc(), kept(&desc));
        }
        // What is compiled again is the same file; and the old one may go while it is in use.
        std::fs::remove_file(&path).unwrap();
        let mut again = Vec::new();
        opened.write(&mut again).unwrap();
        assert!(again == bytes);
    }
}

#[test]
fn camera_and_sampling_can_be_changed_later() {
    let desc = everything();
    let compiled = CompiledScene::parse(&file_of(&desc), "").unwrap();
    let mut wanted = desc.clone();
    (wanted.camera.width, wanted.camera.height) = (7, 5);
    wanted.camera.vfov_deg *= 1.25;
    wanted.camera.look_from[0] += 0.125;
    wanted.render.max_depth = 9;
    wanted.render.seed = 0x1234_5678_9abc;
    let mut changed = compiled.desc().clone();
    changed.camera = CameraDesc { medium: None, ..wanted.camera.clone() };
    changed.render = wanted.render.clone();
    let (a, b) = (lowered(&wanted), compiled.arena_for(&changed).unwrap());
    assert_eq!(a.globals(), b.globals());
    assert_eq!(pixels(&a, 2), pixels(&b, 2));

    let problem = |change: &dyn Fn(&mut SceneDesc)| {
        let mut desc = compiled.desc().clone();
        change(&mut desc);
        compiled.arena_for(&desc).map(|_| ()).unwrap_err()[0].message.clone()
    };
    assert!(problem(&|d| d.camera.shutter_close_s += 0.25).contains("only the name, the camera"));
    assert!(problem(&|d| d.objects = everything().objects).contains("material"));
    assert!(problem(&|d| d.camera.width = 0).contains("width"));
}

#[test]
fn files_that_are_no_compiled_scenes_are_refused() {
    use SceneErrorKind::{Damaged, Io, UnsupportedFormat};
    let good = &files()[0];
    refused(b"", UnsupportedFormat, "not a compiled scene");
    refused(b"format = 1\n", UnsupportedFormat, "zrak compile SCENE");
    refused(&[0; 10_000], UnsupportedFormat, "not a compiled scene");
    let changed = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let swapped = 0x0102_0304_u32.swap_bytes().to_ne_bytes();
    refused(&changed(8, &swapped), UnsupportedFormat, "the other order of bytes");
    refused(&changed(8, &[1, 1, 1, 1]), Damaged, "not the ones that were written");
    refused(&changed(12, &2_u32.to_ne_bytes()), UnsupportedFormat, "compiled by zrak");
    refused(&changed(16, b"9.8.7\0"), Damaged, "its head");
    // Of another layout: it says who wrote it, and hides what would disturb a terminal.
    let mut other = changed(16, b"9.8.7\x1b[31m\0");
    other[40] ^= 1;
    refused(&other, UnsupportedFormat, "zrak 9.8.7\\u{1b}[31m");
    refused(&other, UnsupportedFormat, "compile the scene again");

    for n in [9, 127, 128, 300, start_of(good) - 1, start_of(good), good.len() - 1] {
        refused(
            &good[..n],
            Damaged,
            if n < 128 { "ends in the middle" } else { "bytes and should" },
        );
    }
    refused(&[&good[..], &[0]].concat(), Damaged, "bytes and should have");

    let folder = tempfile::tempdir().unwrap();
    let open = |path: &Path| CompiledScene::open(path).unwrap_err();
    let error = open(folder.path());
    assert!(error.kind() == Io && error.to_string().contains("a folder"), "{error}");
    let error = open(&folder.path().join("none.zscene"));
    assert!(error.kind() == Io && error.to_string().contains("no such file"), "{error}");
    let path = folder.path().join("x.zscene");
    for (bytes, kind) in
        [(&good[..0], UnsupportedFormat), (&good[..100], Damaged), (&good[..9000], Damaged)]
    {
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(open(&path).kind(), kind);
    }
}

/// Every byte of the file is under a checksum.
#[test]
fn a_changed_bit_is_found_wherever_it_is() {
    for good in files() {
        let mut file = good.clone();
        let step = (good.len() / 500).max(1);
        for at in (0..good.len()).step_by(step).chain(0..600) {
            for bit in [0, 7] {
                file[at] ^= 1 << bit;
                assert!(CompiledScene::parse(&file, "").is_err(), "byte {at} is {:#x}", file[at]);
                file[at] ^= 1 << bit;
            }
        }
        assert!(CompiledScene::parse(&file, "").is_ok());
    }
}

#[test]
fn a_signed_file_is_a_good_file() {
    for good in files() {
        let mut file = good.clone();
        file[..16].fill(0);
        file[40..72].fill(0);
        sign(&mut file);
        assert!(file == *good);
    }
}

#[test]
fn heads_that_lie_are_refused() {
    use SceneErrorKind::{Damaged, Invalid};
    let good = &files()[0];
    let signed = |change: &dyn Fn(&mut [u8])| {
        let mut file = good.clone();
        change(&mut file);
        sign(&mut file);
        file
    };
    // One record more than there is, or as many as can be, of each array.
    for i in 0..ARRAY_TYPES.len() {
        let at = 128 + 4 * i;
        for len in [u32::MAX, 1 << 31] {
            let lie = |file: &mut [u8]| file[at..at + 4].copy_from_slice(&len.to_ne_bytes());
            refused(&signed(&lie), Damaged, "its arrays are not as long");
        }
    }
    // A scene in the text that is none, or more than one.
    let at = good.windows(9).position(|w| w == b"max_depth").unwrap();
    refused(&signed(&|file| file[at] = b'w'), Invalid, "wax_depth");
    refused(&signed(&|file| file[at] = 0xff), Damaged, "its text is none");
    let medium = |file: &mut [u8]| file[76..80].copy_from_slice(&77_u32.to_ne_bytes());
    refused(&signed(&medium), Damaged, "no medium 77");
    let huge = |file: &mut [u8]| file[72..76].copy_from_slice(&u32::MAX.to_ne_bytes());
    let mut file = good.clone();
    huge(&mut file);
    refused(&file, Damaged, "ends in the middle");

    // More than camera and sampling.
    let mut desc = file::parse(&file::write_string(&kept(&everything())), "").unwrap();
    desc.objects = (builtin::find("quads").unwrap().build)().objects;
    desc.materials = (builtin::find("quads").unwrap().build)().materials;
    let mut bytes = Vec::new();
    let arena = lowered(&everything());
    CompiledScene { desc, arena }.write(&mut bytes).unwrap();
    refused(&bytes, Damaged, "describes more");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// With the checksum right, whatever is changed in the arena is refused or does no harm: what can be
    /// opened can be rendered, by both trees, without a panic and in little time.
    #[test]
    fn hostile_arenas_are_refused_or_harmless(
        which in 0..2_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), value()), 1..12),
    ) {
        let mut file = files()[which].clone();
        let start = start_of(&file);
        let lens: Lens = bytemuck::pod_read_unaligned(&file[128..128 + size_of::<Lens>()]);
        let (spans, _) = crate::arena::layout(&lens).unwrap();
        // An array first and a word of it then, or hardly any change would hit the small ones.
        let spans = crate::arena::spans_in_order(&spans);
        let arrays: Vec<_> = spans.iter().zip(ARRAY_TYPES).filter(|(span, _)| span.len > 0).collect();
        for (array, word, value) in &changes {
            let (span, kind) = arrays[array.index(arrays.len())];
            let n_words = span.len as usize * kind.size / 4;
            let at = start + span.offset as usize * 16 + 4 * word.index(n_words);
            file[at..at + 4].copy_from_slice(&value.to_ne_bytes());
        }
        sign(&mut file);
        if let Ok(scene) = CompiledScene::parse(&file, "") {
            pixels(scene.arena(), 1);
        }
    }

    /// The same for any bytes of the file.
    #[test]
    fn hostile_files_are_refused_or_harmless(
        which in 0..2_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut file = files()[which].clone();
        for (at, value) in &changes {
            let n = if at.index(3) == 0 { file.len() } else { 4096 };
            file[at.index(n)] = *value;
        }
        if let Some(cut) = cut {
            file.truncate(cut.index(file.len()).max(4096));
        }
        sign(&mut file);
        if let Ok(scene) = CompiledScene::parse(&file, "") {
            prop_assume!(scene.desc().camera.width <= 64 && scene.desc().camera.height <= 64);
            prop_assume!(scene.desc().render.max_depth <= 100);
            pixels(scene.arena(), 1);
        }
    }
}

/// Words that do harm where they can: small and large indices, handles of all kinds, odd numbers.
fn value() -> impl Strategy<Value = u32> {
    prop_oneof![
        0..64_u32,
        (0..16_u32, 0..16_u32).prop_map(|(kind, index)| kind << 28 | index),
        prop::sample::select(vec![u32::MAX, i32::MAX as u32, 1 << 31, (1 << 28) - 1]),
        prop::sample::select(vec![
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            f32::MIN,
            f32::MIN_POSITIVE,
            1e-45,
            -0.0,
            1e30,
            -1e-30,
            1.0,
        ])
        .prop_map(f32::to_bits),
        any::<u32>(),
    ]
}

/// A medium in a boundary smaller than the smallest numbers: the search for a point inside ends.
#[test]
fn a_medium_without_room_does_not_keep_rays() {
    use zrak_core::math::Vec3;
    use zrak_core::ray::Ray;
    use zrak_core::sampler::Sampler;
    use zrak_core::shapes::{boundary_interval, boundary_surely_contains};
    let mut file = file_of(&(builtin::find("cornell-smoke").unwrap().build)());
    let start = start_of(&file);
    let lens: Lens = bytemuck::pod_read_unaligned(&file[128..128 + size_of::<Lens>()]);
    let (spans, _) = crate::arena::layout(&lens).unwrap();
    assert!(spans.media.len > 0 && spans.boxes.len > 0);
    let mut put = |at: usize, words: &[u32]| {
        for (i, word) in words.iter().enumerate() {
            let at = start + at + 4 * i;
            file[at..at + 4].copy_from_slice(&word.to_ne_bytes());
        }
    };
    let tiny = f32::to_bits(1e-41);
    // No free path, no placement; and boxes next to the origin.
    for i in 0..spans.media.len as usize {
        put(spans.media.offset as usize * 16 + 16 * i + 8, &[0, u32::MAX]);
    }
    for i in 0..spans.boxes.len as usize {
        let at = spans.boxes.offset as usize * 16 + 32 * i;
        put(at, &[0; 3]);
        put(at + 16, &[tiny; 3]);
    }
    sign(&mut file);
    let scene = CompiledScene::parse(&file, "").unwrap();
    let view = scene.arena().view();
    let d = Vec3::splat(1.0).normalized();
    let ray = Ray { o: Vec3::ZERO, d, time: 0.0 };
    let mut n_searches = 0;
    for i in 0..view.media.len() {
        let medium = view.media.get(i);
        // A share of the way to the middle is no step at all, and the start is not inside.
        if let Some([start, end]) = boundary_interval(&view, medium.boundary, None, &ray) {
            assert!(start == 0.0 && end > 0.0 && 0.5 * end / 1_048_576.0 == 0.0, "{end:e}");
            let (p, error) = (Vec3::ZERO, Vec3::ZERO);
            assert!(!boundary_surely_contains(&view, medium.boundary, None, p, error, 0.0));
            n_searches += 1;
        }
        let _ = medium.intersect(&view, i, &ray, &Sampler::new(0, 0, 0, 0), 0.0);
    }
    assert!(n_searches > 0);
}
