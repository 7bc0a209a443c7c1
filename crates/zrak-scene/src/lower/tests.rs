//! Tests.

mod camera;
mod meshes;
mod shapes;
mod surfaces;
mod transform;

use std::collections::BTreeMap;

use crate::arena::SceneArena;
use crate::desc::{
    BackgroundDesc, CameraDesc, ColorDesc, MaterialDesc, ObjectDesc, RenderDesc, SceneDesc,
};
use crate::lower::{LowerOptions, lower};

/// A scene with a white material `m` and a mist `mist`.
fn scene(objects: Vec<ObjectDesc>) -> SceneDesc {
    let white = ColorDesc::Solid([0.5; 3]);
    let materials = [
        ("m".to_owned(), MaterialDesc::Lambertian { color: white.clone() }),
        ("mist".to_owned(), MaterialDesc::Isotropic { color: white }),
    ];
    SceneDesc {
        format: 1,
        name: "test".to_owned(),
        description: String::new(),
        camera: CameraDesc {
            look_from: [0.0, 0.0, 5.0],
            look_at: [0.0; 3],
            vup: [0.0, 1.0, 0.0],
            vfov_deg: 90.0,
            width: 40,
            height: 20,
            defocus_angle_deg: 0.0,
            focus_distance: 10.0,
            shutter_open_s: 0.0,
            shutter_close_s: 1.0,
            ..CameraDesc::default()
        },
        render: RenderDesc::default(),
        background: BackgroundDesc::Constant { color: [1.0; 3] },
        textures: BTreeMap::new(),
        materials: BTreeMap::from(materials),
        objects,
        ..SceneDesc::default()
    }
}

fn arena(desc: &SceneDesc) -> SceneArena {
    match lower(desc, &LowerOptions::new(env!("CARGO_MANIFEST_DIR"))) {
        Ok(arena) => arena,
        Err(problems) => panic!("{problems:?}"),
    }
}

/// Uniform numbers by SplitMix64.
struct Rng(u64);

impl Rng {
    fn range(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        lo + (hi - lo) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn triple(&mut self, size: f64) -> [f64; 3] {
        [(); 3].map(|()| self.range(-size, size))
    }
}
