//! The covers: the last scene of *Ray Tracing in One Weekend*, and the first of *The Next Week*,
//! which is the same one with bouncing spheres on a checkered ground.

use super::parts::{
    camera, glass, green_checker, lambertian, metal, moving_sphere, scene, sphere, texture,
};
use super::rng::Rng;
use crate::desc::{BackgroundDesc, CameraDesc, MaterialDesc, SceneDesc};

/// *Ray Tracing in One Weekend* 14.1, "A Final Render".
pub(super) fn cover() -> SceneDesc {
    // White at the horizon's nadir to blue overhead: the book's a = (y + 1) / 2.
    let sky = BackgroundDesc::Gradient { bottom: [1.0, 1.0, 1.0], top: [0.5, 0.7, 1.0] };
    let mut scene = scene("cover", shallow_focus([640, 360]), 64, sky);
    scene.materials.insert("ground".to_owned(), lambertian([0.5, 0.5, 0.5]));
    add_spheres(&mut scene, false);
    scene
}

/// *The Next Week* 2.5 and 4.3, "Adding Motion Blur" and the checkered ground.
pub(super) fn bouncing_spheres() -> SceneDesc {
    let mut scene =
        scene("bouncing-spheres", shallow_focus([400, 225]), 100, super::parts::blue_sky());
    scene.textures.insert("checker".to_owned(), green_checker());
    scene
        .materials
        .insert("ground".to_owned(), MaterialDesc::Lambertian { color: texture("checker") });
    add_spheres(&mut scene, true);
    scene
}

fn shallow_focus(size: [u32; 2]) -> CameraDesc {
    let camera = camera([13.0, 2.0, 3.0], [0.0, 0.0, 0.0], 20.0, size);
    CameraDesc { defocus_angle_deg: 0.6, focus_distance: 10.0, ..camera }
}

/// Adds the ground, the field of small spheres and the three big ones; the random numbers are
/// drawn in the book's order.
fn add_spheres(scene: &mut SceneDesc, bouncing: bool) {
    let mut rng = Rng::new(1);
    scene.objects.push(sphere([0.0, -1000.0, 0.0], 1000.0, "ground"));
    for (name, material) in [
        ("glass", glass()),
        ("brown", lambertian([0.4, 0.2, 0.1])),
        ("mirror", metal([0.7, 0.6, 0.5], 0.0)),
    ] {
        scene.materials.insert(name.to_owned(), material);
    }

    let mut n_small = 0;
    for a in -11..11 {
        for b in -11..11 {
            let choice = rng.unit();
            let center = [f64::from(a) + 0.9 * rng.unit(), 0.2, f64::from(b) + 0.9 * rng.unit()];
            // Leave room for the big metal sphere.
            let [dx, dz] = [center[0] - 4.0, center[2]];
            if (dx * dx + dz * dz).sqrt() <= 0.9 {
                continue;
            }
            if choice >= 0.95 {
                scene.objects.push(sphere(center, 0.2, "glass"));
                continue;
            }
            n_small += 1;
            let (name, material, object);
            if choice < 0.8 {
                let [p, q] = [rng.triple(0.0, 1.0), rng.triple(0.0, 1.0)];
                name = format!("diffuse_{n_small:03}");
                material = lambertian([p[0] * q[0], p[1] * q[1], p[2] * q[2]]);
                object = if bouncing {
                    let end = [center[0], center[1] + rng.range(0.0, 0.5), center[2]];
                    moving_sphere(center, end, 0.2, &name)
                } else {
                    sphere(center, 0.2, &name)
                };
            } else {
                let color = rng.triple(0.5, 1.0);
                name = format!("metal_{n_small:03}");
                material = metal(color, rng.range(0.0, 0.5));
                object = sphere(center, 0.2, &name);
            }
            scene.materials.insert(name, material);
            scene.objects.push(object);
        }
    }

    scene.objects.push(sphere([0.0, 1.0, 0.0], 1.0, "glass"));
    scene.objects.push(sphere([-4.0, 1.0, 0.0], 1.0, "brown"));
    scene.objects.push(sphere([4.0, 1.0, 0.0], 1.0, "mirror"));
}
