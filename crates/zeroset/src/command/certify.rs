//! `zeroset certify`.

use crate::args::CertifyArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::{Progress, only_png, write_watched};
use crate::interrupt::{self, Asking};
use crate::json;
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;
use zeroset_output::atomic::probe;
use zeroset_output::display::{self, NAME};
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{self, Depth};
use zeroset_output::picture::Picture;
use zeroset_scene::film::Plane;
use zeroset_trace::CpuRenderer;
use zeroset_trace::certify::{Certificate, Verdict};

/// The verdicts with what they are called and the colours of the map, linear.
const VERDICTS: [(Verdict, &str, [f32; 3]); 4] = [
    (Verdict::Hit, "proven hits", [0.06, 0.32, 0.12]),
    (Verdict::Miss, "proven misses", [0.05, 0.12, 0.3]),
    (Verdict::Unknown, "unknown", [0.83, 0.55, 0.12]),
    (Verdict::Wrong, "wrong", [0.75, 0.02, 0.02]),
];

/// What `--json` prints.
#[derive(Serialize)]
struct Numbers {
    scene: String,
    width: u32,
    height: u32,
    hits: usize,
    misses: usize,
    unknown: usize,
    wrong: usize,
    /// The share of pixels that are proven, 0 to 1.
    proven: f64,
    seconds: f64,
}

/// Proves a picture pixel by pixel.
pub(crate) fn run(args: &CertifyArgs, console: &Console) -> Result<(), Failure> {
    let _asking = Asking::begin();
    if let Some(path) = &args.output {
        only_png(path, "maps")?;
    }
    let options = crate::scene::options(&args.scene, args.size.map(|size| size.0))?;
    let scene = crate::scene::loaded(&args.scene, &options, console)?.scene;
    let size = scene.settings().size;
    (options.limits)
        .check_picture(size, &[Plane::Depth, Plane::Coverage], 16)
        .map_err(|e| Failure::new(Exit::Scene, e.to_string()))?;
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let name = scene.name().to_owned();
    let began = Instant::now();
    let prepared =
        CpuRenderer::new(args.threads.map(usize::from))?.prepare_scene(Arc::new(scene))?;
    let progress = Progress {
        bar: indicatif::ProgressBar::hidden(),
        cancelled: &interrupt::requested,
    };
    let found = prepared.certify(size, &progress)?;
    let seconds = began.elapsed().as_secs_f64();
    if let Some(path) = &args.output {
        let notes = Metadata::new(&name).with("Certificate", told(&found));
        let picture = map(&found);
        write_watched(path, console, &interrupt::requested, |writer, observer| {
            png::write_watched(writer, &picture, Depth::Eight, &notes, observer)
        })?;
    }
    if args.json {
        let count = |verdict| found.count(verdict);
        console.emit(&json::line(&Numbers {
            scene: name,
            width: size[0],
            height: size[1],
            hits: count(Verdict::Hit),
            misses: count(Verdict::Miss),
            unknown: count(Verdict::Unknown),
            wrong: count(Verdict::Wrong),
            proven: found.proven(),
            seconds,
        })?)?;
    } else {
        console.print(&format!(
            "{}, {} x {}: {:.3} % of the pixels are proven ({}) in {seconds:.1} s\n",
            display::name(&name, NAME),
            size[0],
            size[1],
            100.0 * found.proven(),
            told(&found)
        ))?;
    }
    let wrong = found.count(Verdict::Wrong);
    if wrong > 0 {
        let message = format!("{wrong} pixels show what is not there, or not what is");
        let help = "what is thinner than a sixteenth of a pixel is passed: a larger --size shows it; where a slope is stated it may be too low: \
                    `zeroset check` says where, `zeroset why SCENE X Y` what a ray met";
        return Err(Failure::with_help(Exit::Job, message, help));
    }
    if 100.0 * found.proven() < args.at_least {
        let message = format!(
            "{:.3} % of the pixels are proven, --at-least asks for {}",
            100.0 * found.proven(),
            args.at_least
        );
        let help = "-o map.png shows which are not: estimates such as fractals never are";
        return Err(Failure::with_help(Exit::Job, message, help));
    }
    Ok(())
}

/// The counts.
fn told(found: &Certificate) -> String {
    let counts = VERDICTS.map(|(verdict, name, _)| format!("{} {name}", found.count(verdict)));
    counts.join(", ")
}

/// A pixel of a colour for each verdict.
fn map(found: &Certificate) -> Picture {
    let [width, height] = found.size;
    Picture::from_fn(width, height, |x, y| {
        let verdict = found.verdicts[y as usize * width as usize + x as usize];
        let colour = VERDICTS.iter().find(|(v, _, _)| *v == verdict);
        colour.map_or([0.0; 3], |(_, _, colour)| *colour)
    })
}
