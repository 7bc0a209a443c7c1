//! The shape of a scene file: fields, kinds and types, checked against the format's schema.
//!
//! serde could do this while it deserializes, but it loses places and wording inside enums that
//! are told apart by `kind`, and it stops at the first error. This is an interpreter of that part of
//! JSON Schema that schemars makes of the types in [`crate::desc`]: `$ref`, `oneOf`, `anyOf`,
//! `const`, `type`, `properties`, `required`, `additionalProperties`, `items` and their number,
//! and `format` of integers. A test makes sure that no other keyword turns up.

use std::ops::Range;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

use crate::schema;
use crate::suggest;
use crate::validate::limits::GROUP_NESTING_MAX;
use crate::validate::{KeyPath, PathPart, Problem};

/// What is wrong with the shape of a file, each with its place.
pub(super) fn check(tree: &Spanned<DeTable<'_>>) -> Vec<(Problem, Range<usize>)> {
    let mut walk = Walk { path: KeyPath::default(), problems: Vec::new() };
    walk.table(schema::root(), tree.get_ref(), 0..0);
    walk.problems
}

/// The keywords of JSON Schema that are understood here; the first five say nothing about files.
#[cfg(test)]
pub(super) const KEYWORDS: [&str; 18] = [
    "$schema",
    "$defs",
    "title",
    "description",
    "default",
    "$ref",
    "oneOf",
    "anyOf",
    "const",
    "type",
    "properties",
    "required",
    "additionalProperties",
    "items",
    "minItems",
    "maxItems",
    "format",
    "minimum",
];

/// A member of a group in a group ... is two steps further in than the group.
const PATH_LEN_MAX: usize = 2 * GROUP_NESTING_MAX + 2;

/// The walk down the tree: where it is, and what it has found.
struct Walk {
    path: KeyPath,
    problems: Vec<(Problem, Range<usize>)>,
}

impl Walk {
    fn note(&mut self, span: Range<usize>, message: String, help: Option<String>) {
        self.problems.push((Problem { path: self.path.clone(), message, help }, span));
    }

    fn enter(&mut self, part: impl Into<PathPart>, look: impl FnOnce(&mut Self)) {
        self.path.0.push(part.into());
        look(self);
        self.path.0.pop();
    }

    fn value(&mut self, schema: &Value, value: &Spanned<DeValue<'_>>) {
        let schema = resolve(schema);
        if let Some(variants) = schema.get("oneOf").and_then(Value::as_array) {
            self.one_of(schema, variants, value);
        } else if let Some(variants) = schema.get("anyOf").and_then(Value::as_array) {
            let fits = |variant: &&Value| accepts_type(resolve(variant), value.get_ref());
            match variants.iter().find(fits) {
                Some(variant) => self.value(variant, value),
                None => self.wrong_type(schema, value),
            }
        } else if !accepts_type(schema, value.get_ref()) {
            self.wrong_type(schema, value);
        } else {
            match value.get_ref() {
                DeValue::Table(table) => self.table(schema, table, value.span()),
                DeValue::Array(array) => {
                    self.length(schema, array.len(), value.span());
                    for (i, element) in array.iter().enumerate() {
                        self.enter(i, |walk| walk.value(&schema["items"], element));
                    }
                }
                DeValue::Integer(integer) => self.integer(schema, integer, value.span()),
                DeValue::Float(float) => {
                    let x: f64 = float.as_str().parse().unwrap_or(f64::NAN);
                    if x.is_infinite() && !float.as_str().contains("inf") {
                        self.note(value.span(), "the number is too large".to_owned(), None);
                    }
                }
                _ => {}
            }
        }
    }

    /// An enum: of names, of tables told apart by `kind`, or of tables with one key.
    fn one_of(&mut self, schema: &Value, variants: &[Value], value: &Spanned<DeValue<'_>>) {
        if let Some(names) = variants.iter().map(constant).collect::<Option<Vec<_>>>() {
            match value.get_ref().as_str() {
                Some(name) if names.contains(&name) => {}
                Some(name) => self.unknown("value", name, &names, value.span(), None),
                None => self.wrong_type(schema, value),
            }
            return;
        }
        let Some(table) = value.get_ref().as_table() else {
            self.wrong_type(schema, value);
            return;
        };
        if variants.iter().all(|variant| kind(variant).is_some()) {
            self.tagged(schema, variants, table, value.span());
        } else {
            self.keyed(schema, variants, table, value.span());
        }
    }

