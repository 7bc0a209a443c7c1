//! MTL files: what each material says, as it says it.

use std::collections::HashMap;

use zrak_mesh::Error;
use zrak_mesh::text::{Line, Lines, Word, Words};
use zrak_scene::desc::{ImageChannel, Triple};

/// A material. What it does not say is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mtl {
    pub(crate) name: String,
    /// Where it begins.
    pub(crate) line: usize,
    /// `Kd`, `Ks`, `Ke`, `Tf`.
    pub(crate) colors: HashMap<&'static str, Triple>,
    /// `Ns`, `Ni`, `d`, `Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`.
    pub(crate) numbers: HashMap<&'static str, f64>,
    pub(crate) illum: Option<u32>,
    /// By what they are maps of; `bump` and `norm` too.
    pub(crate) maps: HashMap<&'static str, Map>,
}

/// A picture, and how it is looked up.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Map {
    pub(crate) line: usize,
    /// As it stands in the file.
    pub(crate) path: String,
    pub(crate) offset: [f64; 2],
    pub(crate) scale: [f64; 2],
    /// Added to the values, after they were multiplied by the gain.
    pub(crate) base: f64,
    pub(crate) gain: f64,
    pub(crate) bump: f64,
    pub(crate) clamps: bool,
    pub(crate) channel: Option<ImageChannel>,
}

/// Keywords of colours, numbers and maps, and what they are called here.
const COLORS: [(&str, &str); 4] = [("kd", "Kd"), ("ks", "Ks"), ("ke", "Ke"), ("tf", "Tf")];
const NUMBERS: [(&str, &str); 9] = [
    ("ns", "Ns"),
    ("ni", "Ni"),
    ("d", "d"),
    ("pr", "Pr"),
    ("pm", "Pm"),
    ("ps", "Ps"),
    ("pc", "Pc"),
    ("pcr", "Pcr"),
    ("aniso", "aniso"),
];
const MAPS: [(&str, &str); 16] = [
    ("map_kd", "Kd"),
    ("map_ks", "Ks"),
    ("map_ke", "Ke"),
    ("map_d", "d"),
    ("map_opacity", "d"),
    ("map_pr", "Pr"),
    ("map_pm", "Pm"),
    ("map_ps", "Ps"),
    ("map_pc", "Pc"),
    ("map_pcr", "Pcr"),
    ("map_aniso", "aniso"),
    ("bump", "bump"),
    ("map_bump", "bump"),
    ("norm", "norm"),
    ("map_norm", "norm"),
    ("map_kn", "norm"),
];
/// Keywords that mean nothing to a path tracer, or nothing that is visible.
const SILENT: [&str; 6] = ["ka", "map_ka", "map_aat", "sharpness", "km", "unsmoothed"];

/// The materials of a file; what is left out is given to `warn` with its line.
pub(crate) fn parse(bytes: &[u8], mut warn: impl FnMut(usize, String)) -> Result<Vec<Mtl>, Error> {
    let mut all: Vec<Mtl> = Vec::new();
    let mut warned = Vec::new();
    for line in Lines::new(bytes) {
        let mut words = line.words();
        let Some(keyword) = words.next() else { continue };
        let key = keyword.text().to_ascii_lowercase();
        if key == "newmtl" {
            let name = words.rest().text().into_owned();
            all.push(Mtl { name, line: line.number, ..Mtl::default() });
            continue;
        }
        let Some(mtl) = all.last_mut() else {
            let message =
                format!("`{}` comes before any `newmtl`; is this an MTL file?", keyword.text());
            return Err(line.error(keyword.span(), message));
        };
        if let Some(message) = statement(mtl, &line, &key, words)?
            && !warned.contains(&message)
            && warned.len() < 64
        {
            warn(line.number, message.clone());
            warned.push(message);
        }
    }
    Ok(all)
}

