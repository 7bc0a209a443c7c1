//! `zrak render`: a scene to picture files.

mod report;

use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, ValueEnum};
use zrak::{BackendChoice, ErrorKind, LoweredScene, RenderOptions, RenderOutput, Scene, Transfer};

use crate::args::BackendArgs;
use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::load::LoadArgs;
use crate::overrides::Overrides;
use crate::progress::Progress;
use crate::{interrupt, terminal};
use report::Report;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak render final                               to final.png, on the GPU if there is one
  zrak render final --width 1600 --spp 1000       larger (the aspect ratio stays) and cleaner
  zrak render killeroo.pbrt -o killeroo.exr       a scene for pbrt-v4
  zrak render crown.zscene                        a scene that `zrak compile` made
  zrak render model.glb --camera Close            a glTF file, seen by one of its cameras
  zrak render my.toml -o my.png -o my.exr         one for the screen, one for further work
  zrak render cover --backend cpu --threads 1     on one thread: the same picture
  zrak render cover --json --quiet | jq .times    what it took, for a script

Ctrl-C stops at once and writes the samples per pixel that are finished; a second one ends without.";

/// Options of `zrak render`.
#[derive(Args, Debug)]
pub(crate) struct RenderArgs {
    /// Built-in scene (see `zrak scenes`) or path of a .toml, .pbrt, .gltf, .glb, .obj or .zscene file
    scene: PathBuf,
    /// Picture to write, as .png, .jpg, .hdr, .exr or .pfm; may be repeated [default: the scene's name, as .png]
    #[arg(long, short, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How radiance becomes the 8 bits of PNG and JPEG
    #[arg(long, value_name = "CURVE", default_value = "srgb")]
    transfer: TransferName,
    /// Print one line of JSON about the render on stdout
    #[arg(long)]
    json: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    overrides: Overrides,
    #[command(flatten)]
    pub(crate) backend: BackendArgs,
}

/// [`Transfer`] on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum TransferName {
    /// The curve that screens expect
    Srgb,
    /// The square root, as in Ray Tracing in One Weekend
    Gamma2,
}

/// Renders, and ends with the exit code of what happened.
pub(crate) fn run(args: &RenderArgs, start: Instant) -> Result<Exit, Failure> {
    let control = interrupt::install();
    let mut loaded = args.load.load(&args.scene, args.quiet)?;
    args.overrides.apply(&mut loaded.scene.desc)?;
    let outputs = outputs(args, &loaded.scene)?;
    let (scene, LoweredScene { arena, .. }) = loaded.lower()?;
    let build_s = start.elapsed().as_secs_f64();

    let spp = scene.desc.render.samples_per_pixel;
    let n_pixels = u64::from(scene.desc.camera.width) * u64::from(scene.desc.camera.height);
    let progress = Progress::start(&control, n_pixels, spp, args.quiet);
    let options = args.backend.options();
    let rendered = zrak::render(arena, spp, &options, &control, &mut |line| progress.note(line));
    drop(progress);

    // What was finished before a failure is written like what was finished before Ctrl-C.
    let (output, failure) = match rendered {
        Ok(output) => (Some(output), None),
        Err(error) => (error.finished().cloned(), Some(explain(error, &options))),
    };
    if let Some(output) = output {
        let write_start = Instant::now();
        let (written, write_failure) = write(&output, &scene, &outputs, args.transfer);
        let report = Report {
            scene: &scene,
            output: &output,
            options: &options,
            build_s,
            write_s: write_start.elapsed().as_secs_f64(),
            total_s: start.elapsed().as_secs_f64(),
            outputs: &written,
        };
        report.show(args)?;
        if let Some(failure) = write_failure {
            return Err(failure);
        }
        if output.n_samples < spp && failure.is_none() {
            terminal::note(&report.interrupted());
            return Ok(Exit::Interrupted);
        }
    }
    failure.map_or(Ok(Exit::Success), Err)
}

/// What to tell of a backend that failed: who asked for a GPU may not know that any will do.
fn explain(error: zrak::Error, options: &RenderOptions) -> Failure {
    let is_missing = error.kind() == ErrorKind::Backend && error.finished().is_none();
    if is_missing && options.backend == BackendChoice::Cuda {
        let advice = "`--backend auto` renders the same picture on what there is";
        return Failure::new(Exit::Backend, format!("{error}; {advice}"));
    }
    error.into()
}

/// Where to write, once it is known that all of it can be written to.
fn outputs(args: &RenderArgs, scene: &Scene) -> Result<Vec<PathBuf>, Failure> {
    let mut outputs = args.output.clone();
    if outputs.is_empty() {
        outputs.push(PathBuf::from(file_name(&scene.desc.name) + ".png"));
    }
    for path in &outputs {
        zrak::image::check_writable(path).map_err(|error| Failure::file(&error))?;
    }
    Ok(outputs)
}

/// The name of a scene, which may be any text, as the name of a file.
fn file_name(name: &str) -> String {
    let is_safe = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    let name: String = name.chars().map(|c| if is_safe(c) { c } else { '-' }).take(80).collect();
    let name = name.trim_matches(['.', ' ']);
    if name.is_empty() { "scene".to_owned() } else { name.to_owned() }
}

/// Writes the picture to all places, unless it has no sample. Returns those that were written and
/// the last failure.
fn write(
    output: &RenderOutput,
    scene: &Scene,
    paths: &[PathBuf],
    transfer: TransferName,
) -> (Vec<PathBuf>, Option<Failure>) {
    let (mut written, mut failure) = (Vec::new(), None);
    if output.n_samples == 0 {
        return (written, failure);
    }
    let transfer = match transfer {
        TransferName::Srgb => Transfer::Srgb,
        TransferName::Gamma2 => Transfer::Gamma2,
    };
    let (picture, metadata) = (output.film.to_picture(), output.metadata(&scene.desc));
    for path in paths {
        // One that fails does not cost the others.
        match zrak::image::write(path, &picture, Some(&metadata), transfer) {
            Ok(()) => written.push(path.clone()),
            Err(error) => {
                let earlier: Option<Failure> = failure.replace(Failure::file(&error));
                earlier.map(Failure::report);
            }
        }
    }
    (written, failure)
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn any_name_is_a_file_name() {
        for (name, expected) in [
            ("cornell-box", "cornell-box"),
            ("../../etc/passwd", "-..-etc-passwd"),
            ("a\u{1b}[31mb\n", "a--31mb-"),
            ("Świat 2.0", "Świat 2.0"),
            ("..", "scene"),
            ("", "scene"),
        ] {
            assert_eq!(file_name(name), expected);
        }
    }
}
