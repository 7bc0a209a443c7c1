//! Scenes by name or from a file.

mod readers;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use zrak_scene::arena::SceneArena;
use zrak_scene::builtin;
use zrak_scene::compiled::CompiledScene;
use zrak_scene::desc::SceneDesc;
use zrak_scene::file::Source;
use zrak_scene::lower::{
    Embedded, LoadedImage, LowerOptions, MAX_BYTES, MissingTextures, lower_with_warnings,
};
use zrak_scene::progress::LoadProgress;
use zrak_scene::validate::Problem;

use crate::{Error, ErrorKind};

/// A scene without problems, and where it came from.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The scene; free to be changed before it is lowered.
    pub desc: SceneDesc,
    /// Folder that the paths of its images and meshes start from.
    pub base_dir: PathBuf,
    /// The file it came from; `None` for a built-in scene.
    pub path: Option<PathBuf>,
    /// Its text, if it came from a scene file of zrak's own.
    pub source: Option<Source>,
    /// The pictures inside its file: the texture path `embedded:NAME` means entry `NAME`.
    pub embedded: Embedded,
    /// What was not read as it stands in a file of another format.
    pub warnings: Vec<String>,
    /// What was compiled before, if it is a compiled scene: then the description has no objects, and
    /// only its name, camera and sampling can be changed.
    pub compiled: Option<CompiledScene>,
    /// How it was loaded, and will be lowered.
    pub options: LoadOptions,
}

/// What may be read, and how.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Whether files outside of the scene's folder may be read.
    pub allow_external: bool,
    /// Most bytes of all files of a scene together, once they are unpacked; and again of the meshes,
    /// images and other data that are made of them for rendering.
    pub max_bytes: u64,
    /// What becomes of textures whose image cannot be read.
    pub missing_textures: MissingTextures,
    /// Which camera, where a file has several (glTF): the name of its node, or its own, or its number
    /// from 0.
    pub camera: Option<String>,
    /// What only glTF files ask for.
    pub gltf: GltfOptions,
    /// Is told how far loading and lowering are.
    pub progress: LoadProgress,
}

/// How glTF files are read.
#[derive(Clone, Debug)]
pub struct GltfOptions {
    /// Name or number of the scene; without it the file's default.
    pub scene: Option<String>,
    /// Luminous efficacy by which candela and lux become radiometric units; 1 takes the numbers as
    /// they are.
    pub lumens_per_watt: f64,
    /// Whether backs of single-sided surfaces are holes, as rasterisers show them.
    pub cull_back_faces: bool,
}

impl Default for GltfOptions {
    fn default() -> Self {
        let zrak_gltf::ImportOptions { lumens_per_watt, cull_back_faces, .. } =
            zrak_gltf::ImportOptions::default();
        Self { scene: None, lumens_per_watt, cull_back_faces }
    }
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            allow_external: false,
            max_bytes: MAX_BYTES,
            missing_textures: MissingTextures::default(),
            camera: None,
            gltf: GltfOptions::default(),
            progress: LoadProgress::default(),
        }
    }
}

/// A scene that is ready to be rendered.
#[derive(Clone)]
pub struct LoweredScene {
    /// What backends render.
    pub arena: Arc<SceneArena>,
    /// What had to be left out or replaced.
    pub warnings: Vec<String>,
    /// Its images.
    pub images: Vec<LoadedImage>,
}

/// More problems than this are counted, not shown.
const SHOWN_MAX: usize = 10;

impl Scene {
    /// Reads its images, builds its tree and lays everything out for rendering.
    ///
    /// # Errors
    /// If an image cannot be read, or the description was changed to one that has problems. They
    /// are shown at their places in the file, if there is one.
    pub fn lower(&self) -> Result<Arc<SceneArena>, Error> {
        self.lower_with_warnings().map(|lowered| lowered.arena)
    }

