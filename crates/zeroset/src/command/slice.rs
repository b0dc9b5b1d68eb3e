//! `zeroset slice`.

use crate::args::SliceArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::{default_name, only_png, write_watched};
use zeroset::section::SectionPlane;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::program::{Limits, Program};
use zeroset_output::atomic::probe;
use zeroset_output::display;
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{self, Depth};
use zeroset_scene::film;
use zeroset_scene::scene::Scene;

/// Air around the bounds, as a share of their larger side.
const AIR: f64 = 0.15;
/// Half side of what is seen where nothing is bounded, scene units.
const UNBOUNDED: f64 = 2.0;

/// Draws a section.
pub(crate) fn run(args: &SliceArgs, console: &Console) -> Result<(), Failure> {
    let mut options = crate::scene::options(&args.scene, Some(args.size.0))?;
    // the solid, not the floor that a picture of it would have
    options.bare = true;
    let scene = crate::scene::loaded(&args.scene, &options, console)?.scene;
    let path = match &args.output {
        Some(path) => path.clone(),
        None => default_name(&args.scene.scene, "-slice.png")?,
    };
    only_png(&path, "sections")?;
    let invalid = |error: String| Failure::new(Exit::Scene, error);
    // a value and a slope a pixel, the picture, and the picture with a legend beside it
    let planes = [film::Plane::Residual, film::Plane::Steps];
    (options.limits)
        .check_picture(args.size.0, &planes, 24)
        .map_err(|error| invalid(error.to_string()))?;
    probe(&path)?;
    let Some(field) = scene.field().map_err(|error| invalid(error.to_string()))? else {
        return Err(invalid(
            "the scene shows nothing that could be cut".to_owned(),
        ));
    };
    let program =
        Program::compile(&field, &Limits::default()).map_err(|error| invalid(error.to_string()))?;
    let plane = plane(args, &scene);
    let picture = plane.sample(&program, args.size.0).picture(!args.no_legend);
    let notes = Metadata::new(scene.name()).with("Section", args.plane.to_string());
    write_watched(&path, console, &|| false, |writer, observer| {
        png::write_watched(writer, &picture, Depth::Eight, &notes, observer)
    })?;
    let [width, height] = args.size.0.map(|n| f64::from(n) * plane.pixel);
    let shown = crate::reference::shortest;
    console.note(format_args!(
        "{}: {} of {}, {} x {}",
        path.display(),
        args.plane,
        display::name(scene.name(), display::NAME),
        shown(width),
        shown(height)
    ));
    Ok(())
}

/// What is seen: the window, or what is bounded with some air; the whole of it fits into the picture.
fn plane(args: &SliceArgs, scene: &Scene) -> SectionPlane {
    let mut plane = SectionPlane {
        axis: args.plane.axis,
        at: args.plane.at,
        centre: [0.0; 2],
        pixel: 1.0,
    };
    let [u0, v0, u1, v1] = args
        .window
        .map_or_else(|| around(scene, &plane), |window| window.0);
    let [width, height] = args.size.0.map(f64::from);
    plane.centre = [0.5 * (u0 + u1), 0.5 * (v0 + v1)];
    plane.pixel = ((u1 - u0) / width).max((v1 - v0) / height);
    plane
}

/// The bounds of all that is bounded along the picture's axes.
fn around(scene: &Scene, plane: &SectionPlane) -> [f64; 4] {
    let finite = |b: &Aabb| {
        !b.is_empty()
            && plane
                .directions()
                .iter()
                .all(|&(k, _)| b.min[k].is_finite() && b.max[k].is_finite())
    };
    let bounds = scene
        .objects()
        .iter()
        .map(|o| o.field.facts().bounds)
        .filter(finite)
        .reduce(|a, b| a.hull(&b));
    let Some(bounds) = bounds else {
        return [-UNBOUNDED, -UNBOUNDED, UNBOUNDED, UNBOUNDED];
    };
    let sides = plane.directions().map(|(k, sign)| {
        let (a, b) = (sign * bounds.min[k], sign * bounds.max[k]);
        (a.min(b), a.max(b))
    });
    let air = AIR
        * sides
            .iter()
            .map(|(low, high)| high - low)
            .fold(1e-3, f64::max);
    let [(u0, u1), (v0, v1)] = sides;
    [u0 - air, v0 - air, u1 + air, v1 + air]
}
