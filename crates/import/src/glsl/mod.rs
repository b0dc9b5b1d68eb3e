//! GLSL as it is written for Shadertoy: a function that gives the distance at a point.

mod expression;
mod loops;
mod slice;
mod store;
mod times;
mod translate;
mod write;

use naga::front::glsl::{Error as NagaError, ErrorKind, Frontend, Options as NagaOptions};
use naga::{Function, Handle, Module, ShaderStage, Span, TypeInner};
use std::ops::Range;
use std::sync::mpsc;
use std::time::Duration;
use translate::{Time, Translator};

/// Names of functions that give the distance, in the order in which they are looked for.
pub const NAMES: [&str; 14] = [
    "map",
    "sdf",
    "scene",
    "de",
    "DE",
    "GetDist",
    "getDist",
    "sdScene",
    "sceneSDF",
    "SDF",
    "Map",
    "world",
    "dist",
    "distanceField",
];

/// Why GLSL is not translated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct GlslError {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
    /// The bytes of the text that it is about.
    pub place: Option<Range<usize>>,
    span: Option<Span>,
}

impl GlslError {
    fn new(message: impl Into<String>) -> GlslError {
        GlslError {
            message: message.into(),
            help: None,
            place: None,
            span: None,
        }
    }

    fn unsupported(span: Span, message: impl Into<String>, help: impl Into<String>) -> GlslError {
        GlslError {
            message: message.into(),
            help: Some(help.into()),
            place: None,
            span: span
                .is_defined()
                .then_some(span)
                .filter(|s| s.to_range().is_some_and(|r| r.end > r.start)),
        }
    }

    /// With a place, if it has none.
    fn or_at(mut self, span: Span) -> GlslError {
        let is_place = span.to_range().is_some_and(|r| r.end > r.start);
        if self.span.is_none() && self.place.is_none() && is_place {
            self.span = Some(span);
        }
        self
    }
}

/// What the function gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gives {
    /// The distance.
    Distance,
    /// A vector whose first part is the distance. Of two parts, the second one may be the number of a material.
    Vector(usize),
    /// A structure, an item of which is the distance.
    Item(usize),
}

/// A shader as functions of the scene language.
#[derive(Clone, Debug, PartialEq)]
pub struct Functions {
    /// Their text, with constants and helpers.
    pub text: String,
    /// The name of the one that gives the distance.
    pub name: String,
    /// Its name in the shader.
    pub original: String,
    /// What it gives.
    pub gives: Gives,
    /// What a person should know.
    pub notes: Vec<String>,
}

/// Bytes of a shader that are read.
const LONGEST: usize = 256 << 10;
/// Brackets and signs within each other that are followed.
const DEEPEST: usize = 256;
/// Bytes of the stack on which so much can be parsed: the parser calls itself for every bracket, sign and `else`.
const STACK: usize = 1 << 30;

/// How long the parser may take. It expands macros without a limit, and nothing ends it but the end of the program: what comes too late is
/// left alone.
const PATIENCE: Duration = Duration::from_secs(5);

/// Translates the function of this name, or the first that has one of [`NAMES`].
///
/// # Errors
/// What cannot be parsed or translated, with its place.
pub fn translate(text: &str, function: Option<&str>) -> Result<Functions, GlslError> {
    if text.len() > LONGEST {
        let message = format!("it has {} bytes, at most {LONGEST} are read", text.len());
        return Err(GlslError::new(message));
    }
    if let Some(at) = slice::too_deep(text, DEEPEST) {
        return Err(GlslError {
            place: Some(at..at + 1),
            ..GlslError::new(format!("this is nested more than {DEEPEST} deep"))
        });
    }
    let (done, result) = mpsc::channel();
    let (text, function) = (text.to_owned(), function.map(str::to_owned));
    let work = move || {
        // who has waited too long does not hear it
        let _ = done.send(translated(&text, function.as_deref()));
    };
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(work);
    if let Err(error) = thread {
        let message = format!("there is no room to parse it: {error}");
        return Err(GlslError::new(message));
    }
    result
        .recv_timeout(PATIENCE)
        .unwrap_or_else(|ended| match ended {
            mpsc::RecvTimeoutError::Timeout => Err(GlslError {
                help: Some("write out macros that name others more than once".to_owned()),
                ..GlslError::new(format!(
                    "it takes longer than {} s to parse, as macros do that grow with each other",
                    PATIENCE.as_secs()
                ))
            }),
            // the parser is not ours, and breaks down for some texts that are no GLSL
            mpsc::RecvTimeoutError::Disconnected => Err(GlslError::new(
                "the parser broke down: the shader is wrong in a way that it does not tell",
            )),
        })
}

