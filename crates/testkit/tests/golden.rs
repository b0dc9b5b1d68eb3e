//! Every scene of `scenes/` renders, and looks as it did when somebody last judged it by eye.
//!
//! A picture that differs is written to the target folder beside its difference, and the message says how to bless it:
//! `ZEROSET_BLESS=1 cargo test -p zeroset-testkit --test golden`. Look at it first.

use std::path::{Path, PathBuf};
use zeroset::language::load::{Options, load};
use zeroset::output::compare::compare;
use zeroset::output::format::Metadata;
use zeroset::output::format::png::Depth;
use zeroset::output::format::read::read;
use zeroset::output::picture::Picture;
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::settings::{Antialias, ViewTransform};
use zeroset::trace::CpuRenderer;
use zeroset_testkit::scenes;

/// Side of the pictures.
const SIDE: u32 = 96;
/// FLIP's mean error that a picture may have: rounding moves a hit here and there, a wrong method moves everything.
const ALLOWED: f64 = 0.01;

fn golden(file: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/golden")
        .join(file)
}

fn render(path: &Path) -> Film {
    let options = Options {
        size: Some([SIDE, SIDE]),
        ..Options::default()
    };
    let mut scene = load(path, &options)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
        .scene;
    scene
        .edit(|s| s.settings.antialias = Antialias::None)
        .expect("a scene");
    CpuRenderer::new(None)
        .unwrap()
        .render(&scene, &Silent)
        .unwrap()
        .film
}

fn save(path: &Path, picture: &Picture) {
    zeroset::output::atomic::create_folder(path.parent().unwrap()).unwrap();
    zeroset::output::atomic::write_atomically(path, |writer| {
        zeroset::output::format::png::write(writer, picture, Depth::Eight, &Metadata::new("golden"))
    })
    .unwrap();
}

/// Holds the picture of a scene against the one that was judged; the message if it differs.
fn check(path: &Path, group: &str, film: &Film) -> Result<(), String> {
    let file = Path::new(group).join(path.with_extension("png").file_name().unwrap());
    let golden = golden(&file);
    let name = file.display();
    let picture = Picture::develop(film, ViewTransform::standard(0.0));
    if std::env::var_os("ZEROSET_BLESS").is_some() {
        save(&golden, &picture);
    }
    let kept = read(&golden).map_err(|e| format!("{name}: {e}"))?;
    let found = compare(&kept, &picture).map_err(|e| format!("{name}: {e}"))?;
    if found.flip_mean <= ALLOWED {
        return Ok(());
    }
    let new = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("golden")
        .join(&file);
    save(&new, &picture);
    Err(format!(
        "{name}: FLIP {:.4}, allowed {ALLOWED}; the new picture is {}",
        found.flip_mean,
        new.display()
    ))
}

fn all(group: &str) {
    let failures: Vec<String> = (scenes::of(group).iter())
        .filter_map(|path| check(path, group, &render(path)).err())
        .collect();
    assert!(
        failures.is_empty(),
        "{}\nlook at the new pictures, then: ZEROSET_BLESS=1 cargo test -p zeroset-testkit --test golden",
        failures.join("\n")
    );
}

#[test]
fn the_papers_scenes_look_as_judged() {
    all("papers");
}

#[test]
fn the_first_scene_looks_as_judged() {
    all("");
}

#[test]
fn every_scene_of_the_gallery_renders_something() {
    for path in scenes::of("gallery") {
        let film = render(&path);
        let hit = film
            .plane(Plane::Coverage)
            .iter()
            .filter(|c| **c > 0.5)
            .count();
        let share = hit as f64 / f64::from(SIDE * SIDE);
        assert!(
            share > 0.1,
            "{}: only {share} of the picture is covered",
            path.display()
        );
        let colours = film.plane(Plane::Colour);
        assert!(
            colours.iter().all(|c| c.is_finite() && *c >= 0.0),
            "{}: a colour is no number",
            path.display()
        );
    }
}

/// The comparison can fail: a picture with another sun is not the golden one.
#[test]
fn a_wrong_light_is_noticed() {
    let path = scenes::folder().join("papers/tomczak_sphere_ground_1.star");
    let options = Options {
        size: Some([SIDE, SIDE]),
        ..Options::default()
    };
    let mut scene = load(&path, &options).unwrap().scene;
    scene
        .edit(|s| {
            s.settings.antialias = Antialias::None;
            s.lights[0].radiance *= 0.9;
        })
        .expect("a scene");
    let film = CpuRenderer::new(None)
        .unwrap()
        .render(&scene, &Silent)
        .unwrap()
        .film;
    let kept = read(&golden("papers/tomczak_sphere_ground_1.png")).unwrap();
    let found = compare(
        &kept,
        &Picture::develop(&film, ViewTransform::standard(0.0)),
    )
    .unwrap();
    assert!(found.flip_mean > ALLOWED, "FLIP {}", found.flip_mean);
}
