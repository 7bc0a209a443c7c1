//! From a file to a scene description.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::de::SliceRead;
use zrak_scene::desc::SceneDesc;
use zrak_scene::lower::stays_inside;

use crate::budget::Budget;
use crate::buffers::{Buffers, Resolver};
use crate::container;
use crate::error::{Error, ErrorKind, Warning, Warnings};
use crate::extensions;
use crate::hierarchy;
use crate::json::Root;
use crate::materials::Materials;
use crate::options::ImportOptions;
use crate::place::{Placer, is_degenerate};
use crate::primitive::Source;
use crate::textures::Textures;
use crate::{cameras, lights};

/// What a glTF file says.
#[derive(Debug)]
pub struct Imported {
    /// The scene.
    pub desc: SceneDesc,
    /// Folder that the paths in it start from.
    pub base_dir: PathBuf,
    /// The pictures inside the file: the texture path `embedded:NAME` means entry `NAME`.
    pub assets: BTreeMap<String, Arc<[u8]>>,
    /// What was read otherwise than it was meant, or not at all.
    pub warnings: Vec<Warning>,
}

/// Reads a .gltf or .glb file, and the buffers that it refers to.
///
/// # Errors
/// The file or one of its buffers cannot be read, is damaged, contradicts the specification, needs an
/// extension that zrak lacks, or asks for more memory than it may have. Missing pictures are found
/// later, when they are read.
pub fn import(path: &Path, options: &ImportOptions) -> Result<Imported, Error> {
    let base_dir = path.parent().unwrap_or(Path::new("")).to_owned();
    let read = |path: &Path, max: u64| {
        let bytes = read_file(path, max)?;
        options.progress.add(bytes.len() as u64);
        Ok(bytes)
    };
    let bytes = read(path, options.limits.max_bytes).map_err(|cause| {
        let help = "check the path and that it may be read";
        Error::new(ErrorKind::Io, "", format!("cannot read the file: {cause}"), help)
            .in_file(path.display())
    })?;
    let resolver = |name: &str, max: u64| {
        let base = if base_dir.as_os_str().is_empty() { Path::new(".") } else { &base_dir };
        // Paths are checked as text before; a link may still lead anywhere.
        if !options.allow_external && !stays_inside(base, Path::new(name)) {
            return Err("it is outside of the file's folder; --allow-external reads it".to_owned());
        }
        read(&base.join(name), max)
    };
    let mut imported =
        parse_gltf(&bytes, &resolver, options).map_err(|e| e.in_file(path.display()))?;
    if imported.desc.name.is_empty() {
        imported.desc.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    }
    imported.base_dir = base_dir;
    Ok(imported)
}

