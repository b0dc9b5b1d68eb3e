//! Colours, patterns and materials.

use super::colours::Shown;
use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot, spoken};
use super::place::{MOVE, TURN, coordinates, each_axis, turned};
use super::value::{Thing, Value};
use crate::draft::unit;
use crate::images;
use glam::{DVec3, Vec3};
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_scene::colour;
use zeroset_scene::material::{Bump, Ink, Material, Pattern};

macro_rules! function {
    ($group:literal, $name:literal, $doc:literal, $slots:ident, $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: $slots, rest: false, run: $run }
    };
    ($group:literal, $name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
}

const A: Slot = slot(
    "a",
    "\"#e8e8e8\"",
    "The one colour, a pattern or a function in its place, or a number for what is no colour.",
);
const B: Slot = slot("b", "\"#404040\"", "The other one.");
const SIZE: Slot = slot("size", "1", "Size, scene units.");

/// The functions.
pub(crate) const ALL: &[Native] = &[
    function!(
        "Materials",
        "material",
        "What a surface looks like.",
        [
            slot(
                "color",
                "\"#cbc8c4\"",
                "A colour, a pattern, or a function of a point that gives a colour; white where it transmits."
            ),
            slot(
                "metallic",
                "0",
                "0 plastic or stone, 1 metal; or a pattern of numbers, or a function."
            ),
            slot(
                "roughness",
                "0.5",
                "0 mirror, 1 chalk, or a pattern of numbers, or a function; from `shininess` where that alone is given."
            ),
            slot(
                "specular",
                "0.25",
                "Strength of the highlight, 0 to 10; 0.25 is usual for glass, stone and plastic."
            ),
            slot(
                "shininess",
                "from roughness",
                "Sharpness of the highlight in Phong's model, 1 to 10,000."
            ),
            slot("emission", "\"black\"", "The colour that it glows in."),
            slot("strength", "1", "How strongly it glows."),
            slot(
                "transmission",
                "0",
                "0 opaque, 1 glass: what light is not reflected goes on inside."
            ),
            slot(
                "ior",
                "1.5",
                "Index of refraction, 1 to 4: 1.33 water, 1.5 glass, 2.42 diamond."
            ),
            slot(
                "tint",
                "\"white\"",
                "Colour that white light has after the way `tint_depth` inside."
            ),
            slot("tint_depth", "1", "See `tint`; scene units."),
            slot(
                "bump",
                "None",
                "A pattern of heights, 0 to 1, or a function of any, that the surface is shown with as if it had them."
            ),
            slot(
                "bump_depth",
                "0.02",
                "How high 1 is, scene units; below 0 for dents."
            )
        ],
        material
    ),
    function!(
        "Materials",
        "rgb",
        "A colour from red, green and blue, each 0 to 1.",
        [
            slot("red", "", "0 to 1."),
            slot("green", "", "0 to 1."),
            slot("blue", "", "0 to 1.")
        ],
        |c| {
            let [r, g, b] = three(c, ["red", "green", "blue"], [1.0; 3])?;
            tuple(c, [r, g, b])
        }
    ),
    function!(
        "Materials",
        "hsv",
        "A colour from hue, saturation and value.",
        [
            slot(
                "hue",
                "",
                "Degrees: 0 red, 120 green, 240 blue; any number."
            ),
            slot("saturation", "1", "0 grey to 1 pure."),
            slot("value", "1", "0 black to 1 bright.")
        ],
        |c| {
            let hue = c.need("hue")?;
            let hue = c.number("hue", hue)?;
            let (s, v) = (
                c.number_or("saturation", 1.0, 0.0, 1.0)?,
                c.number_or("value", 1.0, 0.0, 1.0)?,
            );
            tuple(c, colour::hsv(hue, s, v))
        }
    ),
    function!(
        "Patterns",
        "checker",
        "Cubes of two colours.",
        [A, B, SIZE],
        |c| {
            let (colours, size) = (pair(c)?, size(c)?);
            pattern(c, Pattern::Checker { colours, size })
        }
    ),
    function!(
        "Patterns",
        "stripes",
        "Bands of two colours across a direction.",
        [A, B, slot("direction", "\"y\"", "Across which way."), SIZE],
        |c| {
            let (colours, size) = (pair(c)?, size(c)?);
            let direction = c
                .get("direction")
                .map_or(Ok([0.0, 1.0, 0.0]), |g| c.direction("direction", g))?;
            let direction = unit(direction).as_vec3();
            pattern(
                c,
                Pattern::Stripes {
                    colours,
                    direction,
                    size,
                },
            )
        }
    ),
    function!(
        "Patterns",
        "noise",
        "Clouds between two colours.",
        [
            A,
            B,
            SIZE,
            slot("octaves", "4", "How fine the finest detail is, 1 to 8.")
        ],
        |c| {
            let (colours, size, octaves) = (pair(c)?, size(c)?, c.count_or("octaves", 4, 1, 8)?);
            pattern(
                c,
                Pattern::Noise {
                    colours,
                    size,
                    octaves,
                },
            )
        }
    ),
    function!(
        "Patterns",
        "gradient",
        "From one colour to another between two points.",
        [
            A,
            B,
            slot("start", "(0, -1, 0)", "Where the first colour is."),
            slot("end", "(0, 1, 0)", "Where the second is.")
        ],
        |c| {
            let colours = pair(c)?;
            let start = c
                .get("start")
                .map_or(Ok([0.0, -1.0, 0.0]), |g| c.numbers("start", g))?;
            let end = c
                .get("end")
                .map_or(Ok([0.0, 1.0, 0.0]), |g| c.numbers("end", g))?;
            if start == end {
                return Err(mistake("`start` and `end` of gradient() must differ"));
            }
            pattern(
                c,
                Pattern::Gradient {
                    colours,
                    from: DVec3::from(start).as_vec3(),
                    to: DVec3::from(end).as_vec3(),
                },
            )
        }
    ),
    function!(
        "Patterns",
        "triplanar",
        "An image projected along the three axes.",
        [
            slot("image", "", "A PNG or JPEG file in the scene's folder."),
            slot("size", "1", "Side of a copy of the image, scene units."),
            slot(
                "sharpness",
                "4",
                "How sharply the three projections are told apart: 1 soft, 8 sharp."
            )
        ],
        |c| {
            let given = c.need("image")?;
            let name = c.text("image", given)?;
            let (size, sharpness) = (size(c)?, c.number_or("sharpness", 4.0, 1.0, 64.0)? as f32);
            let limits = c.machine.limits;
            let image = images::load(&mut c.machine.draft.files, &name, &limits)
                .map_err(|m| mistake(m).at(given.place))?;
            pattern(
                c,
                Pattern::Triplanar {
                    image,
                    size,
                    sharpness,
                },
            )
        }
    ),
    function!(
        "Patterns",
        "orbit",
        "Colours by the orbit of a fractal: by how near it came to each trap.",
        [
            slot("center", "\"#f2e8cf\"", "Colour near the origin."),
            slot("x", "\"#bc4749\"", "Colour near the plane x = 0."),
            slot("y", "\"#6a994e\"", "Colour near the plane y = 0."),
            slot("z", "\"#386fa4\"", "Colour near the plane z = 0.")
        ],
        |c| {
            let colours = [
                c.ink_or("center", "#f2e8cf")?,
                c.ink_or("x", "#bc4749")?,
                c.ink_or("y", "#6a994e")?,
                c.ink_or("z", "#386fa4")?,
            ];
            pattern(c, Pattern::Orbit { colours })
        }
    ),
];

