//! A scene from a shader.

use crate::glsl::{Functions, Gives, GlslError, translate};
use crate::measure::{self, number};
use crate::{ImportError, Imported, Request, one_line};
use std::fmt::Write;

/// Colours of materials, in turn.
const COLOURS: [&str; 8] = [
    "#c8553d", "#2a6f7f", "#e0a84c", "#7a4a78", "#6d8b4a", "#d8cfc0", "#3f5a8a", "#b5838d",
];

impl From<GlslError> for ImportError {
    fn from(error: GlslError) -> Self {
        ImportError::Shader {
            message: error.message,
            help: error.help,
            place: error.place,
        }
    }
}

/// The distance at p.
fn distance(functions: &Functions) -> String {
    match functions.gives {
        Gives::Distance => format!("{}(p)", functions.name),
        Gives::Vector(_) | Gives::Item(_) => {
            let k = if let Gives::Item(k) = functions.gives {
                k
            } else {
                0
            };
            format!("{}(p)[{k}]", functions.name)
        }
    }
}

pub(crate) fn scene(text: &str, request: &Request<'_>) -> Result<Imported, ImportError> {
    let functions = translate(text, request.function)?;
    let mut out = format!(
        "# {}: `{}`, imported from GLSL.\n\n{}\n",
        one_line(request.title),
        functions.original,
        functions.text
    );
    let mut notes = functions.notes.clone();
    let d = distance(&functions);
    let f = if functions.gives == Gives::Distance {
        functions.name.clone()
    } else {
        format!("lambda p: {d}")
    };
    let one = |place: &str| {
        format!(
            "show(field({f}, {place}), material(color = \"{}\", roughness = 0.5))\n",
            COLOURS[0]
        )
    };
    let head = out.clone();
    let made = measure::framed(&|place| format!("{head}{}", one(place)), None)?;
    notes.extend(made.notes.iter().cloned());
    let materials = match functions.gives {
        Gives::Vector(2) => {
            let second = format!(
                "{head}show(field(lambda p: {}(p)[1], size = 1, slope = 1e6))",
                functions.name
            );
            measure::values_on(&second, &made)?
        }
        _ => Some(Vec::new()),
    };
    out += &made.comment;
    match materials {
        Some(numbers) if (2..=COLOURS.len()).contains(&numbers.len()) => {
            let gap = numbers
                .windows(2)
                .map(|w| w[1] - w[0])
                .fold(f64::INFINITY, f64::min);
            let slope = match made.slope {
                Some(slope) => slope,
                None => made.steepest.max(1.0),
            };
            let _ = write!(
                out,
                "# What has the material of this number. Elsewhere the distance is taken as that of something solid, so that the parts meet in\n\
                 # the surface alone; their slope is that of the whole.\n\
                 def part(number):\n    def distance_at(p):\n        d = {}(p)\n        return d[0] if abs(d[1] - number) < {} else abs(d[0])\n\
                 \x20   return field(distance_at, {}, slope = {})\n\n",
                functions.name,
                number(0.5 * gap),
                made.bounds_text(),
                number(slope)
            );
            for (k, value) in numbers.iter().enumerate() {
                let _ = writeln!(
                    out,
                    "show(part({}), material(color = \"{}\", roughness = 0.5), name = \"material {}\")",
                    number(*value),
                    COLOURS[k],
                    number(*value)
                );
            }
        }
        other => {
            if other.is_none() {
                notes.push(
                    "its materials are no few numbers: all is shown in one colour".to_owned(),
                );
            }
            out += &one(&made.place);
        }
    }
    out += &made.camera;
    measure::loaded(&out, None)?;
    Ok(Imported { text: out, notes })
}
