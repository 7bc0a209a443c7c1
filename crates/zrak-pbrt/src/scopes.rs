//! What is begun and ended: attributes, transforms, objects.

use std::rc::Rc;

use zrak_scene::desc::ObjectDesc;
use zrak_scene::lower::Transform;

use crate::error::{Fault, Result, Span};
use crate::params::{Param, Params};
use crate::references::What;
use crate::state::{Importer, matrix_step, steps};

/// How deep attributes may be nested.
const ATTRIBUTES_MAX: usize = 4096;

/// What `Attribute` can be for.
const TARGETS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

/// Most attributes for a target.
const PARAMS_MAX: usize = 256;

impl Importer {
    pub(crate) fn set(&mut self, map: impl Fn(&Transform) -> Transform) {
        let [start, end] = self.state.active;
        if start {
            self.state.ctm.start = map(&self.state.ctm.start);
        }
        if end {
            self.state.ctm.end = map(&self.state.ctm.end);
        }
    }

    /// Puts a map before those that are there.
    pub(crate) fn concat(&mut self, map: &Transform) {
        self.set(|ctm| map.then(ctm));
    }

    pub(crate) fn push(&mut self, name: &'static str, span: &Span) -> Result<()> {
        if self.stack.len() >= ATTRIBUTES_MAX {
            let message = format!("attributes are nested more than {ATTRIBUTES_MAX} deep");
            return Err(Fault::new(span, message));
        }
        self.stack.push((self.state.clone(), name));
        Ok(())
    }

    pub(crate) fn pop(&mut self, name: &'static str, span: &Span) -> Result<()> {
        // What began outside of an imported file does not end in it.
        let n_outside = self.imports.last().map_or(0, |(_, n)| *n);
        if self.stack.len() <= n_outside {
            return Err(Fault::new(span, format!("there is no {name}Begin before this")));
        }
        match self.stack.pop() {
            Some((state, begun)) if begun == name => {
                if name == "Transform" {
                    // Nothing but the map is forgotten.
                    self.state.ctm = state.ctm;
                    self.state.active = state.active;
                } else {
                    self.state = state;
                }
                Ok(())
            }
            Some((_, begun)) => {
                Err(Fault::new(span, format!("{begun}Begin is closed by {name}End")))
            }
            None => Err(Fault::new(span, format!("there is no {name}Begin before this"))),
        }
    }

    pub(crate) fn world_only(&self, span: &Span) -> Result<()> {
        if self.in_world {
            return Ok(());
        }
        Err(Fault::new(span, "this must come after WorldBegin"))
    }

    pub(crate) fn object_begin(&mut self, span: &Span) -> Result<()> {
        let (name, at) = self.string(span, "a name")?;
        self.world_only(span)?;
        if self.object.is_some() {
            return Err(Fault::new(&at, "objects cannot be defined within objects"));
        }
        self.is_new(What::Object, &name, &at)?;
        self.push("Object", span)?;
        self.object = Some((name, Vec::new()));
        Ok(())
    }

    pub(crate) fn object_end(&mut self, span: &Span) -> Result<()> {
        self.pop("Object", span)?;
        if let Some((name, objects)) = self.object.take() {
            self.desc.prototypes.insert(name, objects);
        }
        Ok(())
    }

    pub(crate) fn object_instance(&mut self, span: &Span) -> Result<()> {
        let (name, at) = self.string(span, "a name")?;
        self.world_only(span)?;
        if self.object.is_some() {
            return Err(Fault::new(&at, "objects cannot be placed within objects"));
        }
        self.refer(What::Object, &name, &at);
        let object = self.instance(name);
        self.desc.objects.push(object);
        Ok(())
    }

    /// Parameters for all directives of a kind to come.
    pub(crate) fn attribute(&mut self, target: &str, at: &Span, params: Params) -> Result<()> {
        if !TARGETS.contains(&target) {
            return Err(Fault::unknown(at, "target", target, &TARGETS));
        }
        let mut all = params.all;
        if let Some(before) = self.state.attributes.get(target) {
            // The last one counts.
            let is_kept = |p: &&Param| !all.iter().any(|new| new.name == p.name);
            let kept: Vec<Param> = before.iter().filter(is_kept).cloned().collect();
            all.extend(kept);
        }
        if all.len() > PARAMS_MAX {
            let message = format!("there are more than {PARAMS_MAX} attributes for a {target}");
            return Err(Fault::new(at, message));
        }
        self.state.attributes.insert(target.to_owned(), Rc::new(all));
        Ok(())
    }

    /// A prototype under the present map.
    pub(crate) fn instance(&self, prototype: String) -> ObjectDesc {
        let ctm = self.state.ctm;
        ObjectDesc::Instance {
            prototype,
            transform: steps(&ctm.start),
            transform_end: ctm.is_moving().then(|| vec![matrix_step(&ctm.end)]),
        }
    }
}