impl Call<'_, '_> {
    /// A colour, linear.
    pub(crate) fn colour(&self, param: &str, given: Given) -> Run<Vec3> {
        Ok(colour::linear(self.srgb(param, given)?))
    }

    /// A colour, sRGB, 0 to 1.
    pub(crate) fn srgb(&self, param: &str, given: Given) -> Run<[f64; 3]> {
        if let Value::Text(i) = given.value {
            let text = self.machine.store.text(i).clone();
            return crate::colour::parse(&text).map_err(|reason| {
                mistake(format!("{} is no colour: \"{text}\", {reason}", self.called(param)))
                    .help("write \"#e8b04a\", \"#888\", a CSS name such as \"tomato\", hsv(30, 0.7, 0.9) or (0.9, 0.7, 0.3)")
                    .at(given.place)
            });
        }
        if !matches!(given.value, Value::List(_) | Value::Tuple(_)) {
            return Err(self.unfit(
                param,
                "a colour such as \"#e8b04a\" or (0.9, 0.7, 0.3)",
                given,
            ));
        }
        let numbers: [f64; 3] = self.numbers(param, given)?;
        if let Some(x) = numbers.iter().find(|x| !(0.0..=1.0).contains(*x)) {
            let message = format!(
                "{} has {}, allowed is 0 to 1",
                self.called(param),
                spoken(*x)
            );
            return Err(mistake(message)
                .help("divide numbers from 0 to 255 by 255")
                .at(given.place));
        }
        Ok(numbers)
    }