fn of(table: &[(&str, &'static str)], key: &str) -> Option<&'static str> {
    table.iter().find(|(known, _)| *known == key).map(|(_, name)| *name)
}

/// Reads a line of a material; gives what is left out.
fn statement(
    mtl: &mut Mtl,
    line: &Line<'_>,
    key: &str,
    mut words: Words<'_>,
) -> Result<Option<String>, Error> {
    if let Some(name) = of(&COLORS, key) {
        return match color(line, &mut words)? {
            Some(color) => {
                mtl.colors.insert(name, color);
                Ok(None)
            }
            None => Ok(Some(format!("`{name}` by a spectrum or as XYZ is left out"))),
        };
    }
    if let Some(name) = of(&NUMBERS, key) {
        let mut word = words.next();
        if key == "d" && word.is_some_and(|w| w.bytes == b"-halo") {
            word = words.next();
        }
        mtl.numbers.insert(name, number(line, word, &words)?);
        return Ok(None);
    }
    if let Some(name) = of(&MAPS, key) {
        let (map, left_out) = map(line, words)?;
        mtl.maps.insert(name, map);
        return Ok(left_out);
    }
    match key {
        "tr" => {
            let opacity = 1.0 - number(line, words.next(), &words)?;
            // Where both are said, they are the same, but for exporters that do not know it.
            mtl.numbers.entry("d").or_insert(opacity);
        }
        "illum" => {
            let word = words.next();
            let n = number(line, word, &words)?;
            let known = (0.0..=10.0).contains(&n) && n.fract() == 0.0;
            if !known {
                return Ok(Some(format!("`illum {n}` is unknown and is left out")));
            }
            mtl.illum = Some(n as u32);
        }
        key if SILENT.contains(&key) => {}
        "map_ns" => {
            return Ok(Some("`map_Ns` is left out: only `map_Pr` makes roughness vary".into()));
        }
        "anisor" | "map_anisor" | "disp" | "map_disp" | "decal" | "refl" | "map_refl"
        | "map_tr" | "map_ni" | "map_rma" | "map_orm" | "map_tf" => {
            return Ok(Some(format!("`{key}` is left out")));
        }
        key => {
            let key: String = key.chars().filter(|c| !c.is_control()).take(40).collect();
            return Ok(Some(format!("`{key}` is unknown and is left out")));
        }
    }
    Ok(None)
}

fn number(line: &Line<'_>, word: Option<Word<'_>>, words: &Words<'_>) -> Result<f64, Error> {
    let Some(word) = word else {
        return Err(line.error(words.end(), "a number is missing here"));
    };
    word.number()
        .ok_or_else(|| line.error(word.span(), format!("`{}` is not a finite number", word.text())))
}

/// One number for all channels, or three; none if it is something else than red, green and blue.
fn color(line: &Line<'_>, words: &mut Words<'_>) -> Result<Option<Triple>, Error> {
    let first = words.next();
    if first.is_some_and(|w| matches!(w.bytes, b"spectral" | b"xyz")) {
        return Ok(None);
    }
    let r = number(line, first, words)?;
    let Some(second) = words.next() else { return Ok(Some([r; 3])) };
    let g = number(line, Some(second), words)?;
    let third = words.next();
    Ok(Some([r, g, number(line, third, words)?]))
}

/// Options and a path, which may have spaces in it.
fn map(line: &Line<'_>, mut words: Words<'_>) -> Result<(Map, Option<String>), Error> {
    let mut map = Map {
        line: line.number,
        path: String::new(),
        offset: [0.0; 2],
        scale: [1.0; 2],
        base: 0.0,
        gain: 1.0,
        bump: 1.0,
        clamps: false,
        channel: None,
    };
    let mut left_out = None;
    loop {
        let rest = words.rest();
        let mut after = words.clone();
        let Some(option) = after.next().filter(|w| w.bytes.starts_with(b"-")) else {
            map.path = rest.text().into_owned();
            break;
        };
        match option.bytes {
            b"-o" | b"-s" | b"-t" => {
                let fill = if option.bytes == b"-s" { 1.0 } else { 0.0 };
                let values = up_to_three(line, &mut after, fill)?;
                match option.bytes {
                    b"-o" => map.offset = values,
                    b"-s" => map.scale = values,
                    _ => left_out = Some("the turbulence of maps, `-t`, is left out".to_owned()),
                }
            }
            b"-mm" => {
                let first = after.next();
                map.base = number(line, first, &after)?;
                let second = after.next();
                map.gain = number(line, second, &after)?;
            }
            b"-bm" => {
                let word = after.next();
                map.bump = number(line, word, &after)?;
            }
            b"-clamp" => map.clamps = after.next().is_some_and(|w| w.bytes == b"on"),
            b"-imfchan" => {
                map.channel = match after.next().map(|w| w.bytes) {
                    Some(b"r") => Some(ImageChannel::R),
                    Some(b"g") => Some(ImageChannel::G),
                    Some(b"b") => Some(ImageChannel::B),
                    Some(b"m") => Some(ImageChannel::A),
                    Some(b"l") => Some(ImageChannel::Color),
                    _ => {
                        left_out = Some("this `-imfchan` is left out".to_owned());
                        None
                    }
                };
            }
            // How pictures are filtered is the renderer's affair.
            b"-blendu" | b"-blendv" | b"-boost" | b"-texres" | b"-cc" | b"-type" => {
                after.next();
            }
            _ => {
                // It may be a file whose name begins so.
                map.path = rest.text().into_owned();
                break;
            }
        }
        words = after;
    }
    if map.path.is_empty() {
        return Err(line.error(words.end(), "the name of a picture is missing here"));
    }
    Ok((map, left_out))
}

/// One to three numbers, of which the first two count.
fn up_to_three(line: &Line<'_>, words: &mut Words<'_>, fill: f64) -> Result<[f64; 2], Error> {
    let word = words.next();
    let first = number(line, word, words)?;
    let mut values = [first, fill];
    for i in 1..3 {
        let mut after = words.clone();
        let Some(x) = after.next().and_then(|w| w.number()) else { break };
        if i == 1 {
            values[1] = x;
        }
        *words = after;
    }
    Ok(values)
}