    /// An enum of tables told apart by `kind`.
    fn tagged(
        &mut self,
        schema: &Value,
        variants: &[Value],
        table: &DeTable<'_>,
        span: Range<usize>,
    ) {
        let kinds: Vec<&str> = variants.iter().filter_map(kind).collect();
        let Some(tag) = table.get("kind") else {
            let message = format!("missing field `kind`, one of {}", suggest::list_any(kinds));
            self.note(span, message, description(schema));
            return;
        };
        let Some(name) = tag.get_ref().as_str() else {
            let message = format!(
                "invalid type: {}, expected one of {}",
                found(tag.get_ref()),
                suggest::list_any(kinds)
            );
            self.enter("kind", |walk| walk.note(tag.span(), message, None));
            return;
        };
        match variants.iter().find(|variant| kind(variant) == Some(name)) {
            None => {
                let is_boundary = self.path.0.last() == Some(&PathPart::Key("boundary".to_owned()));
                let help = is_boundary.then(|| {
                    "a medium needs a closed convex boundary: a sphere or a box".to_owned()
                });
                self.enter("kind", |walk| walk.unknown("kind", name, &kinds, tag.span(), help));
            }
            Some(_) if self.path.0.len() > PATH_LEN_MAX => {
                let message = format!("groups are nested more than {GROUP_NESTING_MAX} deep");
                self.note(span, message, None);
            }
            Some(variant) => self.table(variant, table, span),
        }
    }

    /// An enum of tables with one key, which says which variant it is.
    fn keyed(
        &mut self,
        schema: &Value,
        variants: &[Value],
        table: &DeTable<'_>,
        span: Range<usize>,
    ) {
        let keys: Vec<&str> = variants
            .iter()
            .filter_map(|variant| properties(variant)?.keys().next())
            .map(String::as_str)
            .collect();
        if table.len() != 1 {
            let message = format!(
                "expected exactly one of {}, found {}",
                suggest::list_any(keys.iter().copied()),
                table.len()
            );
            self.note(span, message, description(schema));
        }
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            let property = variants.iter().find_map(|variant| properties(variant)?.get(name));
            match property {
                Some(property) => self.enter(name, |walk| walk.value(property, value)),
                None => self.unknown("field", name, &keys, key.span(), None),
            }
        }
    }

    /// A table with fields of its own, or one from names to values of one type.
    fn table(&mut self, schema: &Value, table: &DeTable<'_>, span: Range<usize>) {
        let no_fields = Map::new();
        let fields = properties(schema).unwrap_or(&no_fields);
        let mut meant = Vec::new();
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            if let Some(field) = fields.get(name) {
                self.enter(name, |walk| walk.value(field, value));
            } else if schema["additionalProperties"].is_object() {
                self.enter(name, |walk| walk.value(&schema["additionalProperties"], value));
            } else {
                let names: Vec<&str> = fields.keys().map(String::as_str).collect();
                meant.extend(suggest::closest(name, names.iter().copied()));
                let help =
                    format!("the fields here are {}", suggest::list_all(names.iter().copied()));
                self.unknown("field", name, &names, key.span(), Some(help));
            }
        }
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            // A misspelt field is not missing.
            if !table.contains_key(name) && !meant.contains(&name) {
                let field = &fields[name];
                let expected = expected(field);
                let help = match description(field) {
                    Some(about) => format!("`{name}` is {expected}: {about}"),
                    None => format!("`{name}` is {expected}"),
                };
                self.note(span.clone(), format!("missing field `{name}`"), Some(help));
            }
        }
    }

    fn length(&mut self, schema: &Value, len: usize, span: Range<usize>) {
        let limit = |key: &str| schema[key].as_u64();
        let too_short = limit("minItems").is_some_and(|min| (len as u64) < min);
        let too_long = limit("maxItems").is_some_and(|max| len as u64 > max);
        if too_short || too_long {
            let s = if len == 1 { "" } else { "s" };
            let message = format!("expected {}, found {len} element{s}", expected(schema));
            self.note(span, message, None);
        }
    }

    fn integer(&mut self, schema: &Value, integer: &DeInteger<'_>, span: Range<usize>) {
        let value = i128::from_str_radix(integer.as_str(), integer.radix()).ok();
        let (min, max) = match schema["format"].as_str() {
            Some("uint32") => (0, i128::from(u32::MAX)),
            Some("uint64") => (0, i128::from(u64::MAX)),
            // A number: any integer that serde passes on, 64 bits wide.
            _ => (i128::from(i64::MIN), i128::from(u64::MAX)),
        };
        if !value.is_some_and(|value| (min..=max).contains(&value)) {
            let message = format!("{integer} is out of range: expected {}", expected(schema));
            let help = format!("it must be from {min} to {max}");
            self.note(span, message, Some(help));
        }
    }

    fn wrong_type(&mut self, schema: &Value, value: &Spanned<DeValue<'_>>) {
        let message =
            format!("invalid type: {}, expected {}", found(value.get_ref()), expected(schema));
        self.note(value.span(), message, description(schema));
    }

    /// A name that is not among `known`.
    fn unknown(
        &mut self,
        what: &str,
        name: &str,
        known: &[&str],
        span: Range<usize>,
        help: Option<String>,
    ) {
        let known = known.iter().copied();
        let message = match suggest::closest(name, known.clone()) {
            Some(near) => format!("unknown {what} `{name}`, did you mean `{near}`?"),
            None => {
                format!("unknown {what} `{name}`, expected {}", suggest::list_any(known.clone()))
            }
        };
        let help = help.or_else(|| Some(format!("possible are {}", suggest::list_all(known))));
        self.note(span, message, help);
    }
}

