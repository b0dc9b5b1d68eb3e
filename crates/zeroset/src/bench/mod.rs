//! `zeroset bench`: how fast it is, as ratios of what was measured in one run.

mod cells;
mod eval;
mod frame;
#[cfg(feature = "gpu")]
mod gpu;
mod march;
mod volumes;

use crate::args::{BenchArgs, Measure};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::json;
use zeroset_field::program::{Limits, Program};
use zeroset_language::load::{Language, Options, load, load_text};
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;
use zeroset_trace as trace;

/// Three joined solids over a floor.
const SCENE: &str = r#"
joined = smooth_union([sphere(0.8), box(1.0).move(x = 0.9), box((0.4, 1.8, 0.4)).round(0.1).move(x = -0.7)], 0.2)
show(joined | plane().move(y = -0.9))
"#;

/// Measures.
pub(crate) fn run(args: &BenchArgs, console: &Console) -> Result<(), Failure> {
    match &args.measure {
        Measure::Eval(what) => {
            let scene = match &what.scene {
                Some(path) => loaded(path)?,
                None => {
                    load_text(
                        "bench.star",
                        SCENE,
                        Language::Starlark,
                        None,
                        &Options::default(),
                    )?
                    .scene
                }
            };
            let invalid = |error: String| Failure::new(Exit::Scene, error);
            let field = scene.field().map_err(|error| invalid(error.to_string()))?;
            let field = field.ok_or_else(|| invalid("the scene shows nothing".to_owned()))?;
            let program = Program::compile(&field, &Limits::default())
                .map_err(|error| invalid(error.to_string()))?;
            let found = eval::eval(&program);
            if what.json {
                return console.emit(&json::line(&found)?);
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
        Measure::Cells(what) => {
            let scene = match &what.scene {
                Some(path) => loaded(path)?,
                None => trace::bench::molecule(),
            };
            let found = cells::cells(&scene).map_err(failed)?;
            console.emit(&if what.json {
                json::line(&found)?
            } else {
                found.text()
            })
        }
        Measure::Volumes(what) => {
            let found = volumes::volumes().map_err(|error| Failure::new(Exit::Job, error))?;
            console.emit(&if what.json {
                json::line(&found)?
            } else {
                found.text()
            })
        }
        Measure::March(what) => {
            let scene = match &what.scene {
                Some(path) => loaded(path)?,
                None => trace::bench::city(),
            };
            let found = march::march(&scene).map_err(failed)?;
            if what.json {
                return console.emit(&json::line(&found)?);
            }
            let row = |(name, evaluations): (&String, &f64)| {
                let share = found.share_of_sphere[name];
                format!("{name:16} {evaluations:8.2} evaluations a ray, {share:5.2} of sphere")
            };
            let rows: Vec<String> = found.evaluations_per_ray.iter().map(row).collect();
            console.print(&rows.join("\n"))
        }
        Measure::Frame(what) => {
            let scene = match &what.scene {
                Some(path) => loaded(path)?,
                None => trace::bench::frame(),
            };
            #[cfg(feature = "gpu")]
            if let Some(renderer) = crate::backend::gpu(what.backend, what.adapter.as_deref())? {
                let found = gpu::frame(&scene, usize::from(what.threads), &renderer);
                let found = found.map_err(failed)?;
                return console.emit(&if what.json {
                    json::line(&found)?
                } else {
                    found.text()
                });
            }
            #[cfg(not(feature = "gpu"))]
            crate::backend::refused(what.backend, what.adapter.as_deref())?;
            let found = frame::frame(&scene, usize::from(what.threads)).map_err(failed)?;
            if what.json {
                return console.emit(&json::line(&found)?);
            }
            let e = found.evaluations_per_pixel;
            console.print(&format!(
                "{}x{}, {} threads\n\
                 {:.1} frames a second, {:.2} ms a frame\n\
                 evaluations a pixel: {:.1} (prepass {:.1}, march {:.1}, normal {:.1}, occlusion {:.1}, shadow {:.1}, \
                 material {:.1})",
                found.size[0],
                found.size[1],
                found.threads,
                found.frames_per_second,
                found.milliseconds,
                e.total,
                e.prepass,
                e.march,
                e.normal,
                e.occlusion,
                e.shadow,
                e.material,
            ))
        }
    }
}

fn failed(error: RenderError) -> Failure {
    Failure::new(Exit::Job, error.to_string())
}

/// The scene that was named.
fn loaded(path: &std::path::Path) -> Result<Scene, Failure> {
    Ok(load(path, &Options::default())?.scene)
}