fn translated(text: &str, function: Option<&str>) -> Result<Functions, GlslError> {
    let functions = slice::functions(text);
    let name = match function {
        Some(name) if functions.iter().any(|f| f == name) => name.to_owned(),
        Some(name) => {
            return Err(GlslError {
                help: Some(listed(&functions)),
                ..GlslError::new(format!("there is no function `{name}`"))
            });
        }
        None => match NAMES
            .into_iter()
            .find(|name| functions.iter().any(|f| f == name))
        {
            Some(name) => name.to_owned(),
            None => {
                return Err(GlslError {
                    help: Some(format!(
                        "name the function that gives the distance at a point with --function; {}",
                        listed(&functions)
                    )),
                    ..GlslError::new(format!(
                        "there is no function called {}",
                        NAMES[..8].join(", ")
                    ))
                });
            }
        },
    };
    let slice = slice::slice(text, &name);
    let (source, offset) = wrapped(&slice);
    let place = |span: Span| {
        let range = span.to_range()?;
        let start = range.start.checked_sub(offset)?.min(text.len());
        let end = range.end.saturating_sub(offset).clamp(start, text.len());
        Some(start..end)
    };
    let settled = |mut error: GlslError| {
        // what is behind the text is ours
        if error
            .span
            .and_then(|s| s.to_range())
            .is_some_and(|r| r.start >= offset + text.trim_end().len() && r.end > r.start)
        {
            error = of_parser_at_end();
            error.place = Some(text.len()..text.len());
        }
        error.place = error.place.or_else(|| error.span.and_then(place));
        error
    };
    let options = NagaOptions::from(ShaderStage::Fragment);
    let parsed = Frontend::default().parse(&options, &source);
    let module = parsed.map_err(|errors| settled(of_parser(errors.errors.first())))?;
    functions_of(&module, &name, &slice.uniforms).map_err(settled)
}

fn listed(functions: &[String]) -> String {
    match functions {
        [] => "the file has no functions".to_owned(),
        _ => {
            let shown: Vec<&str> = functions.iter().take(20).map(String::as_str).collect();
            format!(
                "there are {}{}",
                shown.join(", "),
                if functions.len() > 20 {
                    " and more"
                } else {
                    ""
                }
            )
        }
    }
}

/// A slice as a whole shader, and where it begins in that.
fn wrapped(slice: &slice::Slice) -> (String, usize) {
    let mut source = String::from("#version 450\n");
    for (name, ty) in INPUTS {
        if slice.mentions.contains(name) && !slice.uniforms.iter().any(|u| u == name) {
            source += &format!("{ty} {name};\n");
        }
    }
    let offset = source.len();
    source += &slice.text;
    source += "\nvoid main() {}\n";
    (source, offset)
}

/// What Shadertoy declares.
const INPUTS: [(&str, &str); 8] = [
    ("iTime", "float"),
    ("iGlobalTime", "float"),
    ("iTimeDelta", "float"),
    ("iFrameRate", "float"),
    ("iFrame", "int"),
    ("iResolution", "vec3"),
    ("iMouse", "vec4"),
    ("iDate", "vec4"),
];

fn of_parser_at_end() -> GlslError {
    GlslError {
        help: Some("a brace or a semicolon may be missing".to_owned()),
        ..GlslError::new("the file ends too early")
    }
}

fn of_parser(error: Option<&NagaError>) -> GlslError {
    let Some(error) = error else {
        return GlslError::new("this is no GLSL");
    };
    let (message, help) = match &error.kind {
        ErrorKind::UnknownVariable(name) if name.starts_with("iChannel") => (
            "textures are not translated".to_owned(),
            Some(
                "replace it by a function: noise(p), value_noise(p) and fbm(p) are there in scenes"
                    .to_owned(),
            ),
        ),
        ErrorKind::UnknownVariable(name) => (format!("`{name}` is not declared"), None),
        ErrorKind::UnknownType(name) => (format!("there is no type `{name}`"), None),
        ErrorKind::UnknownField(name) => (format!("there is no `{name}` in this"), None),
        ErrorKind::EndOfFile => return of_parser_at_end(),
        other => (other.to_string(), None),
    };
    GlslError {
        help,
        span: Some(error.meta),
        ..GlslError::new(message)
    }
}

