//! One of each shape, material, texture and option, from a scene file: what the self-test and newcomers
//! to the format look at.

use crate::desc::SceneDesc;

const TEXT: &str = include_str!("../../../../scenes/everything.toml");

pub(super) fn everything() -> SceneDesc {
    // The tests parse the same bytes.
    crate::file::parse(TEXT, "everything.toml").expect("the built-in scene file is valid")
}
