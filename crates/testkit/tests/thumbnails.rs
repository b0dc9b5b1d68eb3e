//! The small pictures of `docs/fields.md`: every shape, join and change of the catalogue, the patterns, and those methods that can be seen.
//!
//! `ZEROSET_BLESS=1 cargo test --workspace --test thumbnails` makes them anew. Look at them first.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use zeroset::catalogue::Dimension;
use zeroset::catalogue::entries::catalogue;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::output::compare::compare;
use zeroset::output::format::Metadata;
use zeroset::output::format::png::Depth;
use zeroset::output::format::read::read;
use zeroset::output::picture::Picture;
use zeroset::output::view::{PlaneView, needed};
use zeroset::scene::film::Plane;
use zeroset::scene::methods::GROUPS;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::trace::CpuRenderer;

/// Side of the pictures.
const SIDE: u32 = 96;
/// FLIP's mean error that a picture may have.
const ALLOWED: f64 = 0.02;

const PAINT: &str = "material(\"#c8703a\")";

/// Shapes that their defaults do not show, as a reader would write them.
const SHAPES: &[(&str, &str)] = &[
    ("plane", "plane() & cylinder(1, 1)"),
    ("slab", "slab() & cylinder(1, 3)"),
    ("infinite_cylinder", "infinite_cylinder(0.5) & box(2)"),
    ("infinite_cone", "infinite_cone() & box(2).move(y = -1)"),
    ("quadric", "quadric() & box(2.4)"),
    ("gyroid", "gyroid() & box(2)"),
    ("schwarz_p", "schwarz_p() & box(2)"),
    ("schwarz_d", "schwarz_d() & box(2)"),
    ("neovius", "neovius() & box(2)"),
    ("iwp", "iwp() & box(2)"),
    ("apollonian", "apollonian() & sphere(1)"),
    ("parabola", "(parabola() & rectangle((2, 2))).extrude(0.3)"),
];

/// What modifiers and maps are shown on, and with what.
const CHANGES: &[(&str, &str)] = &[
    (
        "complement",
        "box(1.6) - sphere(1).complement().complement()",
    ),
    ("offset", "box_frame((1.2, 1.2, 1.2)).offset(0.12)"),
    ("round", "box(1).round(0.3)"),
    ("onion", "sphere(1).onion(0.12) & box(2).move(z = -1)"),
    ("extrude", "star().extrude(0.5)"),
    ("displace", "sphere(1).displace(0.08, frequency = 1.5)"),
    ("displace_value", "sphere(1).displace_value(0.3)"),
    ("displace_gradient", "sphere(1).displace_gradient(0.2)"),
    ("displace_cellular", "sphere(1).displace_cellular(0.3)"),
    (
        "symmetry",
        "capsule(0.25, 1).turn(z = 40).move(x = 0.6).symmetry((1, 0, 0))",
    ),
    (
        "mirror",
        "cone().turn(z = 30).move(x = 0.7).mirror((1, 0, 0))",
    ),
    ("elongate", "torus(0.6, 0.2).elongate((1, 0, 0))"),
    ("stretch", "sphere(0.7).stretch((1.6, 1, 0.6))"),
    ("shear", "box((1, 1.6, 1)).shear(0.5)"),
    ("twist", "box((0.8, 2.2, 0.8)).twist(50)"),
    ("taper", "box((1.2, 2, 1.2)).taper(2, 0.3)"),
    ("bend", "box((2.4, 0.4, 0.8)).bend(90)"),
    ("wrap", "box((2.4, 0.5, 0.3)).wrap(1)"),
    ("revolve", "ring().move(x = 0.9).revolve()"),
    (
        "slice",
        "torus(0.8, 0.3).turn(x = 90).slice(0).extrude(0.3)",
    ),
];

/// Patterns, on a ball.
const PATTERNS: &[(&str, &str)] = &[
    ("checker", "checker(size = 0.5)"),
    ("stripes", "stripes(size = 0.4)"),
    ("noise", "noise(size = 0.8)"),
    ("gradient", "gradient(\"#c8703a\", \"#f2e8cf\")"),
];

/// What shows methods of a kind: the scene to which the method is added.
fn stage_of(group: &str) -> Option<&'static str> {
    const LIT: &str = "show(plane().move(y = -0.8), material(\"#d8d4cc\"))\nshow(sphere(0.8).move(x = -0.6), material(\"#c8703a\"))\n\
        show(box(0.9).move(0.9, -0.35, 0.3), material(\"#5a8f7b\"))\ncamera(eye = (1.6, 1.6, 4.4), target = (0.1, -0.15, 0), fov = 36)\n\
        sun(direction = (-0.7, -1, -0.5))\nsky(ambient = 0.5)\n";
    // nothing that would be met in closed form
    const MARCHED: &str = "show(torus(0.9, 0.35).turn(x = 50).twist(40))\n";
    const GLASS: &str = "show(plane().move(y = -0.8), checker(size = 0.6))\n\
        show(sphere(0.75).move(-0.8, -0.05, 0), material(\"#ffffff\", transmission = 1, ior = 1.5, roughness = 0))\n\
        show(sphere(0.75).move(0.8, -0.05, 0), material(\"#e8c070\", metallic = 1, roughness = 0.05))\n\
        camera(eye = (0.6, 1.2, 4.8), target = (0, -0.1, 0), fov = 36)\nsun(direction = (-0.7, -1, -0.5))\n";
    match group {
        "march" => Some(MARCHED),
        "normals" | "shadow" | "ao" | "shading" | "tone" | "view" => Some(LIT),
        "integrator" => Some(GLASS),
        _ => None,
    }
}

