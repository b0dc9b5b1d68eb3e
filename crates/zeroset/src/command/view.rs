//! `zeroset view`.

use crate::args::ViewArgs;
use crate::console::plain_report;
use crate::failure::{Exit, Failure};
use std::sync::Arc;
use zeroset_scene::render::Renderer;
use zeroset_viewer::engine::{MakeRenderer, cpu};
use zeroset_viewer::{Open, open};

/// Opens the window, and returns when it is closed. Ctrl-C ends the process: what the window saves is whole or not there,
/// whenever it ends.
pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    crate::scene::present(&args.scene)?;
    let options = crate::scene::options(&args.scene, None)?;
    let window = Open {
        scene: args.scene.scene.clone(),
        options,
        renderer: renderer(args)?,
        explain: |failed| plain_report(failed.report.as_ref()),
        assets: crate::cache::assets(),
    };
    open(window).map_err(|error| Failure::with_help(Exit::Job, error.to_string(), error.advice()))
}

/// What renders. A GPU that is asked for must be there before the window opens; one that may be there is looked for while
/// it opens.
fn renderer(args: &ViewArgs) -> Result<MakeRenderer, Failure> {
    use crate::backend::{Backend, gpu};
    let threads = args.threads.map(usize::from);
    if args.backend == Backend::Auto && args.adapter.is_none() {
        return Ok(Box::new(move || match gpu(Backend::Auto, None) {
            Ok(Some(renderer)) => Ok(Arc::new(renderer) as Arc<dyn Renderer>),
            _ => cpu(threads),
        }));
    }
    let renderer = gpu(args.backend, args.adapter.as_deref())?;
    Ok(Box::new(move || match renderer {
        Some(renderer) => Ok(Arc::new(renderer) as Arc<dyn Renderer>),
        None => cpu(threads),
    }))
}