    /// [`Scene::lower`], and what there is to say about it.
    ///
    /// # Errors
    /// As for [`Scene::lower`].
    pub fn lower_with_warnings(&self) -> Result<LoweredScene, Error> {
        if let Some(compiled) = &self.compiled {
            let arena = compiled.arena_for(&self.desc).map_err(|problems| self.error(problems))?;
            let (warnings, images) = (Vec::new(), Vec::new());
            return Ok(LoweredScene { arena: Arc::new(arena), warnings, images });
        }
        let lowered = lower_with_warnings(&self.desc, &self.lower_options());
        let lowered = lowered.map_err(|problems| self.error(problems))?;
        Ok(LoweredScene {
            arena: Arc::new(lowered.arena),
            warnings: lowered.warnings.iter().map(|problem| self.in_file(problem)).collect(),
            images: lowered.images,
        })
    }

    /// Lowers the scene into what can be written to a file and opened again in no time.
    ///
    /// # Errors
    /// As for [`Scene::lower`].
    pub fn compile(&self) -> Result<CompiledScene, Error> {
        Ok(CompiledScene::new(&self.desc, (*self.lower()?).clone()))
    }

    /// How it is lowered.
    pub(crate) fn lower_options(&self) -> LowerOptions {
        let mut options = LowerOptions::new(&self.base_dir);
        options.allow_external = self.options.allow_external;
        options.max_bytes = self.options.max_bytes;
        options.image_limits.max_bytes = options.image_limits.max_bytes.min(options.max_bytes);
        options.missing_textures = self.options.missing_textures;
        options.embedded = self.embedded.clone();
        options.progress = self.options.progress.clone();
        options
    }

    /// The error for problems of the description.
    pub(crate) fn error(&self, problems: Vec<Problem>) -> Error {
        if let Some(source) = &self.source {
            return source.error(problems).into();
        }
        let mut lines: Vec<String> =
            problems.iter().take(SHOWN_MAX).map(|problem| self.in_file(problem)).collect();
        if problems.len() > SHOWN_MAX {
            lines.push(format!("and {} more problems", problems.len() - SHOWN_MAX));
        }
        Error::new(ErrorKind::Scene, lines.join("\n"))
    }

    /// A problem of the description, after the name of the file.
    fn in_file(&self, problem: &Problem) -> String {
        match &self.path {
            Some(path) => format!("{}: {problem}", path.display()),
            None => problem.to_string(),
        }
    }
}

/// Loads a scene: from a file, if the argument ends in the extension of a format (`.toml`, `.pbrt`,
/// `.gltf`, `.glb`, `.obj`, `.zscene`), has a path separator in it or is the name of a file; otherwise the built-in scene
/// of this name, which goes before a file of the same name.
///
/// # Errors
/// If the file is not a scene that can be rendered, or there is no built-in scene of this name.
pub fn load_scene(name_or_path: impl AsRef<OsStr>) -> Result<Scene, Error> {
    load_scene_with(name_or_path, &LoadOptions::default())
}

/// [`load_scene`] with options.
///
/// # Errors
/// As for [`load_scene`]; or the options ask for a choice that the scene does not have.
pub fn load_scene_with(
    name_or_path: impl AsRef<OsStr>,
    options: &LoadOptions,
) -> Result<Scene, Error> {
    let path = Path::new(name_or_path.as_ref());
    let builtin = path.to_str().and_then(builtin::find);
    let reader = readers::of_path(path).filter(|_| builtin.is_none());
    if !reader.is_some_and(|reader| reader.has_choice) {
        for (option, wanted) in [("camera", &options.camera), ("glTF scene", &options.gltf.scene)] {
            if let Some(wanted) = wanted {
                let message = format!(
                    "no {option} '{wanted}' can be chosen: only glTF files have several to choose \
                     from"
                );
                return Err(Error::new(ErrorKind::InvalidOption, message));
            }
        }
    }
    if let Some(builtin) = builtin {
        return Ok(Scene {
            desc: (builtin.build)(),
            base_dir: PathBuf::new(),
            path: None,
            source: None,
            embedded: Embedded::new(),
            warnings: Vec::new(),
            compiled: None,
            options: options.clone(),
        });
    }
    if let Some(reader) = reader {
        return (reader.read)(path, options);
    }
    if is_path(path) {
        return readers::read_unnamed(path, options);
    }
    let name = path.to_string_lossy();
    let guess = match builtin::suggest(&name) {
        Some(near) => format!("; did you mean '{near}'?"),
        None => String::from(";"),
    };
    let message = format!(
        "there is no built-in scene '{name}'{guess} run `zrak scenes` for a list, or give the path \
         of a {} file",
        readers::known()
    );
    Err(Error::new(ErrorKind::UnknownScene, message))
}

