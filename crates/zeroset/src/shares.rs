//! What the time of a picture goes to, object by object: counted, not measured, so that it is the same on every machine.
//!
//! A picture's work is steps times instructions: each step of a ray evaluates all objects, and is as long as the nearest of them allows. So an
//! object costs in two ways: by the instructions that it adds to each step, and by the steps that it is the reason for. Both factors
//! count alike, half of a share each, so that the shares of all objects add up to 1.

use crate::survey;
use serde::Serialize;
use std::collections::BTreeMap;
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::op::code;
use zeroset_catalogue::tape::{Instruction, Operation};
use zeroset_field::closed::Split;
use zeroset_field::field::Field;
use zeroset_field::program::{Limits, Program};
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Occlusion;
use zeroset_trace::CpuRenderer;

/// Rays along the longer side of the picture that are counted, at least and at most.
const RAYS: [f64; 2] = [4.0, 32.0];
/// Instructions of all rays together that take about half a second, at some hundred steps a ray.
const WORK: f64 = 250e3;
/// Steps of a ray that are counted.
const STEPS: usize = 256;
/// A share of this is worth a word.
const LARGE_SHARE: f64 = 0.25;
/// Fields that are divided by more than this make rays slow.
const STEEP: f64 = 1.5;
/// An evaluation of fewer instructions than this is quick.
const FEW: usize = 40;

/// What an object costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Share {
    /// Name of the object.
    pub object: String,
    /// Share of the time, 0 to 1: the mean of the next two.
    pub time: f64,
    /// Share of the instructions of an evaluation.
    pub of_instructions: f64,
    /// Share of the steps of rays that it is the reason for; none where they were not counted.
    pub of_steps: Option<f64>,
    /// Instructions that it takes by itself.
    pub instructions: usize,
    /// What to do about it.
    pub advice: String,
}

/// The shares of the objects, the largest first.
///
/// # Errors
/// A scene that cannot be prepared.
pub(crate) fn shares(scene: &Scene) -> Result<Vec<Share>, RenderError> {
    let of_objects = scene.objects().iter().map(|object| program(&object.field));
    let programs: Vec<Option<Program>> = of_objects.collect();
    let length = |program: &Option<Program>| program.as_ref().map_or(0, |p| instructions(p).len());
    let own: Vec<usize> = programs.iter().map(length).collect();
    let all_instructions = own.iter().sum::<usize>().max(1) as f64;
    let steps = steps(scene, all_instructions)?;
    let all_steps = steps.iter().sum::<u64>() as f64;
    let mut shares: Vec<Share> = (scene.objects().iter().enumerate())
        .map(|(k, object)| {
            let of_instructions = own[k] as f64 / all_instructions;
            let of_steps = (all_steps > 0.0).then(|| steps[k] as f64 / all_steps);
            // where none were counted, instructions are all there is to go by
            let share = of_steps.unwrap_or(of_instructions);
            Share {
                object: object.name.clone(),
                time: 0.5 * (share + of_instructions),
                of_instructions,
                of_steps,
                instructions: own[k],
                advice: advice(&object.field, programs[k].as_ref(), of_instructions, share),
            }
        })
        .collect();
    shares.sort_by(|a, b| b.time.total_cmp(&a.time));
    Ok(shares)
}

/// Steps that each object is the reason for, of rays through a grid of places of the picture; none where rays do not go by steps, or where so
/// few could be counted in time that they say nothing.
fn steps(scene: &Scene, instructions: f64) -> Result<Vec<u64>, RenderError> {
    let mut steps = vec![0_u64; scene.objects().len()];
    let has_steps = (scene.objects().iter()).all(|object| !object.field.facts().unbounded);
    let rays = (WORK / instructions).sqrt().min(RAYS[1]);
    if !has_steps || rays < RAYS[0] {
        return Ok(steps);
    }
    let rays = rays as u64;
    let mut plain = scene.clone();
    // rays from the eye are all that is followed
    plain.edit(|parts| {
        parts.settings.occlusion = Occlusion::None;
        parts
            .objects
            .iter_mut()
            .for_each(|object| object.occlusion = None);
        parts.lights.clear();
    })?;
    let prepared = CpuRenderer::new(Some(1))?.prepare_scene(plain.into())?;
    let size = scene.settings().size;
    let longer = size[0].max(size[1]).max(1);
    let [columns, rows] = size.map(|n| {
        let along = u64::from(n) * rays.min(u64::from(longer)) / u64::from(longer);
        along.max(1) as u32
    });
    let met: Vec<bool> = (scene.objects().iter())
        .map(|object| is_met(&object.field))
        .collect();
    let most = STEPS.min(scene.settings().max_steps as usize);
    for row in 0..rows {
        for column in 0..columns {
            // the middles of the cells of a grid over the picture
            let middle = |k: u32, n: u32, all: u32| {
                (u64::from(2 * k + 1) * u64::from(all) / u64::from(2 * n)) as u32
            };
            let pixel = [middle(column, columns, size[0]), middle(row, rows, size[1])];
            let why = prepared.why(size, pixel, most);
            for object in why.steps.iter().filter_map(|step| step.object) {
                steps[object] += u64::from(!met[object]);
            }
        }
    }
    Ok(steps)
}

/// Whether it is a floor or a wall, which rays meet where a formula says, without steps (Keinert et al. 2014, section 4). Balls are met so too, as long
/// as a scene has few of them.
fn is_met(field: &Field) -> bool {
    matches!(Split::of(field, 0), Ok(Some(Split { rest: None, .. })))
}

fn program(field: &Field) -> Option<Program> {
    Program::compile(field, &Limits::default()).ok()
}

