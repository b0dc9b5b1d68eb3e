//! How the scene is rendered: `render(...)` and the methods that it takes.

use super::mistake::{Run, mistake};
use super::native::{Call, Native, Slot, slot};
use super::value::{Thing, Value};
use crate::draft::check_size;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_scene::settings::{
    Antialias, Filter, March, Normals, Occlusion, Settings, Shading, Shadow,
};

macro_rules! function {
    ($group:literal, $name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
}

macro_rules! march {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => { function!("Marching", $name, $doc, [$($slot),*], $run) };
}

macro_rules! shadow {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => { function!("Shadows", $name, $doc, [$($slot),*], $run) };
}

macro_rules! occlusion {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        function!("Ambient occlusion", $name, $doc, [$($slot),*], $run)
    };
}

const SHARPNESS: Slot = slot("sharpness", "16", "Larger is sharper, 1 to 1000.");
const REACH: Slot = slot("reach", "unlimited", "How far they look, scene units.");
const RAYS: Slot = slot("rays", "64", "Number of rays.");

/// The functions.
pub(crate) const ALL: &[Native] = &[
    function!(
        "Rendering",
        "render",
        "How the picture is made.",
        [
            slot("size", "(512, 512)", "Width and height in pixels."),
            slot(
                "march",
                "auto()",
                "How rays find the surface: fixed(), sphere_tracing(), relaxed(), enhanced(), auto()."
            ),
            slot(
                "normals",
                "\"exact\"",
                "How normals are found: \"tetrahedron\", \"central\", \"samples18\", \"samples26\", \"exact\"."
            ),
            slot(
                "ao",
                "cones()",
                "Ambient occlusion: none(), quilez(), bent(), evans(), upward(), cones(), hemisphere(), obscurance()."
            ),
            slot(
                "aa",
                "supersample(4)",
                "Antialiasing: none() or supersample()."
            ),
            slot(
                "shading",
                "\"phong\"",
                "How light becomes colour: \"phong\", \"lambert\", \"lambert_legacy\"."
            ),
            slot("exposure", "0", "Stops brighter, -20 to 20."),
            slot(
                "seed",
                "0",
                "Chooses other random numbers for everything that samples."
            ),
            slot(
                "prepass",
                "True",
                "Whether whole tiles are marched as cones first."
            ),
            slot("max_steps", "256", "Most steps of a ray, 1 to 100,000."),
            slot(
                "hit_selection",
                "True",
                "Whether a ray that runs out of steps takes its best candidate."
            ),
            slot(
                "discontinuity_reduction",
                "2",
                "Steps that put a hit where its pixel meets the surface, 0 to 16."
            ),
            slot(
                "footprint",
                "0.5",
                "A hit is nearer to the surface than this many pixels, 0.001 to 4."
            )
        ],
        render
    ),
    function!(
        "Rendering",
        "none",
        "Without: shadow, ambient occlusion, antialiasing.",
        [],
        |c| c.machine.thing(Thing::Nothing)
    ),
    function!(
        "Rendering",
        "supersample",
        "Several rays a pixel.",
        [
            slot("samples", "4", "Rays a pixel."),
            slot(
                "filter",
                "\"mitchell\"",
                "\"box\", \"tent\" or \"mitchell\"."
            )
        ],
        |c| {
            let samples = samples(c, "samples", 4)?;
            let filters = [
                ("box", Filter::Box),
                ("tent", Filter::Tent),
                ("mitchell", Filter::Mitchell),
            ];
            let filter = c.word_or("filter", Filter::Mitchell, &filters)?;
            c.machine
                .thing(Thing::Antialias(Antialias::Supersample { samples, filter }))
        }
    ),
    march!(
        "fixed",
        "Constant steps, then bisection.",
        [slot("step", "0.02", "Step, scene units.")],
        |c| {
            let step = small(c, "step", 0.02, SMALL, LARGE)?;
            march(c, March::Fixed { step })
        }
    ),
    march!(
        "sphere_tracing",
        "Steps of the field's value (Hart 1996).",
        [],
        |c| march(c, March::Sphere)
    ),
    march!(
        "relaxed",
        "Longer steps, taken back where they go too far (Keinert 2014).",
        [slot("omega", "1.2", "Factor on every step, 1 to 1.99.")],
        |c| {
            let omega = small(c, "omega", 1.2, 1.0, 1.99)?;
            march(c, March::Relaxed { omega })
        }
    ),
    march!(
        "enhanced",
        "Steps from a planar guess (Balint and Valasek 2018).",
        [slot(
            "share",
            "0.9",
            "Share of the guess that is taken, 0.1 to 1."
        )],
        |c| {
            let share = small(c, "share", 0.9, 0.1, 1.0)?;
            march(c, March::Enhanced { share })
        }
    ),
    march!(
        "auto",
        "Longer steps from the slope along the ray (Ban and Valasek 2023).",
        [slot(
            "beta",
            "0.3",
            "How fast the slope is followed, 0.01 to 1."
        )],
        |c| {
            let beta = small(c, "beta", 0.3, 0.01, 1.0)?;
            march(c, March::Auto { beta })
        }
    ),
    shadow!("hard", "A shadow with a sharp edge.", [], |c| c
        .machine
        .thing(Thing::Shadow(Shadow::Hard))),
    shadow!(
        "soft",
        "A shadow that softens with distance (Quilez 2010).",
        [SHARPNESS],
        |c| {
            let sharpness = small(c, "sharpness", 16.0, 1.0, 1000.0)?;
            c.machine.thing(Thing::Shadow(Shadow::Soft { sharpness }))
        }
    ),
    shadow!(
        "soft_closest",
        "A soft shadow without banding (Aaltonen 2018).",
        [SHARPNESS],
        |c| {
            let sharpness = small(c, "sharpness", 16.0, 1.0, 1000.0)?;
            c.machine
                .thing(Thing::Shadow(Shadow::SoftClosest { sharpness }))
        }
    ),
    occlusion!(
        "quilez",
        "Samples along the normal (Tomczak 2012, 3.4).",
        [
            slot("steps", "5", "Number of samples."),
            slot("step", "0.1", "Distance between samples."),
            slot("scale", "1", "Strength.")
        ],
        |c| {
            let (steps, step, scale) = (
                samples(c, "steps", 5)?,
                small(c, "step", 0.1, SMALL, LARGE)?,
                scale(c, 1.0)?,
            );
            occlusion(c, Occlusion::Quilez { steps, step, scale })
        }
    ),
    occlusion!(
        "bent",
        "Samples along a way that bends upwards (Tomczak 2012, 3.7).",
        [
            slot("steps", "5", "Number of samples."),
            slot("step", "0.1", "Distance between samples."),
            slot("scale", "0.5", "Strength."),
            slot(
                "bend",
                "0.2",
                "How far the way bends at each sample, 0 to 10."
            )
        ],
        |c| {
            let (steps, step, scale) = (
                samples(c, "steps", 5)?,
                small(c, "step", 0.1, SMALL, LARGE)?,
                scale(c, 0.5)?,
            );
            let bend = small(c, "bend", 0.2, 0.0, 10.0)?;
            occlusion(
                c,
                Occlusion::Bent {
                    steps,
                    step,
                    scale,
                    bend,
                },
            )
        }
    ),
    occlusion!(
        "evans",
        "Samples at doubling distances (Evans 2006).",
        [
            slot("scale", "1", "Strength."),
            slot("step", "0.1", "First distance above zero."),
            slot(
                "bend",
                "0.5",
                "How far the normal bends towards the sky, 0 to 10."
            )
        ],
        |c| {
            let (scale, step) = (scale(c, 1.0)?, small(c, "step", 0.1, SMALL, LARGE)?);
            let bend = small(c, "bend", 0.5, 0.0, 10.0)?;
            occlusion(c, Occlusion::Evans { scale, step, bend })
        }
    ),
    occlusion!(
        "upward",
        "From the slope of the surface alone (Tomczak 2012, 4.3).",
        [slot("scale", "0.5", "Strength.")],
        |c| {
            let scale = scale(c, 0.5)?;
            occlusion(c, Occlusion::Upward { scale })
        }
    ),
    occlusion!(
        "cones",
        "Eleven cones, each as open as its axis is clear.",
        [REACH, slot("steps", "14", "Samples along a cone, at most.")],
        |c| {
            let (reach, steps) = (reach(c)?, samples(c, "steps", 14)?);
            occlusion(c, Occlusion::Cones { reach, steps })
        }
    ),
    occlusion!(
        "hemisphere",
        "Sampled visibility: the reference.",
        [RAYS, REACH],
        |c| {
            let (rays, reach) = (samples(c, "rays", 64)?, reach(c)?);
            occlusion(c, Occlusion::Hemisphere { rays, reach })
        }
    ),
    occlusion!(
        "obscurance",
        "As hemisphere, near things counting more (Iones 2003).",
        [
            RAYS,
            REACH,
            slot("tau", "2", "Falloff over distance, above 0 to 1000.")
        ],
        |c| {
            let (rays, reach) = (samples(c, "rays", 64)?, reach(c)?);
            let tau = small(c, "tau", 2.0, 1e-3, 1000.0)?;
            occlusion(c, Occlusion::Obscurance { rays, reach, tau })
        }
    ),
];

