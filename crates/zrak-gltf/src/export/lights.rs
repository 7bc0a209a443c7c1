//! The camera and the lights, as nodes.

use serde_json::{Value, json};
use zrak_scene::desc::{LightDesc, ProjectionDesc, Triple};

use super::Export;

/// Both ways the same, and what Blender uses.
const LUMENS_PER_WATT: f64 = 683.0;

/// The node of the camera.
pub(super) fn camera(export: &mut Export<'_>) -> usize {
    let camera = &export.desc.camera;
    let aspect = f64::from(camera.width) / f64::from(camera.height.max(1));
    let lens = match camera.projection {
        ProjectionDesc::Orthographic { height } => json!({
            "type": "orthographic",
            "orthographic": {"xmag": height / 2.0 * aspect, "ymag": height / 2.0, "znear": 0.0,
                             "zfar": 1e6}
        }),
        projection => {
            if projection != ProjectionDesc::Perspective {
                let message = "glTF has no panoramic cameras: the view is written as a flat one";
                export.warnings.note("camera.projection", message);
            }
            let yfov = camera.vfov_deg.to_radians();
            json!({"type": "perspective",
                   "perspective": {"yfov": yfov, "aspectRatio": aspect, "znear": 0.01}})
        }
    };
    if camera.defocus_angle_deg > 0.0 {
        export
            .warnings
            .note("camera.defocus_angle_deg", "glTF's cameras have no lens: all is sharp");
    }
    if camera.window != [0.0, 1.0, 0.0, 1.0] {
        export.warnings.note("camera.window", "the whole view is written, not the window");
    }
    let index = export.file.push("cameras", lens);
    let view = [0, 1, 2].map(|i| camera.look_at[i] - camera.look_from[i]);
    let [mut right, up, back] = frame(view, camera.vup);
    if camera.flip_x {
        right = right.map(|x| -x);
    }
    let matrix = columns([right, up, back, camera.look_from]);
    export.file.push("nodes", json!({"camera": index, "matrix": matrix, "name": "camera"}))
}

/// The nodes of the lights.
pub(super) fn lights(export: &mut Export<'_>) -> Vec<usize> {
    let mut list = Vec::new();
    let mut nodes = Vec::new();
    for (i, light) in export.desc.lights.iter().enumerate() {
        let (mut json, position, direction, strength) = match *light {
            LightDesc::Point { position, intensity } => {
                (json!({"type": "point"}), position, [0.0, 0.0, -1.0], intensity)
            }
            LightDesc::Distant { direction, irradiance } => {
                (json!({"type": "directional"}), [0.0; 3], direction, irradiance)
            }
            LightDesc::Spot {
                position,
                direction,
                intensity,
                cone_angle_deg,
                falloff_start_deg,
                ..
            } => {
                let outer = cone_angle_deg.min(90.0);
                if cone_angle_deg > 90.0 {
                    let message = "glTF's spots are at most half a sphere wide";
                    export.warnings.note(format_args!("lights[{i}]"), message);
                }
                // glTF asks for an inner angle below the outer one.
                let inner = falloff_start_deg.min(outer * (1.0 - 1e-6));
                let spot = json!({"innerConeAngle": inner.to_radians(),
                                  "outerConeAngle": outer.to_radians()});
                (json!({"type": "spot", "spot": spot}), position, direction, intensity)
            }
        };
        let largest = strength.iter().fold(0.0_f64, |m, &x| m.max(x));
        if largest > 0.0 {
            json["color"] = json!(strength.map(|x| x / largest));
        }
        json["intensity"] = json!(largest * LUMENS_PER_WATT);
        let index = list.len();
        list.push(json);
        let [right, up, back] = frame(direction, [0.0, 1.0, 0.0]);
        let extension = json!({"KHR_lights_punctual": {"light": index}});
        let matrix = columns([right, up, back, position]);
        nodes.push(export.file.push("nodes", json!({"matrix": matrix, "extensions": extension})));
    }
    if !list.is_empty() {
        export.file.set_extension("KHR_lights_punctual", json!({"lights": list}));
    }
    nodes
}

/// Right, up and back of what looks along `view`, as unit vectors.
fn frame(view: Triple, up: Triple) -> [Triple; 3] {
    let back = unit(view.map(|x| -x)).unwrap_or([0.0, 0.0, 1.0]);
    let cross = |a: Triple, b: Triple| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    // Some axis is not along the view.
    let right = [up, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
        .into_iter()
        .map(|up| cross(up, back))
        .find(|r| r.iter().any(|x| x.abs() > 1e-6))
        .and_then(unit)
        .unwrap_or([1.0, 0.0, 0.0]);
    [right, cross(back, right), back]
}

fn unit(v: Triple) -> Option<Triple> {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    Some(v.map(|x| x / length))
}

/// A glTF matrix of three axes and an origin.
fn columns([x, y, z, o]: [Triple; 4]) -> Value {
    json!([
        x[0], x[1], x[2], 0.0, y[0], y[1], y[2], 0.0, z[0], z[1], z[2], 0.0, o[0], o[1], o[2], 1.0
    ])
}
