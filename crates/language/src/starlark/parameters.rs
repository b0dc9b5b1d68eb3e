//! What changes from outside: time, sliders, choices, toggles, colours.

use super::mistake::{Mistake, Run, mistake};
use super::native::{Call, Given, Native, Slot, slot, spoken};
use super::value::Value;
use crate::load::{Control, Parameter, Setting};
use crate::report::suggestion;

macro_rules! function {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native {
            name: $name, doc: $doc, group: "Parameters", params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run
        }
    };
}

const NAME: Slot = slot(
    "name",
    "",
    "What it is called in the window and after --set.",
);

/// The functions.
pub(crate) const ALL: &[Native] = &[
    function!("time", "Seconds of the animation.", [], |c| {
        c.machine.draft.animated = true;
        Ok(Value::Float(c.machine.draft.time))
    }),
    function!(
        "slider",
        "A number that is changed from outside.",
        [
            NAME,
            slot("default", "", "Its value at first."),
            slot("min", "0", "The smallest value."),
            slot("max", "1, or twice the default", "The largest value.")
        ],
        slider
    ),
    function!(
        "choice",
        "A word that is chosen from outside.",
        [
            NAME,
            slot("options", "", "A list of words."),
            slot("default", "the first", "The word at first.")
        ],
        choice
    ),
    function!(
        "toggle",
        "A truth value that is changed from outside.",
        [NAME, slot("default", "False", "Its value at first.")],
        |c| {
            let default = c.flag_or("default", false)?;
            let value = parameter(c, Control::Toggle, Setting::Flag(default))?;
            from_setting(c, value)
        }
    ),
    function!(
        "color",
        "A colour that is changed from outside.",
        [NAME, slot("default", "\"white\"", "Its value at first.")],
        |c| {
            let default = c
                .get("default")
                .map_or(Ok([1.0; 3]), |g| c.srgb("default", g))?;
            let value = parameter(c, Control::Colour, Setting::Colour(default))?;
            from_setting(c, value)
        }
    ),
];

/// The most parameters a scene may have.
const PARAMETERS: usize = 256;

fn slider(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("default")?;
    let default = c.number("default", given)?;
    let min = c
        .get("min")
        .map_or(Ok(default.min(0.0)), |g| c.number("min", g))?;
    let max = c
        .get("max")
        .map_or(Ok((2.0 * default).max(1.0)), |g| c.number("max", g))?;
    if min >= max {
        return Err(mistake(format!(
            "`min` of slider() must be less than `max`, not {} and {}",
            spoken(min),
            spoken(max)
        )));
    }
    c.ranged("default", given, min, max)?;
    let value = parameter(c, Control::Slider { min, max }, Setting::Number(default))?;
    from_setting(c, value)
}

fn choice(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("options")?;
    let items = c
        .machine
        .collect(given.value)
        .map_err(|_| c.unfit("options", "a list of texts", given))?;
    let mut options = Vec::with_capacity(items.len());
    for value in items {
        let text = c.text("options", Given { value, ..given })?;
        c.machine.charge(text.len() as u64 / 16)?;
        c.machine.grow(2 * text.len())?;
        options.push(text.to_string());
    }
    let Some(first) = options.first().cloned() else {
        return Err(mistake("`options` of choice() needs at least one word").at(given.place));
    };
    let default = match c.get("default") {
        None => first,
        Some(given) => {
            let text = c.text("default", given)?;
            if !options.iter().any(|o| **o == *text) {
                let m = mistake(format!("\"{text}\" is not among the options of choice()"))
                    .at(given.place);
                return Err(m.maybe_help(suggestion(&text, options.iter().map(String::as_str))));
            }
            text.to_string()
        }
    };
    let value = parameter(c, Control::Choice { options }, Setting::Text(default))?;
    from_setting(c, value)
}

/// Declares a parameter and gives its value: what was set from outside, or the default.
fn parameter(c: &mut Call<'_, '_>, control: Control, default: Setting) -> Run<Setting> {
    let given = c.need("name")?;
    let name = c.text("name", given)?.to_string();
    if name.is_empty() || name.contains(['=', '\n']) {
        return Err(
            mistake("the name of a parameter must not be empty nor hold `=`").at(given.place),
        );
    }
    let fits = c.machine.limits.check_name(&name);
    fits.map_err(|m| mistake(m).at(given.place))?;
    let value = match c.machine.draft.overrides.get(&name) {
        None => default.clone(),
        Some(text) => read(&name, text, &control)?,
    };
    let place = c.machine.draft.position(c.place);
    let parameter = Parameter {
        name: name.clone(),
        control,
        value: value.clone(),
        default,
        place,
    };
    if let Some(other) = c.machine.draft.parameters.iter().find(|p| p.name == name) {
        if (&other.control, &other.default) == (&parameter.control, &parameter.default) {
            return Ok(value);
        }
        let m = mistake(format!("there is another parameter \"{name}\" already")).at(given.place);
        return Err(m.help("give it another name"));
    }
    if c.machine.draft.parameters.len() >= PARAMETERS {
        return Err(mistake(format!("more than {PARAMETERS} parameters")));
    }
    c.machine.grow(512)?;
    c.machine.draft.parameters.push(parameter);
    Ok(value)
}

/// What was set from outside, as text.
fn read(name: &str, text: &str, control: &Control) -> Run<Setting> {
    let unfit = |wanted: String| {
        mistake(format!(
            "{name} is set to \"{text}\", but it must be {wanted}"
        ))
    };
    let result: Result<Setting, Box<Mistake>> = match control {
        Control::Slider { min, max } => match text.trim().parse::<f64>() {
            Ok(x) if (*min..=*max).contains(&x) => Ok(Setting::Number(x)),
            _ => Err(unfit(format!(
                "a number from {} to {}",
                spoken(*min),
                spoken(*max)
            ))),
        },
        Control::Choice { options } => {
            if options.iter().any(|o| o == text) {
                return Ok(Setting::Text(text.to_string()));
            }
            const MOST: usize = 16;
            let help = suggestion(text, options.iter().map(String::as_str));
            let wanted = match options.len() {
                n if n > MOST || options.iter().any(|o| o.len() > 64) => {
                    format!("one of its {n} options")
                }
                _ => format!("one of {}", options.join(", ")),
            };
            Err(unfit(wanted).maybe_help(help))
        }
        Control::Toggle => match text.trim().to_lowercase().as_str() {
            "true" | "on" | "yes" | "1" => Ok(Setting::Flag(true)),
            "false" | "off" | "no" | "0" => Ok(Setting::Flag(false)),
            _ => Err(unfit("true or false".into())),
        },
        Control::Colour => match crate::colour::parse(text.trim()) {
            Ok(srgb) => Ok(Setting::Colour(srgb)),
            Err(reason) => Err(unfit(format!("a colour such as #e8b04a ({reason})"))),
        },
    };
    result
}

fn from_setting(c: &mut Call<'_, '_>, setting: Setting) -> Run<Value> {
    match setting {
        Setting::Number(x) => Ok(Value::Float(x)),
        Setting::Flag(b) => Ok(Value::Bool(b)),
        Setting::Text(text) => c.machine.text(text),
        Setting::Colour(srgb) => {
            c.machine.grow_items(3)?;
            c.machine.tuple(srgb.map(Value::Float).to_vec())
        }
    }
}
