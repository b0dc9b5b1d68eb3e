//! `zeroset view`.

use crate::args::View;
use crate::console::plain_report;
use crate::failure::{Exit, Failure};
use zeroset_viewer::engine::Backend;
use zeroset_viewer::{Open, open};

/// Opens the window, and returns when it is closed.
pub(crate) fn run(args: &View) -> Result<(), Failure> {
    crate::scene::present(&args.scene)?;
    let options = crate::scene::options(&args.scene, None)?;
    let threads = args.threads.map(usize::from);
    let window = Open {
        scene: args.scene.scene.clone(),
        options,
        backend: Box::new(move || Backend::cpu(threads)),
        explain: |failed| plain_report(failed.report.as_ref()),
    };
    open(window).map_err(|error| Failure::with_help(Exit::Job, error.to_string(), error.advice()))
}
