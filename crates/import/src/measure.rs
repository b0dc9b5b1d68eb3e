//! What a field is like: where its surface lies, how steep it is. Scenes are loaded to find out, so that what is measured is what will be
//! shown.

use crate::ImportError;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::{Field, Node};
use zeroset_field::formula::Formula;
use zeroset_language::assets::Assets;
use zeroset_language::document::Document;
use zeroset_language::files::{Files, InMemory};
use zeroset_language::load::{Language, Loaded, Options};
use zeroset_number::{Dual, F64, Vec3, v3};

/// Half the sides of boxes in which surfaces are looked for.
const BOXES: [f64; 7] = [64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0];
/// Places along a side of a box, at most.
const PLACES: usize = 24;
/// Operations that a look at a box may take.
const WORK: usize = 10_000_000;
/// Half the side that is shown of what has no end.
const OPEN: f64 = 4.0;
/// A proven slope may be so many times the steepest that is found before a measured one is stated instead.
const LOOSE: f64 = 6.0;
/// What changes faster than this is asked how far its steps may go.
const ESTIMATED: f64 = 4.0;
/// How deep values go that are cut off inside, of half the longest side.
const DEPTH: f64 = 0.02;
/// What a measured slope is multiplied by: the steepest place is seldom found.
const MARGIN: f64 = 1.25;

/// Light of a scene that states its camera.
pub(crate) const LIGHT: &str = "sun(direction = (-0.6, -1, -0.7), strength = 0.9, shadow = soft(16))\n\
     sky(top = \"#7fa3cf\", horizon = \"#e8e2d6\", ambient = 0.5)\n";

/// A field that was looked at.
#[cfg_attr(
    not(feature = "glsl"),
    allow(dead_code, reason = "what only shaders ask for")
)]
#[derive(Clone, Debug)]
pub(crate) struct Framed {
    /// `bounds = ...`, and `slope = ...` where that is not proven.
    pub place: String,
    pub bounds: Aabb,
    /// How far below zero its values go, if they are cut off.
    pub cut: Option<String>,
    /// The steepest that was found.
    pub steepest: f64,
    /// What the scene says about it.
    pub comment: String,
    /// Camera and light.
    pub camera: String,
    pub notes: Vec<String>,
    formula: Arc<Formula>,
}

impl Framed {
    /// How fast it changes at most: proven or stated.
    #[cfg_attr(
        not(feature = "glsl"),
        allow(dead_code, reason = "what only shaders ask for")
    )]
    pub(crate) fn slope(&self) -> f64 {
        self.formula.slope()
    }

    #[cfg_attr(
        not(feature = "glsl"),
        allow(dead_code, reason = "what only shaders ask for")
    )]
    pub(crate) fn bounds_text(&self) -> String {
        bounds_text(&self.bounds)
    }
}

fn bounds_text(b: &Aabb) -> String {
    let corner = |c: [f64; 3]| format!("({})", c.map(number).join(", "));
    format!("bounds = ({}, {})", corner(b.min), corner(b.max))
}

