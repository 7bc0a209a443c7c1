//! From a file to a scene description.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use zrak_mesh::{Error, Limits, TriangleMesh, obj};
use zrak_scene::defaults;
use zrak_scene::desc::{MeshDesc, ObjectDesc, SceneDesc, Triple};
use zrak_scene::error::{SceneError, SceneErrorKind};
use zrak_scene::lower::stays_inside;

use crate::materials::Materials;
use crate::mtl::{self, Mtl};
use crate::textures::Textures;
use crate::{ImportOptions, Imported, Warning};

/// Reads an .obj file, which may be gzip-ed, and the .mtl files that it names.
///
/// # Errors
/// If a file cannot be read, is not what its name says, or is larger than it may be. The error shows the
/// place. An .mtl file that is not there is worth a warning.
pub fn import(path: &Path, options: &ImportOptions) -> Result<Imported, SceneError> {
    let limits = Limits { max_bytes: options.max_bytes };
    let bytes = zrak_mesh::read_file(path, &limits).map_err(|e| located(path, &e))?;
    let n_bytes = bytes.len() as u64;
    let obj = obj::parse(&bytes, &limits).map_err(|e| located(path, &e))?;
    drop(bytes);
    let base_dir = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => ".".into(),
    };
    let mut warnings: Vec<Warning> = obj
        .warnings
        .iter()
        .map(|(line, message)| Warning {
            file: path.to_owned(),
            line: *line,
            message: message.clone(),
        })
        .collect();
    let left = options.max_bytes.saturating_sub(n_bytes);
    let libraries = Libraries { obj_path: path, base_dir: &base_dir, options };
    let library = libraries.read(&obj.libraries, left, &mut warnings)?;
    let bounds = bounds(&obj.mesh);
    let size = (0..3).map(|i| (bounds[1][i] - bounds[0][i]).powi(2)).sum::<f64>().sqrt();
    let mut materials = Materials {
        textures: Textures::new(&base_dir),
        materials: BTreeMap::new(),
        has_light: false,
        has_colors: !obj.mesh.colors.is_empty(),
        size,
    };
    let names = name_materials(&obj, &library, &mut materials, path, &mut warnings);
    let (material, group_materials) = match &names[..] {
        [only] => (only.clone(), Vec::new()),
        all => (all[0].clone(), all.to_vec()),
    };
    let mesh_name = mesh_name(path);
    let object = ObjectDesc::Mesh {
        mesh: mesh_name.clone(),
        material,
        group_materials,
        flip: false,
        transform: Vec::new(),
    };
    let mut desc = SceneDesc {
        name: mesh_name.clone(),
        camera: defaults::frame_camera(bounds, options.height.clamp(1, 8192)),
        textures: materials.textures.textures,
        materials: materials.materials,
        meshes: BTreeMap::from([(mesh_name, MeshDesc::Loaded(Arc::new(obj.mesh)))]),
        objects: vec![object],
        ..SceneDesc::default()
    };
    if !materials.has_light && options.default_light {
        desc.background = defaults::default_background();
    }
    Ok(Imported { desc, base_dir, warnings })
}

/// An error in a file, shown at its place.
fn located(path: &Path, error: &Error) -> SceneError {
    let origin = path.display().to_string();
    let message = error.message().to_owned();
    match error.place() {
        Some(place) => {
            let text = (place.line, place.text.as_str());
            SceneError::line(SceneErrorKind::Invalid, &origin, text, place.span.clone(), message)
        }
        None => SceneError::file(SceneErrorKind::Invalid, &origin, message, None),
    }
}

/// The stem of the file's name, without `.obj` and `.gz`, or something else to call a mesh.
fn mesh_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = name.split(".obj").next().unwrap_or_default();
    let stem: String = stem.chars().filter(|c| !c.is_control()).take(80).collect();
    if stem.is_empty() { "mesh".to_owned() } else { stem }
}

fn bounds(mesh: &TriangleMesh) -> [Triple; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    // Vertices that no face has may be anywhere.
    for &v in mesh.triangles.iter().flatten() {
        let p = mesh.positions[v as usize];
        for axis in 0..3 {
            let x = f64::from(p[axis]);
            bounds[0][axis] = bounds[0][axis].min(x);
            bounds[1][axis] = bounds[1][axis].max(x);
        }
    }
    bounds
}

