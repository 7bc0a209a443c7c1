//! `zrak compare`: how two pictures differ.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use zrak::image::{Comparison, ErrorKind};

use crate::exit_codes::Exit;
use crate::failure::Failure;
use crate::terminal;

pub(crate) const EXAMPLES: &str = "\
Examples:
  zrak compare cpu.pfm gpu.pfm --identical     exit code 1 if any bit differs
  zrak compare a.exr b.exr --max-rmse 0.01     exit code 1 if they differ by more

The numbers are of linear radiance; PNG and JPEG are taken for sRGB. Only PFM and EXR keep every bit.";

/// Options of `zrak compare`.
#[derive(Args, Debug)]
pub(crate) struct CompareArgs {
    /// A picture: PNG, JPEG, HDR, EXR or PFM
    a: PathBuf,
    /// Another one of the same size
    b: PathBuf,
    /// Fail (exit code 1) if the root of the mean squared difference is larger
    #[arg(long, value_name = "X", value_parser = parse_limit, allow_negative_numbers = true)]
    max_rmse: Option<f64>,
    /// Fail (exit code 1) if any bit of a pixel differs
    #[arg(long)]
    identical: bool,
    /// Print one line of JSON
    #[arg(long)]
    json: bool,
}

fn parse_limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(limit) if limit >= 0.0 => Ok(limit),
        Ok(_) => Err("a limit is 0 or more".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

#[derive(Serialize)]
struct Json {
    max_abs: f64,
    mean_abs: f64,
    rmse: f64,
    /// None when it is infinite.
    psnr_db: Option<f64>,
    differing_pixels: u64,
    pixels: u64,
    first_difference: Option<(u32, u32)>,
    identical: bool,
    ok: bool,
}

/// Compares, and fails with [`Exit::Different`] above the limits.
pub(crate) fn run(args: &CompareArgs) -> Result<Exit, Failure> {
    let read = |path| zrak::image::read_picture(path).map_err(|error| Failure::file(&error));
    let comparison = zrak::image::compare(&read(&args.a)?, &read(&args.b)?).map_err(|error| {
        let differ = error.kind() == ErrorKind::SizeMismatch;
        Failure::new(if differ { Exit::Different } else { Exit::File }, error.to_string())
    })?;

    let is_identical = comparison.n_differing_pixels == 0;
    // Written so that a NaN is over every limit.
    let is_near = args.max_rmse.is_none_or(|limit| comparison.rmse <= limit);
    let is_ok = is_near && (is_identical || !args.identical);
    if args.json {
        terminal::print_json(&json(&comparison, is_ok))?;
    } else {
        terminal::print(&describe(&comparison))?;
    }
    if !is_near {
        let limit = args.max_rmse.unwrap_or_default();
        terminal::note(&format!("the RMSE {} is over the limit {limit}", comparison.rmse));
    }
    if args.identical && !is_identical {
        terminal::note("the pictures are not identical");
    }
    Ok(if is_ok { Exit::Success } else { Exit::Different })
}

fn json(comparison: &Comparison, ok: bool) -> Json {
    Json {
        max_abs: comparison.max_abs,
        mean_abs: comparison.mean_abs,
        rmse: comparison.rmse,
        psnr_db: comparison.psnr_db.is_finite().then_some(comparison.psnr_db),
        differing_pixels: comparison.n_differing_pixels,
        pixels: comparison.n_pixels,
        first_difference: comparison.first_difference,
        identical: comparison.n_differing_pixels == 0,
        ok,
    }
}

fn describe(comparison: &Comparison) -> String {
    let Some((x, y)) = comparison.first_difference else {
        return format!("identical: all {} pixels\n", comparison.n_pixels);
    };
    format!(
        "max difference    {:.6}\n\
         mean difference   {:.6}\n\
         RMSE              {:.6}\n\
         PSNR              {:.2} dB\n\
         differing pixels  {} of {}, the first at ({x}, {y})\n",
        comparison.max_abs,
        comparison.mean_abs,
        comparison.rmse,
        comparison.psnr_db,
        comparison.n_differing_pixels,
        comparison.n_pixels
    )
}
