//! How close antialiasing comes to 256 rays a pixel where a pixel holds a silhouette, and what it takes, beside one ray a pixel:
//! `cargo run --release -p zeroset-trace --example edges [SCENE]...`.

use std::path::PathBuf;
use zeroset_language::load::{Options, load};
use zeroset_scene::settings::{Antialias, Filter};
use zeroset_testkit::scenes;
use zeroset_trace::CpuRenderer;

#[path = "../tests/render/edges.rs"]
mod edges;
use edges::Edges;

/// Width of the pictures, pixels.
const WIDTH: u32 = 96;

fn main() {
    let mut paths: Vec<PathBuf> = std::env::args_os().skip(1).map(Into::into).collect();
    if paths.is_empty() {
        paths = scenes::of("papers");
    }
    let renderer = CpuRenderer::new(None).expect("threads");
    println!(
        "| scene, {WIDTH} pixels wide | edges | none | coverage | closer | 4 rays | time | evaluations |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for path in paths {
        let scene = load(&path, &Options::default())
            .unwrap_or_else(|e| panic!("{e}"))
            .scene;
        let edges = Edges::of(&renderer, &scene, WIDTH);
        let measure = |aa: Antialias| edges.measure(&renderer, &scene, aa);
        let coverage = Antialias::Coverage { layers: 4 };
        let filter = Filter::Box;
        let (none, parts) = (measure(Antialias::None), measure(coverage));
        let four = measure(Antialias::Supersample { samples: 4, filter });
        println!(
            "| {} | {:.1} % | {:.4} | {:.4} | {:.1} | {:.4} | {:.2} | {:.2} |",
            path.file_stem().unwrap_or_default().display(),
            100.0 * edges.share(),
            none.error,
            parts.error,
            none.error / parts.error,
            four.error,
            parts.seconds / none.seconds,
            parts.evaluations / none.evaluations,
        );
    }
}