/// Every picture: its file, and its scene.
fn all() -> Vec<(String, String)> {
    let catalogue = catalogue();
    let mut all = Vec::new();
    let show = |shape: &str| format!("show({shape}, {PAINT})\n");
    let known = |table: &[(&str, &str)], name: &str| {
        let found = table.iter().find(|(entry, _)| *entry == name);
        found.map(|(_, shape)| (*shape).to_owned())
    };
    for entry in &catalogue.primitives {
        let name = entry.info.name;
        let flat = entry.info.dimension == Dimension::Two;
        let shape = known(SHAPES, name).unwrap_or_else(|| match flat {
            true => format!("{name}().extrude(0.3)"),
            false => format!("{name}()"),
        });
        all.push((name.to_owned(), show(&shape)));
    }
    for entry in &catalogue.joins {
        let name = entry.info.name;
        let parts = "[box(1.3), cylinder(0.55, 2).turn(x = 90).move(0.35, 0.35, 0)]";
        all.push((name.to_owned(), show(&format!("{name}({parts})"))));
    }
    let changes =
        (catalogue.modifiers.iter().map(|e| &e.info)).chain(catalogue.maps.iter().map(|e| &e.info));
    for info in changes {
        let shape = known(CHANGES, info.name)
            .unwrap_or_else(|| panic!("{} has no picture: write its scene", info.name));
        all.push((info.name.to_owned(), show(&shape)));
    }
    for (name, pattern) in PATTERNS {
        all.push((
            (*name).to_owned(),
            format!("show(sphere(1), material({pattern}))\n"),
        ));
    }
    all.push((
        "orbit".to_owned(),
        "show(mandelbulb(), material(orbit()))\n".to_owned(),
    ));
    for group in &GROUPS {
        let Some(stage) = stage_of(group.key) else {
            continue;
        };
        for method in group.methods {
            let value = match group.is_called() {
                true => format!("{}()", method.word),
                false => format!("\"{}\"", method.name),
            };
            let view = match group.key {
                "march" => Some("steps"),
                "normals" => Some("normal"),
                "ao" => Some("occlusion"),
                "shadow" => Some("shadow"),
                _ => None,
            };
            // the name of a view is an option of its own
            let settings = match (group.key, view) {
                ("view", _) => String::new(),
                ("shadow", _) => format!("sun(direction = (-0.7, -1, -0.5), shadow = {value})\n"),
                (key, _) => format!("render({key} = {value})\n"),
            };
            let view = if group.key == "view" {
                Some(method.name)
            } else {
                view
            };
            let note = view.map_or(String::new(), |view| format!("# view {view}\n"));
            // the shadow is one of the light's
            let stage = match group.key {
                "shadow" => stage.replace("sun(direction = (-0.7, -1, -0.5))\n", ""),
                _ => stage.to_owned(),
            };
            all.push((
                format!("{}_{}", group.key, method.name),
                format!("{note}{stage}{settings}"),
            ));
        }
    }
    all
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/fields")
}

fn picture(name: &str, text: &str) -> Result<Picture, String> {
    let options = Options {
        size: Some([SIDE, SIDE]),
        ..Options::default()
    };
    let scene = load_text("thumbnail.star", text, Language::Starlark, None, &options)
        .map_err(|e| format!("{name}: {}\n{text}", e.report))?
        .scene;
    let view = text
        .strip_prefix("# view ")
        .and_then(|rest| rest.lines().next());
    let plane = Plane::ALL
        .into_iter()
        .find(|plane| Some(plane.name()) == view);
    let plane = plane.unwrap_or(Plane::Colour);
    let film = CpuRenderer::new(None)
        .unwrap()
        .render_planes(&scene, needed(plane), &Silent)
        .unwrap()
        .film;
    let transform = scene.settings().view_transform();
    let view = PlaneView {
        plane,
        transform,
        legend: false,
        objects: &[],
    };
    Ok(view.of(&film))
}

#[test]
fn every_entry_has_the_picture_that_it_makes() {
    let blessed = std::env::var_os("ZEROSET_BLESS").is_some();
    let mut failures = Vec::new();
    let mut files = BTreeSet::new();
    for (name, text) in all() {
        let path = folder().join(format!("{name}.png"));
        files.insert(format!("{name}.png"));
        let picture = match picture(&name, &text) {
            Ok(picture) => picture,
            Err(e) => {
                failures.push(e);
                continue;
            }
        };
        if blessed {
            zeroset::output::atomic::create_folder(&folder()).unwrap();
            zeroset::output::atomic::write_atomically(&path, |writer| {
                let about = Metadata::new(&name);
                zeroset::output::format::png::write(writer, &picture, Depth::Eight, &about)
            })
            .unwrap();
        }
        match read(&path)
            .map_err(|e| e.to_string())
            .and_then(|kept| compare(&kept, &picture).map_err(|e| e.to_string()))
        {
            Ok(found) if found.flip_mean <= ALLOWED => {}
            Ok(found) => failures.push(format!("{name}: FLIP {:.4}", found.flip_mean)),
            Err(e) => failures.push(format!("{name}: {e}")),
        }
    }
    // and no picture of what is no more
    let there = std::fs::read_dir(folder()).unwrap();
    let there = there.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    failures.extend(
        there
            .filter(|file| !files.contains(file))
            .map(|file| format!("docs/fields/{file} is of nothing")),
    );
    assert!(
        failures.is_empty(),
        "{}\nlook at the new pictures after: ZEROSET_BLESS=1 cargo test --workspace --test thumbnails",
        failures.join("\n")
    );
}
