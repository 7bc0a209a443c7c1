//! The state of a validation: where it stands and what it has found.

use std::collections::BTreeMap;

use super::limits::{NUMBER_MAX, RADIANCE_MAX};
use super::problem::{KeyPath, PathPart, Problem};
use crate::desc::{SceneDesc, Triple};
use crate::suggest;

pub(super) struct Checker<'a> {
    pub(super) scene: &'a SceneDesc,
    /// Whether what is being looked at belongs to a prototype.
    pub(super) in_prototype: bool,
    path: KeyPath,
    problems: Vec<Problem>,
}

impl<'a> Checker<'a> {
    pub(super) fn new(scene: &'a SceneDesc) -> Self {
        Self { scene, in_prototype: false, path: KeyPath::default(), problems: Vec::new() }
    }

    pub(super) fn into_problems(self) -> Vec<Problem> {
        self.problems
    }

    /// Looks at a part of what is being looked at.
    pub(super) fn enter<R>(
        &mut self,
        part: impl Into<PathPart>,
        look: impl FnOnce(&mut Self) -> R,
    ) -> R {
        self.path.0.push(part.into());
        let result = look(self);
        self.path.0.pop();
        result
    }

    /// Notes a problem with the field `key` of what is being looked at.
    pub(super) fn note(&mut self, key: &str, message: impl Into<String>, help: Option<&str>) {
        let path = if key.is_empty() { self.path.clone() } else { self.path.join(key) };
        self.note_at(path, message, help);
    }

    /// Notes a problem anywhere.
    pub(super) fn note_at(
        &mut self,
        path: KeyPath,
        message: impl Into<String>,
        help: Option<&str>,
    ) {
        self.problems.push(Problem {
            path,
            message: message.into(),
            help: help.map(str::to_owned),
        });
    }

    /// Is `value` a number that `f32` can hold? Notes it if not.
    pub(super) fn number(&mut self, key: &str, value: f64) -> bool {
        if !value.is_finite() {
            self.note(key, format!("`{key}` must be a finite number, not {value}"), None);
        } else if value.abs() > NUMBER_MAX {
            let message = format!("`{key}` is {value:?}; numbers must lie in [-1e12, 1e12]");
            let help = "choose another unit of length: pictures are computed in single precision";
            self.note(key, message, Some(help));
        } else {
            return true;
        }
        false
    }

    /// Is `value` a number for which `ok` holds? Notes it if not, saying that it must be `rule`.
    pub(super) fn require(
        &mut self,
        key: &str,
        value: f64,
        ok: impl FnOnce(f64) -> bool,
        rule: &str,
        help: Option<&str>,
    ) -> bool {
        if !self.number(key, value) {
            return false;
        }
        let ok = ok(value);
        if !ok {
            self.note(key, format!("`{key}` must be {rule}, is {value:?}"), help);
        }
        ok
    }

    /// Are all three numbers of `value` ones that `f32` can hold? Notes those that are not.
    pub(super) fn triple(&mut self, key: &str, value: Triple) -> bool {
        self.enter(key, |checker| checker.numbers(&value))
    }

    /// The same for the elements of the array that is being looked at.
    pub(super) fn numbers(&mut self, values: &[f64]) -> bool {
        let mut good = true;
        for (i, &x) in values.iter().enumerate() {
            if !x.is_finite() || x.abs() > NUMBER_MAX {
                good = false;
                let message = format!("numbers must lie in [-1e12, 1e12], not {x:?}");
                self.note_at(self.path.join(i), message, None);
            }
        }
        good
    }

    /// Checks a direction: any length but none.
    pub(super) fn direction(&mut self, key: &str, value: Triple) {
        if self.triple(key, value) && super::length(value) < super::limits::LENGTH_MIN {
            self.note(key, format!("`{key}` has no length"), None);
        }
    }

    /// Checks a radiance.
    pub(super) fn radiance(&mut self, key: &str, color: Triple) {
        let path = self.path.join(key);
        self.radiance_at(&path, color);
    }

    /// Checks a radiance that stands at `path`.
    pub(super) fn radiance_at(&mut self, path: &KeyPath, color: Triple) {
        for (i, x) in color.into_iter().enumerate() {
            if !(0.0..=RADIANCE_MAX).contains(&x) {
                let message = format!("a radiance must have numbers from 0 to 1e9, not {x:?}");
                self.note_at(path.join(i), message, None);
            }
        }
    }

    /// Checks the share of light that something reflects or scatters, at `path`.
    pub(super) fn albedo_at(&mut self, path: &KeyPath, color: Triple) {
        for (i, x) in color.into_iter().enumerate() {
            if x > 1.0 {
                let message = format!("a reflected share must be at most 1, is {x:?}");
                let help = "more would create light out of nothing; to make something shine, \
                            use a `diffuse_light`";
                self.note_at(path.join(i), message, Some(help));
            } else if !(0.0..=1.0).contains(&x) {
                let message = format!("a reflected share must have numbers from 0 to 1, not {x:?}");
                self.note_at(path.join(i), message, None);
            }
        }
    }

    /// Notes that `name` is not among the `what`s that exist.
    pub(super) fn unknown_name<T>(
        &mut self,
        path: KeyPath,
        what: &str,
        name: &str,
        existing: &BTreeMap<String, T>,
    ) {
        let names = || existing.keys().map(String::as_str);
        let help = if existing.is_empty() {
            format!("the scene has no {what}s; add one under `[{what}s]`")
        } else if let Some(near) = suggest::closest(name, names()) {
            format!("did you mean `{near}`?")
        } else {
            format!("the scene's {what}s are {}", suggest::list_all(names()))
        };
        self.note_at(path, format!("unknown {what} `{name}`"), Some(&help));
    }

    /// The path of what is being looked at.
    pub(super) fn path(&self) -> KeyPath {
        self.path.clone()
    }

    /// The path of the field `key` of what is being looked at.
    pub(super) fn path_of(&self, key: &str) -> KeyPath {
        self.path.join(key)
    }
}