fn read_file(path: &Path, max: u64) -> Result<Vec<u8>, String> {
    let file = File::open(path).map_err(|e| e.to_string())?;
    if !file.metadata().map_err(|e| e.to_string())?.is_file() {
        return Err("it is not a file".to_owned());
    }
    let mut bytes = Vec::new();
    // One more than allowed tells that there are more.
    file.take(max.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    if bytes.len() as u64 > max {
        return Err(format!("it has more than the {max} bytes it may have"));
    }
    Ok(bytes)
}

/// Reads the bytes of a .gltf or .glb file; `resolver` reads the buffers beside it.
///
/// # Errors
/// As for [`import`], without the file's name.
pub fn parse_gltf(
    bytes: &[u8],
    resolver: &Resolver<'_>,
    options: &ImportOptions,
) -> Result<Imported, Error> {
    let budget = Budget::new(options.limits.max_bytes);
    budget.spend("", bytes.len() as u64, 1)?;
    let container = container::split(bytes)?;
    let root = parse_json(container.json, options)?;
    let mut warnings = Warnings::default();
    extensions::check(&root, &mut warnings)?;
    let buffers = Buffers::load(&root, container.bin, resolver, options.allow_external, &budget)?;
    let source = Source { root: &root, buffers: &buffers, budget: &budget };
    let (desc, assets) = scene(&source, options, &mut warnings)?;
    Ok(Imported { desc, base_dir: PathBuf::new(), assets, warnings: warnings.into_list() })
}

fn parse_json(json: &[u8], options: &ImportOptions) -> Result<Root, Error> {
    // An upper bound, as braces in names count too: a file of nothing but braces would grow a
    // hundredfold in memory.
    let n_objects = json.iter().filter(|&&b| b == b'{').count() as u64;
    let max = options.limits.max_objects;
    if n_objects > max {
        let message = format!("the file has {n_objects} JSON objects; at most {max} are read");
        return Err(Error::new(
            ErrorKind::TooLarge,
            "",
            message,
            "split the scene, or allow more (--max-bytes)",
        ));
    }
    let mut deserializer = serde_json::Deserializer::new(SliceRead::new(json));
    let syntax = |location: &str, e: &serde_json::Error| {
        let help = "the file is damaged or was written by a faulty exporter: export it again";
        Error::new(ErrorKind::Syntax, location, e, help)
    };
    let root: Root = serde_path_to_error::deserialize(&mut deserializer).map_err(|e| {
        let path = e.path().to_string();
        syntax(if path == "." { "" } else { &path }, e.inner())
    })?;
    deserializer.end().map_err(|e| syntax("", &e))?;
    let help = "export it as glTF 2.0";
    let Some(asset) = &root.asset else {
        let message = "there is no version of glTF";
        return Err(Error::new(ErrorKind::NotGltf, "asset", message, help));
    };
    for version in [Some(&asset.version), asset.min_version.as_ref()].into_iter().flatten() {
        if version.split('.').next() != Some("2") {
            let version: String = version.chars().take(20).collect();
            let message = format!("the file is glTF {version}; zrak reads glTF 2");
            return Err(Error::new(ErrorKind::Unsupported, "asset", message, help));
        }
    }
    if asset.min_version.as_ref().is_some_and(|version| version != "2.0") {
        let message = "the file needs a later glTF than 2.0";
        return Err(Error::new(ErrorKind::Unsupported, "asset.minVersion", message, help));
    }
    Ok(root)
}

type Assets = BTreeMap<String, Arc<[u8]>>;

fn scene(
    source: &Source<'_>,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<(SceneDesc, Assets), Error> {
    let root = source.root;
    let hierarchy = hierarchy::read(root, options.scene.as_deref(), warnings)?;
    if !root.animations.is_empty() {
        let message = "animations are not played: the nodes stay where the file has them";
        warnings.note("animations", message);
    }
    let textures = Textures::new(source, options.allow_external);
    let materials = Materials::new(source, textures, options.cull_back_faces);
    let mut placer = Placer::new(source, materials);
    let mut scene_lights = Vec::new();
    let mut camera_nodes = Vec::new();
    for &i in &hierarchy.in_scene {
        let node = &root.nodes[i];
        let extensions = node.extensions.as_deref();
        let light = extensions.and_then(|e| e.light.as_ref());
        let is_needed = node.mesh.is_some() || node.camera.is_some() || light.is_some();
        if !is_needed {
            continue;
        }
        let world = &hierarchy.world_from_node[i];
        // The place of a skinned mesh is its joints' alone.
        let is_placed = node.skin.is_none() || node.mesh.is_none();
        if is_placed && is_degenerate(world) {
            let message = "the node is flat or without size: what is in it is left out";
            warnings.note(format_args!("nodes[{i}]"), message);
            continue;
        }
        if let Some(mesh) = node.mesh {
            placer.mesh(i, node, mesh, &hierarchy, warnings)?;
        }
        if let Some(light) = light {
            let at = format!("nodes[{i}].extensions.KHR_lights_punctual.light");
            let efficacy = options.lumens_per_watt;
            let placed = lights::place(root, light.light, &at, world, efficacy, warnings)?;
            scene_lights.extend(placed);
        }
        if let Some(camera) = node.camera {
            camera_nodes.push((i, camera));
        }
    }
    let chosen = cameras::choose(root, &camera_nodes, options.camera.as_deref(), warnings)?;
    let camera = match chosen {
        Some((node, camera)) => {
            let at = format!("nodes[{node}].camera");
            let world = &hierarchy.world_from_node[node];
            Some(cameras::place(root, camera, &at, world, options.height, warnings)?)
        }
        None => None,
    };
    let placed = placer.finish(warnings)?;
    let camera = camera.unwrap_or_else(|| {
        let bounds = placed.bounds.unwrap_or([[-1.0; 3], [1.0; 3]]);
        zrak_scene::defaults::frame_camera(bounds, options.height.clamp(1, 8192))
    });
    let is_dark = scene_lights.is_empty() && !placed.materials.has_light;
    let mut desc = SceneDesc {
        camera,
        textures: placed.materials.textures.textures,
        materials: placed.materials.materials,
        media: placed.materials.media,
        meshes: placed.meshes,
        prototypes: placed.prototypes,
        lights: scene_lights,
        objects: placed.objects,
        ..SceneDesc::default()
    };
    if is_dark && options.default_light {
        desc.background = zrak_scene::defaults::default_background();
    }
    if let Some(name) = hierarchy.scene.and_then(|i| root.scenes[i].name.as_deref()) {
        desc.name = name.chars().filter(|c| !c.is_control()).take(200).collect();
    }
    Ok((desc, placed.materials.textures.assets))
}