/// A number in few digits.
pub(crate) fn number(x: f64) -> String {
    let text = format!("{x:.4}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// A scene, or why it is none.
pub(crate) fn loaded(text: &str, files: Option<InMemory>) -> Result<Loaded, ImportError> {
    let options = Options {
        bare: true,
        ..Options::default()
    };
    let files = files.map(|f| Arc::new(f) as Arc<dyn Files>);
    let document = Document::of_text(
        "scene.star",
        text,
        Language::Starlark,
        files,
        &options.limits,
        &Assets::default(),
    );
    let loaded = document.and_then(|mut d| d.scene(&options));
    loaded.map_err(|failed| ImportError::Scene {
        message: failed.to_string(),
        help: failed.report.hint().map(str::to_owned),
    })
}

fn formula_of(field: &Field) -> Option<Arc<Formula>> {
    match field.node() {
        Node::Formula(formula) => Some(formula.clone()),
        Node::Place { shape, .. } | Node::Paint { shape, .. } | Node::Sided(shape) => {
            formula_of(shape)
        }
        _ => None,
    }
}

fn formula(text: &str, files: Option<InMemory>) -> Result<Arc<Formula>, ImportError> {
    let loaded = loaded(text, files)?;
    let found = loaded
        .scene
        .objects()
        .first()
        .and_then(|o| formula_of(&o.field));
    found.ok_or_else(|| ImportError::Scene {
        message: "it shows no formula".into(),
        help: None,
    })
}

/// Places along a side of a box in which a formula is asked: fewer for long ones.
fn places(formula: &Formula) -> usize {
    let most = WORK / formula.steps().len().max(1);
    ((most as f64).cbrt() as usize).clamp(10, PLACES)
}

fn at([x, y, z]: [f64; 3]) -> Vec3<F64> {
    v3(F64(x), F64(y), F64(z))
}

/// The slope to state for a formula.
pub(crate) fn steepness(text: &str, files: Option<InMemory>) -> Result<f64, ImportError> {
    let formula = formula(text, files)?;
    Ok(stated(
        formula
            .steepest()
            .max(steepest_near(&formula, &formula.bounds())),
    ))
}

/// A measured slope with a margin, in two digits.
fn stated(steepest: f64) -> f64 {
    let wanted = (MARGIN * steepest).clamp(1.0, 1e5);
    let unit = 10_f64.powf(wanted.log10().floor() - 1.0);
    (wanted / unit).ceil() * unit
}

/// The longest gradient on a grid.
fn steepest_near(formula: &Formula, bounds: &Aabb) -> f64 {
    let mut longest = 0.0_f64;
    grid(bounds, places(formula), |p, _| {
        let d = formula.eval(Dual::point(at(p))).d;
        let length = d.iter().map(|x| x.0 * x.0).sum::<f64>().sqrt();
        if length.is_finite() {
            longest = longest.max(length);
        }
    });
    longest
}

/// How many times too large the values outside of a solid are at most, as distances: the surface is looked for in every direction.
fn overestimate(formula: &Formula, bounds: &Aabb) -> f64 {
    const WAYS: u32 = 16;
    const PARTS: u32 = 24;
    const SHARES: [f64; 5] = [0.866_417, 0.750_682, 0.650_406, 0.563_524, 0.488_249];
    let looks = WAYS as usize * PARTS as usize * formula.steps().len().max(1);
    let points = (10 * WORK / looks).clamp(20, 500) as u32;
    let share = |k: u32, a: usize| (0.5 + f64::from(k) * SHARES[a]).fract();
    let value = |p| formula.eval(at(p)).0;
    let mut most = 0.0_f64;
    for k in 1..=points {
        let mut p: [f64; 3] =
            std::array::from_fn(|a| bounds.min[a] + share(k, a) * (bounds.max[a] - bounds.min[a]));
        for way in 1..=WAYS {
            let d = value(p);
            if d <= 0.0 || !d.is_finite() {
                break;
            }
            let turn = k * WAYS + way;
            let (z, angle) = (
                2.0 * share(turn, 3) - 1.0,
                std::f64::consts::TAU * share(turn, 4),
            );
            let r = (1.0 - z * z).max(0.0).sqrt();
            let direction = [r * angle.cos(), r * angle.sin(), z];
            let along = |t: f64| std::array::from_fn(|a| p[a] + t * direction[a]);
            let hit =
                (1..PARTS).find(|part| value(along(d * f64::from(*part) / f64::from(PARTS))) < 0.0);
            if let Some(part) = hit {
                most = most.max(f64::from(PARTS) / f64::from(part));
            }
            // what is nearer to the surface is looked at too
            let nearer = along(0.5 * d / most.max(1.0));
            if value(nearer) < d {
                p = nearer;
            }
        }
    }
    most
}

/// The middles of the cells of a grid, with their indices.
fn grid(bounds: &Aabb, n: usize, mut visit: impl FnMut([f64; 3], [usize; 3])) {
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let index = [i, j, k];
                let p = std::array::from_fn(|a| {
                    bounds.min[a]
                        + (index[a] as f64 + 0.5) / n as f64 * (bounds.max[a] - bounds.min[a])
                });
                visit(p, index);
            }
        }
    }
}

