//! `zeroset check`.

use crate::args::CheckArgs;
use crate::console::Console;
use crate::estimate::{self, Cost};
use crate::failure::{Exit, Failure};
use crate::json;
use crate::reference::shortest;
use crate::shares::{self, Share};
use crate::survey;
use serde::Serialize;
use std::collections::{BTreeSet, HashSet};
use std::fmt::Write;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_field::field::{Field, Node};
use zeroset_field::formula::Ground;
use zeroset_field::program::{Limits, Program};
use zeroset_language::load::{Control, Loaded, Setting};
use zeroset_output::display;

/// What `--json` prints.
#[derive(Serialize)]
struct Findings {
    scene: String,
    files: Vec<String>,
    /// Whether the scene uses time().
    animated: bool,
    width: u32,
    height: u32,
    lights: usize,
    materials: usize,
    parameters: Vec<ParameterFinding>,
    objects: Vec<ObjectFinding>,
    /// Steps of an evaluation of the whole scene; none without objects.
    instructions: Option<usize>,
    /// Whether every distance is proven never to be too large.
    proven: bool,
    /// Formulas of materials that give values out of their range.
    clamped: Vec<ClampedFinding>,
    /// What single precision tells apart where the camera looks, and the width of a pixel there, where that is too coarse.
    coarse: Option<(f64, f64)>,
    /// The object that the camera stands in.
    inside: Option<String>,
    /// What the picture will cost.
    cost: Cost,
    /// What each object is of that, the largest share first.
    shares: Vec<Share>,
}

/// A bound that is looser than this is worth a word.
const LOOSE: f64 = 1.5;

#[derive(Serialize)]
struct ParameterFinding {
    name: String,
    allowed: String,
    value: String,
    default: String,
}

#[derive(Serialize)]
struct ObjectFinding {
    name: String,
    /// File, line and column.
    place: Option<(String, u32, u32)>,
    distance: &'static str,
    /// Lipschitz constant of the formula, which its value is divided by.
    lipschitz: f64,
    /// Smallest and largest corner; null along an unbounded side.
    bounds: [[Option<f64>; 3]; 2],
    nodes: u64,
    /// What its distance rests on without a proof.
    unproven: Vec<String>,
    /// Why formulas of it have no Lipschitz constant, so that their surfaces are looked for by ranges.
    sought: Vec<String>,
    /// Where a slope that was stated by hand is exceeded.
    exceeded: Option<ExceededFinding>,
    /// How many times less than the distance the marched value is near its surface, where that is not about one.
    looseness: Option<f64>,
}

#[derive(Serialize)]
struct ExceededFinding {
    /// The slope that was stated.
    stated: f64,
    /// The length of the gradient that was found.
    found: f64,
    /// Where, in the coordinates of the formula.
    at: [f64; 3],
}

#[derive(Serialize)]
struct ClampedFinding {
    /// What the formula is of: the colour, the roughness, the metal.
    what: &'static str,
    /// The number of the material in the scene.
    material: usize,
    /// The objects that it is the material of.
    objects: Vec<String>,
    /// A value that is clamped; null where it is no number.
    value: Option<f64>,
    /// Where, in the coordinates of the formula.
    at: [f64; 3],
}

/// Checks a scene, and says what is known about it.
pub(crate) fn run(args: &CheckArgs, console: &Console) -> Result<(), Failure> {
    let options = crate::scene::options(&args.scene, None)?;
    let loaded = crate::scene::loaded(&args.scene, &options, console)?;
    let invalid = |error: String| Failure::new(Exit::Scene, error);
    let field = loaded
        .scene
        .field()
        .map_err(|error| invalid(error.to_string()))?;
    let program = field.map(|field| Program::compile(&field, &Limits::default()));
    let program = program
        .transpose()
        .map_err(|error| invalid(error.to_string()))?;
    let cost = estimate::cost(&loaded.scene)?;
    let shares = shares::shares(&loaded.scene)?;
    let findings = findings(&loaded, program.as_ref(), cost, shares);
    if args.json {
        console.emit(&json::pretty(&findings)?)
    } else {
        console.print(&words(&findings))
    }
}

