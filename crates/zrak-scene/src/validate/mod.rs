//! What is wrong with a description.
//!
//! A description without problems can be lowered and rendered: its numbers are finite and fit
//! `f32`, its names lead somewhere, its shapes have a size and its materials create no energy.
//! Images are looked at later, when they are read.

mod checker;
mod curves;
mod lights;
pub mod limits;
mod materials;
mod meshes;
mod objects;
mod problem;
mod textures;
mod transforms;

#[cfg(test)]
mod tests;

pub use problem::{KeyPath, PathPart, Problem};

use checker::Checker;
use limits::{DEPTH_MAX, LENGTH_MIN, PIXELS_MAX, SAMPLES_MAX, SIDE_MAX, SINE_MIN};

use crate::desc::{BackgroundDesc, CameraDesc, ProjectionDesc, RenderDesc, SceneDesc, Triple};
use crate::lower::Transform;

/// The version of the format that this version of zrak reads.
pub const FORMAT: u32 = 1;

/// Everything that is wrong with a description; nothing if it can be rendered.
pub fn validate(scene: &SceneDesc) -> Vec<Problem> {
    let mut checker = Checker::new(scene);
    if scene.format != FORMAT {
        let message = format!("format {} is not known; this zrak reads {FORMAT}", scene.format);
        checker.note("format", message, Some("write `format = 1`, or use a newer zrak"));
    }
    checker.enter("camera", |checker| camera(checker, &scene.camera));
    checker.enter("render", |checker| render(checker, &scene.render));
    checker.enter("background", |checker| background(checker, &scene.background));
    textures::check(&mut checker);
    materials::check(&mut checker);
    lights::check(&mut checker);
    meshes::check_meshes(&mut checker);
    meshes::check_prototypes(&mut checker);
    checker.enter("objects", |checker| objects::check(checker, &scene.objects));
    checker.into_problems()
}

fn camera(checker: &mut Checker<'_>, camera: &CameraDesc) {
    // Both ends of the view must be numbers before their difference means something.
    let has_ends =
        checker.triple("look_from", camera.look_from) & checker.triple("look_at", camera.look_at);
    let has_up = checker.triple("vup", camera.vup);
    if has_ends {
        let view = sub(camera.look_at, camera.look_from);
        let distance = length(view);
        // Nearby points must still differ in single precision.
        let single = |p: Triple| p.map(|x| x as f32);
        if distance < LENGTH_MIN || single(camera.look_from) == single(camera.look_at) {
            let message = "`look_at` is the same point as `look_from`";
            checker.note("look_at", message, Some("it must be a point in front of the camera"));
        } else if has_up && are_parallel(view, camera.vup) {
            let message = if length(camera.vup) < LENGTH_MIN {
                "`vup` has no length"
            } else {
                "`vup` is parallel to the view, from `look_from` to `look_at`"
            };
            let help = "choose another direction that is up in the picture, such as [0, 0, 1]";
            checker.note("vup", message, Some(help));
        }
    }
    checker.require(
        "vfov_deg",
        camera.vfov_deg,
        |x| x > 0.0 && x < 180.0,
        "between 0 and 180 degrees, both excluded",
        None,
    );
    size(checker, camera.width, camera.height);
    checker.require(
        "defocus_angle_deg",
        camera.defocus_angle_deg,
        |x| (0.0..180.0).contains(&x),
        "from 0 (a pinhole) to less than 180 degrees",
        None,
    );
    checker.require(
        "focus_distance",
        camera.focus_distance,
        |x| x >= LENGTH_MIN,
        "more than 0",
        None,
    );
    if let ProjectionDesc::Orthographic { height } = camera.projection {
        checker.enter("projection", |checker| {
            checker.require("height", height, |x| x >= LENGTH_MIN, "more than 0", None);
        });
    }
    checker.enter("window", |checker| {
        let [x0, x1, y0, y1] = camera.window;
        if checker.numbers(&camera.window) && (x1 - x0 < 1e-6 || y1 - y0 < 1e-6) {
            let help = "write left, right, top, bottom; the whole view is [0, 1, 0, 1]";
            checker.note("", "the window has no size", Some(help));
        }
    });
    if let Some(name) = &camera.medium {
        let media = &checker.scene.media;
        if !media.contains_key(name) {
            checker.unknown_name(checker.path_of("medium"), "medium", name, media);
        }
    }
    let has_shutter = checker.number("shutter_open_s", camera.shutter_open_s)
        & checker.number("shutter_close_s", camera.shutter_close_s);
    if has_shutter && camera.shutter_open_s > camera.shutter_close_s {
        let [open, close] = [camera.shutter_open_s, camera.shutter_close_s];
        let message = format!("the shutter closes (at {close:?} s) before it opens ({open:?} s)");
        checker.note("shutter_close_s", message, None);
    }
}

