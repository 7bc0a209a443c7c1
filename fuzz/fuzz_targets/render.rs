//! Whatever passes validation can be lowered and rendered, and no tree changes the picture.
//!
//! With a folder in the variable `ZRAK_FUZZ_COMPILE`, scenes are compiled into it: seeds for `zscene`.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use zrak_fuzz::{init, lower_small, mutate_scene, render_and_compare, repair, show};
use zrak_scene::compiled::CompiledScene;

fuzz_target!(init: init(), |bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // The picture of the earth takes longer to decode than the rest of a small scene to render.
    let text = text.replace("builtin:earth.png", "embedded:small.png");
    let Ok(scene) = toml::from_str(&text) else { return };
    let Some(desc) = repair(&scene) else {
        return show(|| "it is not a scene, and cannot be made one".to_owned());
    };
    show(|| zrak_scene::file::write_string(&desc));
    // What is found when it is lowered: meshes that are not there, prototypes of prototypes without end.
    let arena = match lower_small(&desc) {
        Ok(arena) => arena,
        Err(problems) => return show(|| format!("{problems:?}")),
    };
    render_and_compare(&arena);
    if let Some(folder) = std::env::var_os("ZRAK_FUZZ_COMPILE") {
        let path = std::path::Path::new(&folder).join(format!("{}.zscene", desc.name));
        CompiledScene::new(&desc, arena).write_file(path).expect("the folder can be written to");
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    match mutate_scene(&data[..size], max_size, seed) {
        Some(text) => {
            data[..text.len()].copy_from_slice(text.as_bytes());
            text.len()
        }
        None => fuzzer_mutate(data, size, max_size),
    }
});