/// Whether a function may be asked at a point alone.
fn takes_a_point(module: &Module, function: &Function) -> bool {
    let inner = |k: usize| &module.types[function.arguments[k].ty].inner;
    let is_point = |inner: &TypeInner| {
        matches!(
            inner,
            TypeInner::Vector {
                size: naga::VectorSize::Tri,
                ..
            }
        )
    };
    let first = match function.arguments.first().map(|_| inner(0)) {
        Some(TypeInner::Pointer { base, .. }) => is_point(&module.types[*base].inner),
        Some(inner) => is_point(inner),
        None => false,
    };
    first && (1..function.arguments.len()).all(|k| matches!(inner(k), TypeInner::Pointer { .. }))
}

fn functions_of(
    module: &Module,
    original: &str,
    uniforms: &[String],
) -> Result<Functions, GlslError> {
    let named: Vec<(Handle<Function>, &Function)> = module
        .functions
        .iter()
        .filter(|(_, f)| f.name.as_deref() == Some(original))
        .collect();
    let Some(&(handle, function)) = named.iter().find(|(_, f)| takes_a_point(module, f)) else {
        let span = named
            .first()
            .map_or(Span::UNDEFINED, |(h, _)| module.functions.get_span(*h));
        return Err(GlslError::unsupported(
            span,
            format!("`{original}` must take one point: a vec3"),
            "name another function with --function, or write one that calls it: float map(vec3 p) { ... }",
        ));
    };
    let gives = match function.result.as_ref().map(|r| &module.types[r.ty].inner) {
        Some(TypeInner::Scalar(s)) if s.kind == naga::ScalarKind::Float => Gives::Distance,
        Some(TypeInner::Vector { size, .. }) => Gives::Vector(*size as usize),
        Some(TypeInner::Struct { members, .. }) => {
            let is_number = |m: &naga::StructMember| matches!(module.types[m.ty].inner, TypeInner::Scalar(s) if s.kind == naga::ScalarKind::Float);
            match members.iter().position(is_number) {
                Some(k) => Gives::Item(k),
                None => {
                    return Err(GlslError::new(format!(
                        "`{original}` gives a structure without a number that could be the distance"
                    )));
                }
            }
        }
        _ => {
            return Err(GlslError::unsupported(
                module.functions.get_span(handle),
                format!(
                    "`{original}` must give a distance: float, or a vec2 of the distance and a material"
                ),
                "name another function with --function",
            ));
        }
    };
    let mut translator = Translator::new(module, uniforms);
    translator.find_ignored();
    // what is given back beside the result is not needed
    let times: Vec<Time> = (0..function.arguments.len())
        .map(|k| if k == 0 { Time::Formula } else { Time::Plain })
        .collect();
    let name = translator.function(handle, &times)?;
    let outs = function
        .arguments
        .iter()
        .filter(|a| translator.is_pointer(a.ty))
        .count();
    let mut text = String::new();
    for (name, value) in translator.constants.values() {
        text += &format!("{name} = {value}\n");
    }
    for (helper, definition) in expression::HELPERS {
        if translator.helpers.contains(helper) {
            text += &format!("\n{definition}");
        }
    }
    for function in &translator.functions {
        text += &format!("\n{function}");
    }
    let mut name = name;
    if outs > 0 {
        let more: Vec<String> = function
            .arguments
            .iter()
            .skip(1)
            .map(|a| translator.zero_of(a.ty))
            .collect();
        let own = translator.free_name("distance_at");
        let given: Vec<String> = std::iter::once("p".to_owned()).chain(more).collect();
        text += &format!(
            "\ndef {own}(p):\n    return {name}({})[0]\n",
            given.join(", ")
        );
        name = own;
    }
    Ok(Functions {
        text,
        name,
        original: original.to_owned(),
        gives,
        notes: translator.notes,
    })
}
