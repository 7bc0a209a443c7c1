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

#[cfg(test)]
mod tests {
    use super::{json_schema, root};

    #[test]
    fn says_what_fields_mean() {
        let schema = json_schema();
        assert!(schema.contains("Centre of the lens"));
        assert!(schema.ends_with("}\n"));
        assert_eq!(root()["required"], serde_json::json!(["format", "name", "camera"]));
    }
}