/// A material and the folder of its file, relative to the scene's.
type Library = HashMap<String, (Mtl, String, std::path::PathBuf)>;

/// Names of the scene's materials, for each group of the mesh; at least one.
fn name_materials(
    obj: &obj::Obj,
    library: &Library,
    materials: &mut Materials<'_>,
    path: &Path,
    warnings: &mut Vec<Warning>,
) -> Vec<String> {
    if !obj.has_materials {
        return vec![materials.default_material()];
    }
    let mut default_name = None;
    let mut used = vec![obj.mesh.face_groups.is_empty(); obj.mesh.groups.len()];
    for &group in &obj.mesh.face_groups {
        used[group as usize] = true;
    }
    let mut names: Vec<String> = Vec::with_capacity(used.len());
    for ((name, &line), is_used) in obj.mesh.groups.iter().zip(&obj.group_lines).zip(used) {
        match library.get(name).filter(|_| is_used) {
            Some((mtl, folder, file)) => {
                let mut warn = |line: usize, message: String| {
                    warnings.push(Warning { file: file.clone(), line, message });
                };
                names.push(materials.translate(mtl, folder, &mut warn));
            }
            None => {
                if is_used && line > 0 && !library.is_empty() {
                    let message = format!("there is no material `{name}`: its faces are grey");
                    warnings.push(Warning { file: path.to_owned(), line, message });
                }
                let name = default_name.get_or_insert_with(|| materials.default_material());
                names.push(name.clone());
            }
        }
    }
    names
}

struct Libraries<'a> {
    obj_path: &'a Path,
    base_dir: &'a Path,
    options: &'a ImportOptions,
}

impl Libraries<'_> {
    /// Reads all that are named; of materials of one name the first counts.
    fn read(
        &self,
        named: &[(String, usize)],
        mut left: u64,
        warnings: &mut Vec<Warning>,
    ) -> Result<Library, SceneError> {
        let mut library = Library::new();
        let mut done: Vec<String> = Vec::new();
        for (names, line) in named {
            for name in self.split(names) {
                if done.contains(&name) || done.len() >= 1000 {
                    continue;
                }
                done.push(name.clone());
                let file = self.base_dir.join(&name);
                let note = |message: String| Warning {
                    file: self.obj_path.to_owned(),
                    line: *line,
                    message,
                };
                if !self.options.allow_external && !stays_inside(self.base_dir, Path::new(&name)) {
                    let message = format!("`{name}` is outside of the scene's folder");
                    let help = "move the file there, or allow files from elsewhere with \
                                --allow-external";
                    let origin = format!("{}:{line}", self.obj_path.display());
                    let kind = SceneErrorKind::Invalid;
                    return Err(SceneError::file(kind, &origin, message, Some(help)));
                }
                if !file.is_file() {
                    let message = format!("there is no file `{name}`: its materials are grey");
                    warnings.push(note(message));
                    continue;
                }
                let limits = Limits { max_bytes: left };
                let bytes = zrak_mesh::read_file(&file, &limits).map_err(|e| located(&file, &e))?;
                left -= bytes.len() as u64;
                let warn = |line: usize, message: String| {
                    warnings.push(Warning { file: file.clone(), line, message });
                };
                let all = mtl::parse(&bytes, warn).map_err(|e| located(&file, &e))?;
                let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
                for mtl in all {
                    if library.contains_key(&mtl.name) {
                        let message = format!("another material `{}` came before", mtl.name);
                        warnings.push(Warning { file: file.clone(), line: mtl.line, message });
                        continue;
                    }
                    library.insert(mtl.name.clone(), (mtl, folder.to_owned(), file.clone()));
                }
            }
        }
        Ok(library)
    }

    /// What follows `mtllib` is one name with spaces, if there is such a file, or several names.
    fn split(&self, names: &str) -> Vec<String> {
        let names = names.replace('\\', "/");
        if !names.contains(char::is_whitespace) || self.base_dir.join(&names).is_file() {
            return vec![names];
        }
        let each: Vec<String> = names.split_whitespace().map(str::to_owned).collect();
        if each.iter().any(|name| self.base_dir.join(name).is_file()) { each } else { vec![names] }
    }
}