    /// What a pattern shows: a colour, a number as a grey of this luminance, or another pattern. Or a default.
    fn ink_or(&mut self, param: &str, default: &str) -> Run<Ink> {
        let Some(given) = self.get(param) else {
            return Ok(self.colour_or(param, default)?.into());
        };
        if let Some(formula) = self.formula_pattern(param, given, Shown::Either)? {
            return Ok(formula.into());
        }
        match given.value {
            Value::Int(_) | Value::Float(_) => {
                let grey = self.ranged(param, given, 0.0, 1.0)? as f32;
                Ok(Vec3::splat(grey).into())
            }
            Value::Thing(i) => match self.machine.store.thing(i) {
                Thing::Pattern(pattern) => Ok(pattern.clone().into()),
                _ => Err(self.unfit(param, "a colour, a number or a pattern", given)),
            },
            _ => Ok(self.colour(param, given)?.into()),
        }
    }

    /// A number, or a pattern of numbers.
    fn number_or_map(&mut self, param: &str, default: f32) -> Run<(Option<f32>, Option<Pattern>)> {
        if let Some(pattern) = self.pattern(param)? {
            return Ok((None, Some(pattern)));
        }
        let number = self.number_or(param, f64::from(default), 0.0, 1.0)? as f32;
        Ok((self.get(param).is_some().then_some(number), None))
    }

    /// A pattern of numbers or a function that gives one, if that is what was given.
    fn pattern(&mut self, param: &str) -> Run<Option<Pattern>> {
        let Some(given) = self.get(param) else {
            return Ok(None);
        };
        if let Value::Thing(i) = given.value
            && let Thing::Pattern(pattern) = self.machine.store.thing(i)
        {
            return Ok(Some(pattern.clone()));
        }
        self.formula_pattern(param, given, Shown::Number)
    }

    /// A colour, linear, or a default.
    pub(crate) fn colour_or(&self, param: &str, default: &str) -> Run<Vec3> {
        match self.get(param) {
            Some(given) => self.colour(param, given),
            None => crate::colour::parse(default)
                .map(colour::linear)
                .map_err(mistake),
        }
    }
}

fn material(c: &mut Call<'_, '_>) -> Run<Value> {
    let default = Material::default();
    let transmission = c.number_or("transmission", f64::from(default.transmission), 0.0, 1.0)?;
    let pattern = match c.get("color") {
        // what lets light through colours it by its tint
        None if transmission > 0.0 => Pattern::Solid { colour: Vec3::ONE },
        None => default.pattern,
        Some(given) => match c.formula_pattern("color", given, Shown::Colour)? {
            Some(formula) => formula,
            None => match given.value {
                Value::Thing(i) => match c.machine.store.thing(i) {
                    Thing::Pattern(pattern) => pattern.clone(),
                    _ => return Err(c.unfit("color", "a colour, a pattern or a function", given)),
                },
                _ => Pattern::Solid {
                    colour: c.colour("color", given)?,
                },
            },
        },
    };
    let strength = c.number_or("strength", 1.0, 0.0, 1e6)? as f32;
    let (roughness, roughness_map) = c.number_or_map("roughness", default.roughness)?;
    let (metallic, metallic_map) = c.number_or_map("metallic", default.metallic)?;
    let depth = c.number_or("bump_depth", 0.02, -LARGE, LARGE)? as f32;
    let bump = match (c.pattern("bump")?, c.get("bump")) {
        (Some(pattern), _) => Some(Bump { pattern, depth }),
        (None, Some(given)) => {
            let wanted =
                "a pattern such as noise(0, 1), or a function such as lambda p: noise(8 * p)";
            return Err(c.unfit("bump", wanted, given));
        }
        (None, None) => None,
    };
    let shininess = c.number_or("shininess", f64::from(default.shininess), 1.0, 1e4)? as f32;
    let shininess = c.get("shininess").is_some().then_some(shininess);
    let depth = c.number_or("tint_depth", 1.0, SMALL, LARGE)? as f32;
    let material = Material {
        pattern,
        specular: c.number_or("specular", f64::from(default.specular), 0.0, 10.0)? as f32,
        shininess: (shininess.or(roughness.map(shininess_of))).unwrap_or(default.shininess),
        metallic: metallic.unwrap_or(default.metallic),
        roughness: (roughness.or(shininess.map(roughness_of))).unwrap_or(default.roughness),
        transmission: transmission as f32,
        ior: c.number_or("ior", f64::from(default.ior), 1.0, 4.0)? as f32,
        attenuation: attenuation(c.colour_or("tint", "white")?, depth),
        emission: c.colour_or("emission", "black")? * strength,
        roughness_map,
        metallic_map,
        bump,
    };
    c.machine.thing(Thing::Material(material.into()))
}

