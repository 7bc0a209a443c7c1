//! The JSON Schema of the scene format, made from the types of [`crate::desc`].
//!
//! Editors use it to complete and check scene files; zrak itself checks the shape of a file against
//! it, so the types are the only place that says what a file may contain.

use std::sync::OnceLock;

use serde_json::Value;

use crate::desc::SceneDesc;

/// The JSON Schema of a scene file, indented, with a newline at the end.
pub fn json_schema() -> String {
    format!("{:#}\n", root())
}

/// The schema as a value.
pub(crate) fn root() -> &'static Value {
    static ROOT: OnceLock<Value> = OnceLock::new();
    ROOT.get_or_init(|| schemars::schema_for!(SceneDesc).to_value())
}
