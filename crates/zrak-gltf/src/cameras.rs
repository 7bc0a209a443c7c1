//! Cameras.

use zrak_scene::desc::{CameraDesc, ProjectionDesc};
use zrak_scene::lower::Transform;
use zrak_scene::validate::limits::{PIXELS_MAX, SIDE_MAX};

use crate::buffers::element;
use crate::error::{Error, ErrorKind, Warnings};
use crate::json::Root;

/// The camera that is wanted among nodes with cameras, and its node; none if there is no camera and none is
/// asked for.
pub(crate) fn choose(
    root: &Root,
    nodes: &[(usize, usize)],
    wanted: Option<&str>,
    warnings: &mut Warnings,
) -> Result<Option<(usize, usize)>, Error> {
    // A camera that is not in the file is an error where it is placed.
    let camera_name = |camera: usize| root.cameras.get(camera).and_then(|c| c.name.as_deref());
    let name =
        |node: usize, camera: usize| root.nodes[node].name.as_deref().or(camera_name(camera));
    let list = || {
        let names = nodes.iter().take(20).map(|&(node, camera)| name(node, camera).unwrap_or("-"));
        let names: Vec<_> = names.map(|name| name.escape_debug().to_string()).collect();
        names.join(", ")
    };
    let Some(wanted) = wanted else {
        if nodes.len() > 1 {
            let message = format!(
                "the scene has {} cameras, of which the first is used: {}",
                nodes.len(),
                list()
            );
            warnings.note("cameras", message);
        }
        return Ok(nodes.first().copied());
    };
    let is_node = |&&(node, _): &&(usize, usize)| root.nodes[node].name.as_deref() == Some(wanted);
    let is_camera = |&&(_, camera): &&(usize, usize)| camera_name(camera) == Some(wanted);
    let found = nodes
        .iter()
        .find(is_node)
        .or_else(|| nodes.iter().find(is_camera))
        .or_else(|| nodes.get(wanted.parse::<usize>().ok()?));
    if found.is_none() {
        let wanted = wanted.escape_debug();
        let (message, help) = match nodes.len() {
            0 => (format!("there is no camera '{wanted}': the scene has none"), String::new()),
            n => (
                format!("there is no camera '{wanted}' in the scene"),
                format!("name one of its {n}, or give its number from 0: {}", list()),
            ),
        };
        return Err(Error::new(ErrorKind::Invalid, "cameras", message, help));
    }
    Ok(found.copied())
}

/// The camera of this index, at a node: it looks along -z, with +y up.
pub(crate) fn place(
    root: &Root,
    index: usize,
    at: &str,
    world: &Transform,
    height: u32,
    warnings: &mut Warnings,
) -> Result<CameraDesc, Error> {
    let camera = element(&root.cameras, "cameras", index, at)?;
    let location = format!("cameras[{index}]");
    let from = [world.rows[0][3], world.rows[1][3], world.rows[2][3]];
    let forward = unit(world.vector([0.0, 0.0, -1.0]));
    // Far from the origin, a point one unit ahead could be the same in single precision.
    let largest = from.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    let desc = CameraDesc {
        look_from: from,
        look_at: [0, 1, 2].map(|i| from[i] + forward[i] * largest),
        vup: unit(world.vector([0.0, 1.0, 0.0])),
        flip_x: world.determinant() < 0.0,
        ..CameraDesc::default()
    };
    let positive = |key: &str, x: f64| {
        if x > 0.0 {
            return Ok(x);
        }
        Err(Error::invalid(format_args!("{location}.{key}"), format!("{x} is not more than 0")))
    };
    match (camera.kind.as_str(), &camera.perspective, &camera.orthographic) {
        ("perspective", Some(perspective), _) => {
            let yfov = positive("perspective.yfov", perspective.yfov)?.to_degrees();
            if yfov >= 180.0 {
                let message = format!("{yfov} degrees are too wide for straight lines");
                return Err(Error::invalid(format_args!("{location}.perspective.yfov"), message));
            }
            let aspect = match perspective.aspect_ratio {
                Some(aspect) => positive("perspective.aspectRatio", aspect)?,
                None => 16.0 / 9.0,
            };
            let (width, height) = size(height, aspect, &location, warnings);
            Ok(CameraDesc { vfov_deg: yfov, width, height, ..desc })
        }
        ("orthographic", _, Some(orthographic)) => {
            let xmag = positive("orthographic.xmag", orthographic.xmag.abs())?;
            let ymag = positive("orthographic.ymag", orthographic.ymag.abs())?;
            let (width, height) = size(height, xmag / ymag, &location, warnings);
            let projection = ProjectionDesc::Orthographic { height: 2.0 * ymag };
            Ok(CameraDesc { projection, width, height, ..desc })
        }
        (kind, ..) => {
            let message = format!("the camera is of type {kind:?}, and has no numbers for it");
            Err(Error::invalid(location, message))
        }
    }
}

/// Width and height of a picture of this aspect.
fn size(height: u32, aspect: f64, location: &str, warnings: &mut Warnings) -> (u32, u32) {
    let height = height.clamp(1, 16_384);
    // The height that the limit of pixels allows at this aspect.
    let wanted = f64::from(height);
    let width = (wanted * aspect).round();
    let widest = f64::from(SIDE_MAX).min((PIXELS_MAX / u64::from(height)) as f64);
    if !(1.0..=widest).contains(&width) {
        warnings.note(location, format!("the picture cannot be {width} pixels wide"));
    }
    (width.clamp(1.0, widest) as u32, height)
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return v;
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}
