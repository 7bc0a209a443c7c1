use serde_json::Value;

use crate::file::shape::KEYWORDS;
use crate::schema;

/// Checks the keywords of a schema and of the schemas in it.
fn check(schema: &Value) {
    // `true`: anything goes; the format has no such place, and the check would let it pass unseen.
    let keywords = schema.as_object().expect("a schema is a table");
    for (keyword, value) in keywords {
        assert!(KEYWORDS.contains(&keyword.as_str()), "{keyword} is not checked by `shape`");
        match keyword.as_str() {
            "properties" | "$defs" => value.as_object().unwrap().values().for_each(check),
            "items" => check(value),
            "oneOf" | "anyOf" => value.as_array().unwrap().iter().for_each(check),
            "additionalProperties" if value.is_object() => check(value),
            "additionalProperties" => assert_eq!(value, &Value::Bool(false)),
            "minItems" => assert_eq!(Some(value), schema.get("maxItems")),
            "format" => {
                assert!(["double", "float", "uint32", "uint64"].contains(&value.as_str().unwrap()))
            }
            "minimum" => assert_eq!(value, 0, "only that of unsigned integers is checked"),
            _ => {}
        }
    }
}

#[test]
fn the_schema_has_no_keyword_that_goes_unchecked() {
    check(schema::root());
}
