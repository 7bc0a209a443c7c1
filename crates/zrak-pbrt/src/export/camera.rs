//! Camera, film, sampler and integrator.

use std::f64::consts::PI;
use std::fmt::Write;

use zrak_scene::desc::{CameraDesc, ProjectionDesc};
use zrak_scene::lower::Transform;

use super::Writer;
use super::text::{numbers, param, quoted, transform, word};
use crate::maths::{cross, dot, sub, unit};

/// How long the shutter is open if it does not open at all: pbrt needs some time.
const MOMENT_S: f64 = 1e-4;

impl Writer<'_, '_> {
    pub(super) fn camera(&mut self) {
        let desc = self.desc;
        let camera = &desc.camera;
        if !desc.name.is_empty() {
            // A name of several lines would end the comment.
            let name: String = desc.name.chars().filter(|c| !c.is_control()).collect();
            let _ = writeln!(self.out, "# {name}");
        }
        if let Some(name) = &camera.medium {
            self.medium(name);
            let name = self.media[name].clone();
            let _ = writeln!(self.out, "MediumInterface \"\" {}", quoted(&name));
        }
        let mut params = String::new();
        let kind = match camera.projection {
            ProjectionDesc::Perspective => "perspective",
            ProjectionDesc::Orthographic { .. } => "orthographic",
            ProjectionDesc::Equirectangular | ProjectionDesc::EqualArea => "spherical",
        };
        let mut size = [camera.width, camera.height];
        let mut crop = None;
        let half = half_view(camera);
        match camera.projection {
            ProjectionDesc::Perspective if camera.window == [0.0, 1.0, 0.0, 1.0] => {
                // Theirs is on the shorter side.
                let aspect = f64::from(camera.width) / f64::from(camera.height);
                let fov = if aspect >= 1.0 {
                    camera.vfov_deg
                } else {
                    2.0 * libm::atan(half[0]) * (180.0 / PI)
                };
                params += &param("float", "fov", [fov]);
            }
            ProjectionDesc::Perspective => {
                params += &param("float", "fov", [90.0]);
                params += &param("float", "screenwindow", window_of(camera, half));
            }
            ProjectionDesc::Orthographic { .. } => {
                params += &param("float", "screenwindow", window_of(camera, half));
            }
            ProjectionDesc::Equirectangular | ProjectionDesc::EqualArea => {
                let mapping = match camera.projection {
                    ProjectionDesc::Equirectangular => "equirectangular",
                    _ => "equalarea",
                };
                params += &word("string", "mapping", mapping);
                let [x0, x1, y0, y1] = camera.window;
                if camera.window != [0.0, 1.0, 0.0, 1.0] {
                    let whole = |n: u32, part: f64| (f64::from(n) / part).round().max(1.0) as u32;
                    size = [whole(camera.width, x1 - x0), whole(camera.height, y1 - y0)];
                    crop = Some(camera.window);
                }
            }
        }
        if camera.defocus_angle_deg > 0.0 {
            let radius = camera.focus_distance * libm::tan(camera.defocus_angle_deg * PI / 360.0);
            params += &param("float", "lensradius", [radius]);
            params += &param("float", "focaldistance", [camera.focus_distance]);
        }
        let (open, close) = (camera.shutter_open_s, camera.shutter_close_s);
        let close = if close > open { close } else { open + MOMENT_S };
        if [open, close] != [0.0, 1.0] {
            params += &param("float", "shutteropen", [open]);
            params += &param("float", "shutterclose", [close]);
        }
        self.out += &camera_map(camera);
        let _ = writeln!(self.out, "Camera \"{kind}\"{params}");
        let mut film = word("string", "filename", &self.options.picture);
        film += &param("integer", "xresolution", [size[0]]);
        film += &param("integer", "yresolution", [size[1]]);
        if let Some(window) = crop {
            film += &param("float", "cropwindow", window);
        }
        if close - open != 1.0 {
            // A longer exposure makes their picture brighter, and not ours.
            film += &param("float", "iso", [100.0 / (close - open)]);
        }
        let _ = writeln!(self.out, "Film \"rgb\"{film}");
        let render = &desc.render;
        let samples = param("integer", "pixelsamples", [render.samples_per_pixel]);
        // Theirs is of 32 bits.
        let seed = param("integer", "seed", [render.seed & 0x7fff_ffff]);
        let depth = param("integer", "maxdepth", [render.max_depth.saturating_sub(1)]);
        let _ = writeln!(
            self.out,
            "PixelFilter \"box\" \"float xradius\" [ 0.5 ] \"float yradius\" [ 0.5 ]\n\
             Sampler \"independent\"{samples}{seed}\nIntegrator \"volpath\"{depth}"
        );
    }
}

/// Half of the whole view across and down: tangents, or lengths.
fn half_view(camera: &CameraDesc) -> [f64; 2] {
    let down = match camera.projection {
        ProjectionDesc::Orthographic { height } => 0.5 * height,
        _ => libm::tan(camera.vfov_deg * PI / 360.0),
    };
    let [x0, x1, y0, y1] = camera.window;
    // Pixels are squares.
    let whole = |n: u32, part: f64| f64::from(n) / part;
    let aspect = whole(camera.width, x1 - x0) / whole(camera.height, y1 - y0);
    [down * aspect, down]
}

/// Left, right, bottom and top of the picture where its middle is 0.
fn window_of(camera: &CameraDesc, [across, down]: [f64; 2]) -> [f64; 4] {
    let [x0, x1, y0, y1] = camera.window;
    [
        across * (2.0 * x0 - 1.0),
        across * (2.0 * x1 - 1.0),
        down * (1.0 - 2.0 * y1),
        down * (1.0 - 2.0 * y0),
    ]
}

/// The map from the world to the camera. pbrt's cameras are left-handed.
fn camera_map(camera: &CameraDesc) -> String {
    let view = sub(camera.look_at, camera.look_from);
    if camera.projection == ProjectionDesc::Equirectangular {
        // Their longitude begins at the x axis and turns towards z; ours is at z in the middle.
        let (Some(view), Some(up)) = (unit(view), unit(camera.vup)) else { return String::new() };
        let right = view.map(|x| -x);
        let along = dot(up, right);
        let Some(up) = unit([0, 1, 2].map(|i| up[i] - along * right[i])) else {
            return String::new();
        };
        let side = cross(right, up);
        let forward = if camera.flip_x { side } else { side.map(|x| -x) };
        let row = |axis: [f64; 3]| [axis[0], axis[1], axis[2], -dot(axis, camera.look_from)];
        return transform(&Transform { rows: [row(right), row(up), row(forward)] });
    }
    let flip = if camera.flip_x { "" } else { "Scale -1 1 1\n" };
    let ends = [camera.look_from, camera.look_at, camera.vup].map(numbers);
    format!("{flip}LookAt {}\n", ends.join("  "))
}
