//! `zeroset fit-ao`.

use crate::args::FitAoArgs;
use crate::console::{Console, grouped};
use crate::failure::{Exit, Failure};
use crate::file::{Progress, write_watched};
use crate::fit::{Found, Judge, written};
use crate::interrupt::{self, Asking};
use crate::json;
use serde::Serialize;
use zeroset_output::atomic::probe;
use zeroset_output::display::{self, NAME};
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{Depth, write_watched as write_png};
use zeroset_output::picture::Picture;
use zeroset_scene::film::Plane;
use zeroset_scene::methods::Choice;
use zeroset_scene::settings::Occlusion;
use zeroset_trace::CpuRenderer;

/// Methods that are fitted where none is asked for: those of the papers, which look along one way.
const CHEAP: [&str; 4] = ["quilez", "bent", "evans", "upward"];
/// How much larger differences are shown.
const LARGER: f32 = 4.0;
/// How often a picture is rendered to know what it takes.
const RUNS: usize = 3;

/// What `--json` prints.
#[derive(Serialize)]
struct Numbers {
    scene: String,
    width: u32,
    height: u32,
    /// Pixels that hit something.
    hits: usize,
    /// Rays a pixel of the reference.
    rays: u32,
    /// How far the reference itself is off.
    reference_noise: f64,
    methods: Vec<Row>,
}

/// A method before and after.
#[derive(Serialize)]
struct Row {
    method: &'static str,
    before: Figures,
    /// None where there is nothing to fit.
    after: Option<Figures>,
}

#[derive(Serialize)]
struct Figures {
    settings: String,
    rmse: f64,
    evaluations_per_hit: f64,
    /// Of the whole picture with this method, the least of some.
    seconds: f64,
}

/// Fits and prints.
pub(crate) fn run(args: &FitAoArgs, console: &Console) -> Result<(), Failure> {
    let _asking = Asking::begin();
    let options = crate::scene::options(&args.scene, Some(args.size.0))?;
    let loaded = crate::scene::loaded(&args.scene, &options, console)?;
    (options.limits)
        .check_picture(args.size.0, &[Plane::Occlusion, Plane::Depth], 128)
        .map_err(|e| Failure::new(Exit::Scene, e.to_string()))?;
    let methods = methods(args, loaded.scene.settings().occlusion);
    for method in &methods {
        (method.check(options.limits.samples)).map_err(|(param, refused)| {
            Failure::new(Exit::Usage, format!("`{param}` of --ao {refused}"))
        })?;
    }
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let renderer = CpuRenderer::new(args.threads.map(usize::from))?;
    let progress = Progress {
        bar: indicatif::ProgressBar::hidden(),
        cancelled: &interrupt::requested,
    };
    console.note("Rendering the reference.");
    let mut judge = Judge::new(&renderer, loaded.scene.clone(), args.rays, &progress)?;
    if judge.hits() == 0 {
        let message = "the camera sees nothing that could be occluded";
        return Err(Failure::new(Exit::Scene, message));
    }
    // what there is to choose without fitting
    let mut found = vec![
        (judge.timed(Occlusion::None)?, None),
        (
            judge.timed(Occlusion::named("cones").unwrap_or_default())?,
            None,
        ),
    ];
    for method in methods {
        console.note(format_args!("Fitting {}.", method.method().name));
        let before = judge.timed(method)?;
        let after = judge.fitted(method)?;
        let after = judge.timed(after.method)?;
        found.push((before, Some(after)));
    }
    if let Some(path) = &args.output {
        let notes = Metadata::new(loaded.scene.name()).with("Occlusion", legend(&found));
        let picture = sheet(args.size.0, &judge, &found);
        write_watched(path, console, &interrupt::requested, |writer, observer| {
            write_png(writer, &picture, Depth::Eight, &notes, observer)
        })?;
    }
    let [width, height] = args.size.0;
    let numbers = Numbers {
        scene: loaded.scene.name().to_owned(),
        width,
        height,
        hits: judge.hits(),
        rays: 2 * args.rays,
        reference_noise: judge.noise,
        methods: found.iter().map(Row::of).collect(),
    };
    if args.json {
        return console.emit(&json::line(&numbers)?);
    }
    console.print(&numbers.table())
}