/// The cells that the surface or the inside may be in: the first and last along each axis.
fn occupied(formula: &Formula, bounds: &Aabb, n: usize) -> Option<[[usize; 2]; 3]> {
    let mut found: Option<[[usize; 2]; 3]> = None;
    let cell = (0..3)
        .map(|a| (bounds.max[a] - bounds.min[a]) / n as f64)
        .fold(0.0, f64::max);
    grid(bounds, n, |p, index| {
        // a distance that is nearer than the corners of the cell
        if formula.eval(at(p)).0 < 0.9 * cell {
            let ends = found.get_or_insert([[n, 0]; 3]);
            for a in 0..3 {
                ends[a] = [ends[a][0].min(index[a]), ends[a][1].max(index[a])];
            }
        }
    });
    found
}

/// The box that the surface of a field lies in, or as much of it as is shown of what has no end.
fn surface(formula: &Formula) -> Option<Aabb> {
    let n = places(formula);
    // which sides have an end, and a box around those
    let (mut ends, mut within) = ([[false; 2]; 3], None);
    for half in BOXES {
        let bounds = Aabb::centred([half; 3]);
        let Some(cells) = occupied(formula, &bounds, n) else {
            // too small to be seen from afar, or outside of the smaller box
            if within.is_some() {
                break;
            }
            continue;
        };
        let now: [[bool; 2]; 3] = std::array::from_fn(|a| [cells[a][0] > 0, cells[a][1] + 1 < n]);
        if within.is_none() {
            ends = now;
        } else if (0..3).any(|a| (0..2).any(|s| ends[a][s] && !now[a][s])) {
            break;
        }
        let width = 2.0 * half / n as f64;
        within = Some(Aabb::new(
            std::array::from_fn(|a| {
                if ends[a][0] {
                    -half + (cells[a][0] as f64 - 0.5) * width
                } else {
                    -OPEN
                }
            }),
            std::array::from_fn(|a| {
                if ends[a][1] {
                    -half + (cells[a][1] as f64 + 1.5) * width
                } else {
                    OPEN
                }
            }),
        ));
    }
    let mut bounds = within?;
    for a in 0..3 {
        // what ends on one side far from the origin is shown from there on
        if !ends[a][0] {
            bounds.min[a] = bounds.min[a].min(bounds.max[a] - OPEN);
        }
        if !ends[a][1] {
            bounds.max[a] = bounds.max[a].max(bounds.min[a] + OPEN);
        }
    }
    // nearer, where it ends
    for _ in 0..4 {
        let Some(cells) = occupied(formula, &bounds, n) else {
            break;
        };
        let width: [f64; 3] = std::array::from_fn(|a| (bounds.max[a] - bounds.min[a]) / n as f64);
        let old = bounds;
        for a in 0..3 {
            if ends[a][0] && cells[a][0] > 1 {
                bounds.min[a] = old.min[a] + (cells[a][0] as f64 - 1.0) * width[a];
            }
            if ends[a][1] && cells[a][1] + 2 < n {
                bounds.max[a] = old.min[a] + (cells[a][1] as f64 + 2.0) * width[a];
            }
        }
    }
    if !ends[1][0] {
        let n = 2 * n;
        if let Some(things) = above_ground(formula, &bounds, n) {
            for a in [0, 2] {
                // a thing that is wide is seen from afar, and has more around it
                let room = 0.6
                    * (0..3)
                        .map(|k| things.max[k] - things.min[k])
                        .fold(0.0, f64::max);
                if !ends[a][0] {
                    bounds.min[a] = bounds.min[a].max(things.min[a] - room);
                }
                if !ends[a][1] {
                    bounds.max[a] = bounds.max[a].min(things.max[a] + room);
                }
            }
        }
    }
    // a ground without a bottom is cut a little below its surface
    if !ends[1][0] {
        let n = 2 * n;
        let mut full = vec![true; n];
        let height = bounds.max[1] - bounds.min[1];
        grid(&bounds, n, |p, index| {
            if formula.eval(at(p)).0 >= 0.0 {
                full[index[1]] = false;
            }
        });
        if let Some(top) = full.iter().rposition(|f| *f) {
            bounds.min[1] += height * (top as f64 - 1.0).max(0.0) / n as f64;
        }
    }
    Some(bounds)
}