fn instructions(program: &Program) -> &[Instruction] {
    &program.structure().values.instructions
}

/// What makes an object slow, and what to do, in a sentence.
fn advice(field: &Field, program: Option<&Program>, of_instructions: f64, of_steps: f64) -> String {
    let facts = field.facts();
    let endless =
        (0..3).any(|k| !(facts.bounds.min[k].is_finite() && facts.bounds.max[k].is_finite()));
    if facts.unbounded {
        return "no slope holds for all of it, so rays search it by ranges: keep roots, poles and jumps away from its surface, or state `slope`".into();
    }
    if is_met(field) {
        return "rays meet it where a formula says, without steps".into();
    }
    let own = program.map_or(0, |p| instructions(p).len());
    let loose = survey::looseness(field).unwrap_or(1.0);
    if of_steps >= LARGE_SHARE && loose > STEEP {
        return format!(
            "its value is {loose:.1} times less than the distance, so rays take as many more steps: a smaller `slope` that still holds, a smaller \
             `size`, or a formula nearer to a distance"
        );
    }
    if of_instructions >= LARGE_SHARE && own > FEW {
        let what = program.and_then(most_frequent);
        let most = what.map_or_else(String::new, |(name, count)| {
            format!(", {count} of them {name}")
        });
        return format!(
            "each step of each ray runs its {own} instructions{most}: many equal parts are few as repeat(...) or polar(...), and what stands still \
             can be baked to samples (zeroset bake)"
        );
    }
    if of_steps >= LARGE_SHARE && endless {
        return "it has no end, so rays that pass it go along it: cut it with a box where it is not seen".into();
    }
    if of_steps >= LARGE_SHARE {
        return "rays take most steps at its edges and beside it: it is large in the picture"
            .into();
    }
    "nothing stands out".into()
}

/// The kind of instruction that a program has most of, and how many.
fn most_frequent(program: &Program) -> Option<(&'static str, usize)> {
    let catalogue = catalogue();
    let mut counts: BTreeMap<&'static str, usize> = BTreeMap::new();
    for instruction in instructions(program) {
        let name = match instruction.operation {
            Operation::Leaf(code) => (catalogue.primitives.iter())
                .find(|entry| entry.code == code)
                .map_or("numbers of formulas", |entry| entry.info.name),
            Operation::Warp(code) => (catalogue.maps.iter())
                .find(|entry| entry.code == code)
                .map_or("moves", |entry| entry.info.name),
            Operation::Change(code::SCALE) => "scales",
            Operation::Change(code) => (catalogue.modifiers.iter())
                .find(|entry| entry.code == code)
                .map_or("functions of formulas", |entry| entry.info.name),
            Operation::Pair(code::MIN) => "unions",
            Operation::Pair(code) => (catalogue.joins.iter())
                .find(|entry| entry.code == code)
                .map_or("operators of formulas", |entry| entry.info.name),
            Operation::Put(_) | Operation::Mark(..) => continue,
        };
        *counts.entry(name).or_default() += 1;
    }
    counts.into_iter().max_by_key(|(_, count)| *count)
}

/// For a person: nothing where there are no objects.
pub(crate) fn words(shares: &[Share], name: impl Fn(&str) -> String) -> String {
    const SHOWN: usize = 6;
    if shares.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "Time by object (counted: half by instructions, half by the steps that it makes rays take):\n",
    );
    let percent = |x: f64| format!("{:.0} %", 100.0 * x);
    for share in shares.iter().take(SHOWN) {
        out += &format!(
            "  {:>5}  {}: {} instruction{} ({}){}; {}.\n",
            percent(share.time),
            name(&share.object),
            share.instructions,
            if share.instructions == 1 { "" } else { "s" },
            percent(share.of_instructions),
            (share.of_steps).map_or_else(String::new, |x| format!(", {} of the steps", percent(x))),
            share.advice
        );
    }
    if let Some(rest) = shares.get(SHOWN..).filter(|rest| !rest.is_empty()) {
        let time: f64 = rest.iter().map(|share| share.time).sum();
        out += &format!("  {:>5}  {} more objects.\n", percent(time), rest.len());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn of(text: &str) -> Vec<Share> {
        let loaded = load_text(
            "t.star",
            text,
            Language::Starlark,
            None,
            &Options::default(),
        );
        shares(&loaded.expect("a scene").scene).expect("shares")
    }

    #[test]
    fn shares_are_counted_and_sum_to_one() {
        let many = "union([sphere(0.1).move(x = i * 0.3) for i in range(60)])";
        let text =
            format!("show({many}, name = \"row\")\nshow(plane().move(y = -1), name = \"floor\")");
        let found = of(&text);
        assert_eq!(found[0].object, "row");
        assert!(found[0].of_instructions > 0.9 && found[0].advice.contains("repeat"));
        assert!((found.iter().map(|s| s.time).sum::<f64>() - 1.0).abs() < 1e-9);
        // counting gives the same each time
        assert_eq!(found, of(&text));
    }

    #[test]
    fn steps_of_large_scenes_are_not_counted() {
        let found = of("show(union([sphere(0.1).move(x = i) for i in range(9000)]))");
        assert!(found.iter().all(|share| share.of_steps.is_none()));
        assert!((found.iter().map(|s| s.time).sum::<f64>() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_loose_bound_is_named() {
        let found = of(
            "show(field(lambda p: length(p) - 1, size = 3, slope = 8), name = \"ball\")\nshow(sphere(0.1).move(x = 3))",
        );
        assert_eq!(found[0].object, "ball");
        assert!(found[0].advice.contains("slope"), "{}", found[0].advice);
        assert!(found[0].of_steps.is_some_and(|share| share > 0.5));
    }
}