fn size(checker: &mut Checker<'_>, width: u32, height: u32) {
    let mut ok = true;
    for (key, side) in [("width", width), ("height", height)] {
        if side == 0 || side > SIDE_MAX {
            ok = false;
            let message = format!("`{key}` must be from 1 to {SIDE_MAX} pixels, is {side}");
            checker.note(key, message, None);
        }
    }
    let n_pixels = u64::from(width) * u64::from(height);
    if ok && n_pixels > PIXELS_MAX {
        let message = format!(
            "a picture of {width} x {height} = {n_pixels} pixels is too large; \
             at most {PIXELS_MAX} (such as 16384 x 16384) are possible"
        );
        checker.note("width", message, None);
    }
}

fn render(checker: &mut Checker<'_>, render: &RenderDesc) {
    for (key, value, max) in [
        ("samples_per_pixel", render.samples_per_pixel, SAMPLES_MAX),
        ("max_depth", render.max_depth, DEPTH_MAX),
        ("rr_depth", render.rr_depth, DEPTH_MAX),
    ] {
        if value == 0 || value > max {
            checker.note(key, format!("`{key}` must be from 1 to {max}, is {value}"), None);
        }
    }
}

fn background(checker: &mut Checker<'_>, background: &BackgroundDesc) {
    match *background {
        BackgroundDesc::Constant { color } => checker.radiance("color", color),
        BackgroundDesc::Gradient { bottom, top } => {
            checker.radiance("bottom", bottom);
            checker.radiance("top", top);
        }
        BackgroundDesc::Image { ref path, mapping: _, strength, tint, ref transform } => {
            if path.is_empty() {
                let help = "name a picture's file, relative to the scene file";
                checker.note("path", "`path` is empty", Some(help));
            }
            checker.require("strength", strength, is_strength, STRENGTHS, None);
            checker.radiance("tint", tint);
            transforms::check(checker, transform, Some(Transform::IDENTITY));
        }
        BackgroundDesc::Sky { sun_direction, up, turbidity, ground_albedo, sun: _, strength } => {
            checker.direction("sun_direction", sun_direction);
            checker.direction("up", up);
            let is_turbidity = |x| (1.0..=10.0).contains(&x);
            checker.require("turbidity", turbidity, is_turbidity, "from 1 to 10", None);
            checker.albedo_at(&checker.path_of("ground_albedo"), ground_albedo);
            checker.require("strength", strength, is_strength, STRENGTHS, None);
        }
    }
}

const STRENGTHS: &str = "from 0 to 1e9";

fn is_strength(x: f64) -> bool {
    (0.0..=limits::RADIANCE_MAX).contains(&x)
}

fn sub(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Triple) -> f64 {
    dot(a, a).sqrt()
}

/// Have two vectors the same or opposite directions, or has one no length?
fn are_parallel(a: Triple, b: Triple) -> bool {
    let lengths = length(a) * length(b);
    length(a) < LENGTH_MIN || length(b) < LENGTH_MIN || length(cross(a, b)) < SINE_MIN * lengths
}
