//! The glTF file that is being made.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

/// Lists of JSON and the bytes behind them.
pub(super) struct GltfFile {
    root: Map<String, Value>,
    bin: Vec<u8>,
    extensions: BTreeSet<&'static str>,
}

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

impl GltfFile {
    pub(super) fn new() -> Self {
        let mut root = Map::new();
        let generator = concat!("zrak ", env!("CARGO_PKG_VERSION"));
        root.insert("asset".into(), json!({"version": "2.0", "generator": generator}));
        root.insert("scene".into(), json!(0));
        Self { root, bin: Vec::new(), extensions: BTreeSet::new() }
    }

    /// Adds to a list; gives the index.
    pub(super) fn push(&mut self, list: &str, value: Value) -> usize {
        match self.root.entry(list).or_insert_with(|| json!([])) {
            Value::Array(list) => {
                list.push(value);
                list.len() - 1
            }
            // All lists are made here.
            _ => 0,
        }
    }

    /// Sets an extension of the whole file.
    pub(super) fn set_extension(&mut self, name: &'static str, value: Value) {
        self.uses(name);
        self.root.insert("extensions".into(), json!({name: value}));
    }

    /// Notes that an extension is used.
    pub(super) fn uses(&mut self, extension: &'static str) {
        self.extensions.insert(extension);
    }

    /// Adds a view of bytes.
    pub(super) fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.push("bufferViews", view)
    }

    /// Adds an accessor of numbers, at least one; `has_range` writes the smallest and largest.
    pub(super) fn floats<const N: usize>(
        &mut self,
        numbers: &[[f32; N]],
        has_range: bool,
    ) -> usize {
        let bytes: Vec<u8> = numbers.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let mut accessor = json!({
            "bufferView": view, "componentType": 5126, "type": format!("VEC{N}"),
            "count": numbers.len()
        });
        if has_range {
            let (mut lo, mut hi) = ([f32::INFINITY; N], [f32::NEG_INFINITY; N]);
            for v in numbers {
                for (i, &x) in v.iter().enumerate() {
                    lo[i] = lo[i].min(x);
                    hi[i] = hi[i].max(x);
                }
            }
            accessor["min"] = json!(lo.to_vec());
            accessor["max"] = json!(hi.to_vec());
        }
        self.push("accessors", accessor)
    }

    /// Adds an accessor of the corners of triangles among `n` vertices.
    pub(super) fn triangles(&mut self, triangles: &[[u32; 3]], n: usize) -> usize {
        let corners = triangles.as_flattened();
        let is_short = n < usize::from(u16::MAX);
        let bytes: Vec<u8> = match is_short {
            true => corners.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(),
            false => corners.iter().flat_map(|i| i.to_le_bytes()).collect(),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let component = if is_short { 5123 } else { 5125 };
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": component, "type": "SCALAR",
                   "count": corners.len()}),
        )
    }

    /// The JSON and the bytes.
    pub(super) fn finish(mut self) -> (Vec<u8>, Vec<u8>) {
        if !self.bin.is_empty() {
            self.push("buffers", json!({"byteLength": self.bin.len()}));
        }
        if !self.extensions.is_empty() {
            self.root.insert("extensionsUsed".into(), json!(self.extensions));
        }
        (Value::Object(self.root).to_string().into_bytes(), self.bin)
    }
}