/// The box of what stands on a ground, if that is less than all of it.
fn above_ground(formula: &Formula, bounds: &Aabb, n: usize) -> Option<Aabb> {
    let mut height = vec![vec![0_usize; n]; n];
    let mut solid = Vec::new();
    grid(bounds, n, |p, [i, j, k]| {
        if formula.eval(at(p)).0 < 0.0 {
            height[i][k] = height[i][k].max(j + 1);
            solid.push([i, j, k]);
        }
    });
    // the level that most columns have
    let mut levels = vec![0; n + 1];
    height.iter().flatten().for_each(|h| levels[*h] += 1);
    let ground = (0..=n).max_by_key(|level| levels[*level])?;
    let width: [f64; 3] = std::array::from_fn(|a| (bounds.max[a] - bounds.min[a]) / n as f64);
    let mut things = Aabb::EMPTY;
    for cell in solid.into_iter().filter(|c| c[1] > ground) {
        if [cell[0], cell[2]].iter().any(|c| *c == 0 || *c + 1 == n) {
            return None;
        }
        for a in 0..3 {
            let low = bounds.min[a] + cell[a] as f64 * width[a];
            things.min[a] = things.min[a].min(low);
            things.max[a] = things.max[a].max(low + width[a]);
        }
    }
    (!things.is_empty()).then_some(things)
}

