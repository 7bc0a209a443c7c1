//! From a scene description to a pbrt-v4 file.
//!
//! Numbers are written so that reading them gives the same ones. Meshes become binary PLY files beside
//! the scene unless they are small, and pictures are copied there. What pbrt cannot say becomes the
//! nearest thing that it can, with a warning; `docs/guide/pbrt.md` says what.
//!
//! # To write something new
//! The counterpart of each module of the reader is here under the same name.

mod camera;
mod lights;
mod materials;
mod meshes;
mod objects;
mod pictures;
mod surfaces;
mod text;
mod textures;

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use zrak_scene::desc::SceneDesc;
use zrak_scene::error::{SceneError, SceneErrorKind};
use zrak_scene::lower::Embedded;
use zrak_scene::validate::validate;

use surfaces::Shading;

/// How a scene is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportOptions {
    /// What pbrt is to call its picture.
    pub picture: String,
    /// Folder of the other files, relative to the scene's.
    pub folder: String,
    /// Meshes of at most so many triangles or patches are written into the scene file itself.
    pub max_inline: usize,
    /// Most bytes of a file that is read, and of what is written.
    pub max_bytes: u64,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            picture: "picture.exr".to_owned(),
            folder: "files".to_owned(),
            max_inline: 64,
            max_bytes: 16 << 30,
        }
    }
}

/// A scene for pbrt, in memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exported {
    /// The scene file.
    pub text: String,
    /// The files that it refers to: paths relative to its folder, and what is in them.
    pub files: Vec<(String, Vec<u8>)>,
    /// What of the scene pbrt cannot say, each once.
    pub warnings: Vec<String>,
}

/// Takes a file that a scene refers to, as a name to begin with and what is in it; gives its path as the
/// scene is to say it.
pub type Sink<'a> = dyn FnMut(&str, &[u8]) -> Result<String, SceneError> + 'a;

/// Writes a scene for pbrt, with all its files in memory. Paths in it start at `base_dir`, `embedded:NAME`
/// means entry `NAME` of `embedded`; the files that they lead to are read without asking whether they
/// may be.
///
/// # Errors
/// The scene has problems, refers to files that cannot be read, or is too large.
pub fn export(
    desc: &SceneDesc,
    base_dir: &Path,
    embedded: &Embedded,
    options: &ExportOptions,
) -> Result<Exported, SceneError> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut taken = BTreeSet::new();
    let mut sink = |wanted: &str, bytes: &[u8]| {
        let name = text::unique(&text::file_name(wanted), &mut taken);
        let path = format!("{}/{name}", options.folder);
        files.push((path.clone(), bytes.to_vec()));
        Ok(path)
    };
    let (text, warnings) = export_to(desc, base_dir, embedded, options, &mut sink)?;
    Ok(Exported { text, files, warnings })
}

/// The same, with each file given to `sink` when it is made: gives the scene file and the warnings.
///
/// # Errors
/// As for [`export`], or what the sink gives.
pub fn export_to(
    desc: &SceneDesc,
    base_dir: &Path,
    embedded: &Embedded,
    options: &ExportOptions,
    sink: &mut Sink<'_>,
) -> Result<(String, Vec<String>), SceneError> {
    if let Some(problem) = validate(desc).first() {
        return Err(failure(&problem.to_string()));
    }
    let mut writer = Writer {
        desc,
        base_dir,
        embedded,
        options,
        sink,
        out: String::new(),
        warnings: Vec::new(),
        names: BTreeSet::new(),
        textures: HashMap::new(),
        pictures: HashMap::new(),
        materials: HashMap::new(),
        shadings: HashMap::new(),
        media: HashMap::new(),
        meshes: HashMap::new(),
        objects: HashMap::new(),
        n_media: 0,
    };
    writer.write_all()?;
    Ok((writer.out, writer.warnings))
}

fn failure(message: &str) -> SceneError {
    let help = Some("mend the scene first; `zrak info` shows what is in it");
    SceneError::file(SceneErrorKind::Invalid, "scene", message.to_owned(), help)
}

/// What is written so far.
struct Writer<'a, 'b> {
    desc: &'a SceneDesc,
    base_dir: &'a Path,
    embedded: &'a Embedded,
    options: &'a ExportOptions,
    sink: &'a mut Sink<'b>,
    out: String,
    warnings: Vec<String>,
    /// Names that are taken, each after a word for its kind.
    names: BTreeSet<String>,
    /// Names of textures by what they are made of.
    textures: HashMap<String, String>,
    /// Paths of pictures by what they are made of.
    pictures: HashMap<String, String>,
    materials: HashMap<String, String>,
    shadings: HashMap<String, Shading>,
    media: HashMap<String, String>,
    /// Shapes of meshes: directive and parameters, without those of a surface.
    meshes: HashMap<String, String>,
    /// Names of prototypes that were written as objects; none if each instance is written out.
    objects: HashMap<String, Option<String>>,
    n_media: usize,
}

impl Writer<'_, '_> {
    fn write_all(&mut self) -> Result<(), SceneError> {
        self.camera();
        self.out.push_str("\nWorldBegin\n\n");
        if self.desc.camera.medium.is_some() {
            // The camera's is not that of the shapes.
            self.out.push_str("MediumInterface \"\" \"\"\n");
        }
        self.all_media();
        self.background()?;
        self.lights();
        let desc = self.desc;
        for object in &desc.objects {
            self.object(object, &zrak_scene::lower::Transform::IDENTITY, false)?;
        }
        Ok(())
    }

    /// Says once that something cannot be said.
    fn warn(&mut self, message: impl Into<String>) {
        let message = message.into();
        if !self.warnings.contains(&message) {
            self.warnings.push(message);
        }
    }

    /// A name that nothing of this kind has yet, as near to the wanted one as can be.
    fn unique_name(&mut self, kind: &str, wanted: &str) -> String {
        // Names that the reader makes of those of pbrt files become these again.
        let plain = wanted
            .strip_prefix("named:")
            .or_else(|| wanted.strip_prefix("float:"))
            .or_else(|| wanted.strip_prefix("spectrum:"))
            .unwrap_or(wanted);
        let mut name = plain.to_owned();
        let mut i = 1;
        while !self.names.insert(format!("{kind} {name}")) {
            i += 1;
            name = format!("{plain}-{i}");
        }
        name
    }
}