/// The methods to fit, with the numbers to begin with: those of the scene where it states the method.
fn methods(args: &FitAoArgs, stated: Occlusion) -> Vec<Occlusion> {
    if let Some(chosen) = args.ao {
        return vec![chosen.0];
    }
    let with = |name: &&str| match stated.method().name == *name {
        true => Some(stated),
        false => Occlusion::named(name),
    };
    CHEAP.iter().filter_map(with).collect()
}

impl Judge<'_> {
    /// What a method finds, and the least time that it takes.
    fn timed(&mut self, method: Occlusion) -> Result<Found, Failure> {
        let mut found = self.found(method)?;
        for _ in 1..RUNS {
            found.seconds = found.seconds.min(self.found(method)?.seconds);
        }
        Ok(found)
    }
}

impl Row {
    fn of((before, after): &(Found, Option<Found>)) -> Row {
        let figures = |found: &Found| Figures {
            settings: written(&found.method),
            rmse: found.rmse,
            evaluations_per_hit: found.evaluations,
            seconds: found.seconds,
        };
        Row {
            method: before.method.method().name,
            before: figures(before),
            after: after.as_ref().map(figures),
        }
    }
}

impl Numbers {
    /// For a person.
    fn table(&self) -> String {
        let mut text = format!(
            "scene      {}, {} x {}, {} pixels hit something\n\
             reference  {} rays each, off by {:.4} themselves\n\n\
             RMSE      evaluations  milliseconds  settings\n",
            display::name(&self.scene, NAME),
            self.width,
            self.height,
            grouped(self.hits as u64),
            self.rays,
            self.reference_noise,
        );
        let mut line = |figures: &Figures, what: &str| {
            text += &format!(
                "{:.4}    {:>11.1}  {:>12.1}  {}{what}\n",
                figures.rmse,
                figures.evaluations_per_hit,
                1e3 * figures.seconds,
                figures.settings,
            );
        };
        for row in &self.methods {
            line(&row.before, "");
            if let Some(after) = &row.after {
                line(after, "  (fitted)");
            }
        }
        let fitted = self.methods.iter().filter_map(|row| row.after.as_ref());
        let best = fitted.min_by(|a, b| a.rmse.total_cmp(&b.rmse));
        if let Some(best) = best {
            text += &format!("\nrender(ao = {})", best.settings);
        }
        text.trim_end().to_owned()
    }
}

/// What the columns of a sheet are.
fn legend(found: &[(Found, Option<Found>)]) -> String {
    let names: Vec<&str> = found[1..]
        .iter()
        .map(|(f, _)| f.method.method().name)
        .collect();
    format!(
        "columns: reference, {}; rows: as stated, fitted, {LARGER} times the difference of the best to the reference",
        names.join(", ")
    )
}

/// The reference and all methods beside each other: as stated, fitted, and how far they are off then.
fn sheet(
    [width, height]: [u32; 2],
    judge: &Judge<'_>,
    found: &[(Found, Option<Found>)],
) -> Picture {
    let columns = found.len() as u32;
    let all = [columns * width, 3 * height];
    let mut picture = Picture::filled(all[0], all[1], [1.0; 3]);
    let mut put = |column: u32, row: u32, shown: &dyn Fn(usize) -> f32| {
        for i in 0..width * height {
            let (x, y) = (column * width + i % width, row * height + i / width);
            let grey = shown(i as usize).clamp(0.0, 1.0);
            picture.set(i64::from(x), i64::from(y), [grey; 3]);
        }
    };
    let reference = |i: usize| judge.reference[i].unwrap_or(1.0);
    put(0, 0, &reference);
    // the first is none: white
    for (column, (before, after)) in (1..).zip(&found[1..]) {
        let best = after.as_ref().unwrap_or(before);
        put(column, 0, &|i| before.open[i]);
        put(column, 1, &|i| best.open[i]);
        put(column, 2, &|i| {
            1.0 - LARGER * (best.open[i] - reference(i)).abs()
        });
    }
    picture
}