fn march(c: &mut Call<'_, '_>, march: March) -> Run<Value> {
    c.machine.thing(Thing::March(march))
}

fn occlusion(c: &mut Call<'_, '_>, occlusion: Occlusion) -> Run<Value> {
    c.machine.thing(Thing::Occlusion(occlusion))
}

/// How far occlusion looks: to the end of the scene where nothing is said.
fn reach(c: &Call<'_, '_>) -> Run<Option<f32>> {
    (c.get("reach"))
        .map(|g| Ok(c.ranged("reach", g, SMALL, LARGE)? as f32))
        .transpose()
}

fn small(c: &Call<'_, '_>, name: &str, default: f64, min: f64, max: f64) -> Run<f32> {
    Ok(c.number_or(name, default, min, max)? as f32)
}

fn scale(c: &Call<'_, '_>, default: f64) -> Run<f32> {
    small(c, "scale", default, 0.0, 1000.0)
}

fn samples(c: &Call<'_, '_>, name: &str, default: u32) -> Run<u32> {
    let limit = c.machine.limits.samples.min(1 << 20) as u32;
    c.count_or(name, default.min(limit), 1, limit)
}

fn render(c: &mut Call<'_, '_>) -> Run<Value> {
    c.once("how it is rendered")?;
    let d = Settings::default();
    let size = match c.get("size") {
        None => d.size,
        Some(given) => {
            let numbers: [f64; 2] = c.numbers("size", given)?;
            if numbers
                .iter()
                .any(|x| x.fract() != 0.0 || !(1.0..=1e6).contains(x))
            {
                let m = mistake(format!(
                    "{} must be two whole numbers from 1 to 1,000,000",
                    c.called("size")
                ));
                return Err(m.at(given.place));
            }
            let size = numbers.map(|x| x as u32);
            check_size(size, &c.machine.limits).map_err(|m| mistake(m).at(given.place))?;
            size
        }
    };
    let thing = |name: &str| {
        c.get(name).map(|g| match g.value {
            Value::Thing(i) => (g, Some(c.machine.store.thing(i))),
            _ => (g, None),
        })
    };
    let march = match thing("march") {
        None => d.march,
        Some((_, Some(Thing::March(march)))) => *march,
        Some((given, _)) => {
            return Err(c.unfit("march", "a marching method such as auto()", given));
        }
    };
    let antialias = match thing("aa") {
        None => d.antialias,
        Some((_, Some(Thing::Antialias(antialias)))) => *antialias,
        Some((_, Some(Thing::Nothing))) => Antialias::None,
        Some((given, _)) => {
            return Err(c.unfit(
                "aa",
                "an antialiasing method such as supersample(16)",
                given,
            ));
        }
    };
    let normals = [
        ("tetrahedron", Normals::Tetrahedron),
        ("central", Normals::Central),
        ("samples18", Normals::Samples18),
        ("samples26", Normals::Samples26),
        ("exact", Normals::Exact),
    ];
    let shading = [
        ("phong", Shading::Phong),
        ("lambert", Shading::Lambert),
        ("lambert_legacy", Shading::LambertLegacy),
    ];
    let settings = Settings {
        size,
        march,
        prepass: c.flag_or("prepass", d.prepass)?,
        max_steps: c.count_or("max_steps", d.max_steps, 1, 100_000)?,
        hit_selection: c.flag_or("hit_selection", d.hit_selection)?,
        discontinuity_reduction: c.count_or(
            "discontinuity_reduction",
            d.discontinuity_reduction,
            0,
            16,
        )?,
        footprint: small(c, "footprint", f64::from(d.footprint), 1e-3, 4.0)?,
        normals: c.word_or("normals", d.normals, &normals)?,
        shading: c.word_or("shading", d.shading, &shading)?,
        occlusion: c
            .get("ao")
            .map_or(Ok(d.occlusion), |g| c.occlusion("ao", g))?,
        antialias,
        seed: c.count_or("seed", d.seed, 0, u32::MAX)?,
        exposure: small(c, "exposure", f64::from(d.exposure), -20.0, 20.0)?,
    };
    c.machine.draft.settings = Some(settings);
    Ok(Value::None)
}
