//! `zeroset bench`: how fast it is, as ratios of what was measured in one run.

mod eval;

use crate::args::{Bench, Measure};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::json;
use zeroset_field::program::{Limits, Program};
use zeroset_scene::load::{Language, Loaded, Options, load, load_text};

/// Three joined solids over a floor.
const SCENE: &str = r#"
joined = smooth_union([sphere(0.8), box(1.0).move(x = 0.9), box((0.4, 1.8, 0.4)).round(0.1).move(x = -0.7)], 0.2)
show(joined | plane().move(y = -0.9))
"#;

/// Measures.
pub(crate) fn run(args: &Bench, console: &Console) -> Result<(), Failure> {
    match &args.measure {
        Measure::Eval(what) => {
            let scene = loaded(what.scene.as_deref())?.scene;
            let invalid = |error: String| Failure::new(Exit::Scene, error);
            let field = scene.field().map_err(|error| invalid(error.to_string()))?;
            let field = field.ok_or_else(|| invalid("the scene shows nothing".to_owned()))?;
            let program = Program::compile(&field, &Limits::default())
                .map_err(|error| invalid(error.to_string()))?;
            let found = eval::eval(&program);
            if what.json {
                return console.print(&json::line(&found)?);
            }
            console.print(&format!(
                "{}, {} instructions, one thread\n\
                 a point in a batch      {:8.2} ns\n\
                 a gradient in a batch   {:8.2} ns\n\
                 a point alone           {:8.2} ns, {:.1} times a point in a batch",
                found.level,
                found.instructions,
                found.ns_per_point,
                found.ns_per_gradient,
                found.ns_per_point_scalar,
                found.simd_over_scalar,
            ))
        }
    }
}

/// The scene that was named, or the one above.
fn loaded(scene: Option<&std::path::Path>) -> Result<Loaded, Failure> {
    let options = Options::default();
    Ok(match scene {
        Some(path) => load(path, &options)?,
        None => load_text("bench.star", SCENE, Language::Starlark, None, &options)?,
    })
}
