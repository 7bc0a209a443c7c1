//! Names that may be used before they are made, and what is put together once all are known.
//!
//! pbrt looks up materials, textures of materials, media and objects when the whole scene has been
//! read; only textures that others are made of must come first.

use std::collections::HashMap;

use zrak_scene::desc::{MaterialDesc, SceneDesc};
use zrak_scene::suggest;

use crate::error::{Fault, Result, Span};
use crate::state::{Importer, named};

/// What a name is that of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum What {
    Material,
    FloatTexture,
    SpectrumTexture,
    Medium,
    Object,
}

impl What {
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Material => ("material", "MakeNamedMaterial makes one"),
            Self::FloatTexture => ("float texture", "Texture makes one"),
            Self::SpectrumTexture => ("spectrum texture", "Texture makes one"),
            Self::Medium => ("medium", "MakeNamedMedium makes one"),
            Self::Object => ("object", "ObjectBegin begins one"),
        }
    }

    /// Names that there are, as the file has them.
    fn all(self, desc: &SceneDesc) -> Vec<&str> {
        fn keys<'a, T>(
            map: &'a std::collections::BTreeMap<String, T>,
            prefix: &str,
        ) -> Vec<&'a str> {
            map.keys().filter_map(|key| key.strip_prefix(prefix)).collect()
        }
        match self {
            Self::Material => keys(&desc.materials, "named:"),
            Self::FloatTexture => keys(&desc.textures, "float:"),
            Self::SpectrumTexture => keys(&desc.textures, "spectrum:"),
            Self::Medium => keys(&desc.media, ""),
            Self::Object => keys(&desc.prototypes, ""),
        }
    }

    fn exists(self, name: &str, desc: &SceneDesc) -> bool {
        match self {
            Self::Material => desc.materials.contains_key(&named(name)),
            Self::FloatTexture => desc.textures.contains_key(&format!("float:{name}")),
            Self::SpectrumTexture => desc.textures.contains_key(&format!("spectrum:{name}")),
            Self::Medium => desc.media.contains_key(name),
            Self::Object => desc.prototypes.contains_key(name),
        }
    }

    /// That there is none of this name.
    pub(crate) fn missing(self, name: &str, span: &Span, desc: &SceneDesc) -> Fault {
        let (what, help) = self.words();
        let fault = Fault::new(span, format!("there is no {what} \"{name}\""));
        match suggest::closest(name, self.all(desc)) {
            Some(near) => fault.help(format!("did you mean \"{near}\"?")),
            None => fault.help(help),
        }
    }
}

/// The names that were used, each where it was used first.
#[derive(Debug, Default)]
pub(crate) struct References {
    first: HashMap<(What, String), usize>,
    spans: Vec<(What, String, Span)>,
    /// Surfaces that shine, and the shape that was given one first.
    pub(crate) shining: HashMap<String, Span>,
}

impl Importer {
    /// Notes that a name is used.
    pub(crate) fn refer(&mut self, what: What, name: &str, span: &Span) {
        let references = &mut self.references;
        let n = references.spans.len();
        references.first.entry((what, name.to_owned())).or_insert_with(|| {
            references.spans.push((what, name.to_owned(), span.clone()));
            n
        });
    }

    /// That a name is new; where it is made is noted.
    pub(crate) fn is_new(&mut self, what: What, name: &str, span: &Span) -> Result<()> {
        if !what.exists(name, &self.desc) {
            self.places.note(what, name, span);
            return Ok(());
        }
        let fault = Fault::new(span, format!("there is already a {} \"{name}\"", what.words().0));
        Err(fault.help("give it another name; pbrt refuses it, too"))
    }

    /// That a name has been made already.
    pub(crate) fn must_exist(&self, what: What, name: &str, span: &Span) -> Result<()> {
        if what.exists(name, &self.desc) {
            return Ok(());
        }
        Err(what.missing(name, span, &self.desc))
    }

    /// That all names that were used have been made.
    pub(crate) fn check_references(&self) -> Result<()> {
        match self.references.spans.iter().find(|(what, name, _)| !what.exists(name, &self.desc)) {
            Some((what, name, span)) => Err(what.missing(name, span, &self.desc)),
            None => Ok(()),
        }
    }

    /// Puts surfaces of surfaces together: a shape's light, media and alpha on its material's bumps.
    pub(crate) fn join_surfaces(&mut self) {
        let names: Vec<String> = self.desc.materials.keys().cloned().collect();
        for name in &names {
            let Some(MaterialDesc::Surface { base, .. }) = self.desc.materials.get(name) else {
                continue;
            };
            if let Some(MaterialDesc::Surface { base, normal_map, bump, .. }) =
                self.desc.materials.get(base).cloned()
                && let Some(MaterialDesc::Surface { base: b, normal_map: n, bump: h, .. }) =
                    self.desc.materials.get_mut(name)
            {
                (*b, *n, *h) = (base, normal_map, bump);
            }
        }
        // As in pbrt, what is not there does not shine.
        let mut dark = Vec::new();
        for (name, span) in &self.references.shining {
            if let Some(MaterialDesc::Surface { base, .. }) = self.desc.materials.get(name)
                && self.desc.materials.get(base) == Some(&MaterialDesc::Interface)
            {
                dark.push((name.clone(), span.clone()));
            }
        }
        dark.sort_by_key(|d| (d.1.file, d.1.bytes.start));
        for (name, span) in dark {
            if let Some(MaterialDesc::Surface { emission, .. }) = self.desc.materials.get_mut(&name)
            {
                *emission = None;
            }
            self.warn(&span, "a shape of material \"interface\" does not shine, as in pbrt");
        }
        for name in names {
            let Some(MaterialDesc::Mix { materials, .. }) = self.desc.materials.get(&name) else {
                continue;
            };
            let mut plain = materials.clone();
            for part in &mut plain {
                if let Some(MaterialDesc::Surface { base, .. }) = self.desc.materials.get(part) {
                    *part = base.clone();
                }
            }
            let Some(MaterialDesc::Mix { materials, .. }) = self.desc.materials.get_mut(&name)
            else {
                continue;
            };
            if *materials != plain {
                *materials = plain;
                let span = self.places.name(&name).cloned().unwrap_or_default();
                self.warn(&span, "the bumps of the materials of a mix are not rendered");
            }
        }
    }
}