/// What a reference refers to.
fn resolve(schema: &Value) -> &Value {
    let target = |reference: &str| schema::root().pointer(reference.strip_prefix('#')?);
    schema.get("$ref").and_then(Value::as_str).and_then(target).unwrap_or(schema)
}

fn properties(schema: &Value) -> Option<&Map<String, Value>> {
    schema.get("properties")?.as_object()
}

fn constant(schema: &Value) -> Option<&str> {
    schema.get("const")?.as_str()
}

fn kind(variant: &Value) -> Option<&str> {
    constant(properties(variant)?.get("kind")?)
}

fn description(schema: &Value) -> Option<String> {
    let text =
        schema.get("description").or_else(|| resolve(schema).get("description"))?.as_str()?;
    Some(text.trim_end_matches('.').to_owned())
}

/// Does the type of `value`, without its inside, suit the schema?
fn accepts_type(schema: &Value, value: &DeValue<'_>) -> bool {
    let accepts = |name: &str| {
        matches!(
            (name, value),
            ("object", DeValue::Table(_))
                | ("array", DeValue::Array(_))
                | ("string", DeValue::String(_))
                | ("integer", DeValue::Integer(_))
                | ("number", DeValue::Integer(_) | DeValue::Float(_))
                | ("boolean", DeValue::Boolean(_))
        )
    };
    // Something that may be left out, of a type that is itself one of several.
    if let Some(variants) = schema.get("anyOf").and_then(Value::as_array) {
        return variants.iter().any(|variant| accepts_type(resolve(variant), value));
    }
    match &schema["type"] {
        Value::String(name) => accepts(name),
        Value::Array(names) => names.iter().filter_map(Value::as_str).any(accepts),
        _ => false,
    }
}

/// What a value is, in an error about its type.
fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) if text.len() <= 32 => format!("string {text:?}"),
        DeValue::Integer(_) | DeValue::Float(_) => "number".to_owned(),
        DeValue::Datetime(_) => "date".to_owned(),
        other => other.type_str().to_owned(),
    }
}

/// What a schema wants, in an error about something else.
fn expected(schema: &Value) -> String {
    let schema = resolve(schema);
    if let Some(variants) = schema.get("anyOf").and_then(Value::as_array) {
        return variants.iter().map(expected).collect::<Vec<_>>().join(" or ");
    }
    if let Some(variants) = schema.get("oneOf").and_then(Value::as_array) {
        let names: Option<Vec<_>> = variants.iter().map(constant).collect();
        return names
            .map_or("a table".to_owned(), |names| format!("one of {}", suggest::list_any(names)));
    }
    let name = match &schema["type"] {
        Value::Array(names) => names.first().and_then(Value::as_str),
        name => name.as_str(),
    };
    match name {
        Some("array") => match schema["minItems"].as_u64() {
            Some(n) => format!("an array of {n} {}", plural(&schema["items"])),
            None => format!("an array of {}", plural(&schema["items"])),
        },
        Some("object") => "a table".to_owned(),
        Some("integer") => "a whole number".to_owned(),
        Some(name) => format!("a {name}"),
        None => "something else".to_owned(),
    }
}

fn plural(schema: &Value) -> String {
    let schema = resolve(schema);
    match (schema["type"].as_str(), schema["minItems"].as_u64()) {
        (Some("array"), Some(n)) => format!("arrays of {n} {}", plural(&schema["items"])),
        (Some("number"), _) => "numbers".to_owned(),
        (Some("string"), _) => "strings".to_owned(),
        _ => "tables".to_owned(),
    }
}
