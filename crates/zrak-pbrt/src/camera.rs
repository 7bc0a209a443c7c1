//! Camera and film.

use zrak_scene::desc::{CameraDesc, ProjectionDesc};
use zrak_scene::lower::Transform;

use crate::error::{Fault, Result, Span};
use crate::lens::ThinLens;
use crate::params::Params;
use crate::state::{Importer, cross, dot};

/// A camera whose film may come later.
#[derive(Clone, Debug)]
pub(crate) struct CameraSoFar {
    kind: String,
    params: Params,
    world_from_camera: Transform,
    medium: Option<String>,
}

/// Size of the whole picture in pixels, and the part of it that is rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Film {
    size: [u32; 2],
    crop: [f64; 4],
    iso: f64,
    diagonal_mm: f64,
}

impl Default for Film {
    fn default() -> Self {
        Self { size: [1280, 720], crop: [0.0, 1.0, 0.0, 1.0], iso: 100.0, diagonal_mm: 35.0 }
    }
}

impl Importer {
    pub(crate) fn camera_directive(&mut self, kind: &str, at: &Span, params: Params) -> Result<()> {
        let kinds = ["perspective", "orthographic", "spherical", "realistic"];
        if !kinds.contains(&kind) {
            return Err(Fault::unknown(at, "camera", kind, &kinds));
        }
        let ctm = self.state.ctm;
        if ctm.is_moving() {
            self.warn(at, "the camera moves; it is taken as it stands at first");
        }
        let Some(world_from_camera) = ctm.start.inverse() else {
            return Err(Fault::new(at, "the camera's map flattens space"));
        };
        let medium = Some(self.state.media[1].to_string()).filter(|name| !name.is_empty());
        self.camera =
            Some(CameraSoFar { kind: kind.to_owned(), params, world_from_camera, medium });
        Ok(())
    }

    pub(crate) fn film_directive(&mut self, kind: &str, at: &Span, params: Params) -> Result<()> {
        let kinds = ["rgb", "gbuffer", "spectral"];
        if !kinds.contains(&kind) {
            return Err(Fault::unknown(at, "film", kind, &kinds));
        }
        let side = |name: &str, default: u32| -> Result<u32> {
            let Some(n) = params.integer(name)? else { return Ok(default) };
            if (1..=65_536).contains(&n) {
                return Ok(n as u32);
            }
            let message = format!("`{name}` must be from 1 to 65536, is {n}");
            Err(Fault::new(&params.span_of(name), message))
        };
        self.film.size = [side("xresolution", 1280)?, side("yresolution", 720)?];
        let [w, h] = self.film.size.map(f64::from);
        let window = |name: &str, kind: &str| -> Result<Option<[f64; 4]>> {
            match params.numbers(&[kind], name)? {
                None => Ok(None),
                Some(&[x0, x1, y0, y1]) => Ok(Some([x0, x1, y0, y1])),
                Some(_) => {
                    let message = format!("`{name}` must be left, right, top and bottom");
                    Err(Fault::new(&params.span_of(name), message))
                }
            }
        };
        // What is beyond the picture is cut off, as in pbrt.
        for (name, kind, scale) in
            [("pixelbounds", "integer", [1.0 / w, 1.0 / h]), ("cropwindow", "float", [1.0; 2])]
        {
            let Some([x0, x1, y0, y1]) = window(name, kind)? else { continue };
            let part = |a: f64, b: f64, scale: f64| {
                [a.min(b) * scale, a.max(b) * scale].map(|x| x.clamp(0.0, 1.0))
            };
            let ([x0, x1], [y0, y1]) = (part(x0, x1, scale[0]), part(y0, y1, scale[1]));
            if x0 >= x1 || y0 >= y1 {
                let message = format!("`{name}` has no size within the picture");
                return Err(Fault::new(&params.span_of(name), message));
            }
            self.film.crop = [x0, x1, y0, y1];
        }
        self.film.diagonal_mm = params.float("diagonal")?.unwrap_or(35.0).max(1e-3);
        if let Some(name) = params.string("filename")? {
            self.filename = Some(name.to_owned());
        }
        self.film.iso = params.float("iso")?.unwrap_or(100.0);
        if !(self.film.iso > 0.0 && self.film.iso < 1e9) {
            let message = format!("`iso` must be more than 0, is {}", self.film.iso);
            return Err(Fault::new(&params.span_of("iso"), message));
        }
        if params.string("sensor")?.is_some_and(|name| name != "cie1931") {
            self.warn(
                &params.span_of("sensor"),
                "sensors of real cameras are not simulated: the film is CIE 1931's",
            );
        }
        for (name, what) in [
            ("whitebalance", "colours are not balanced: `whitebalance` is not read"),
            (
                "maxcomponentvalue",
                "bright samples are not cut off: `maxcomponentvalue` is not read",
            ),
        ] {
            if params.float(name)?.is_some_and(|x| x != 0.0) {
                self.warn(&params.span_of(name), what);
            }
        }
        params.ignore(&[
            "savefp16",
            "coordinatesystem",
            // Of spectral films.
            "nbuckets",
            "lambdamin",
            "lambdamax",
        ]);
        self.warn_unused(&params);
        Ok(())
    }

