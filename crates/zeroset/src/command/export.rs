//! `zeroset export`.

use crate::args::ExportArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_text;
use zeroset_language::load::{Control, Loaded, Options, Parameter, Setting};
use zeroset_language::report::Report;
use zeroset_output::atomic::probe;
use zeroset_output::display;
use zeroset_shader::export::{ExportError, Held, Input, glsl_moving, wgsl};

/// Prints a scene as one file of shader text.
pub(crate) fn run(args: &ExportArgs, console: &Console) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let options = crate::scene::options(&args.scene, args.size.map(|s| s.0))?;
    let mut document = crate::scene::document(&args.scene, &options)?;
    let loaded = crate::scene::evaluated(&args.scene, &mut document, &options, console)?;
    let text = if args.language.glsl {
        let inputs = inputs(&loaded, &options);
        let mut scene_at = |values: &[f64]| {
            let mut options = options.clone();
            for (input, value) in inputs.iter().zip(values) {
                match input.range {
                    None => options.time = *value,
                    Some(_) => {
                        options.set.insert(input.name.clone(), value.to_string());
                    }
                }
            }
            document.scene(&options).ok().map(|loaded| loaded.scene)
        };
        let exported = glsl_moving(&loaded.scene, &inputs, &still(&loaded), &mut scene_at)?;
        for held in &exported.held {
            let text = format!("the GLSL does not have {}: {}", held.name, held.why);
            console.warn(&Report::new(text).as_warning());
        }
        exported.text
    } else {
        if loaded.animated {
            let text = format!(
                "the scene asks for time(), and the WGSL holds it as it is at {} seconds: the shader does not move",
                options.time
            );
            let help = "choose the moment with --time, or take --glsl, which moves";
            console.warn(&Report::new(text).with_help(help).as_warning());
        }
        wgsl(&loaded.scene)?
    };
    // comments repeat names of the scene
    let text = display::clean(&text);
    match &args.output {
        None => console.emit(&text),
        Some(path) => write_text(path, &text),
    }
}

/// What changes the scene and can be changed in the shader.
fn inputs(loaded: &Loaded, options: &Options) -> Vec<Input> {
    let time = loaded.animated.then(|| Input {
        name: "time()".to_owned(),
        value: options.time,
        range: None,
    });
    let sliders = loaded
        .parameters
        .iter()
        .filter_map(|p| match (&p.control, &p.value) {
            (Control::Slider { min, max }, Setting::Number(value)) => Some(Input {
                name: p.name.clone(),
                value: *value,
                range: Some([*min, *max]),
            }),
            _ => None,
        });
    time.into_iter().chain(sliders).collect()
}

/// What else changes the scene, and stays as it is.
fn still(loaded: &Loaded) -> Vec<Held> {
    let of = |p: &Parameter| {
        let what = match p.control {
            Control::Slider { .. } => return None,
            Control::Choice { .. } => "a choice",
            Control::Toggle => "a toggle",
            Control::Colour => "a colour",
        };
        let why = format!("{what} stays as it is set");
        Some(Held {
            name: p.name.clone(),
            why,
        })
    };
    let blur = (loaded.animated && loaded.shutter.seconds > 0.0).then(|| Held {
        name: "motion blur".to_owned(),
        why: "its pictures are of single moments".to_owned(),
    });
    loaded
        .parameters
        .iter()
        .filter_map(of)
        .chain(blur)
        .collect()
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Scene(error) => error.into(),
            ExportError::Large { .. } => Failure::with_help(
                Exit::Scene,
                error.to_string(),
                "export a part of the scene, or render it with `zeroset render`, which has no such limit",
            ),
            ExportError::Translation(_) => Failure::new(Exit::Job, error.to_string()),
        }
    }
}
