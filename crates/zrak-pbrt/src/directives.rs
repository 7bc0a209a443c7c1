//! The directives.

use zrak_scene::desc::TransformStep;
use zrak_scene::lower::Transform;
use zrak_scene::suggest;

use crate::color::SPACES;
use crate::error::{Fault, Result, Span};
use crate::lexer::{self, Kind};
use crate::maths::{Maps, inverse_of, look_at};
use crate::references::What;
use crate::state::{Importer, named};

impl Importer {
    pub(crate) fn directive(&mut self, span: &Span) -> Result<()> {
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
                let step = TransformStep::Rotate { axis: [x, y, z], angle_deg };
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
                    None => {
                        let names = self.systems.keys().map(String::as_str);
                        let near = suggest::closest(&name, names)
                            .map_or_else(String::new, |near| format!("; did you mean \"{near}\"?"));
                        let message = format!(
                            "there is no coordinate system \"{name}\": the map stays as it is{near}"
                        );
                        self.warn(&at, message);
                    }
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
                let (target, at) = self.string(span, "what the attributes are for")?;
                let params = self.params(span)?;
                self.attribute(&target, &at, params)?;
            }
            "Include" | "Import" => {
                let (name, at) = self.string(span, "a file")?;
                let path = self.sources.resolve(&name, &at)?;
                let is_import = self.text(span) == "Import";
                self.sources.enter(path, is_import, &at)?;
                if is_import {
                    self.imports.push((self.state.clone(), self.stack.len()));
                }
            }
            "WorldBegin" => {
                if self.in_world {
                    return Err(Fault::new(span, "the world has begun already"));
                }
                self.in_world = true;
                self.expose()?;
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
                        return Err(Fault::unknown(&at, "colour space", &name, &names));
                    }
                }
            }
            "Option" => {
                let params = self.params(span)?;
                self.option(&params)?;
            }
            "Camera" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.systems.insert("camera".to_owned(), inverse_of(&self.state.ctm, span)?);
                self.places.camera = span.clone();
                self.camera_directive(&kind, &at, params)?;
            }
            "Film" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.film_directive(&kind, &at, params)?;
            }
            "Sampler" => {
                let (_, _) = self.string(span, "a type")?;
                let params = self.params(span)?;
                let grid = [params.integer("xsamples")?, params.integer("ysamples")?];
                let grid = match grid {
                    [None, None] => None,
                    // Stratified: four by four if it does not say.
                    [x, y] => Some(x.unwrap_or(4).saturating_mul(y.unwrap_or(4))),
                };
                if let Some(n) = params.integer("pixelsamples")?.or(grid) {
                    self.desc.render.samples_per_pixel = n.clamp(1, 1 << 24) as u32;
                }
                if let Some(seed) = params.integer("seed")? {
                    self.desc.render.seed = seed as u64;
                }
                params.ignore(&["randomization", "jitter"]);
                self.warn_unused(&params);
            }
            "PixelFilter" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.pixel_filter(&kind, &at, &params)?;
            }
            "Accelerator" => {
                // There is one kind of tree.
                let (_, _) = self.string(span, "a type")?;
                self.params(span)?;
            }
            "Integrator" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params(span)?;
                self.integrator(&kind, &at, &params)?;
            }
            "Shape" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("shape", span)?;
                self.world_only(span)?;
                let before = self.n_objects();
                self.shape(&kind, &at, &params)?;
                self.apply_power(before, &at)?;
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
                self.is_new(What::Material, &name, &at)?;
                let kind = match params.string("type")? {
                    Some(kind) => kind.to_owned(),
                    None => return Err(Fault::new(&at, "the material has no \"string type\"")),
                };
                self.material(&named(&name), &kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "NamedMaterial" => {
                let (name, at) = self.string(span, "a name")?;
                self.refer(What::Material, &name, &at);
                self.state.material = named(&name).into();
            }
            "MakeNamedMedium" => {
                let (name, at) = self.string(span, "a name")?;
                let params = self.params_of("medium", span)?;
                self.is_new(What::Medium, &name, &at)?;
                self.medium(&name, &at, &params)?;
                self.warn_unused(&params);
            }
            "MediumInterface" => {
                let (inside, at) = self.string(span, "the medium inside")?;
                // With one name, it is on both sides.
                let (outside, outside_at) = match self.next_in(span.file)? {
                    Some((Kind::String, span)) => (lexer::unquote(self.text(&span)), span),
                    token => {
                        self.peeked = token;
                        (inside.clone(), at.clone())
                    }
                };
                for (name, at) in [(&inside, &at), (&outside, &outside_at)] {
                    if !name.is_empty() {
                        self.refer(What::Medium, name, at);
                    }
                }
                self.state.media = [inside.into(), outside.into()];
            }
            "Texture" => {
                let (name, name_at) = self.string(span, "a name")?;
                let (value, value_at) = self.string(span, "\"float\" or \"spectrum\"")?;
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("texture", span)?;
                let what = match value.as_str() {
                    "float" => What::FloatTexture,
                    "spectrum" => What::SpectrumTexture,
                    _ => {
                        let message = format!("there are no textures of \"{value}\"");
                        let fault = Fault::new(&value_at, message);
                        return Err(fault.help("textures are of \"float\" or \"spectrum\""));
                    }
                };
                self.is_new(what, &name, &name_at)?;
                self.in_texture = true;
                self.texture(&name, value == "float", &kind, &at, &params)?;
                self.in_texture = false;
                self.warn_unused(&params);
            }
            "LightSource" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("light", span)?;
                self.world_only(span)?;
                if kind == "infinite" {
                    self.places.background = span.clone();
                }
                self.light_source(&kind, &at, &params)?;
                self.warn_unused(&params);
            }
            "AreaLightSource" => {
                let (kind, at) = self.string(span, "a type")?;
                let params = self.params_of("light", span)?;
                self.world_only(span)?;
                self.area_light(&kind, &at, &params)?;
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
