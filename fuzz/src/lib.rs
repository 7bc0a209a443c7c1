//! What the fuzz targets share.

mod files;
mod mutate;
mod render;
mod repair;

pub use files::file_set;
pub use mutate::mutate_scene;
pub use render::{lower_small, render, render_and_compare};
pub use repair::repair;

/// Makes a target repeatable: everything that is parallel runs on the thread that asks for it.
pub fn init() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("nothing else has made a pool");
}

/// Says what became of an input, if the variable `ZRAK_FUZZ_SHOW` is set: to look at seeds and findings.
pub fn show(outcome: impl FnOnce() -> String) {
    if std::env::var_os("ZRAK_FUZZ_SHOW").is_some() {
        eprintln!("{}", outcome());
    }
}

/// [`init`] for targets that read OpenEXR files. The decoder's panics are caught by design, and the hook that
/// libFuzzer's crate sets would end the process at them: in its place, panics are told, those of the decoder
/// are not, and what nobody catches still ends the process.
pub fn init_with_exr() {
    init();
    std::panic::set_hook(Box::new(|info| {
        if !info.location().is_some_and(|place| is_of_the_decoder(place.file())) {
            eprintln!("{info}");
        }
    }));
}

/// Whether a source file belongs to what is run behind `catch_unwind`, or to the library that it calls.
fn is_of_the_decoder(file: &str) -> bool {
    let crates = ["/exr-", "/half-", "/bit_field-", "/lebe-", "/smallvec-", "/library/"];
    crates.iter().any(|name| file.contains(name))
}