fn findings(
    loaded: &Loaded,
    program: Option<&Program>,
    cost: Cost,
    shares: Vec<Share>,
) -> Findings {
    let scene = &loaded.scene;
    let objects: Vec<ObjectFinding> = (scene.objects().iter())
        .map(|object| {
            let facts = object.field.facts();
            ObjectFinding {
                name: object.name.clone(),
                place: object.place.clone(),
                distance: match facts.exactness {
                    Exactness::Exact => "exact",
                    Exactness::Outside => "exact outside",
                    Exactness::Bound => "bound",
                    Exactness::Estimate => "estimate",
                },
                lipschitz: facts.slope,
                bounds: corners(&facts.bounds),
                nodes: facts.nodes,
                unproven: unproven(&object.field),
                sought: sought(&object.field),
                exceeded: survey::exceeded(&object.field).map(|e| ExceededFinding {
                    stated: e.stated,
                    found: e.found,
                    at: e.at,
                }),
                looseness: survey::looseness(&object.field).filter(|loose| *loose > LOOSE),
            }
        })
        .collect();
    let parameters = loaded.parameters.iter().map(|p| ParameterFinding {
        name: p.name.clone(),
        allowed: match &p.control {
            Control::Slider { min, max } => format!("{} to {}", shortest(*min), shortest(*max)),
            Control::Choice { options } => options.join(", "),
            Control::Toggle => "true, false".to_owned(),
            Control::Colour => "a colour".to_owned(),
        },
        value: setting(&p.value),
        default: setting(&p.default),
    });
    Findings {
        scene: scene.name().to_string(),
        files: loaded
            .files
            .iter()
            .map(|f| f.to_string_lossy().into_owned())
            .collect(),
        animated: loaded.animated,
        width: scene.settings().size[0],
        height: scene.settings().size[1],
        lights: scene.lights().len(),
        materials: scene.materials().len(),
        parameters: parameters.collect(),
        proven: objects
            .iter()
            .all(|o| o.unproven.is_empty() && o.sought.is_empty()),
        objects,
        clamped: survey::clamped(scene)
            .into_iter()
            .map(|c| ClampedFinding {
                what: c.what,
                material: c.material,
                objects: (scene.objects().iter())
                    .filter(|o| usize::from(o.material) == c.material)
                    .map(|o| o.name.clone())
                    .collect(),
                value: c.value,
                at: c.at,
            })
            .collect(),
        coarse: survey::coarse(scene),
        inside: survey::around_camera(scene).map(str::to_owned),
        cost,
        shares,
        instructions: program.map(|p| p.structure().values.instructions.len()),
    }
}

fn setting(setting: &Setting) -> String {
    match setting {
        Setting::Number(x) => shortest(*x),
        Setting::Text(text) => text.clone(),
        Setting::Flag(flag) => flag.to_string(),
        Setting::Colour(rgb) => {
            let [r, g, b] = rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
            format!("#{r:02x}{g:02x}{b:02x}")
        }
    }
}

fn corners(bounds: &Aabb) -> [[Option<f64>; 3]; 2] {
    [bounds.min, bounds.max].map(|corner| corner.map(|x| x.is_finite().then_some(x)))
}

/// What in a tree has no proof, each kind once. Shared parts are looked at once.
fn unproven(field: &Field) -> Vec<String> {
    let (mut seen, mut found, mut open) = (HashSet::new(), BTreeSet::new(), vec![field]);
    while let Some(field) = open.pop() {
        if field.facts().exactness != Exactness::Estimate || !seen.insert(field.key()) {
            continue;
        }
        open.extend(field.children());
        match field.node() {
            Node::Primitive { entry, .. } => {
                found.insert(format!("{}: a distance estimator", entry.info.name))
            }
            Node::Formula(formula) if *formula.ground() == Ground::Stated => {
                found.insert("a formula whose slope is stated by hand".to_owned())
            }
            // what is above an estimate is one too; an operation that makes an estimate of a proven field is named
            Node::Map { entry, shape, .. } if is_proven(shape) => {
                found.insert(entry.info.name.to_owned())
            }
            Node::Modify { entry, shape, .. } if is_proven(shape) => {
                found.insert(entry.info.name.to_owned())
            }
            Node::Join { entry, shapes, .. } if shapes.iter().all(is_proven) => {
                found.insert(entry.info.name.to_owned())
            }
            _ => false,
        };
    }
    found.into_iter().collect()
}

/// Why formulas in a tree have no Lipschitz constant, each reason once.
fn sought(field: &Field) -> Vec<String> {
    let (mut seen, mut found, mut open) = (HashSet::new(), BTreeSet::new(), vec![field]);
    while let Some(field) = open.pop() {
        if !field.facts().unbounded || !seen.insert(field.key()) {
            continue;
        }
        open.extend(field.children());
        if let Node::Formula(formula) = field.node()
            && let Ground::Usual(reason) = formula.ground()
        {
            found.insert(reason.to_string());
        }
    }
    found.into_iter().collect()
}

fn is_proven(field: &Field) -> bool {
    field.facts().exactness != Exactness::Estimate
}

