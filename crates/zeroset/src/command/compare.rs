//! `zeroset compare`.

use crate::args::CompareArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_watched;
use crate::json;
use serde::Serialize;
use std::path::{Path, PathBuf};
use zeroset_output::atomic::probe;
use zeroset_output::compare::{Comparison, compare};
use zeroset_output::display;
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{Depth, write_watched as write_watched_png};
use zeroset_output::format::read::read;

/// What `--json` prints.
#[derive(Serialize)]
struct Numbers {
    /// What was compared, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
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

/// Compares pictures with one.
pub(crate) fn run(args: &CompareArgs, console: &Console) -> Result<(), Failure> {
    match args.tests.as_slice() {
        [test] => one(args, test, console),
        _ if args.output.is_some() => {
            let help = "compare it alone, or leave out -o";
            let message = "-o writes the differences of one picture";
            Err(Failure::with_help(Exit::Usage, message, help))
        }
        tests => many(args, tests, console),
    }
}

/// A table: a line for each picture.
fn many(args: &CompareArgs, tests: &[PathBuf], console: &Console) -> Result<(), Failure> {
    let reference = read(&args.reference)?;
    if !args.json {
        console.print("RMSE      PSNR       largest   SSIM      FLIP mean  FLIP 99 %  picture")?;
    }
    for path in tests {
        let found = compare(&reference, &read(path)?)
            .map_err(|error| Failure::new(Exit::Job, format!("{}: {error}", path.display())))?;
        let name = display::name(&path.to_string_lossy(), display::LINE);
        if args.json {
            let numbers = Numbers {
                file: Some(name),
                ..Numbers::of(&found)
            };
            console.emit(&json::line(&numbers)?)?;
            continue;
        }
        console.print(&format!(
            "{:.6}  {:<9}  {:.6}  {:.6}  {:.6}   {:.6}   {name}",
            found.rmse,
            decibels(found.psnr),
            found.largest,
            found.ssim,
            found.flip_mean,
            found.flip_p99
        ))?;
    }
    Ok(())
}

fn decibels(psnr: f64) -> String {
    if psnr.is_finite() {
        format!("{psnr:.2} dB")
    } else {
        "equal".to_owned()
    }
}

/// Two pictures.
fn one(args: &CompareArgs, test: &Path, console: &Console) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let (reference, test) = (read(&args.reference)?, read(test)?);
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
    let psnr = decibels(found.psnr);
    console.print(&format!(
        "size       {} x {}\nRMSE       {:.6}\nPSNR       {psnr}\nlargest    {:.6}\nSSIM       {:.6}\nFLIP mean  {:.6}\n\
         FLIP 99 %  {:.6}",
        found.width, found.height, found.rmse, found.largest, found.ssim, found.flip_mean, found.flip_p99,
    ))
}

impl Numbers {
    fn of(found: &Comparison) -> Numbers {
        Numbers {
            file: None,
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
