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
    let one = |place: &str, cut: Option<&str>| {
        let f = match cut {
            Some(depth) => format!("lambda p: max({d}, -{depth})"),
            None if functions.gives == Gives::Distance => functions.name.clone(),
            None => format!("lambda p: {d}"),
        };
        format!(
            "show(field({f}, {place}), material(color = \"{}\", roughness = 0.5))\n",
            COLOURS[0]
        )
    };
    let head = out.clone();
    let made = measure::framed(&|place, cut| format!("{head}{}", one(place, cut)), None)?;
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
            let here = match &made.cut {
                None => "d[0]".to_owned(),
                Some(depth) => format!("max(d[0], -{depth})"),
            };
            let _ = write!(
                out,
                "# What has the material of this number. Elsewhere the distance is taken as that of something solid, so that the parts meet in\n\
                 # the surface alone; their slope is that of the whole.\n\
                 def part(number):\n    def distance_at(p):\n        d = {}(p)\n        return {here} if abs(d[1] - number) < {} else abs({here})\n\
                 \x20   return field(distance_at, {}, slope = {})\n\n",
                functions.name,
                number(0.5 * gap),
                made.bounds_text(),
                number(made.slope())
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
            out += &one(&made.place, made.cut.as_deref());
        }
    }
    out += &made.camera;
    measure::loaded(&out, None)?;
    Ok(Imported { text: out, notes })
}
