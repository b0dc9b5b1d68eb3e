//! `zeroset why`.

use crate::args::WhyArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::json;
use crate::reference::shortest;
use serde::Serialize;
use std::fmt::Write;
use std::sync::Arc;
use zeroset_catalogue::bounds::Exactness;
use zeroset_output::display::{self, NAME};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;
use zeroset_trace::certify::Verdict;
use zeroset_trace::why::{End, Step, Why};

/// Bars of the plot are this long at most.
const BAR: usize = 24;
/// Steps that are printed; of more, the first and the last.
const SHOWN: usize = 40;
/// A ray of more steps than this is worth a word.
const MANY: usize = 100;
/// What divides a field by more than this makes rays slow.
const STEEP: f64 = 4.0;

/// What `--json` prints.
#[derive(Serialize)]
struct Findings {
    scene: String,
    pixel: [u32; 2],
    origin: [f32; 3],
    direction: [f32; 3],
    inside: bool,
    end: &'static str,
    hit: Option<HitFinding>,
    verdict: &'static str,
    /// Half the width of a pixel where the ray ends, scene units.
    footprint: f64,
    divided_by: f64,
    advice: String,
    steps: Vec<StepFinding>,
}

#[derive(Serialize)]
struct HitFinding {
    t: f32,
    point: [f32; 3],
    normal: [f32; 3],
    object: Option<String>,
    /// File, line and column.
    place: Option<(String, u32, u32)>,
}

#[derive(Serialize)]
struct StepFinding {
    t: f64,
    value: f64,
    slope: f64,
    object: Option<String>,
}

/// Explains a pixel.
pub(crate) fn run(args: &WhyArgs, console: &Console) -> Result<(), Failure> {
    let options = crate::scene::options(&args.scene, args.size.map(|size| size.0))?;
    let scene = Arc::new(crate::scene::loaded(&args.scene, &options, console)?.scene);
    let size = scene.settings().size;
    for (name, at, most) in [("column", args.x, size[0]), ("row", args.y, size[1])] {
        if at >= most {
            let message = format!(
                "{name} {at} is not in the picture: allowed is 0 to {}",
                most - 1
            );
            let help =
                "columns count from the left, rows from above; --size says how many there are";
            return Err(Failure::with_help(Exit::Usage, message, help));
        }
    }
    let prepared = CpuRenderer::new(Some(1))?.prepare_scene(Arc::clone(&scene))?;
    let most = scene.settings().max_steps as usize * 8;
    let why = prepared.why(size, [args.x, args.y], most);
    if args.json {
        return console.emit(&json::line(&findings(&scene, args, &why))?);
    }
    console.print(&report(&scene, args, &why))
}

fn object_name(scene: &Scene, object: Option<usize>) -> Option<String> {
    let object = scene.objects().get(object?)?;
    Some(display::name(&object.name, NAME).to_string())
}

/// The name of an object and where it is shown.
fn placed(scene: &Scene, object: Option<usize>) -> String {
    let Some(name) = object_name(scene, object) else {
        return "nothing".into();
    };
    let place = object.and_then(|k| scene.objects()[k].place.as_ref());
    match place {
        Some((file, line, _)) => format!("{name} ({}:{line})", display::name(file, NAME)),
        None => name,
    }
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Hit => "proven hit",
        Verdict::Miss => "proven miss",
        Verdict::Unknown => "unknown",
        Verdict::Wrong => "wrong",
    }
}

fn end(end: End) -> &'static str {
    match end {
        End::Surface => "surface",
        End::Left => "left",
        End::Steps => "steps",
    }
}

/// One sentence that says what to do, if anything.
fn advice(scene: &Scene, why: &Why) -> String {
    let nearest = |step: &Step| placed(scene, step.object);
    if why.is_fractal {
        return "A fractal's distance is an estimate: what is shown is never proven. A smaller --march step share, or a larger picture, shows more of it.".into();
    }
    if why.is_unbounded && matches!(why.verdict, Verdict::Hit | Verdict::Miss) {
        return "No slope holds for all of the formula (`zeroset check` says why): the steps above are guesses, the picture looks for the surface by ranges.".into();
    }
    if why.verdict == Verdict::Wrong {
        return match why.exactness {
            Exactness::Estimate => "The ray meets a surface that the picture does not show: a stated slope is too low there (`zeroset check` says where and how much).".into(),
            _ => "The ray meets a surface that the picture does not show: it is thinner than the pixel, so a larger --size or more samples (--aa) show it.".into(),
        };
    }
    if why.end == End::Steps {
        return "The plain march ran out of steps: the ray goes along a surface, or the field is far less than the distance. Where the picture has holes there, --max-steps is too low.".into();
    }
    if let Some(step) = why.passed.filter(|_| why.verdict != Verdict::Hit) {
        return format!(
            "The ray passes {} within a pixel, {} away from it: what is thinner than a pixel may be missed.",
            nearest(&step),
            shortest(step.value)
        );
    }
    if why.steps.len() > MANY && why.divided > STEEP {
        return format!(
            "Steps are short because the field is divided by {}: a smaller slope, or a smaller box of its formula, makes the ray faster.",
            shortest(why.divided)
        );
    }
    if why.verdict == Verdict::Unknown {
        return "Neither a hit nor a miss could be shown: the ray runs along a surface there."
            .into();
    }
    "Nothing to do.".into()
}

