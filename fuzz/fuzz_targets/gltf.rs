//! Any bytes are a glTF file or an error; what was read can be lowered, and written and read again.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{init, lower_small, show};
use zrak_gltf::{ImportOptions, Limits, parse_gltf, to_glb};
use zrak_scene::desc::MeshDesc;

fuzz_target!(init: init(), |bytes: &[u8]| {
    let limits = Limits { max_bytes: 32 << 20, max_objects: 1 << 16 };
    let options = ImportOptions { limits, ..ImportOptions::default() };
    let beside = |_: &str, max: u64| Ok(vec![0; max.min(256) as usize]);
    let imported = match parse_gltf(bytes, &beside, &options) {
        Ok(imported) => imported,
        Err(error) => return show(|| error.to_string()),
    };
    if zrak_scene::validate::validate(&imported.desc).is_empty() {
        let _ = lower_small(&imported.desc);
    }
    for mesh in imported.desc.meshes.values() {
        if let MeshDesc::Loaded(mesh) = mesh {
            mesh.validate().expect("meshes that were read are good");
        }
    }
    // Writing may need more than reading: instances in instances, which are written one by one.
    let Ok((written, _)) = to_glb(&imported.desc, Path::new(""), &imported.assets) else { return };
    let options = ImportOptions::default();
    if let Err(error) = parse_gltf(&written, &beside, &options) {
        panic!("what was written cannot be read: {error}");
    }
});