/// Finds out what a field is like. `shown` is a scene that shows it in a place, `bounds = ...` and the like, cut off deep inside if
/// that is given.
pub(crate) fn framed(
    shown: &dyn Fn(&str, Option<&str>) -> String,
    files: Option<&dyn Fn() -> InMemory>,
) -> Result<Framed, ImportError> {
    let files = || files.map(|f| f());
    let far = shown(&format!("size = {}, slope = 1", 2.0 * BOXES[0]), None);
    let far = formula(&far, files())?;
    let mut notes = Vec::new();
    let bounds = match surface(&far) {
        Some(bounds) => bounds,
        None => {
            notes.push(
                "no surface was found within 64 units of the origin: the box of the scene is a guess"
                    .to_owned(),
            );
            Aabb::centred([OPEN; 3])
        }
    };
    let bounds = Aabb::new(
        bounds.min.map(|x| (x * 100.0).floor() / 100.0),
        bounds.max.map(|x| (x * 100.0).ceil() / 100.0),
    );
    let place = bounds_text(&bounds);
    let steepest_of = |cut: Option<&str>| -> Result<f64, ImportError> {
        let near = formula(&shown(&format!("{place}, slope = 1"), cut), files())?;
        Ok(near.steepest().max(steepest_near(&near, &bounds)))
    };
    let mut steepest = steepest_of(None)?;
    let proven = formula(&shown(&place, None), files());
    let (mut cut, mut slope, mut comment) = (None, None, String::new());
    match &proven {
        Ok(f) if f.slope() <= LOOSE * steepest.max(1.0) => {}
        other => {
            // estimators of fractals are steep where nobody looks
            let longest = bounds.half().into_iter().fold(0.0, f64::max);
            let depth = number((DEPTH * longest).max(1e-3));
            let shallow = steepest_of(Some(&depth))?;
            if shallow < 0.5 * steepest {
                comment = format!(
                    "# Deep inside it is cut off at -{depth}: it is steep there, and nobody sees it.\n"
                );
                (steepest, cut) = (shallow, Some(depth));
            }
            let mut asked = steepest;
            let mut found = format!("{} at its steepest", number(steepest));
            if steepest > ESTIMATED {
                let near = formula(
                    &shown(&format!("{place}, slope = 1"), cut.as_deref()),
                    files(),
                )?;
                let over = overestimate(&near, &bounds);
                if over < 0.5 * steepest {
                    asked = 1.5 * over.max(1.0);
                    found = format!(
                        "as an estimate of distances:\n# a step of it is at most {} times too long, though its values change faster than that, as `check` says",
                        number(over.max(1.0))
                    );
                }
            }
            let stated = stated(asked);
            let why = match other {
                Ok(f) => format!(
                    "The slope that can be proven is {}, far above what was found",
                    number(f.slope())
                ),
                Err(_) => "How fast this changes at most could not be proven".to_owned(),
            };
            comment += &format!(
                "# {why}: `slope` was measured ({found})\n# and has a margin. Where the picture has holes it must be larger; a smaller one is faster.\n"
            );
            notes.push(format!(
                "the slope is measured and not proven: {}",
                number(stated)
            ));
            slope = Some(stated);
        }
    }
    let place = match slope {
        Some(slope) => format!("{place}, slope = {}", number(slope)),
        None => place,
    };
    let text = shown(&place, cut.as_deref());
    let scene = loaded(&text, files())?.scene;
    let camera = scene.camera();
    let formula = match scene.objects().first().and_then(|o| formula_of(&o.field)) {
        Some(formula) => formula,
        None => far,
    };
    let reach = formula.reach();
    let reach = if reach.is_empty() || !reach.is_finite() {
        bounds
    } else {
        reach
    };
    let (eye, target) = (camera.eye.as_dvec3(), reach.centre());
    let point = |p: [f64; 3]| {
        format!(
            "({})",
            p.map(|x| number((x * 100.0).round() / 100.0)).join(", ")
        )
    };
    let fov = 2.0 * (0.5 * f64::from(camera.plane_height())).atan().to_degrees();
    let camera = format!(
        "camera(eye = {}, target = {}, fov = {})\n{LIGHT}",
        point(eye.to_array()),
        point(target),
        number(fov.clamp(10.0, 90.0).round())
    );
    Ok(Framed {
        place,
        bounds,
        cut,
        steepest,
        comment,
        camera,
        notes,
        formula,
    })
}

/// The different values that another formula has near the surface; `None` if they are many.
#[cfg_attr(
    not(feature = "glsl"),
    allow(dead_code, reason = "what only shaders ask for")
)]
pub(crate) fn values_on(text: &str, made: &Framed) -> Result<Option<Vec<f64>>, ImportError> {
    let other = formula(text, None)?;
    let mut values: Vec<f64> = Vec::new();
    let bounds = made.bounds;
    let n = 2 * places(&made.formula);
    let cell = (0..3)
        .map(|a| (bounds.max[a] - bounds.min[a]) / n as f64)
        .fold(0.0, f64::max);
    let mut many = false;
    grid(&bounds, n, |p, _| {
        if many || made.formula.eval(at(p)).0.abs() > cell * made.steepest.max(1.0) {
            return;
        }
        let value = other.eval(at(p)).0;
        if !value.is_finite() {
            return;
        }
        if !values.iter().any(|v| (v - value).abs() < 1e-3) {
            values.push(value);
            many = values.len() > 64;
        }
    });
    values.sort_by(f64::total_cmp);
    Ok((!many && values.len() <= 8).then_some(values))
}
