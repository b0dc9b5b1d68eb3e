//! What a few looks at a field tell of a scene: whether the camera stands in a solid, how loose a bound is, what single
//! precision still tells apart.

use std::collections::HashSet;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::Point;
use zeroset_field::field::{Field, Node};
use zeroset_field::formula::{Formula, Ground};
use zeroset_field::program::{Limits, Program};
use zeroset_number::{Dual, F64, Vec3, v3};
use zeroset_scene::camera::Camera;
use zeroset_scene::material::Pattern;
use zeroset_scene::scene::Scene;

/// Rays that are sent through a solid to find its surface.
const RAYS: u32 = 200;
/// Steps of each.
const STEPS: u32 = 96;

fn at(p: [f64; 3]) -> Vec3<F64> {
    v3(F64(p[0]), F64(p[1]), F64(p[2]))
}

/// The name of the object that the camera stands in, if it stands in one.
pub(crate) fn around_camera(scene: &Scene) -> Option<&str> {
    let Camera { eye, near, .. } = *scene.camera();
    let from = (eye - scene.camera().axes.z_axis * near)
        .as_dvec3()
        .to_array();
    let inside = |field: &Field| {
        let program = Program::compile(field, &Limits::default()).ok()?;
        Some(Point::<F64>::new(program.values()).value(at(from)).0 < 0.0)
    };
    let holds = |b: &Aabb| b.contains(from);
    (scene.objects().iter())
        .find(|o| holds(&o.field.facts().bounds) && inside(&o.field) == Some(true))
        .map(|o| o.name.as_str())
}

/// What is said of a camera that stands in an object of this name.
pub(crate) fn inside_words(name: &str) -> String {
    format!(
        "the camera stands inside `{name}`: the picture shows it from within, lit as if there were no solid. Move `eye` out of it, or \
         cut it open."
    )
}

/// How many times less than the distance the marched value of a field is near its surface: the median over places that rays
/// through its box find. `None` where they find none.
pub(crate) fn looseness(field: &Field) -> Option<f64> {
    let bounds = field.facts().bounds;
    let program = Program::compile(field, &Limits::default()).ok()?;
    if program.is_close() || program.is_fractal() || program.is_unbounded() || !bounds.is_finite() {
        return None;
    }
    let (mut values, mut gradients) = (
        Point::<F64>::new(program.values()),
        Point::<Dual<F64>>::new(program.values()),
    );
    let mut slopes = Vec::new();
    for ray in 0..RAYS {
        // two points of the box from a sequence without gaps (Roberts 2018)
        let [a, b] = [0, 3].map(|first| {
            std::array::from_fn::<f64, 3, _>(|k| {
                let share = (0.5 + f64::from(ray + 1) * SEQUENCE[first + k]).fract();
                bounds.min[k] + share * (bounds.max[k] - bounds.min[k])
            })
        });
        let place = |i: f64| {
            let share = i / f64::from(STEPS);
            std::array::from_fn::<f64, 3, _>(|k| a[k] + share * (b[k] - a[k]))
        };
        let mut before = values.value(at(a)).0;
        for i in 1..=STEPS {
            let f = values.value(at(place(f64::from(i)))).0;
            if (f < 0.0) != (before < 0.0) {
                let share = before.abs() / (before.abs() + f.abs()).max(f64::MIN_POSITIVE);
                let p = place(f64::from(i - 1) + share);
                let d = gradients.value(Dual::point(at(p))).d;
                slopes.push(d.iter().map(|x| x.0 * x.0).sum::<f64>().sqrt());
            }
            before = f;
        }
    }
    slopes.retain(|s| s.is_finite() && *s > 0.0);
    slopes.sort_by(f64::total_cmp);
    let median = *slopes.get(slopes.len() / 2)?;
    Some(1.0 / median)
}

/// A stated slope that is exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exceeded {
    /// What was stated (1, where less was).
    pub stated: f64,
    /// A gradient that is longer.
    pub found: f64,
    /// Where it is, in the formula's own coordinates.
    pub at: [f64; 3],
}