fn findings(scene: &Scene, args: &WhyArgs, why: &Why) -> Findings {
    let step = |step: &Step| StepFinding {
        t: step.t,
        value: step.value,
        slope: step.slope,
        object: object_name(scene, step.object),
    };
    Findings {
        scene: scene.name().to_owned(),
        pixel: [args.x, args.y],
        origin: why.origin,
        direction: why.direction,
        inside: why.inside,
        end: end(why.end),
        hit: why.hit.map(|hit| HitFinding {
            t: hit.t,
            point: hit.point.to_array(),
            normal: hit.normal.to_array(),
            object: object_name(scene, hit.object),
            place: (hit.object).and_then(|k| scene.objects().get(k)?.place.clone()),
        }),
        verdict: verdict(why.verdict),
        footprint: why.footprint,
        divided_by: why.divided,
        advice: advice(scene, why),
        steps: why.steps.iter().map(step).collect(),
    }
}

/// For a person.
fn report(scene: &Scene, args: &WhyArgs, why: &Why) -> String {
    let [ox, oy, oz] = why.origin.map(|c| shortest(f64::from(c)));
    let [dx, dy, dz] = why.direction.map(|c| format!("{c:.4}"));
    let size = scene.settings().size;
    let mut text = format!(
        "{}, pixel {} {} of {} x {}: from ({ox}, {oy}, {oz}) along ({dx}, {dy}, {dz})\n",
        display::name(scene.name(), NAME),
        args.x,
        args.y,
        size[0],
        size[1]
    );
    let mut line = |s: String| {
        let _ = writeln!(text, "{s}");
    };
    if why.inside {
        line("the ray begins inside the solid".into());
    }
    line(match why.hit {
        Some(hit) => {
            let [x, y, z] = hit.point.to_array().map(|c| format!("{c:.4}"));
            format!(
                "meets {} at {:.5}, at ({x}, {y}, {z})",
                placed(scene, hit.object),
                hit.t
            )
        }
        None => "meets nothing".into(),
    });
    line(format!(
        "{}; half a pixel is {:.3e} wide there",
        verdict(why.verdict),
        why.footprint
    ));
    if why.divided > 1.0 {
        line(format!("the field is divided by {}", shortest(why.divided)));
    }
    line(format!(
        "\n{:>5}  {:>11}  {:>10}  {:>6}  f along the ray",
        "step", "t", "f", "slope"
    ));
    let largest = (why.steps.iter()).fold(0.0f64, |a, step| a.max(step.value));
    let count = why.steps.len();
    for (k, step) in why.steps.iter().enumerate() {
        if count > SHOWN && k == SHOWN / 2 {
            line(format!("  ...  {} more", count - SHOWN));
        }
        if count > SHOWN && (SHOWN / 2..count - SHOWN / 2).contains(&k) {
            continue;
        }
        // lengths differ by orders of magnitude: the bar is as long as the logarithm
        let share = 1.0 + (step.value / largest.max(1e-300)).max(1e-6).log10() / 6.0;
        let bar = "#".repeat((share * BAR as f64).round() as usize);
        line(format!(
            "{k:>5}  {:>11.6}  {:>10.3e}  {:>6.3}  {bar:<BAR$}  {}",
            step.t,
            step.value,
            step.slope,
            object_name(scene, step.object).unwrap_or_default()
        ));
    }
    line(format!(
        "\n{} steps of the plain march, {}",
        count,
        match why.end {
            End::Surface => "to a surface",
            End::Left => "then the ray has left the scene",
            End::Steps => "which were all there are",
        }
    ));
    line(advice(scene, why));
    text
}
