//! Where in the files things were made, to show what is wrong with them at their place.

use std::collections::HashMap;
use std::ops::Range;

use zrak_scene::error::{SceneError, SceneErrorKind};
use zrak_scene::validate::{KeyPath, PathPart, Problem, validate};

use crate::error::Span;
use crate::references::What;
use crate::state::Importer;

/// The directives that made things.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// The one that is being read.
    pub(crate) here: Span,
    names: HashMap<String, Span>,
    objects: Vec<Span>,
    lights: Vec<Span>,
    /// Of the shapes of each object.
    members: HashMap<String, Vec<Span>>,
    pub(crate) camera: Span,
    pub(crate) background: Span,
}

fn key_of(what: What, name: &str) -> String {
    let prefix = match what {
        What::Material => "named",
        What::FloatTexture => "float",
        What::SpectrumTexture => "spectrum",
        What::Medium => "medium",
        What::Object => "object",
    };
    format!("{prefix}:{name}")
}

impl Places {
    /// Notes a name of the reader's own.
    pub(crate) fn note_name(&mut self, name: String) {
        self.names.insert(name, self.here.clone());
    }

    /// Notes a name that the file gives.
    pub(crate) fn note(&mut self, what: What, name: &str, span: &Span) {
        self.names.insert(key_of(what, name), span.clone());
    }

    /// Where a material of this name in the description was made.
    pub(crate) fn name(&self, name: &str) -> Option<&Span> {
        self.names.get(name)
    }

    fn of(&self, path: &KeyPath) -> Option<&Span> {
        let index = |i: usize| match path.0.get(i) {
            Some(PathPart::Index(i)) => Some(*i),
            _ => None,
        };
        let key = |i: usize| match path.0.get(i) {
            Some(PathPart::Key(key)) => Some(key.as_str()),
            _ => None,
        };
        match key(0)? {
            "camera" => Some(&self.camera),
            "background" => Some(&self.background),
            "lights" => self.lights.get(index(1)?),
            "objects" => self.objects.get(index(1)?),
            "media" => self.names.get(&key_of(What::Medium, key(1)?)),
            "prototypes" => {
                let name = key(1)?;
                let member = self.members.get(name).and_then(|members| members.get(index(2)?));
                member
                    .or_else(|| self.names.get(&key_of(What::Object, name)))
                    .or_else(|| self.names.get(name))
            }
            _ => self.names.get(key(1)?),
        }
    }
}

impl Importer {
    /// Notes what the present directive has made.
    pub(crate) fn note_places(&mut self) {
        let places = &mut self.places;
        places.objects.resize(self.desc.objects.len(), places.here.clone());
        places.lights.resize(self.desc.lights.len(), places.here.clone());
        if let Some((name, objects)) = &self.object {
            if !places.members.contains_key(name) {
                places.members.insert(name.clone(), Vec::new());
            }
            if let Some(members) = places.members.get_mut(name) {
                members.resize(objects.len(), places.here.clone());
            }
        }
    }

    /// What is wrong with the scene as a whole, each at its place: of the first file with problems.
    pub(crate) fn problems(&self) -> Result<(), SceneError> {
        let mut found: Vec<(usize, (Problem, Range<usize>))> = validate(&self.desc)
            .into_iter()
            .map(|problem| {
                let span = self.places.of(&problem.path).cloned().unwrap_or_default();
                let problem = Problem { path: KeyPath::default(), ..problem };
                (span.file, (problem, span.bytes))
            })
            .collect();
        let Some(first) = found.iter().map(|(file, _)| *file).min() else { return Ok(()) };
        found.retain(|(file, _)| *file == first);
        let file = &self.sources.files[first];
        let problems = found.into_iter().map(|(_, problem)| problem).collect();
        let origin = file.path.display().to_string();
        Err(SceneError::text(SceneErrorKind::Invalid, &origin, &file.text, problems))
    }
}
