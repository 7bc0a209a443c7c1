//! Any bytes are a scene file or an error that shows its place; what was read can be written and read again.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use zrak_fuzz::show;
use zrak_scene::file::{parse, write_string};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match parse(text, "fuzz.toml") {
        Ok(desc) => {
            let written = write_string(&desc);
            let again = parse(&written, "written.toml");
            assert_eq!(again.expect("what was written can be read"), desc);
        }
        Err(error) => {
            // The error shows its place, which has to be in the text.
            let shown = error.to_string();
            show(|| shown);
        }
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    // Half of the changes are of bytes, to meet the syntax as well.
    if seed % 2 == 0 {
        return fuzzer_mutate(data, size, max_size);
    }
    match zrak_fuzz::mutate_scene(&data[..size], max_size, seed) {
        Some(text) => {
            data[..text.len()].copy_from_slice(text.as_bytes());
            text.len()
        }
        None => fuzzer_mutate(data, size, max_size),
    }
});
