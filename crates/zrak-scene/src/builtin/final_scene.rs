//! *The Next Week* 10, "A Scene Testing All New Features".

use super::parts::{
    camera, darkness, glass, isotropic, lambertian, light, marble, metal, moving_sphere, quad,
    scene, sphere, texture, turned_then_moved,
};
use super::rng::Rng;
use crate::desc::{BoundaryDesc, MaterialDesc, ObjectDesc, SceneDesc};

pub(super) fn final_scene() -> SceneDesc {
    let mut rng = Rng::new(2);
    let camera = camera([478.0, 278.0, -600.0], [278.0, 278.0, 0.0], 40.0, [400, 400]);
    let mut scene = scene("final", camera, 60, darkness());
    scene.textures.insert("earth".to_owned(), super::earth::map());
    scene.textures.insert("marble".to_owned(), marble(0.2));
    for (name, material) in [
        ("ground", lambertian([0.48, 0.83, 0.53])),
        ("light", light([7.0, 7.0, 7.0])),
        ("moving", lambertian([0.7, 0.3, 0.1])),
        ("glass", glass()),
        ("brushed", metal([0.8, 0.8, 0.9], 1.0)),
        ("blue", isotropic([0.2, 0.4, 0.9])),
        ("mist", isotropic([1.0, 1.0, 1.0])),
        ("earth", MaterialDesc::Lambertian { color: texture("earth") }),
        ("marble", MaterialDesc::Lambertian { color: texture("marble") }),
        ("white", lambertian([0.73, 0.73, 0.73])),
    ] {
        scene.materials.insert(name.to_owned(), material);
    }

    // The ground: 20 x 20 boxes of random height.
    let side = 100.0;
    let mut ground = Vec::new();
    for i in 0..20 {
        for j in 0..20 {
            let [x, z] = [f64::from(i) * side - 1000.0, f64::from(j) * side - 1000.0];
            ground.push(ObjectDesc::Box {
                min: [x, 0.0, z],
                max: [x + side, rng.range(1.0, 101.0), z + side],
                material: "ground".to_owned(),
                transform: Vec::new(),
            });
        }
    }
    scene.objects.push(ObjectDesc::Group { objects: ground, transform: Vec::new() });

    scene.objects.extend([
        quad([123.0, 554.0, 147.0], [300.0, 0.0, 0.0], [0.0, 0.0, 265.0], "light"),
        moving_sphere([400.0, 400.0, 200.0], [430.0, 400.0, 200.0], 50.0, "moving"),
        sphere([260.0, 150.0, 45.0], 50.0, "glass"),
        sphere([0.0, 150.0, 145.0], 50.0, "brushed"),
        // Glass filled with a blue medium looks like polished plastic.
        sphere([360.0, 150.0, 145.0], 70.0, "glass"),
        medium([360.0, 150.0, 145.0], 70.0, 0.2, "blue"),
        // A thin mist over everything.
        medium([0.0, 0.0, 0.0], 5000.0, 0.0001, "mist"),
        sphere([400.0, 200.0, 400.0], 100.0, "earth"),
        sphere([220.0, 280.0, 300.0], 80.0, "marble"),
    ]);

    // A cube of a thousand spheres.
    let cube = (0..1000).map(|_| sphere(rng.triple(0.0, 165.0), 10.0, "white")).collect();
    let transform = turned_then_moved(15.0, [-100.0, 270.0, 395.0]);
    scene.objects.push(ObjectDesc::Group { objects: cube, transform });
    scene
}

fn medium(center: [f64; 3], radius: f64, density: f64, material: &str) -> ObjectDesc {
    ObjectDesc::Medium {
        boundary: BoundaryDesc::Sphere { center, center_end: None, radius, transform: Vec::new() },
        density,
        material: material.to_owned(),
        transform: Vec::new(),
    }
}
