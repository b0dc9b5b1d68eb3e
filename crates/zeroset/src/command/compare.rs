//! `zeroset compare`.

use crate::args::CompareArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_watched;
use crate::json;
use serde::Serialize;
use zeroset_output::atomic::probe;
use zeroset_output::compare::{Comparison, compare};
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{Depth, write_watched as write_watched_png};
use zeroset_output::format::read::read;

/// What `--json` prints.
#[derive(Serialize)]
struct Numbers {
    width: u32,
    height: u32,
    /// Whether every pixel is the same.
    equal: bool,
    rmse: f64,
    /// Decibels; null for equal pictures.
    psnr: Option<f64>,
    largest: f64,
    ssim: f64,
    flip_mean: f64,
    flip_p99: f64,
}

/// Compares two pictures.
pub(crate) fn run(args: &CompareArgs, console: &Console) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let (reference, test) = (read(&args.reference)?, read(&args.test)?);
    let found =
        compare(&reference, &test).map_err(|error| Failure::new(Exit::Job, error.to_string()))?;
    if let Some(path) = &args.output {
        let notes = Metadata::new("difference").with("Metric", "FLIP");
        let picture = found.picture();
        write_watched(path, console, &|| false, |writer, observer| {
            write_watched_png(writer, &picture, Depth::Eight, &notes, observer)
        })?;
    }
    if args.json {
        return console.emit(&json::line(&Numbers::of(&found))?);
    }
    let psnr = if found.psnr.is_finite() {
        format!("{:.2} dB", found.psnr)
    } else {
        "equal".to_owned()
    };
    console.print(&format!(
        "size       {} x {}\nRMSE       {:.6}\nPSNR       {psnr}\nlargest    {:.6}\nSSIM       {:.6}\nFLIP mean  {:.6}\n\
         FLIP 99 %  {:.6}",
        found.width, found.height, found.rmse, found.largest, found.ssim, found.flip_mean, found.flip_p99,
    ))
}

impl Numbers {
    fn of(found: &Comparison) -> Numbers {
        Numbers {
            width: found.width,
            height: found.height,
            equal: found.largest == 0.0,
            rmse: found.rmse,
            psnr: found.psnr.is_finite().then_some(found.psnr),
            largest: found.largest,
            ssim: found.ssim,
            flip_mean: found.flip_mean,
            flip_p99: found.flip_p99,
        }
    }
}
