//! The graphics state, and the directives that change it.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::rc::Rc;

use zrak_scene::desc::{MaterialDesc, ObjectDesc, SceneDesc};
use zrak_scene::error::{SceneError, SceneErrorKind};
use zrak_scene::lower::Transform;
use zrak_scene::suggest;
use zrak_scene::validate::{KeyPath, Problem};

use crate::color::{ColorSpace, SPACES};
use crate::error::{Fault, Result, Span};
use crate::lexer::{self, Kind};
use crate::params::{KINDS, Param, Params, Values};
use crate::source::{Sources, Store};
use crate::{ImportOptions, Imported, Warning};

/// How deep attributes may be nested.
const ATTRIBUTES_MAX: usize = 4096;

/// A map at the shutter's opening and closing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Maps {
    pub(crate) start: Transform,
    pub(crate) end: Transform,
}

impl Maps {
    const IDENTITY: Self = Self { start: Transform::IDENTITY, end: Transform::IDENTITY };

    pub(crate) fn is_moving(&self) -> bool {
        self.start != self.end
    }
}

/// An area light that the shapes to come have.
#[derive(Clone, Debug)]
pub(crate) struct AreaLight {
    pub(crate) radiance: [f64; 3],
    pub(crate) two_sided: bool,
}

/// What directives change and shapes are made with.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) ctm: Maps,
    active: [bool; 2],
    pub(crate) reverse: bool,
    /// Name of the material.
    pub(crate) material: Rc<str>,
    pub(crate) light: Option<Rc<AreaLight>>,
    /// Names of the media inside and outside; empty for a vacuum.
    pub(crate) media: [Rc<str>; 2],
    pub(crate) space: ColorSpace,
    /// Parameters for directives of a kind to come, by `Attribute`'s target.
    attributes: BTreeMap<String, Rc<Vec<Param>>>,
}