/// Where a stated slope of a formula in the field is exceeded, if it is anywhere that a search finds: the worst of all formulas.
pub(crate) fn exceeded(field: &Field) -> Option<Exceeded> {
    let (mut seen, mut open) = (HashSet::new(), vec![field]);
    let mut worst: Option<Exceeded> = None;
    while let Some(field) = open.pop() {
        if !seen.insert(field.key()) {
            continue;
        }
        open.extend(field.children());
        let Node::Formula(formula) = field.node() else {
            continue;
        };
        if *formula.ground() != Ground::Stated {
            continue;
        }
        let (found, at) = steepest(formula);
        let stated = formula.slope();
        // a hair more may be the rounding of the statement
        let is_worse = worst.is_none_or(|w| found / stated > w.found / w.stated);
        if found > stated * (1.0 + 1e-6) && is_worse {
            worst = Some(Exceeded { stated, found, at });
        }
    }
    worst
}

/// The longest gradient of a formula that is found uphill from the longest one known (compass search; Hooke and Jeeves 1961).
fn steepest(formula: &Formula) -> (f64, [f64; 3]) {
    let bounds = formula.bounds();
    let length = |p: [f64; 3]| {
        let d = formula.eval(Dual::point(at(p))).d;
        d.iter().map(|x| x.0 * x.0).sum::<f64>().sqrt()
    };
    let (mut best, mut place) = (formula.steepest(), formula.steepest_at());
    let looks = (CLIMB / formula.steps().len().max(1)).min(600);
    let mut step = 0.125;
    for _ in 0..looks / 6 {
        let mut better = None;
        for k in 0..3 {
            for sign in [-1.0, 1.0] {
                let mut p = place;
                let side = bounds.max[k] - bounds.min[k];
                p[k] = (p[k] + sign * step * side).clamp(bounds.min[k], bounds.max[k]);
                let there = length(p);
                if there.is_finite() && there > better.map_or(best, |(length, _)| length) {
                    better = Some((there, p));
                }
            }
        }
        match better {
            Some(found) => (best, place) = found,
            None => step *= 0.5,
        }
    }
    (best, place)
}

/// Steps of formulas that such a search may take.
const CLIMB: usize = 4_000_000;

/// Powers of the inverse of the root of x^7 = x + 1.
const SEQUENCE: [f64; 6] = [
    0.898_654_7,
    0.807_580_3,
    0.725_735_8,
    0.652_185_9,
    0.586_090_0,
    0.526_692_3,
];

/// A formula of a material that gives something that is not shown as it is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Clamped {
    /// What it is of: the colour, the roughness.
    pub what: &'static str,
    /// The number of the material.
    pub material: usize,
    /// What it gives, linear; none where that is no number.
    pub value: Option<f64>,
    /// Where, in the coordinates of the formula.
    pub at: [f64; 3],
}

/// Formulas of colours and of numbers from 0 to 1 that leave this range somewhere: each is asked at some points of the box of the scene.
pub(crate) fn clamped(scene: &Scene) -> Vec<Clamped> {
    const POINTS: u32 = 512;
    let Some(bounds) = scene.finite_bounds() else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (number, material) in scene.materials().iter().enumerate() {
        for (name, pattern) in material.patterns() {
            let what = match name {
                "pattern" => "colour",
                "roughness_map" => "roughness",
                "metallic_map" => "metal",
                // heights may be anything
                _ => continue,
            };
            for part in pattern.parts() {
                let Pattern::Formula { formula } = part else {
                    continue;
                };
                let found = (1..=POINTS).find_map(|n| {
                    let p = [0, 1, 2].map(|k| {
                        let share = (f64::from(n) * SEQUENCE[k]).fract();
                        bounds.min[k] + share * (bounds.max[k] - bounds.min[k])
                    });
                    let values = formula.eval(at(p)).map(|x| x.0);
                    // a hair, for the rounding of what is 1
                    let outside = |x: &f64| !(-1e-6..=1.0 + 1e-6).contains(x);
                    let value = values.into_iter().find(outside)?;
                    Some(Clamped {
                        what,
                        material: number,
                        value: value.is_finite().then_some(value),
                        at: p,
                    })
                });
                all.extend(found);
            }
        }
    }
    all
}