    /// The lens of a realistic camera, as a thin one.
    fn realistic(&mut self, params: &Params) -> Result<ThinLens> {
        let Some(name) = params.string("lensfile")?.map(str::to_owned) else {
            let fault = Fault::new(&params.span, "a realistic camera needs a \"string lensfile\"");
            return Err(fault.help("it names a file of the lens's surfaces"));
        };
        let span = params.span_of("lensfile");
        let [width, height] = self.film.size.map(f64::from);
        let short =
            self.film.diagonal_mm * width.min(height) / (width * width + height * height).sqrt();
        let diameter = params.float("aperturediameter")?.unwrap_or(1.0).max(0.0);
        let focus = params.float("focusdistance")?.unwrap_or(10.0).max(1e-6);
        params.ignore(&["aperture"]);
        self.warn(
            &span,
            "the surfaces of a lens are not traced: it is a thin lens of its focal length",
        );
        self.lens(&name, &span, short, diameter, focus)
    }

    /// How much of the light the film sees: the time that the shutter is open, and the film's speed.
    pub(crate) fn expose(&mut self) -> Result<()> {
        let Some(camera) = &self.camera else { return Ok(()) };
        let params = &camera.params;
        let [open, close] = [("shutteropen", 0.0), ("shutterclose", 1.0)]
            .map(|(name, default)| params.float(name).map(|x| x.unwrap_or(default)));
        let (open, close) = (open?, close?);
        if !(close > open) {
            let message = format!("the shutter closes (at {close}) before it opens (at {open})");
            let fault = Fault::new(&params.span_of("shutterclose"), message);
            return Err(fault.help("`shutteropen` must be less than `shutterclose`"));
        }
        self.exposure = (close - open) * self.film.iso / 100.0;
        Ok(())
    }

