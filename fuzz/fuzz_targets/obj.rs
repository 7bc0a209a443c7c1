//! Any files are an OBJ mesh with its materials or an error that shows its place; a scene without problems can be
//! lowered.

#![no_main]

use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{file_set, init, lower_small, show};
use zrak_obj::{ImportOptions, import};

/// Enough for every seed, and little enough that one input cannot take long.
const MAX_BYTES: u64 = 4 << 20;
/// Most files of an input.
const FILES_MAX: usize = 4;

/// A folder of this process's own.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("zrak-fuzz-obj-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("there is a place for files");
        folder
    })
}

fuzz_target!(init: init(), |bytes: &[u8]| {
    let is_plain = |path: &Path| {
        matches!(path.components().collect::<Vec<_>>()[..], [Component::Normal(name)] if name.len() < 64)
            && !path.as_os_str().as_encoded_bytes().contains(&0)
    };
    let files = file_set(bytes, "scene.obj");
    let files: Vec<_> = files.into_iter().filter(|(path, _)| is_plain(path)).collect();
    if files.len() > FILES_MAX {
        return;
    }
    for (path, bytes) in &files {
        std::fs::write(folder().join(path), bytes).expect("files can be written");
    }
    let options = ImportOptions { max_bytes: MAX_BYTES, ..ImportOptions::default() };
    match import(&folder().join("scene.obj"), &options) {
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
            let shown = error.to_string();
            show(|| shown);
        }
    }
    for (path, _) in &files {
        let _ = std::fs::remove_file(folder().join(path));
    }
});