/// The smallest step that single precision tells apart where the camera looks, and the width of a pixel there, where the
/// first is the larger part of the second.
pub(crate) fn coarse(scene: &Scene) -> Option<(f64, f64)> {
    let bounds = scene.finite_bounds()?;
    let largest = (bounds.min.iter().chain(&bounds.max)).fold(
        scene.camera().eye.abs().max_element().into(),
        |m: f64, x| m.max(x.abs()),
    );
    let centre = glam::DVec3::from(bounds.centre());
    let distance = (scene.camera().eye.as_dvec3() - centre).length();
    let (slope, constant) = scene.camera().pixel_width(scene.settings().size[1]);
    let pixel = f64::from(slope) * distance + f64::from(constant);
    let grain = largest * f64::from(f32::EPSILON);
    (grain > 0.25 * pixel).then_some((grain, pixel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn scene(text: &str) -> Scene {
        load_text(
            "t.star",
            text,
            Language::Starlark,
            None,
            &Options::default(),
        )
        .expect("a scene")
        .scene
    }

    #[test]
    fn a_camera_in_a_solid_is_noticed() {
        let within =
            "show(sphere(2), name = \"shell\")\ncamera(eye = (0, 0, 1), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(within)), Some("shell"));
        let without = "show(sphere(2))\ncamera(eye = (0, 0, 5), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(without)), None);
        // a hole that the camera stands in is not the solid
        let hollow = "show(sphere(2) - sphere(1.5))\ncamera(eye = (0, 0, 1), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(hollow)), None);
    }

    #[test]
    fn a_loose_bound_is_measured() {
        let stated = scene("show(field(lambda p: length(p) - 1, size = 4, slope = 30))");
        let loose = looseness(&stated.objects()[0].field).expect("a surface");
        assert!((loose - 30.0).abs() < 0.1, "{loose}");
        let exact = scene("show(sphere(1))");
        assert_eq!(looseness(&exact.objects()[0].field), None);
    }

    #[test]
    fn a_stated_slope_that_is_too_low_is_found_out() {
        // its slope along x is 19 cos(20 x)
        let wave = |slope: &str| {
            let text = format!(
                "show(field(lambda p: p.y + sin(p.x * 20) * 0.95, size = 2, slope = {slope}).move(x = 5))"
            );
            exceeded(&scene(&text).objects()[0].field)
        };
        let found = wave("3").expect("an exceeded slope");
        let steepest = 1.0_f64.hypot(19.0);
        assert!((found.found - steepest).abs() < 1e-3, "{found:?}");
        // where the cosine is 1 or -1
        let turns = found.at[0] * 20.0 / std::f64::consts::PI;
        assert!((turns - turns.round()).abs() < 0.02, "{found:?}");
        assert_eq!(found.stated, 3.0);
        assert_eq!(wave("19.1"), None);
        let proven = scene("show(field(lambda p: length(p) - 1, size = 4))");
        assert_eq!(exceeded(&proven.objects()[0].field), None);
    }

    #[test]
    fn formulas_that_leave_their_range_are_noticed() {
        let found = |words: &str| clamped(&scene(&format!("show(sphere(), material({words}))")));
        assert!(found("color = lambda p: (0.5 + 0.5 * p.x, 0.2, 0.2)").is_empty());
        assert!(found("bump = lambda p: 3 * p.x").is_empty());
        let [one] = &found("color = lambda p: (0.5 + 0.7 * p.x, 0.2, 0.2)")[..] else {
            panic!("a colour out of range")
        };
        assert!(one.value.is_some_and(|x| !(0.0..=1.0).contains(&x)) && one.what == "colour");
        let [none] = &found("roughness = lambda p: 1 / (p.x - p.x)")[..] else {
            panic!("no number")
        };
        assert_eq!((none.what, none.value), ("roughness", None));
    }

    #[test]
    fn far_from_the_origin_is_noticed() {
        assert_eq!(coarse(&scene("show(sphere(1))")), None);
        let far = scene("show(sphere(1).move(x = 100000))");
        let (grain, pixel) = coarse(&far).expect("coarse");
        assert!(grain > 0.01 && pixel < 0.02, "{grain} {pixel}");
    }
}
