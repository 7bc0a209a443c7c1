//! Parts of spheres, cylinders and disks, bilinear patches and curves, from a scene file.

use crate::desc::SceneDesc;

const TEXT: &str = include_str!("../../../../scenes/shapes.toml");

pub(super) fn shapes() -> SceneDesc {
    // The tests parse the same bytes.
    crate::file::parse(TEXT, "shapes.toml").expect("the built-in scene file is valid")
}
