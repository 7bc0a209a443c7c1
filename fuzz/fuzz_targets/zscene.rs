//! Any bytes are a compiled scene that can be rendered, or an error.
//!
//! What is changed at random has wrong checksums, which says nothing about what whoever can write a checksum can do: all
//! but every eighth input are signed first.

#![no_main]

use libfuzzer_sys::fuzz_target;
use zrak_fuzz::{init, render, show};
use zrak_scene::compiled::{CompiledScene, sign};

/// Most path segments.
const DEPTH_MAX: u32 = 12;

fuzz_target!(init: init(), |bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    if bytes.last().is_none_or(|b| b % 8 != 0) {
        sign(&mut bytes);
    }
    let scene = match CompiledScene::parse(&bytes, "fuzz.zscene") {
        Ok(scene) => scene,
        Err(error) => {
            let shown = error.to_string();
            return show(|| shown);
        }
    };
    let mut desc = scene.desc().clone();
    desc.render.max_depth = desc.render.max_depth.min(DEPTH_MAX);
    let arena = scene.arena_for(&desc).expect("depth may be changed");
    render(&arena);
});