/// The exponent of Blinn's highlight that is about as wide as that of a roughness: `2 / alpha^2 - 2` (Walter et al. 2007).
pub(crate) fn shininess_of(roughness: f32) -> f32 {
    (2.0 / roughness.powi(4).max(1e-6) - 2.0).clamp(1.0, 1e4)
}

/// The other way round.
fn roughness_of(shininess: f32) -> f32 {
    (2.0 / (shininess + 2.0)).powf(0.25)
}

/// What leaves of white light a colour after a way (Beer's law). Black is what leaves a millionth.
fn attenuation(tint: Vec3, depth: f32) -> Vec3 {
    Vec3::from(tint.to_array().map(|c| -(c.clamp(1e-6, 1.0).ln()) / depth))
        .clamp(Vec3::ZERO, Vec3::splat(1e6))
}

fn pattern(c: &mut Call<'_, '_>, pattern: Pattern) -> Run<Value> {
    let parts = pattern.parts().take(Pattern::MOST + 1).count();
    if parts > Pattern::MOST {
        let most = Pattern::MOST;
        return Err(mistake(format!(
            "patterns within this pattern are too many, at most {most} are allowed, itself among them"
        )));
    }
    c.machine.thing(Thing::Pattern(pattern))
}

/// The methods of patterns.
pub(crate) const METHODS: &[Native] = &[
    function!(
        "Patterns",
        "move",
        "Moves the pattern over what it is painted on.",
        MOVE,
        |c| {
            let offset = coordinates(c, LARGE)?;
            let back = offset.map(|x| -x);
            placed(c, identity(), back)
        }
    ),
    function!(
        "Patterns",
        "turn",
        "Turns the pattern about the origin, as `turn` of a shape.",
        TURN,
        |c| {
            let r = turned(c)?.rotation;
            let back = [0, 1, 2].map(|i| [r[0][i], r[1][i], r[2][i]]);
            placed(c, back, [0.0; 3])
        }
    ),
    function!(
        "Patterns",
        "scale",
        "Scales the pattern about the origin.",
        [slot(
            "factor",
            "",
            "How many times larger, above 0; or (x, y, z), as for the grain of wood."
        )],
        |c| {
            let given = c.need("factor")?;
            let factor = each_axis(c, "factor", given, SMALL, LARGE)?;
            let mut rows = identity();
            for (k, row) in rows.iter_mut().enumerate() {
                row[k] = 1.0 / factor[k];
            }
            placed(c, rows, [0.0; 3])
        }
    ),
];

fn identity() -> [[f64; 3]; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

/// The pattern whose method is called, in another place: `rows` and `offset` lead from there to where it was.
fn placed(c: &mut Call<'_, '_>, rows: [[f64; 3]; 3], offset: [f64; 3]) -> Run<Value> {
    let inner = match c.receiver {
        Value::Thing(i) => match c.machine.store.thing(i) {
            Thing::Pattern(inner) => inner.clone(),
            _ => unreachable!("methods of patterns are looked up by patterns only"),
        },
        _ => unreachable!("methods of patterns are looked up by patterns only"),
    };
    let placed = Pattern::Placed {
        pattern: Box::new(inner),
        rows: rows.map(|row| DVec3::from(row).as_vec3()),
        offset: DVec3::from(offset).as_vec3(),
    };
    pattern(c, placed)
}

fn pair(c: &mut Call<'_, '_>) -> Run<[Ink; 2]> {
    Ok([c.ink_or("a", "#e8e8e8")?, c.ink_or("b", "#404040")?])
}

fn size(c: &Call<'_, '_>) -> Run<f32> {
    Ok(c.number_or("size", 1.0, SMALL, LARGE)? as f32)
}

fn three(c: &Call<'_, '_>, names: [&str; 3], max: [f64; 3]) -> Run<[f64; 3]> {
    let mut out = [0.0; 3];
    for k in 0..3 {
        let given = c.need(names[k])?;
        out[k] = c.ranged(names[k], given, 0.0, max[k])?;
    }
    Ok(out)
}

fn tuple(c: &mut Call<'_, '_>, numbers: [f64; 3]) -> Run<Value> {
    c.machine.grow_items(3)?;
    c.machine.tuple(numbers.map(Value::Float).to_vec())
}
