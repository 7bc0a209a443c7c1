//! The graphics state, and the reading of a file from its beginning to its end.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::rc::Rc;

use zrak_scene::desc::{ColorDesc, MaterialDesc, ObjectDesc, SceneDesc};
use zrak_scene::error::{SceneError, SceneErrorKind};
use zrak_scene::validate::{KeyPath, Problem};

use crate::color::{ColorSpace, SPACES};
use crate::error::{Fault, Result, Span};
use crate::lexer::Kind;
pub(crate) use crate::maths::{Maps, cross, dot, matrix_step, steps, sub};
use crate::params::{Param, Params};
use crate::places::Places;
use crate::references::References;
use crate::source::{Sources, Store};
use crate::{ImportOptions, Imported, Warning};

/// An area light that the shapes to come have.
#[derive(Clone, Debug)]
pub(crate) struct AreaLight {
    pub(crate) emission: ColorDesc,
    /// Factor of the emission.
    pub(crate) strength: f64,
    pub(crate) two_sided: bool,
    /// What the shape emits in all, if the file says that and not how bright it is.
    pub(crate) power: Option<f64>,
    /// Mean luminance of the emission without its factor, as far as `power` counts it.
    pub(crate) mean: f64,
}

/// What directives change and shapes are made with.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) ctm: Maps,
    pub(crate) active: [bool; 2],
    pub(crate) reverse: bool,
    /// Name of the material.
    pub(crate) material: Rc<str>,
    pub(crate) light: Option<Rc<AreaLight>>,
    /// Names of the media inside and outside; empty for a vacuum.
    pub(crate) media: [Rc<str>; 2],
    pub(crate) space: ColorSpace,
    /// Parameters for directives of a kind to come, by `Attribute`'s target.
    pub(crate) attributes: BTreeMap<String, Rc<Vec<Param>>>,
}

/// The reading of a scene.
pub(crate) struct Importer {
    pub(crate) sources: Sources,
    pub(crate) desc: SceneDesc,
    pub(crate) state: State,
    pub(crate) stack: Vec<(State, &'static str)>,
    /// States to go back to when an imported file ends, and how many scopes were open then.
    pub(crate) imports: Vec<(State, usize)>,
    pub(crate) systems: HashMap<String, Maps>,
    pub(crate) in_world: bool,
    /// Name of the object that is being defined, and its shapes so far.
    pub(crate) object: Option<(String, Vec<ObjectDesc>)>,
    pub(crate) warnings: Vec<Warning>,
    /// Number of names made so far.
    n_names: usize,
    /// Surfaces made of a material, a light, media and an alpha, so that each is made once.
    pub(crate) surfaces: HashMap<String, String>,
    pub(crate) references: References,
    pub(crate) places: Places,
    /// Whether a texture is being made, which may only refer to earlier ones.
    pub(crate) in_texture: bool,
    pub(crate) filename: Option<String>,
    pub(crate) camera: Option<crate::camera::CameraSoFar>,
    /// Factor of all light: the sensor's.
    pub(crate) exposure: f64,
    pub(crate) film: crate::camera::Film,
    pub(crate) peeked: Option<(Kind, Span)>,
}

impl Importer {
    pub(crate) fn new(
        path: &Path,
        store: Store,
        options: ImportOptions,
    ) -> std::result::Result<Self, SceneError> {
        let base = path.parent().unwrap_or(Path::new(""));
        let mut importer = Self {
            sources: Sources::new(base, store, options),
            desc: SceneDesc {
                name: path
                    .file_stem()
                    .map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
                ..SceneDesc::default()
            },
            state: State {
                ctm: Maps::IDENTITY,
                active: [true; 2],
                reverse: false,
                material: "default".into(),
                light: None,
                media: ["".into(), "".into()],
                space: SPACES[0],
                attributes: BTreeMap::new(),
            },
            stack: Vec::new(),
            imports: Vec::new(),
            systems: HashMap::new(),
            in_world: false,
            object: None,
            warnings: Vec::new(),
            n_names: 0,
            surfaces: HashMap::new(),
            references: References::default(),
            places: Places::default(),
            in_texture: false,
            filename: None,
            camera: None,
            exposure: 1.0,
            film: crate::camera::Film::default(),
            peeked: None,
        };
        importer.desc.render.max_depth = 6;
        importer.desc.render.samples_per_pixel = 16;
        let grey = MaterialDesc::Lambertian { color: [0.5; 3].into() };
        importer.desc.materials.insert("default".to_owned(), grey);
        let origin = path.display().to_string();
        if !importer.sources.is_file(path) {
            let message = "there is no such scene file".to_owned();
            let help = Some("check the path; relative paths start at the current folder");
            return Err(SceneError::file(SceneErrorKind::Io, &origin, message, help));
        }
        let nowhere = Span::default();
        importer
            .sources
            .enter(path.to_owned(), false, &nowhere)
            .map_err(|fault| SceneError::file(SceneErrorKind::Io, &origin, fault.message, None))?;
        Ok(importer)
    }

    pub(crate) fn run(mut self) -> std::result::Result<Imported, SceneError> {
        match self.read_all() {
            Ok(()) => {
                self.problems()?;
                let base = self.sources.base().to_owned();
                Ok(Imported {
                    desc: self.desc,
                    base_dir: base,
                    filename: self.filename,
                    warnings: self.warnings,
                })
            }
            Err(fault) => {
                let file = &self.sources.files[fault.span.file];
                let problem =
                    Problem { path: KeyPath::default(), message: fault.message, help: fault.help };
                let origin = file.path.display().to_string();
                let problems = vec![(problem, fault.span.bytes)];
                Err(SceneError::text(SceneErrorKind::Invalid, &origin, &file.text, problems))
            }
        }
    }

    fn read_all(&mut self) -> Result<()> {
        let mut last = Span::default();
        while let Some((kind, span)) = self.next()? {
            last = span.clone();
            if kind != Kind::Word {
                let fault = Fault::new(&span, "a directive must stand here");
                return Err(fault.help("values belong to a parameter: \"type name\" [ values ]"));
            }
            self.places.here = span.clone();
            self.directive(&span)?;
            self.note_places();
        }
        if let Some((_, name)) = self.stack.last() {
            return Err(Fault::new(&last, format!("the file ends, but {name}Begin has no end")));
        }
        if !self.in_world {
            let fault = Fault::new(&last, "the file has no WorldBegin");
            return Err(fault.help("shapes and lights come after it"));
        }
        self.finish_camera(&last)?;
        self.check_references()?;
        self.join_surfaces();
        Ok(())
    }

    /// A name that nothing has yet.
    pub(crate) fn fresh(&mut self, what: &str) -> String {
        self.n_names += 1;
        let name = format!("{what}:{}", self.n_names);
        self.places.note_name(name.clone());
        name
    }

    pub(crate) fn warn(&mut self, span: &Span, message: impl Into<String>) {
        let warning = self.sources.warning(span, message);
        self.warnings.push(warning);
    }

    pub(crate) fn warn_unused(&mut self, params: &Params) {
        let unused: Vec<(Span, String)> = params
            .unused()
            .map(|p| (p.span.clone(), format!("parameter \"{}\" is not used here", p.name)))
            .collect();
        for (span, message) in unused {
            self.warn(&span, message);
        }
    }
}

/// Name of a named material in the description: apart from those of this reader.
pub(crate) fn named(name: &str) -> String {
    format!("named:{name}")
}