/// For a person.
fn words(findings: &Findings) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "{}: {} object{}, {} light{}, {} x {} pixels{}",
        name(&findings.scene),
        findings.objects.len(),
        plural(findings.objects.len()),
        findings.lights,
        plural(findings.lights),
        findings.width,
        findings.height,
        if findings.animated { ", animated" } else { "" },
    );
    for p in &findings.parameters {
        let changed = if p.value == p.default {
            String::new()
        } else {
            format!(", default {}", name(&p.default))
        };
        let (allowed, value) = (display::name(&p.allowed, 200), name(&p.value));
        let _ = writeln!(out, "  {} = {value} ({allowed}{changed})", name(&p.name));
    }
    if !findings.objects.is_empty() {
        let short = |name: &str| {
            display::clean(&name.chars().take(24).collect::<String>()).replace(['\n', '\t'], " ")
        };
        let names = findings
            .objects
            .iter()
            .map(|o| short(&o.name).chars().count());
        let width = names.max().unwrap_or(0).clamp(6, 24);
        let _ = writeln!(
            out,
            "\n{:width$}  {:13}  {:9}  {:>6}  bounds",
            "object", "distance", "Lipschitz", "nodes"
        );
        for o in &findings.objects {
            let short = short(&o.name);
            let lipschitz = shortest((o.lipschitz * 1e4).round() / 1e4);
            let bounds = spoken(&o.bounds);
            let _ = writeln!(
                out,
                "{short:width$}  {:13}  {lipschitz:9}  {:>6}  {bounds}",
                o.distance, o.nodes
            );
        }
    }
    out.push('\n');
    if findings.proven {
        out.push_str("Proven: no distance is ever too large, so that no ray passes a surface.\n");
    }
    for o in findings.objects.iter().filter(|o| !o.unproven.is_empty()) {
        let _ = writeln!(
            out,
            "Unproven: {} rests on {}",
            name(&o.name),
            o.unproven.join(", ")
        );
    }
    for o in &findings.objects {
        for reason in &o.sought {
            let _ = writeln!(
                out,
                "By ranges: no slope holds for all of {}, so that rays look for its surface by ranges of its values, on the CPU, which is as \
                 sure and takes longer. What stands in the way: {reason}.",
                name(&o.name),
            );
        }
        if let Some(e) = &o.exceeded {
            let _ = writeln!(
                out,
                "Too low: the slope of {} that is stated for a formula of {} is exceeded: at ({}) its gradient is {} long. Rays may pass \
                 the surface there. State `slope = {}` or more, or leave `slope` out, so that it is proven.",
                digits(e.stated, 4),
                name(&o.name),
                e.at.map(|x| digits(x, 4)).join(", "),
                digits(e.found, 4),
                digits(e.found * 1.02, 3),
            );
        }
        if let Some(loose) = o.looseness {
            let _ = writeln!(
                out,
                "Loose: the slope that {} is divided by is {} times that of its surface. The picture is the same; rays take up to \
                 that many more steps. A smaller `slope = ...` that still holds, a smaller `size`, or a formula nearer to a distance is \
                 faster.",
                name(&o.name),
                digits(loose, 2),
            );
        }
    }
    for c in &findings.clamped {
        let of = match &c.objects[..] {
            [] => format!("material {}", c.material),
            objects => objects
                .iter()
                .map(|o| name(o))
                .collect::<Vec<_>>()
                .join(", "),
        };
        let at = c.at.map(|x| digits(x, 4)).join(", ");
        let _ = match c.value {
            Some(value) => writeln!(
                out,
                "Clamped: the formula of the {} of {of} leaves 0 to 1: at ({at}) a number of it is {} (linear). saturate(x) or clamp(x, 0, 1) \
                 says that it is meant.",
                c.what,
                digits(value, 3),
            ),
            None => writeln!(
                out,
                "No number: the formula of the {} of {of} has no value at ({at}). It shows magenta there.",
                c.what,
            ),
        };
    }
    if let Some(object) = &findings.inside {
        out.push_str(&survey::inside_words(&name(object)));
        out.push('\n');
    }
    if let Some((grain, pixel)) = findings.coarse {
        let _ = writeln!(
            out,
            "Coarse: this far from the origin single precision tells apart {}, and a pixel is {} wide. Move the scene towards the origin.",
            digits(grain, 2),
            digits(pixel, 2),
        );
    }
    if let Some(instructions) = findings.instructions {
        let _ = writeln!(
            out,
            "An evaluation takes {instructions} instruction{}.",
            plural(instructions)
        );
    }
    out.push_str(&shares::words(&findings.shares, name));
    out + &findings.cost.words([findings.width, findings.height])
}

/// A name that somebody chose.
fn name(from: &str) -> String {
    display::name(from, display::NAME)
}

fn spoken([min, max]: &[[Option<f64>; 3]; 2]) -> String {
    let number = |x: Option<f64>, none: &str| x.map_or(none.to_owned(), |x| digits(x, 4));
    let corner = |corner: &[Option<f64>; 3], none| corner.map(|x| number(x, none)).join(", ");
    format!("({}) to ({})", corner(min, "-inf"), corner(max, "inf"))
}

/// A number with so many digits that count, whatever its size.
fn digits(x: f64, count: i32) -> String {
    if x == 0.0 || !x.is_finite() {
        return shortest(x);
    }
    let unit = 10_f64.powi(x.abs().log10().floor() as i32 + 1 - count);
    // a whole number of units, printed without the rounding of their product
    let rounded = (x / unit).round() * unit;
    format!("{rounded:.*e}", (count - 1).max(0) as usize)
        .parse()
        .map_or_else(|_| shortest(rounded), shortest)
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
