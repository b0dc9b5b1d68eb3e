//! Whole pictures by the stream renderer and by the plain one, the same algorithms, equal threads, in turn:
//! `cargo run --release -p zeroset-testkit --example against_plain [SCENE [THREADS]]`.

use std::time::Instant;
use zeroset::language::load::{Options, load};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::render::Silent;
use zeroset::trace::{CpuRenderer, bench};
use zeroset_testkit::plain::{self, Compiled, Quality};

/// Streamed pictures per plain one.
const STREAMED: usize = 25;
/// Plain pictures.
const PLAIN: usize = 3;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let scene = match arguments.next() {
        Some(path) => {
            let loaded = load(path.as_ref(), &Options::default());
            loaded.unwrap_or_else(|e| panic!("{e}")).scene
        }
        None => bench::frame(),
    };
    let threads = arguments
        .next()
        .map_or(2, |n| n.parse().expect("a number of threads"));
    let renderer = CpuRenderer::new(Some(threads)).expect("threads");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let program = picture.program();
    let [width, height] = scene.settings().size;
    let mut film = Film::new(0, 0);
    let (mut streamed, mut plainly, mut reference) = (f64::MAX, f64::MAX, None);
    for _ in 0..PLAIN {
        for _ in 0..STREAMED {
            let start = Instant::now();
            film = picture
                .render_part([width, height], &[Plane::Colour], &Silent)
                .1;
            streamed = streamed.min(start.elapsed().as_secs_f64());
        }
        let start = Instant::now();
        let quality = Quality::of(program, &scene);
        let made = || Compiled::new(program, None);
        reference = Some(pool.install(|| plain::render(&scene, &quality, made)));
        plainly = plainly.min(start.elapsed().as_secs_f64());
    }
    let likeness = reference.map_or(f64::NAN, |r| {
        psnr(r.plane(Plane::Colour), film.plane(Plane::Colour))
    });
    println!(
        "{width}x{height}, {threads} threads: {:.1} frames a second, {:.1} times the plain renderer ({:.1} ms a frame), \
         {likeness:.1} dB to its picture",
        1.0 / streamed,
        plainly / streamed,
        1e3 * plainly,
    );
}

/// How alike two planes are, with values limited to what a screen shows: 10 log10(1 / mean square), dB.
fn psnr(a: &[f32], b: &[f32]) -> f64 {
    let shown = |x: f32| f64::from(x.clamp(0.0, 1.0)).powf(1.0 / 2.2);
    let square = |(a, b): (&f32, &f32)| (shown(*a) - shown(*b)).powi(2);
    let mean = a.iter().zip(b).map(square).sum::<f64>() / a.len().max(1) as f64;
    -10.0 * mean.max(1e-12).log10()
}
