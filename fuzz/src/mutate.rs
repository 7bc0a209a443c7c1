//! Changes of scenes that leave them scenes.
//!
//! Bytes that are changed at random rarely stay a scene file. These changes are made to the tree of values:
//! numbers become other numbers, values are taken out, doubled, exchanged for others of the scene, or made
//! up by the format's schema, so that every kind of thing turns up in every place where it may be.

use std::sync::OnceLock;

use serde_json::{Map, Value, json};

/// Numbers where something changes.
const NUMBERS: [f64; 28] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    0.1,
    1e-3,
    1e-6,
    1e-7,
    1e-12,
    9e-13,
    1e-20,
    1e6,
    1e9,
    1e12,
    -1e12,
    1.1e12,
    1e38,
    1e300,
    90.0,
    180.0,
    360.0,
    179.999,
    0.999_999_99,
    1.5,
    5e-324,
    1e-45,
];

/// Names that made-up things have and refer to.
const NAMES: [&str; 6] = ["a", "b", "c", "d", "embedded:small.pfm", "embedded:small.png"];

/// How deep made-up values may be nested.
const DEPTH_MAX: usize = 7;

/// Random numbers: SplitMix64.
struct Rng(u64);

impl Rng {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn number(&mut self) -> f64 {
        match self.below(4) {
            0 => NUMBERS[self.below(NUMBERS.len())],
            1 => self.below(9) as f64 - 4.0,
            _ => (self.below(2001) as f64 - 1000.0) / 500.0,
        }
    }
}

/// A changed scene file; nothing if the bytes are not one, or the change has no place in `max_size` bytes.
pub fn mutate_scene(text: &[u8], max_size: usize, seed: u32) -> Option<String> {
    let mut rng = Rng(u64::from(seed));
    let mut scene: Value = toml::from_str(std::str::from_utf8(text).ok()?).ok()?;
    for _ in 0..1 + rng.below(4) {
        change(&mut scene, &mut rng);
    }
    let text = toml::to_string(&scene).ok()?;
    (text.len() <= max_size).then_some(text)
}

/// Makes one change somewhere.
fn change(scene: &mut Value, rng: &mut Rng) {
    if rng.one_in(3) {
        add_something(scene, rng);
        return;
    }
    let other = {
        let mut all = Vec::new();
        collect(scene, schema(), &mut all);
        let (value, value_schema) = all[rng.below(all.len())];
        (value.clone(), value_schema)
    };
    // One of the values that the schema has a say about.
    let mut n = 0;
    visit(scene, schema(), &mut |_, _| n += 1);
    let chosen = rng.below(n);
    let mut i = 0;
    visit(scene, schema(), &mut |value, here| {
        if i == chosen {
            change_value(value, here, &other, rng);
        }
        i += 1;
    });
}