/// The reading of a scene.
pub(crate) struct Importer {
    pub(crate) sources: Sources,
    pub(crate) desc: SceneDesc,
    pub(crate) state: State,
    stack: Vec<(State, &'static str)>,
    /// States to go back to when an imported file ends.
    imports: Vec<State>,
    systems: HashMap<String, Maps>,
    in_world: bool,
    /// Name of the object that is being defined, and its shapes so far.
    pub(crate) object: Option<(String, Vec<ObjectDesc>)>,
    pub(crate) warnings: Vec<Warning>,
    /// Number of names made so far.
    n_names: usize,
    /// Surfaces made of a material, a light, media and an alpha, so that each is made once.
    pub(crate) surfaces: HashMap<String, String>,
    pub(crate) filename: Option<String>,
    pub(crate) camera: Option<crate::camera::CameraSoFar>,
    /// Factor of all light: the sensor's.
    pub(crate) exposure: f64,
    pub(crate) film: crate::camera::Film,
    peeked: Option<(Kind, Span)>,
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
            self.directive(&span)?;
        }
        if let Some((_, name)) = self.stack.last() {
            return Err(Fault::new(&last, format!("the file ends, but {name}Begin has no end")));
        }
        if self.object.is_some() {
            return Err(Fault::new(&last, "the file ends, but ObjectBegin has no end"));
        }
        if !self.in_world {
            let fault = Fault::new(&last, "the file has no WorldBegin");
            return Err(fault.help("shapes and lights come after it"));
        }
        self.finish_camera(&last)
    }

    /// The next token, of whichever file is open.
    fn next(&mut self) -> Result<Option<(Kind, Span)>> {
        if let Some(token) = self.peeked.take() {
            return Ok(Some(token));
        }
        while let Some(open) = self.sources.open.last() {
            let (file, at) = (open.file, open.at);
            match lexer::next(self.sources.text(file), at, file)? {
                Some((kind, bytes)) => {
                    if let Some(open) = self.sources.open.last_mut() {
                        open.at = bytes.end;
                    }
                    return Ok(Some((kind, Span { file, bytes })));
                }
                None => {
                    if self.sources.open.last().is_some_and(|open| open.is_import)
                        && let Some(state) = self.imports.pop()
                    {
                        self.state = state;
                    }
                    self.sources.open.pop();
                }
            }
        }
        Ok(None)
    }

    /// A token that must follow in the same file as `after`.
    fn expect(&mut self, after: &Span, what: &str) -> Result<(Kind, Span)> {
        match self.next()? {
            Some(token) if token.1.file == after.file => Ok(token),
            _ => Err(Fault::new(after, format!("{what} must follow here, but the file ends"))),
        }
    }

    fn text(&self, span: &Span) -> &str {
        &self.sources.text(span.file)[span.bytes.clone()]
    }

    fn string(&mut self, after: &Span, what: &str) -> Result<(String, Span)> {
        let (kind, span) = self.expect(after, what)?;
        if kind != Kind::String {
            return Err(Fault::new(&span, format!("{what} in quotes must stand here")));
        }
        Ok((lexer::unquote(self.text(&span)), span))
    }

    fn number(&mut self, after: &Span) -> Result<f64> {
        let (kind, span) = self.expect(after, "a number")?;
        match self.text(&span).parse::<f64>() {
            Ok(x) if kind == Kind::Word && x.is_finite() => Ok(x),
            _ => Err(Fault::new(&span, "a number must stand here")),
        }
    }

    /// Numbers, with brackets around them or without.
    fn numbers<const N: usize>(&mut self, after: &Span) -> Result<[f64; N]> {
        let token = self.expect(after, "a number")?;
        let bracketed = token.0 == Kind::Open;
        if !bracketed {
            self.peeked = Some(token);
        }
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.number(after)?;
        }
        if bracketed {
            let (kind, span) = self.expect(after, "a closing bracket")?;
            if kind != Kind::Close {
                return Err(Fault::new(&span, format!("there must be {N} numbers")));
            }
        }
        Ok(values)
    }

    /// The parameters that follow.
    fn params(&mut self, directive: &Span) -> Result<Params> {
        let mut params = Params { all: Vec::new(), span: directive.clone() };
        while let Some(token) = self.next()? {
            if token.0 != Kind::String || token.1.file != directive.file {
                self.peeked = Some(token);
                break;
            }
            let declared = lexer::unquote(self.text(&token.1));
            let words: Vec<&str> = declared.split_ascii_whitespace().collect();
            let [kind, name] = words[..] else {
                let fault = Fault::new(&token.1, "a parameter is \"type name\"");
                return Err(fault);
            };
            if !KINDS.contains(&kind) {
                let fault = Fault::new(&token.1, format!("unknown type `{kind}`"));
                return Err(match suggest::closest(kind, KINDS.iter().copied()) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None => fault.help(format!("the types are {}", KINDS.join(", "))),
                });
            }
            let values = self.values(kind, &token.1)?;
            let param = Param::new(kind.to_owned(), name.to_owned(), values, token.1);
            params.all.push(param);
        }
        Ok(params)
    }

    fn values(&mut self, kind: &str, after: &Span) -> Result<Values> {
        let first = self.expect(after, "a value")?;
        if first.0 != Kind::Open {
            let mut values = empty(kind, first.0 == Kind::String);
            self.value(&mut values, &first)?;
            return Ok(values);
        }
        let open = first.1;
        let mut token = self.expect(&open, "a value")?;
        let mut values = empty(kind, token.0 == Kind::String);
        while token.0 != Kind::Close {
            self.value(&mut values, &token)?;
            let file = token.1.file;
            token = match self.next()? {
                Some(token) if token.1.file == file => token,
                _ => return Err(Fault::new(&open, "the bracket is not closed")),
            };
        }
        Ok(values)
    }

    fn value(&mut self, values: &mut Values, (kind, span): &(Kind, Span)) -> Result<()> {
        let text = self.text(span);
        match (values, kind) {
            (Values::Numbers(all), Kind::Word) => match text.parse::<f64>() {
                Ok(x) if x.is_finite() => {
                    all.push(x);
                    Ok(())
                }
                _ => Err(Fault::new(span, "this is not a number")),
            },
            (Values::Strings(all), Kind::String) => {
                all.push(lexer::unquote(text));
                Ok(())
            }
            (Values::Bools(all), Kind::Word | Kind::String) => {
                match lexer::unquote(text).as_str() {
                    "true" => all.push(true),
                    "false" => all.push(false),
                    _ => return Err(Fault::new(span, "this is neither true nor false")),
                }
                Ok(())
            }
            (Values::Numbers(_), _) => Err(Fault::new(span, "a number must stand here")),
            (Values::Strings(_), _) => Err(Fault::new(span, "a string in quotes must stand here")),
            (Values::Bools(_), _) => Err(Fault::new(span, "true or false must stand here")),
        }
    }

    /// The parameters that follow, and those that an `Attribute` gave for this kind of directive.
    fn params_of(&mut self, target: &str, directive: &Span) -> Result<Params> {
        let mut params = self.params(directive)?;
        if let Some(more) = self.state.attributes.get(target) {
            params.all.extend(more.iter().cloned());
        }
        Ok(params)
    }

    fn directive(&mut self, span: &Span) -> Result<()> {
        let name = self.text(span).to_owned();
        match name.as_str() {
            "Identity" => self.set(|_| Transform::IDENTITY),
            "Translate" => {
                let [x, y, z] = self.numbers(span)?;
                let rows = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]];
                self.concat(&Transform { rows });
            }
            "Scale" => {
                let [x, y, z] = self.numbers(span)?;
                if x == 0.0 || y == 0.0 || z == 0.0 {
                    return Err(Fault::new(span, "a scale of 0 flattens space"));
                }
                let rows = [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]];
                self.concat(&Transform { rows });
            }
            "Rotate" => {
                let [angle_deg, x, y, z] = self.numbers(span)?;
                if [x, y, z] == [0.0; 3] {
                    return Err(Fault::new(span, "the axis has no direction"));
                }
                let step = zrak_scene::desc::TransformStep::Rotate { axis: [x, y, z], angle_deg };
                self.concat(&Transform::of_steps(&[step]));
            }
            "LookAt" => {
                let [ex, ey, ez, lx, ly, lz, ux, uy, uz] = self.numbers(span)?;
                let map = look_at([ex, ey, ez], [lx, ly, lz], [ux, uy, uz]).ok_or_else(|| {
                    Fault::new(span, "the view has no direction, or up is along it")
                })?;
                self.concat(&map);
            }
            "Transform" => {
                let map = self.matrix(span)?;
                self.set(|_| map);
            }
            "ConcatTransform" => {
                let map = self.matrix(span)?;
                self.concat(&map);
            }
            "CoordinateSystem" => {
                let (name, _) = self.string(span, "a name")?;
                self.systems.insert(name, self.state.ctm);
            }
            "CoordSysTransform" => {
                let (name, at) = self.string(span, "a name")?;
                match self.systems.get(&name) {
                    Some(maps) => self.state.ctm = *maps,
                    None => self.warn(&at, format!("there is no coordinate system \"{name}\"")),
                }
            }
            "ActiveTransform" => {
                let (_, at) = self.expect(span, "StartTime, EndTime or All")?;
                self.state.active = match self.text(&at) {
                    "StartTime" => [true, false],
                    "EndTime" => [false, true],
                    "All" => [true; 2],
                    _ => return Err(Fault::new(&at, "StartTime, EndTime or All must stand here")),
                };
            }
            "TransformTimes" => {
                let [start, end] = self.numbers(span)?;
                if [start, end] != [0.0, 1.0] {
                    self.warn(
                        span,
                        "transforms run from time 0 to time 1; these times are ignored",
                    );
                }
            }
            "ReverseOrientation" => self.state.reverse = !self.state.reverse,
            "AttributeBegin" => self.push("Attribute", span)?,
            "AttributeEnd" => self.pop("Attribute", span)?,
            "TransformBegin" => self.push("Transform", span)?,
            "TransformEnd" => self.pop("Transform", span)?,
            "ObjectBegin" => self.object_begin(span)?,
            "ObjectEnd" => self.object_end(span)?,
            "ObjectInstance" => self.object_instance(span)?,
            "Attribute" => {
                let (target, _) = self.string(span, "what the attributes are for")?;
                let params = self.params(span)?;
                let mut all = params.all;
                if let Some(before) = self.state.attributes.get(&target) {
                    all.extend(before.iter().cloned());
                }
                self.state.attributes.insert(target, Rc::new(all));
            }
            "Include" | "Import" => {
                let (name, at) = self.string(span, "a file")?;
                let path = self.sources.resolve(&name, &at)?;
                let is_import = self.text(span) == "Import";
                if is_import {
                    self.imports.push(self.state.clone());
                }
                self.sources.enter(path, is_import, &at)?;
            }
            "WorldBegin" => {
                if self.in_world {
                    return Err(Fault::new(span, "the world has begun already"));
                }
                self.in_world = true;
                self.state.ctm = Maps::IDENTITY;
                self.state.active = [true; 2];
                self.systems.insert("world".to_owned(), Maps::IDENTITY);
            }
            "ColorSpace" => {
                let (name, at) = self.string(span, "a colour space")?;
                match SPACES.iter().find(|space| space.name == name) {
                    Some(space) => self.state.space = *space,
                    None => {
                        let names: Vec<_> = SPACES.iter().map(|space| space.name).collect();
                        let fault = Fault::new(&at, format!("unknown colour space \"{name}\""));
                        return Err(fault.help(format!("there are {}", names.join(", "))));
                    }
                }
            }
            "Option" => {
                // They are about pbrt's own ways.
                self.params(span)?;
            }
            "Camera" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.systems.insert("camera".to_owned(), inverse_of(&self.state.ctm, span)?);
                self.camera_directive(&kind, &at, params)?;
            }
            "Film" => {
                let (_, _) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.film_directive(params)?;
            }
            "Sampler" => {
                let (_, _) = self.string(span, "a type")?;
                let params = self.params(span)?;
                if let Some(n) = params.integer("pixelsamples")? {
                    self.desc.render.samples_per_pixel = n.clamp(1, 1 << 24) as u32;
                }
                if let Some(seed) = params.integer("seed")? {
                    self.desc.render.seed = seed as u64;
                }
                params.ignore(&["randomization", "xsamples", "ysamples", "jitter"]);
                self.warn_unused(&params);
            }
            "PixelFilter" | "Accelerator" => {
                // Every pixel is the mean over its area; there is one kind of tree.
                let (_, _) = self.string(span, "a type")?;
                self.params(span)?;
            }
            "Integrator" => {
                let (_, _) = self.string(span, "a type")?;
                let params = self.params(span)?;
                if let Some(n) = params.integer("maxdepth")? {
                    // Theirs counts vertices after the first, ours segments.
                    self.desc.render.max_depth = n.clamp(0, 65_000) as u32 + 1;
                }
            }
            "Shape" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("shape", span)?;
                self.world_only(span)?;
                self.shape(&kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "Material" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("material", span)?;
                let name = self.fresh("material");
                self.material(&name, &kind, &at, &params)?;
                self.warn_unused(&params);
                self.state.material = name.into();
            }
            "MakeNamedMaterial" => {
                let (name, at) = self.string(span, "a name")?;
                let params = self.params_of("material", span)?;
                let kind = match params.string("type")? {
                    Some(kind) => kind.to_owned(),
                    None => return Err(Fault::new(&at, "the material has no \"string type\"")),
                };
                self.material(&named(&name), &kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "NamedMaterial" => {
                let (name, at) = self.string(span, "a name")?;
                if !self.desc.materials.contains_key(&named(&name)) {
                    return Err(self.unknown_material(&name, &at));
                }
                self.state.material = named(&name).into();
            }
            "MakeNamedMedium" => {
                let (name, at) = self.string(span, "a name")?;
                let params = self.params_of("medium", span)?;
                self.medium(&name, &at, &params)?;
                self.warn_unused(&params);
            }
            "MediumInterface" => {
                let (inside, at) = self.string(span, "the medium inside")?;
                // With one name, it is on both sides.
                let outside = match self.next()? {
                    Some((Kind::String, span)) => lexer::unquote(self.text(&span)),
                    Some(token) => {
                        self.peeked = Some(token);
                        inside.clone()
                    }
                    None => inside.clone(),
                };
                for name in [&inside, &outside] {
                    if !name.is_empty() && !self.desc.media.contains_key(name) {
                        let message = format!("there is no medium \"{name}\"");
                        return Err(Fault::new(&at, message).help("MakeNamedMedium makes one"));
                    }
                }
                self.state.media = [inside.into(), outside.into()];
            }
            "Texture" => {
                let (name, _) = self.string(span, "a name")?;
                let (value, _) = self.string(span, "\"float\" or \"spectrum\"")?;
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("texture", span)?;
                self.texture(&name, value == "float", &kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "LightSource" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("light", span)?;
                self.world_only(span)?;
                self.light_source(&kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "AreaLightSource" => {
                let (_, at) = self.string(span, "a type")?;
                let params = self.params_of("light", span)?;
                self.area_light(&at, &params)?;
                self.warn_unused(&params);
            }
            _ => {
                let fault = Fault::new(span, format!("unknown directive `{name}`"));
                return Err(match suggest::closest(&name, DIRECTIVES.iter().copied()) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None => fault.help("files for pbrt-v3 must be converted to version 4 by pbrt"),
                });
            }
        }
        Ok(())
    }

    fn matrix(&mut self, span: &Span) -> Result<Transform> {
        // pbrt writes matrices by columns.
        let m: [f64; 16] = self.numbers(span)?;
        if [m[3], m[7], m[11]] != [0.0; 3] || m[15] == 0.0 {
            return Err(Fault::new(span, "maps that are not affine cannot be rendered"));
        }
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| m[4 * j + i] / m[15]));
        Ok(Transform { rows })
    }

    fn set(&mut self, map: impl Fn(&Transform) -> Transform) {
        let [start, end] = self.state.active;
        if start {
            self.state.ctm.start = map(&self.state.ctm.start);
        }
        if end {
            self.state.ctm.end = map(&self.state.ctm.end);
        }
    }

    /// Puts a map before those that are there.
    fn concat(&mut self, map: &Transform) {
        self.set(|ctm| map.then(ctm));
    }

    fn push(&mut self, name: &'static str, span: &Span) -> Result<()> {
        if self.stack.len() >= ATTRIBUTES_MAX {
            let message = format!("attributes are nested more than {ATTRIBUTES_MAX} deep");
            return Err(Fault::new(span, message));
        }
        self.stack.push((self.state.clone(), name));
        Ok(())
    }

    fn pop(&mut self, name: &'static str, span: &Span) -> Result<()> {
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

    fn world_only(&self, span: &Span) -> Result<()> {
        if self.in_world {
            return Ok(());
        }
        Err(Fault::new(span, "this must come after WorldBegin"))
    }

    fn object_begin(&mut self, span: &Span) -> Result<()> {
        let (name, at) = self.string(span, "a name")?;
        self.world_only(span)?;
        if self.object.is_some() {
            return Err(Fault::new(&at, "objects cannot be defined within objects"));
        }
        self.push("Object", span)?;
        self.object = Some((name, Vec::new()));
        Ok(())
    }

    fn object_end(&mut self, span: &Span) -> Result<()> {
        self.pop("Object", span)?;
        if let Some((name, objects)) = self.object.take() {
            self.desc.prototypes.insert(name, objects);
        }
        Ok(())
    }

    fn object_instance(&mut self, span: &Span) -> Result<()> {
        let (name, at) = self.string(span, "a name")?;
        if self.object.is_some() {
            return Err(Fault::new(&at, "objects cannot be placed within objects"));
        }
        if !self.desc.prototypes.contains_key(&name) {
            let fault = Fault::new(&at, format!("there is no object \"{name}\""));
            let names = self.desc.prototypes.keys().map(String::as_str);
            return Err(match suggest::closest(&name, names) {
                Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                None => fault.help("ObjectBegin begins one"),
            });
        }
        let object = self.instance(name);
        self.desc.objects.push(object);
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

    fn unknown_material(&self, name: &str, at: &Span) -> Fault {
        let fault = Fault::new(at, format!("there is no material \"{name}\""));
        let names = self.desc.materials.keys().filter_map(|key| key.strip_prefix("named:"));
        match suggest::closest(name, names) {
            Some(near) => fault.help(format!("did you mean \"{near}\"?")),
            None => fault.help("MakeNamedMaterial makes one"),
        }
    }

    /// A name that nothing has yet.
    pub(crate) fn fresh(&mut self, what: &str) -> String {
        self.n_names += 1;
        format!("{what}:{}", self.n_names)
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

/// A map as the steps of a description.
pub(crate) fn steps(map: &Transform) -> Vec<zrak_scene::desc::TransformStep> {
    if *map == Transform::IDENTITY { Vec::new() } else { vec![matrix_step(map)] }
}

pub(crate) fn matrix_step(map: &Transform) -> zrak_scene::desc::TransformStep {
    zrak_scene::desc::TransformStep::Matrix(map.rows)
}

fn empty(kind: &str, quoted: bool) -> Values {
    match kind {
        "bool" => Values::Bools(Vec::new()),
        "string" | "texture" => Values::Strings(Vec::new()),
        "spectrum" if quoted => Values::Strings(Vec::new()),
        _ => Values::Numbers(Vec::new()),
    }
}

fn inverse_of(maps: &Maps, span: &Span) -> Result<Maps> {
    let one = |map: &Transform| {
        map.inverse().ok_or_else(|| Fault::new(span, "the map at this point flattens space"))
    };
    Ok(Maps { start: one(&maps.start)?, end: one(&maps.end)? })
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 1e-12).then(|| a.map(|x| x / length))
}

/// From the world to a camera at `eye`, whose z axis points at `look`: left-handed, as pbrt has it.
fn look_at(eye: [f64; 3], look: [f64; 3], up: [f64; 3]) -> Option<Transform> {
    let forward = unit(sub(look, eye))?;
    let right = unit(cross(unit(up)?, forward))?;
    let up = cross(forward, right);
    let row = |axis: [f64; 3]| [axis[0], axis[1], axis[2], -dot(axis, eye)];
    Some(Transform { rows: [row(right), row(up), row(forward)] })
}

/// All directives, for suggestions.
const DIRECTIVES: [&str; 39] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "Translate",
    "WorldBegin",
];