/// Whether it can only mean a file.
fn is_path(path: &Path) -> bool {
    let text = path.as_os_str().to_string_lossy();
    text.contains(std::path::is_separator) || path.is_file()
}

#[cfg(test)]
mod tests {
    use zrak_scene::file;

    use super::*;

    #[test]
    fn scenes_are_found_by_name_and_by_path() {
        assert_eq!(load_scene("final").unwrap().desc.name, "final");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let desc = load_scene("quads").unwrap().desc;
        std::fs::write(&path, file::write_string(&desc)).unwrap();
        let scene = load_scene(&path).unwrap();
        assert_eq!((scene.desc, scene.base_dir), (desc, folder.path().to_owned()));
        assert!(scene.source.is_some());
    }

    #[test]
    fn a_compiled_scene_renders_the_same_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("everything.zscene");
        let mut scene = load_scene("everything").unwrap();
        (scene.desc.camera.width, scene.desc.camera.height) = (16, 12);
        scene.compile().unwrap().write_file(&path).unwrap();
        let mut opened = load_scene(&path).unwrap();
        let film = |scene: &Scene| {
            let options =
                crate::RenderOptions { backend: crate::BackendChoice::Cpu, ..Default::default() };
            let arena = scene.lower().unwrap();
            crate::render(arena, 2, &options, &crate::Control::default(), &mut |_| ()).unwrap().film
        };
        assert!(film(&opened) == film(&scene));
        for scene in [&mut opened, &mut scene] {
            (scene.desc.camera.width, scene.desc.render.seed) = (9, 7);
        }
        assert!(film(&opened) == film(&scene));
        opened.desc.objects = scene.desc.objects;
        opened.desc.materials = scene.desc.materials;
        opened.desc.textures = scene.desc.textures;
        let Err(error) = opened.lower() else { panic!("its objects are in the file") };
        assert!(error.to_string().contains("compiled scene"), "{error}");
    }

    #[test]
    fn what_is_not_there_is_explained() {
        for (name, kind, words) in [
            ("fianl", ErrorKind::UnknownScene, "did you mean 'final'? run `zrak scenes`"),
            ("zzz", ErrorKind::UnknownScene, "'zzz'; run `zrak scenes`"),
            ("none.toml", ErrorKind::Scene, "there is no such scene file"),
            ("no/such/folder", ErrorKind::Scene, "there is no such scene file"),
        ] {
            let error = load_scene(name).unwrap_err();
            assert_eq!(error.kind(), kind, "{name}");
            assert!(error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn a_missing_image_is_shown_in_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("globe.toml");
        let text = file::write_string(&load_scene("earth").unwrap().desc);
        std::fs::write(&path, text.replace("builtin:earth.png", "none.png")).unwrap();
        let Err(error) = load_scene(&path).unwrap().lower() else { panic!("it has no image") };
        assert_eq!(error.kind(), ErrorKind::Scene);
        assert!(error.scene().unwrap().line_column().is_some());
        assert!(error.to_string().contains("none.png"), "{error}");
    }
}