fn change_value(
    value: &mut Value,
    schema: &'static Value,
    other: &(Value, &'static Value),
    rng: &mut Rng,
) {
    if std::ptr::eq(other.1, schema) && rng.one_in(3) {
        *value = other.0.clone();
        return;
    }
    match value {
        Value::Number(number) => {
            let x = number.as_f64().unwrap_or(0.0);
            let is_integer = schema["type"] == "integer";
            let y = match rng.below(4) {
                0 => x * 2.0,
                1 => x / 2.0,
                2 => -x,
                _ => rng.number(),
            };
            *value = if is_integer { json!(y.abs() as u64 & 0xffff_ffff) } else { json!(y) };
        }
        Value::Bool(b) => *b = !*b,
        Value::Array(array) if !array.is_empty() && rng.one_in(2) => {
            let i = rng.below(array.len());
            match rng.below(3) {
                0 => drop(array.remove(i)),
                1 => array.push(array[i].clone()),
                _ => {
                    let j = rng.below(array.len());
                    array.swap(i, j);
                }
            }
        }
        Value::Object(table) if !table.is_empty() && rng.one_in(2) => {
            let i = rng.below(table.len());
            let key = table.keys().nth(i).cloned().unwrap_or_default();
            if rng.one_in(2) {
                table.remove(&key);
            } else {
                fill_in(table, schema, rng);
            }
        }
        _ => *value = make(schema, DEPTH_MAX - 2, rng),
    }
}

/// Adds a field that a table may have.
fn fill_in(table: &mut Map<String, Value>, schema: &'static Value, rng: &mut Rng) {
    if let Some(fields) = schema.get("properties").and_then(Value::as_object) {
        let Some((name, field)) = fields.iter().nth(rng.below(fields.len())) else { return };
        if field.get("const").is_none() {
            table.insert(name.clone(), make(field, DEPTH_MAX - 2, rng));
        }
    }
}

/// Adds a whole object, material, texture, light, medium or prototype.
fn add_something(scene: &mut Value, rng: &mut Rng) {
    let Some(fields) = schema()["properties"].as_object() else { return };
    let Some((name, field)) = fields.iter().nth(rng.below(fields.len())) else { return };
    let Some(scene) = scene.as_object_mut() else { return };
    let made = make(field, DEPTH_MAX, rng);
    match (scene.get_mut(name), made) {
        (Some(Value::Array(old)), Value::Array(new)) => old.extend(new.into_iter().take(2)),
        (Some(Value::Object(old)), Value::Object(new)) if field.get("$ref").is_none() => {
            old.extend(new.into_iter().take(2));
        }
        (_, made) => drop(scene.insert(name.clone(), made)),
    }
}

/// A value that fits a schema.
fn make(schema: &'static Value, depth: usize, rng: &mut Rng) -> Value {
    let schema = resolve(schema);
    for choice in ["oneOf", "anyOf"] {
        if let Some(variants) = schema.get(choice).and_then(Value::as_array) {
            // Deep down, the first of them is the simplest.
            let i = if depth == 0 { 0 } else { rng.below(variants.len()) };
            return make(&variants[i], depth, rng);
        }
    }
    if let Some(value) = schema.get("const") {
        return value.clone();
    }
    if let Some(names) = schema.get("enum").and_then(Value::as_array) {
        return names[rng.below(names.len())].clone();
    }
    let kind = match &schema["type"] {
        Value::Array(kinds) => kinds[0].as_str(),
        kind => kind.as_str(),
    };
    match kind {
        Some("number") => json!(rng.number()),
        Some("integer") => json!(rng.below(9)),
        Some("boolean") => json!(rng.one_in(2)),
        Some("string") => json!(NAMES[rng.below(NAMES.len())]),
        Some("array") => {
            let least = schema["minItems"].as_u64().unwrap_or(0) as usize;
            let most = schema["maxItems"].as_u64().unwrap_or(3) as usize;
            let n =
                if depth == 0 { least } else { least + rng.below(most.saturating_sub(least) + 1) };
            (0..n).map(|_| make(&schema["items"], depth.saturating_sub(1), rng)).collect()
        }
        Some("object") => table(schema, depth, rng),
        _ => json!(0),
    }
}

fn table(schema: &'static Value, depth: usize, rng: &mut Rng) -> Value {
    let mut table = Map::new();
    let required = schema["required"].as_array().map_or(&[][..], Vec::as_slice);
    if let Some(fields) = schema.get("properties").and_then(Value::as_object) {
        for (name, field) in fields {
            let must = required.iter().any(|r| r == name);
            if must || depth > 0 && rng.one_in(4) {
                table.insert(name.clone(), make(field, depth.saturating_sub(1), rng));
            }
        }
    } else if let Some(values @ Value::Object(_)) = schema.get("additionalProperties") {
        for _ in 0..=rng.below(2) {
            let name = NAMES[rng.below(4)].to_owned();
            table.insert(name, make(values, depth.saturating_sub(1), rng));
        }
    }
    Value::Object(table)
}

/// Calls `f` for a value and everything in it, with the schemas that they fit.
fn visit(
    value: &mut Value,
    schema: &'static Value,
    f: &mut impl FnMut(&mut Value, &'static Value),
) {
    let Some(schema) = fitting(schema, value) else { return };
    f(value, schema);
    match value {
        Value::Array(array) => array.iter_mut().for_each(|v| visit(v, &schema["items"], f)),
        Value::Object(table) => {
            for (name, v) in table.iter_mut() {
                if let Some(field) = field(schema, name) {
                    visit(v, field, f);
                }
            }
        }
        _ => {}
    }
}

fn collect<'a>(
    value: &'a Value,
    schema: &'static Value,
    all: &mut Vec<(&'a Value, &'static Value)>,
) {
    let Some(schema) = fitting(schema, value) else { return };
    all.push((value, schema));
    match value {
        Value::Array(array) => array.iter().for_each(|v| collect(v, &schema["items"], all)),
        Value::Object(table) => {
            for (name, v) in table {
                if let Some(field) = field(schema, name) {
                    collect(v, field, all);
                }
            }
        }
        _ => {}
    }
}

/// The schema of a field.
fn field(schema: &'static Value, name: &str) -> Option<&'static Value> {
    match schema.get("properties") {
        Some(fields) => fields.get(name),
        None => schema.get("additionalProperties").filter(|values| values.is_object()),
    }
}

/// The variant of a schema that a value is of.
fn fitting(schema: &'static Value, value: &Value) -> Option<&'static Value> {
    let schema = resolve(schema);
    let variants = schema.get("oneOf").or_else(|| schema.get("anyOf")).and_then(Value::as_array);
    let Some(variants) = variants else { return Some(schema) };
    let fits = |variant: &&'static Value| {
        let variant = resolve(variant);
        let kind = &variant["properties"]["kind"]["const"];
        let is_type = |name: &str| match value {
            Value::Number(_) => name == "number" || name == "integer",
            Value::String(_) => name == "string",
            Value::Bool(_) => name == "boolean",
            Value::Array(_) => name == "array",
            Value::Object(_) => name == "object",
            Value::Null => name == "null",
        };
        let has_keys = || {
            let required = variant["required"].as_array().map_or(&[][..], Vec::as_slice);
            required.iter().all(|key| key.as_str().is_some_and(|key| value.get(key).is_some()))
        };
        match variant.get("const") {
            Some(constant) => constant == value,
            None if kind.is_string() => value.get("kind") == Some(kind),
            None => variant["type"].as_str().is_none_or(is_type) && has_keys(),
        }
    };
    // A name among other names is of the whole.
    variants.iter().find(fits).map(|variant| {
        let variant = resolve(variant);
        if variant.get("const").is_some() {
            schema
        } else {
            fitting(variant, value).unwrap_or(variant)
        }
    })
}

fn resolve(schema: &'static Value) -> &'static Value {
    match schema.get("$ref").and_then(Value::as_str) {
        Some(path) => &self::schema()["$defs"][path.trim_start_matches("#/$defs/")],
        None => schema,
    }
}

fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| {
        serde_json::from_str(&zrak_scene::schema::json_schema()).expect("the schema is JSON")
    })
}
