//! Any files are a pbrt scene or an error that shows its place; a scene without problems can be lowered.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{file_set, init, lower_small, show};
use zrak_pbrt::{ImportOptions, import_from_memory};

/// Enough for every seed, and little enough that one input cannot take long.
const MAX_BYTES: u64 = 4 << 20;

fuzz_target!(init: init(), |bytes: &[u8]| {
    let options = ImportOptions { allow_external: false, max_bytes: MAX_BYTES };
    match import_from_memory(Path::new("scene.pbrt"), file_set(bytes, "scene.pbrt"), &options) {
        Ok(imported) => {
            let problems = zrak_scene::validate::validate(&imported.desc);
            show(|| format!("{} warnings, problems: {problems:?}", imported.warnings.len()));
            if problems.is_empty()
                && let Err(problems) = lower_small(&imported.desc)
            {
                show(|| format!("{problems:?}"));
            }
        }
        Err(error) => {
            // The error shows its place, which has to be in the file.
            let shown = error.to_string();
            show(|| shown);
        }
    }
});
