//! Small glTF files, made in memory.

#![allow(dead_code, unreachable_pub)] // Each test file uses some of it, as a module of its own.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use zrak_gltf::{Error, ImportOptions, Imported, parse_gltf};
use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{MaterialDesc, MeshDesc, PrincipledDesc};

/// The smallest PNG there is to be: one grey texel.
pub const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";

pub struct Builder {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl Builder {
    /// A file with nothing in it.
    pub fn new() -> Self {
        Self { json: json!({"asset": {"version": "2.0"}}), bin: Vec::new() }
    }

    /// A file with one node that shows a triangle of this material, as entry 0 of all lists.
    pub fn triangle() -> Self {
        let mut file = Self::new();
        let positions = file.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let primitive = json!({"attributes": {"POSITION": positions}});
        file.push("meshes", json!({"primitives": [primitive]}));
        file.push("nodes", json!({"mesh": 0}));
        file.push("scenes", json!({"nodes": [0]}));
        file
    }

    /// The same with a material and texture coordinates.
    pub fn with_material(material: Value) -> Self {
        let mut file = Self::triangle();
        let uvs = file.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
        file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        file.push("materials", material);
        file.push("images", json!({"uri": "picture.png"}));
        file.push("textures", json!({"source": 0}));
        file
    }

    /// Adds to a list of the file; gives the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = &mut self.json[list];
        if list.is_null() {
            *list = json!([]);
        }
        let list = list.as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// Adds bytes, aligned to 4, as a view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    /// Adds an accessor of a view of its own.
    pub fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({
            "bufferView": view, "type": kind, "componentType": component, "count": count
        });
        self.push("accessors", accessor)
    }

    pub fn floats<const N: usize>(&mut self, numbers: &[[f32; N]]) -> usize {
        let kind = match N {
            1 => "SCALAR",
            16 => "MAT4",
            n => &format!("VEC{n}"),
        };
        let bytes: Vec<u8> = numbers.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let index = self.accessor(kind, 5126, numbers.len(), &bytes);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N).map(|i| numbers.iter().map(|v| v[i]).reduce(pick).unwrap_or(0.0)).collect()
        };
        self.json["accessors"][index]["min"] = json!(bound(f32::min));
        self.json["accessors"][index]["max"] = json!(bound(f32::max));
        index
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor("SCALAR", 5123, indices.len(), &bytes)
    }

    /// The binary form.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bin.is_empty() && json.get("buffers").is_none() && json.is_object() {
            json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let total = 12 + 8 + text.len() + 8 + bin.len();
        let mut bytes = b"glTF".to_vec();
        let words = |words: &[u32]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<_>>();
        bytes.extend(words(&[2, total as u32, text.len() as u32, 0x4e4f_534a]));
        bytes.extend(text);
        bytes.extend(words(&[bin.len() as u32, 0x004e_4942]));
        bytes.extend(bin);
        bytes
    }

    pub fn import_with(&self, options: &ImportOptions) -> Result<Imported, Error> {
        parse_gltf(&self.glb(), &|name, _| Err(format!("there is no {name}")), options)
    }

    pub fn import(&self) -> Result<Imported, Error> {
        self.import_with(&ImportOptions::default())
    }

    /// The file read, with these warnings and no others.
    pub fn import_warned(&self, parts: &[&str]) -> Imported {
        let imported = self.import().unwrap();
        let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(warnings.len(), parts.len(), "{warnings:?}");
        for (warning, part) in warnings.iter().zip(parts) {
            assert!(warning.contains(part), "{warning:?} has no {part:?}");
        }
        imported
    }

    /// The file read without any warning.
    pub fn import_clean(&self) -> Imported {
        self.import_warned(&[])
    }
}

/// The only mesh.
pub fn only_mesh(imported: &Imported) -> &TriangleMesh {
    assert_eq!(imported.desc.meshes.len(), 1);
    match imported.desc.meshes.values().next().unwrap() {
        MeshDesc::Loaded(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

/// The principled material at the bottom of the only one that is used.
pub fn principled(materials: &BTreeMap<String, MaterialDesc>) -> &PrincipledDesc {
    let found = materials.values().find_map(|material| match material {
        MaterialDesc::Principled { surface } => Some(&**surface),
        _ => None,
    });
    found.expect("there is a principled material")
}
