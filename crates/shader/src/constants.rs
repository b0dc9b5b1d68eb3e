//! Constants that the CPU's renderer and shaders share, as WGSL.

use crate::job::LAMPS;
use std::fmt::Write;
use zeroset_field::program::{FLAT, INSIDE_MARKS};
use zeroset_shade::{
    air, bsdf, coverage, environment, march, occlusion, pattern, sampling, secondary, shadow, skin,
    skylight, surface, view,
};

/// The value of a constant.
enum Value {
    Number(f32),
    Whole(u32),
    Vector(&'static [f32]),
}
use Value::{Number, Vector, Whole};

/// All of them: names in WGSL and values.
fn constants() -> Vec<(&'static str, Value)> {
    let weights = occlusion::weights();
    vec![
        // evaluations in single precision are off by about this share of the largest coordinate
        ("ROUNDING", Number(view::ROUNDING)),
        ("EPSILON", Number(f32::EPSILON)),
        // what no distance reaches: WGSL has no infinity
        ("FAR", Number(f32::MAX)),
        ("LEAST_NORMAL", Number(f32::MIN_POSITIVE)),
        ("FLAT_SLOPE", Number(FLAT)),
        ("FINE_ROWS", Number(view::FINE as f32)),
        ("GUESS_BEYOND", Number(march::GUESS_BEYOND)),
        ("GUESS_LONGEST", Number(march::GUESS_LONGEST)),
        ("TOWARDS", Number(march::TOWARDS)),
        ("LEAST_SHARE", Number(march::LEAST_SHARE)),
        (
            "LEAST_SHARE_OF_FRACTALS",
            Number(march::LEAST_SHARE_OF_FRACTALS),
        ),
        ("LEAST_ROUNDINGS", Number(march::LEAST_ROUNDINGS)),
        (
            "LEAST_ROUNDINGS_BEHIND",
            Number(march::LEAST_ROUNDINGS_BEHIND),
        ),
        ("REFINEMENTS", Whole(march::REFINEMENTS)),
        ("MIDDLE", Whole(march::MIDDLE)),
        ("SETTLED", Number(march::SETTLED)),
        ("MARKS_BEHIND", Number(march::MARKS_BEHIND)),
        ("INSIDE_MARKS", Number(INSIDE_MARKS)),
        ("SKIN_BEHIND", Number(skin::BEHIND)),
        // the prepass
        ("CONE_NEAR", Number(march::CONE_NEAR)),
        ("CONE_STEPS", Whole(march::CONE_STEPS)),
        ("CONE_SMOOTHING", Number(march::CONE_SMOOTHING)),
        // coverage
        ("COVERAGE_CORNERS", Whole(coverage::CORNERS as u32)),
        ("COVERAGE_SMALLEST", Number(coverage::SMALLEST)),
        ("COVERAGE_PASSES", Whole(coverage::PASSES)),
        ("COVERAGE_FINE", Number(coverage::FINE)),
        ("COVERAGE_BENT", Number(coverage::BENT)),
        ("COVERAGE_SURPRISE", Number(coverage::SURPRISE)),
        ("COVERAGE_RISE", Number(coverage::RISE)),
        ("COVERAGE_FALL", Number(coverage::FALL)),
        ("COVERAGE_BEYOND", Number(coverage::BEYOND)),
        ("COVERAGE_NEAR", Number(coverage::NEAR)),
        ("COVERAGE_SURE", Number(coverage::SURE)),
        ("STEEPEST", Number(march::STEEPEST)),
        ("COVERAGE_SOLID", Number(coverage::SOLID)),
        ("COVERAGE_FRACTAL", Number(coverage::FRACTAL)),
        ("COVERAGE_FALLING", Number(coverage::FALLING)),
        ("COVERAGE_UNSEEN", Number(coverage::UNSEEN)),
        ("COVERAGE_STEPS", Whole(coverage::STEPS)),
        // rays from surfaces
        ("SECONDARY_FIRST", Number(secondary::FIRST)),
        ("SECONDARY_STOP", Number(secondary::STOP)),
        ("SECONDARY_LEAST", Number(secondary::LEAST)),
        ("SECONDARY_SMOOTHING", Number(secondary::SMOOTHING)),
        ("SECONDARY_STEEPEST", Number(secondary::STEEPEST)),
        ("DARK", Number(shadow::DARK)),
        // occlusion
        ("UP", Vector(&occlusion::UP)),
        ("QUILEZ_FALL", Number(occlusion::QUILEZ_FALL)),
        ("BENT_FALL", Number(occlusion::BENT_FALL)),
        ("EVANS", Vector(&occlusion::EVANS)),
        ("SKYLIGHT_LEVELS", Whole(skylight::LEVELS as u32)),
        ("SKYLIGHT_COLOURED", Whole(skylight::COLOURED as u32)),
        ("CONES", Whole(occlusion::CONES as u32)),
        ("CONES_HIGH", Whole(occlusion::HIGH as u32)),
        ("CONE_COSINES", Vector(&occlusion::COSINES)),
        ("CONE_WEIGHT_HIGH", Number(weights[0])),
        ("CONE_WEIGHT_LOW", Number(weights[1])),
        ("CONE_WIDTH", Vector(&occlusion::WIDTH)),
        ("CONE_FULL", Number(occlusion::FULL)),
        ("CONE_BLOCKED", Number(occlusion::BLOCKED)),
        ("CONE_CARE", Number(occlusion::CARE)),
        ("CONE_SURE", Number(occlusion::SURE)),
        ("CONE_START", Number(occlusion::START)),
        ("CONE_FREE", Number(occlusion::FREE)),
        ("CONE_MORE", Whole(skin::MORE)),
        ("CONE_NORMAL_SHARE", Number(occlusion::NORMAL_SHARE)),
        ("BALL_GROWTH", Number(occlusion::GROWTH)),
        ("BALL_NARROW", Number(occlusion::NARROW)),
        ("BALL_EMPTY", Number(occlusion::EMPTY)),
        // sampling
        ("PCG_FACTOR", Whole(sampling::PCG[0])),
        ("PCG_SUMMAND", Whole(sampling::PCG[1])),
        ("LENS_DECISION", Whole(sampling::LENS)),
        ("HIT_SEEDS", Whole(sampling::HIT_SEEDS)),
        ("UNIT", Number(sampling::UNIT)),
        ("ENDLESS", Number(air::ENDLESS)),
        // rays that go on
        ("FAINTEST", Number(surface::FAINTEST)),
        // paths
        ("LAMP_RECTANGLE", Number(LAMPS[0])),
        ("LAMP_DISC", Number(LAMPS[1])),
        ("LAMP_SPHERE", Number(LAMPS[2])),
        ("LAMP_AROUND", Number(LAMPS[3])),
        ("AROUND_LEVELS", Number(environment::LEVELS as f32)),
        ("AROUND_WIDTH", Number(environment::GLOSSY[0] as f32)),
        ("AROUND_HEIGHT", Number(environment::GLOSSY[1] as f32)),
        ("AROUND_DECISION", Whole(environment::DECISION)),
        ("LAMP_PI", Number(std::f32::consts::PI)),
        ("PATH_DECISIONS", Whole(bsdf::DECISIONS)),
        ("PATH_SURE", Whole(bsdf::SURE)),
        ("PATH_LIKELIEST", Number(bsdf::LIKELIEST)),
        ("LAINE_KARRAS_A", Whole(sampling::LAINE_KARRAS[0])),
        ("LAINE_KARRAS_B", Whole(sampling::LAINE_KARRAS[1])),
        ("LAINE_KARRAS_C", Whole(sampling::LAINE_KARRAS[2])),
        ("LAINE_KARRAS_D", Whole(sampling::LAINE_KARRAS[3])),
        // patterns
        ("LEAST_WEIGHT", Number(pattern::LEAST_WEIGHT)),
        ("BUMP_STEP", Number(pattern::BUMP_STEP)),
        ("FORMULA_UNKNOWN", Vector(&pattern::UNKNOWN)),
        ("FORMULA_LARGEST", Number(pattern::LARGEST_VALUE)),
        ("FORMULA_HIGHEST", Number(pattern::HIGHEST)),
    ]
}

/// Their declarations.
pub(crate) fn declarations() -> String {
    let mut text = String::new();
    for (name, value) in constants() {
        let (kind, value) = match value {
            Number(x) => ("f32".to_owned(), format!("{x:?}f")),
            Whole(n) => ("u32".to_owned(), format!("{n}u")),
            Vector(v) => {
                let kind = format!("vec{}f", v.len());
                let of: Vec<String> = v.iter().map(|x| format!("{x:?}f")).collect();
                let value = format!("{kind}({})", of.join(", "));
                (kind, value)
            }
        };
        // writing to a string cannot fail
        let _ = writeln!(text, "const {name}: {kind} = {value};");
    }
    text
}
