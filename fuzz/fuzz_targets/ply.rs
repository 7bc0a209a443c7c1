//! Any bytes are a PLY file or an error; what was read is a good mesh, and can be written and read again.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{init, show};
use zrak_mesh::{Limits, ply, unpack};

const LIMITS: Limits = Limits { max_bytes: 8 << 20 };

fuzz_target!(init: init(), |bytes: &[u8]| {
    let Ok(bytes) = unpack(bytes.to_vec(), Path::new("fuzz.ply"), &LIMITS) else { return };
    let mesh = match ply::parse(&bytes, &LIMITS) {
        Ok(mesh) => mesh,
        Err(error) => return show(|| error.to_string()),
    };
    assert!(mesh.n_bytes() as u64 <= LIMITS.max_bytes, "the mesh is larger than its limit");
    // Triangles without an area have been dropped: there may be none left, which is for the scene to say.
    if mesh.triangles.is_empty() {
        return;
    }
    mesh.validate().expect("meshes that were read are good");
    let mut written = Vec::new();
    ply::write(&mut written, &mesh).expect("memory can be written to");
    let again = ply::parse(&written, &Limits { max_bytes: 64 << 20 }).expect("what was written can be read");
    assert_eq!(again.triangles, mesh.triangles);
    assert_eq!(again.positions, mesh.positions);
});
