//! The committed JSON Schema is the one of the types.

use std::path::Path;

#[test]
fn the_committed_schema_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-schema.json");
    let current = zrak_scene::schema::json_schema();
    if std::env::var_os("ZRAK_BLESS").is_some() {
        std::fs::write(&path, &current).unwrap();
    }
    // A checkout on Windows may have turned the ends of lines.
    let committed = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(
        committed == current,
        "docs/scene-schema.json is not the schema of the types in desc.rs; to refresh it:\n\n    \
         ZRAK_BLESS=1 cargo test -p zrak-scene --test schema\n"
    );
}
