//! From a slider to the picture: what a tick costs in a scene with an image of 2048x2048 pixels.
//! `cargo run --release -p zeroset-testkit --example slider`.

use std::sync::Arc;
use std::time::Instant;
use zeroset::language::assets::Assets;
use zeroset::language::document::Document;
use zeroset::language::limits::Limits;
use zeroset::language::load::Options;
use zeroset::scene::accumulator::Accumulator;
use zeroset::scene::film::Plane;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::settings::Antialias;
use zeroset::trace::CpuRenderer;

const SIDE: u32 = 2048;
const TICKS: u32 = 20;

const SCENE: &str = "r = slider(\"r\", 0.8, min = 0.5, max = 1)\n\
                     show(box(1).round(0.1) - sphere(r), material(color = triplanar(\"image.png\")))\n";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let file = std::fs::File::create(folder.path().join("image.png"))?;
    let mut encoder = png::Encoder::new(file, SIDE, SIDE);
    encoder.set_color(png::ColorType::Rgb);
    let pixel = |i: u32| [(i / SIDE) >> 3, (i % SIDE) >> 3, (i * 7) >> 9].map(|c| c as u8);
    let pixels: Vec<u8> = (0..SIDE * SIDE).flat_map(pixel).collect();
    encoder.write_header()?.write_image_data(&pixels)?;
    let path = folder.path().join("scene.star");
    std::fs::write(&path, SCENE)?;

    let start = Instant::now();
    let mut document = Document::open(&path, &Limits::default(), &Assets::default())?;
    let mut options = Options::default();
    let first = Arc::new(document.scene(&options)?.scene);
    println!("first load       {:8.1} ms", milliseconds(start));
    let start = Instant::now();
    let mut prepared = CpuRenderer::new(None)?.prepare(first)?;
    println!("first preparing  {:8.1} ms", milliseconds(start));

    let (mut load, mut update, mut picture) = (f64::MAX, f64::MAX, f64::MAX);
    for tick in 0..TICKS {
        let radius = 0.5 + 0.02 * f64::from(tick);
        options.set.insert("r".into(), radius.to_string());
        let start = Instant::now();
        let scene = Arc::new(document.scene(&options)?.scene);
        load = load.min(milliseconds(start));
        let start = Instant::now();
        prepared.update(scene.clone())?;
        update = update.min(milliseconds(start));
        let start = Instant::now();
        let mut sums = Accumulator::new([160, 120], Antialias::None, &[Plane::Colour]);
        prepared.sample(scene.camera(), 0..1, &mut sums, &Silent)?;
        picture = picture.min(milliseconds(start));
    }
    println!("a tick: scene    {load:8.3} ms (fastest of {TICKS})");
    println!("        update   {update:8.3} ms");
    println!("        160x120  {picture:8.3} ms");
    Ok(())
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
