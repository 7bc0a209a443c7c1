//! Writing PLY files: little-endian bytes, with every attribute. For tangents and groups, programs agree
//! on no names; zrak's own are read back.

use std::io::{self, Write};

use crate::TriangleMesh;

/// Writes a mesh. The names of groups are left out.
///
/// # Errors
/// If writing fails.
pub fn write(out: &mut impl Write, mesh: &TriangleMesh) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(out, "element vertex {}", mesh.positions.len())?;
    let (normals, uvs, colors) =
        (!mesh.normals.is_empty(), !mesh.uvs.is_empty(), !mesh.colors.is_empty());
    let (tangents, groups) = (!mesh.tangents.is_empty(), !mesh.face_groups.is_empty());
    let names = [
        (true, "x y z"),
        (normals, "nx ny nz"),
        (uvs, "u v"),
        (colors, "red green blue alpha"),
        (tangents, "tx ty tz tw"),
    ];
    for name in names.iter().filter(|n| n.0).flat_map(|n| n.1.split(' ')) {
        writeln!(out, "property float {name}")?;
    }
    writeln!(out, "element face {}", mesh.triangles.len())?;
    writeln!(out, "property list uchar int vertex_indices")?;
    if groups {
        writeln!(out, "property uint group")?;
    }
    writeln!(out, "end_header")?;
    let mut record = Vec::with_capacity(64);
    for (i, p) in mesh.positions.iter().enumerate() {
        record.clear();
        let mut put = |values: &[f32]| record.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        put(p);
        if normals {
            put(&mesh.normals[i]);
        }
        if uvs {
            put(&mesh.uvs[i]);
        }
        if colors {
            put(&mesh.colors[i]);
        }
        if tangents {
            put(&mesh.tangents[i]);
        }
        out.write_all(&record)?;
    }
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let mut record = [3_u8; 13];
        for (place, v) in record[1..].chunks_exact_mut(4).zip(triangle) {
            place.copy_from_slice(&v.to_le_bytes());
        }
        out.write_all(&record)?;
        if groups {
            out.write_all(&mesh.face_groups[i].to_le_bytes())?;
        }
    }
    Ok(())
}
