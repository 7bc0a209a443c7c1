//! Descriptions as TOML text that a person would be glad to read.
//!
//! Textures and materials take one line each; objects are `[[objects]]` tables; the members of a
//! group take one line each, unless one of them is a group itself, for then they are
//! `[[objects.objects]]` tables.

use std::fmt::Write;

use serde_json::{Map, Value};

use crate::desc::SceneDesc;

/// A scene file of this description.
///
/// Reading it gives an equal description: numbers are as short as that allows. A number that is
/// not finite, which no valid description has, becomes `nan`. Meshes in memory are written out.
pub fn write_string(scene: &SceneDesc) -> String {
    let mut scene = scene.clone();
    for mesh in scene.meshes.values_mut() {
        *mesh = mesh.inlined();
    }
    // A description is made of tables, arrays, strings and numbers, so this cannot fail.
    let Ok(Value::Object(fields)) = serde_json::to_value(&scene) else { return String::new() };
    let mut out = "# A scene for zrak; docs/scene-format.md explains the format.\n\n".to_owned();
    for (key, value) in fields.iter().filter(|(_, value)| !value.is_object() && !value.is_array()) {
        line(&mut out, key, value);
    }
    for (key, value) in &fields {
        match value {
            // Names of the author's choice: one line each.
            Value::Object(table) => section(&mut out, key, table),
            Value::Array(objects) => tables(&mut out, key, objects),
            _ => {}
        }
    }
    out
}

/// `[name]` and its lines.
fn section(out: &mut String, name: &str, table: &Map<String, Value>) {
    let _ = writeln!(out, "\n[{name}]");
    for (key, value) in table {
        line(out, key, value);
    }
}

/// A `[[name]]` for each object.
fn tables(out: &mut String, name: &str, objects: &[Value]) {
    for object in objects.iter().filter_map(Value::as_object) {
        let _ = writeln!(out, "\n[[{name}]]");
        // A group's members come last: nothing of the group can follow their tables.
        for (key, value) in object.iter().filter(|(key, _)| *key != MEMBERS) {
            line(out, key, value);
        }
        let Some(members) = object.get(MEMBERS).and_then(Value::as_array) else { continue };
        if members.iter().any(|member| member.get(MEMBERS).is_some()) {
            tables(out, &format!("{name}.{MEMBERS}"), members);
        } else {
            let _ = writeln!(out, "{MEMBERS} = [");
            for member in members {
                out.push_str("    ");
                inline(out, member);
                out.push_str(",\n");
            }
            out.push_str("]\n");
        }
    }
}

/// The field of a group that holds its members.
const MEMBERS: &str = "objects";

/// `key = value`.
fn line(out: &mut String, name: &str, value: &Value) {
    key(out, name);
    out.push_str(" = ");
    inline(out, value);
    out.push('\n');
}

/// A value on one line.
fn inline(out: &mut String, value: &Value) {
    match value {
        Value::Null => out.push_str("nan"),
        Value::Bool(value) => {
            let _ = write!(out, "{value}");
        }
        Value::Number(number) => match number.as_f64() {
            Some(x) if number.is_f64() => float(out, x),
            _ => {
                let _ = write!(out, "{number}");
            }
        },
        Value::String(text) => string(out, text),
        Value::Array(elements) => {
            out.push('[');
            for (i, element) in elements.iter().enumerate() {
                out.push_str(if i > 0 { ", " } else { "" });
                inline(out, element);
            }
            out.push(']');
        }
        Value::Object(table) => {
            out.push('{');
            for (i, (name, value)) in table.iter().enumerate() {
                out.push_str(if i > 0 { ", " } else { " " });
                key(out, name);
                out.push_str(" = ");
                inline(out, value);
            }
            out.push_str(" }");
        }
    }
}

/// The shortest decimal that reads back as `x`; without a point where that is exact.
fn float(out: &mut String, x: f64) {
    let is_short_integer = x == x.trunc() && x.abs() < 1e15 && !(x == 0.0 && x.is_sign_negative());
    let _ = if is_short_integer { write!(out, "{}", x as i64) } else { write!(out, "{x:?}") };
}

fn key(out: &mut String, name: &str) {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(is_bare) {
        out.push_str(name);
    } else {
        string(out, name);
    }
}

/// A basic string.
fn string(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
}