    /// Makes the camera, once camera and film are known.
    pub(crate) fn finish_camera(&mut self, end: &Span) -> Result<()> {
        let Some(camera) = self.camera.take() else {
            return Err(Fault::new(end, "the file has no Camera"));
        };
        let CameraSoFar { kind, params, world_from_camera, medium } = camera;
        let origin = world_from_camera.point([0.0; 3]);
        let forward = world_from_camera.vector([0.0, 0.0, 1.0]);
        let up = world_from_camera.vector([0.0, 1.0, 0.0]);
        let right = world_from_camera.vector([1.0, 0.0, 0.0]);
        let length = |v: [f64; 3]| dot(v, v).sqrt();
        let [width, height] = self.film.size;
        let aspect = match params.float("frameaspectratio")? {
            Some(aspect) if aspect > 0.0 => aspect,
            Some(_) => return Err(Fault::new(&params.span, "`frameaspectratio` must be positive")),
            None => f64::from(width) / f64::from(height),
        };
        // Where the picture's rim is, where the shorter side reaches from -1 to 1.
        let screen = match params.numbers(&["float"], "screenwindow")? {
            Some(&[x0, x1, y0, y1]) if x0 < x1 && y0 < y1 => [x0, x1, y0, y1],
            Some(_) => return Err(Fault::new(&params.span, "`screenwindow` has no size")),
            None if aspect > 1.0 => [-aspect, aspect, -1.0, 1.0],
            None => [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect],
        };
        let reach = [screen[0].abs().max(screen[1].abs()), screen[2].abs().max(screen[3].abs())];
        // The same as parts of a whole that is even about the view, y downwards; then the crop.
        let view = [
            (screen[0] + reach[0]) / (2.0 * reach[0]),
            (screen[1] + reach[0]) / (2.0 * reach[0]),
            (reach[1] - screen[3]) / (2.0 * reach[1]),
            (reach[1] - screen[2]) / (2.0 * reach[1]),
        ];
        let pixels = |n: u32, a: f64, b: f64| {
            let first = (f64::from(n) * a).ceil() as u32;
            [first, ((f64::from(n) * b).ceil() as u32).max(first + 1).min(n)]
        };
        let crop = self.film.crop;
        let (x, y) = (pixels(width, crop[0], crop[1]), pixels(height, crop[2], crop[3]));
        let within =
            |lo: f64, hi: f64, i: u32, n: u32| lo + (hi - lo) * f64::from(i) / f64::from(n);
        let window = [
            within(view[0], view[1], x[0], width),
            within(view[0], view[1], x[1], width),
            within(view[2], view[3], y[0], height),
            within(view[2], view[3], y[1], height),
        ];
        let lens = if kind == "realistic" { Some(self.realistic(&params)?) } else { None };
        let fov = match lens {
            Some(lens) => lens.fov_deg,
            None => params.float("fov")?.unwrap_or(90.0),
        };
        if !(fov > 0.0 && fov < 180.0) {
            let message = format!("`fov` must be between 0 and 180 degrees, is {fov}");
            return Err(Fault::new(&params.span_of("fov"), message));
        }
        let half = libm::tan(fov * (std::f64::consts::PI / 360.0));
        let to_deg = |radians: f64| radians * (180.0 / std::f64::consts::PI);
        let (lens_radius, focus) = match lens {
            Some(lens) => (lens.radius, lens.focus),
            None => (
                params.float("lensradius")?.unwrap_or(0.0),
                params.float("focaldistance")?.unwrap_or(1e6),
            ),
        };
        // Distances are measured in the camera's space.
        let focus = focus * length(forward);
        let has_lens = lens_radius > 0.0 && focus > 0.0;
        let lens_radius = lens_radius * length(right);
        let projection = match kind.as_str() {
            "orthographic" => ProjectionDesc::Orthographic { height: 2.0 * reach[1] * length(up) },
            "spherical" => match params.string("mapping")? {
                Some("equirectangular") => ProjectionDesc::Equirectangular,
                None | Some("equalarea") => ProjectionDesc::EqualArea,
                Some(other) => {
                    let all = ["equalarea", "equirectangular"];
                    return Err(Fault::unknown(&params.span_of("mapping"), "mapping", other, &all));
                }
            },
            _ => ProjectionDesc::Perspective,
        };
        let is_round =
            matches!(projection, ProjectionDesc::Equirectangular | ProjectionDesc::EqualArea);
        let mut camera = CameraDesc {
            look_from: origin,
            look_at: [0, 1, 2].map(|i| origin[i] + forward[i] / length(forward)),
            vup: up,
            vfov_deg: to_deg(2.0 * libm::atan(half * reach[1])),
            width: x[1] - x[0],
            height: y[1] - y[0],
            defocus_angle_deg: if has_lens {
                to_deg(2.0 * libm::atan(lens_radius / focus))
            } else {
                0.0
            },
            focus_distance: if has_lens { focus } else { 1.0 },
            shutter_open_s: params.float("shutteropen")?.unwrap_or(0.0),
            shutter_close_s: params.float("shutterclose")?.unwrap_or(1.0),
            projection,
            // pbrt's cameras are left-handed, unless their map is mirrored.
            flip_x: dot(right, cross(forward, up)) < 0.0,
            window: if is_round { [crop[0], crop[1], crop[2], crop[3]] } else { window },
            medium,
        };
        if projection == ProjectionDesc::Equirectangular {
            // Their longitude begins at the x axis and turns towards z; ours is at z in the middle.
            camera.look_at = [0, 1, 2].map(|i| origin[i] - right[i] / length(right));
            camera.flip_x = dot(forward, cross(right, up)) > 0.0;
        }
        self.desc.camera = camera;
        params.ignore(&["shutteropen", "shutterclose"]);
        self.warn_unused(&params);
        Ok(())
    }
}
