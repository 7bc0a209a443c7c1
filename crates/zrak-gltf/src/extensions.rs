//! Which extensions are known.

use crate::error::{Error, ErrorKind, Warnings};
use crate::json::Root;

/// Those that are read, at least in part.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Those that change nothing of the picture if they are skipped, or are named where they matter.
const HARMLESS: &[&str] = &[
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_materials_variants",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Refuses a file that needs what zrak lacks.
pub(crate) fn check(root: &Root, warnings: &mut Warnings) -> Result<(), Error> {
    for (i, name) in root.extensions_required.iter().enumerate() {
        let is_read = READ.contains(&name.as_str());
        // Compressed primitives are refused where they are used, so that others can be read.
        if is_read || name == "KHR_draco_mesh_compression" {
            continue;
        }
        let message = format!("the file needs the extension {}, which zrak lacks", shown(name));
        let help = "export it without the extension";
        let at = format!("extensionsRequired[{i}]");
        return Err(Error::new(ErrorKind::Unsupported, at, message, help));
    }
    for (i, name) in root.extensions_used.iter().enumerate() {
        if ![READ, HARMLESS].iter().any(|known| known.contains(&name.as_str())) {
            let message = format!("the extension {} is unknown and ignored", shown(name));
            warnings.note(format_args!("extensionsUsed[{i}]"), message);
        }
    }
    Ok(())
}

fn shown(name: &str) -> String {
    name.chars().take(60).filter(|c| !c.is_control()).collect()
}
