//! Parameter lists.

use std::cell::Cell;

use crate::error::{Fault, Result, Span};

/// Values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    Numbers(Vec<f64>),
    Strings(Vec<String>),
    Bools(Vec<bool>),
}

/// `"type name" [ values ]`.
#[derive(Clone, Debug)]
pub(crate) struct Param {
    pub(crate) kind: String,
    pub(crate) name: String,
    pub(crate) values: Values,
    pub(crate) span: Span,
    used: Cell<bool>,
}

/// The types that a parameter may have.
pub(crate) const KINDS: [&str; 17] = [
    "integer",
    "float",
    "point2",
    "vector2",
    "point3",
    "vector3",
    "normal3",
    "point",
    "vector",
    "normal",
    "bool",
    "string",
    "rgb",
    "blackbody",
    "spectrum",
    "texture",
    "color",
];

impl Param {
    pub(crate) fn new(kind: String, name: String, values: Values, span: Span) -> Self {
        Self { kind, name, values, span, used: Cell::new(false) }
    }

    fn wrong(&self, expected: &str) -> Fault {
        Fault::new(&self.span, format!("`{}` must be {expected}", self.name))
    }
}

/// The parameters of a directive; those of an `Attribute` come last and count if there is no other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Params {
    pub(crate) all: Vec<Param>,
    /// Where the directive stands.
    pub(crate) span: Span,
}

impl Params {
    /// The parameter of this name and one of these types.
    pub(crate) fn find(&self, kinds: &[&str], name: &str) -> Option<&Param> {
        let found = self.all.iter().find(|p| p.name == name && kinds.contains(&p.kind.as_str()))?;
        found.used.set(true);
        Some(found)
    }

    /// Whether there is a parameter of this name, of any type.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.all.iter().any(|p| p.name == name)
    }

    /// Parameters that nothing has asked for.
    pub(crate) fn unused(&self) -> impl Iterator<Item = &Param> {
        self.all.iter().filter(|p| !p.used.get())
    }

    /// Marks all parameters as ones that are known to have no effect here.
    pub(crate) fn ignore_all(&self) {
        self.all.iter().for_each(|p| p.used.set(true));
    }

    /// Marks parameters as ones that is known to have no effect here.
    pub(crate) fn ignore(&self, names: &[&str]) {
        self.all.iter().filter(|p| names.contains(&p.name.as_str())).for_each(|p| p.used.set(true));
    }

    pub(crate) fn numbers(&self, kinds: &[&str], name: &str) -> Result<Option<&[f64]>> {
        match self.find(kinds, name) {
            None => Ok(None),
            Some(Param { values: Values::Numbers(x), .. }) => Ok(Some(x)),
            Some(param) => Err(param.wrong("numbers")),
        }
    }

    pub(crate) fn float(&self, name: &str) -> Result<Option<f64>> {
        self.one(&["float"], name)
    }

    pub(crate) fn integer(&self, name: &str) -> Result<Option<i64>> {
        let Some(x) = self.one(&["integer"], name)? else { return Ok(None) };
        let param = self.find(&["integer"], name);
        if x != x.trunc() || x.abs() > 1e15 {
            return Err(match param {
                Some(param) => param.wrong("a whole number"),
                None => Fault::new(&self.span, format!("`{name}` must be a whole number")),
            });
        }
        Ok(Some(x as i64))
    }

    fn one(&self, kinds: &[&str], name: &str) -> Result<Option<f64>> {
        match self.find(kinds, name) {
            None => Ok(None),
            Some(Param { values: Values::Numbers(x), .. }) if x.len() == 1 => Ok(Some(x[0])),
            Some(param) => Err(param.wrong("one number")),
        }
    }

    pub(crate) fn bool(&self, name: &str) -> Result<Option<bool>> {
        match self.find(&["bool"], name) {
            None => Ok(None),
            Some(Param { values: Values::Bools(x), .. }) if x.len() == 1 => Ok(Some(x[0])),
            Some(Param { values: Values::Strings(x), .. }) if x == &["true"] => Ok(Some(true)),
            Some(Param { values: Values::Strings(x), .. }) if x == &["false"] => Ok(Some(false)),
            Some(param) => Err(param.wrong("true or false")),
        }
    }

    pub(crate) fn string(&self, name: &str) -> Result<Option<&str>> {
        self.word(&["string"], name)
    }

    /// The name of a texture, and where it stands.
    pub(crate) fn texture(&self, name: &str) -> Result<Option<(&str, &Span)>> {
        let word = self.word(&["texture"], name)?;
        Ok(word.zip(self.find(&["texture"], name).map(|param| &param.span)))
    }

    /// Where a parameter stands, or the directive if there is none.
    pub(crate) fn span_of(&self, name: &str) -> Span {
        self.all.iter().find(|p| p.name == name).map_or(&self.span, |p| &p.span).clone()
    }

    fn word(&self, kinds: &[&str], name: &str) -> Result<Option<&str>> {
        match self.find(kinds, name) {
            None => Ok(None),
            Some(Param { values: Values::Strings(x), .. }) if x.len() == 1 => Ok(Some(&x[0])),
            Some(param) => Err(param.wrong("one string")),
        }
    }

    pub(crate) fn strings(&self, name: &str) -> Result<Option<&[String]>> {
        match self.find(&["string"], name) {
            None => Ok(None),
            Some(Param { values: Values::Strings(x), .. }) => Ok(Some(x)),
            Some(param) => Err(param.wrong("strings")),
        }
    }

    /// Points, vectors or normals of three coordinates.
    pub(crate) fn triples(&self, name: &str) -> Result<Option<Vec<[f64; 3]>>> {
        let kinds = ["point3", "vector3", "normal3", "point", "vector", "normal"];
        let Some(x) = self.numbers(&kinds, name)? else { return Ok(None) };
        if x.len() % 3 != 0 {
            let message = format!("`{name}` has {} numbers, which is no multiple of 3", x.len());
            let span = self.find(&kinds, name).map_or(&self.span, |p| &p.span);
            return Err(Fault::new(span, message));
        }
        Ok(Some(x.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()))
    }

    pub(crate) fn triple(&self, name: &str) -> Result<Option<[f64; 3]>> {
        match self.triples(name)? {
            None => Ok(None),
            Some(x) if x.len() == 1 => Ok(Some(x[0])),
            Some(_) => Err(Fault::new(&self.span, format!("`{name}` must have three numbers"))),
        }
    }

    pub(crate) fn pairs(&self, name: &str) -> Result<Option<Vec<[f64; 2]>>> {
        let kinds = ["point2", "vector2", "float", "point"];
        let Some(x) = self.numbers(&kinds, name)? else { return Ok(None) };
        if x.len() % 2 != 0 {
            let message = format!("`{name}` has {} numbers, which is no multiple of 2", x.len());
            return Err(Fault::new(&self.span, message));
        }
        Ok(Some(x.chunks_exact(2).map(|c| [c[0], c[1]]).collect()))
    }

    /// Indices of vertices.
    pub(crate) fn indices(&self, name: &str) -> Result<Option<Vec<u32>>> {
        let Some(x) = self.numbers(&["integer"], name)? else { return Ok(None) };
        let index = |&x: &f64| {
            let is_index = x >= 0.0 && x < f64::from(u32::MAX) && x == x.trunc();
            let span = self.find(&["integer"], name).map_or(&self.span, |p| &p.span);
            let fault = || Fault::new(span, format!("{x} in `{name}` is no index"));
            if is_index { Ok(x as u32) } else { Err(fault()) }
        };
        x.iter().map(index).collect::<Result<Vec<u32>>>().map(Some)
    }
}
