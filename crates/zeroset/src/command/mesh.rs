//! `zeroset mesh`: a scene's solid as a mesh of triangles.

use crate::args::MeshArgs;
use crate::console::{Console, grouped};
use crate::failure::{Exit, Failure};
use crate::file::{Shares, make_folder};
use crate::interrupt::Asking;
use crate::json;
use crate::paint::Painter;
use crate::reference::shortest;
use serde::Serialize;
use std::io::Write;
use zeroset_catalogue::bounds::Aabb;
use zeroset_contour::{Contour, ContourError, Contoured, Limits, Watch, tightened};
use zeroset_field::program::Program;
use zeroset_field::shape::{Shape, box3};
use zeroset_language::limits::Limits as SceneLimits;
use zeroset_output::atomic::{probe, write_atomically};
use zeroset_output::display;
use zeroset_scene::scene::Scene;
use zeroset_shade::coat::compiled;
use zeroset_volume::write::{Painted, Surfacing, Target, write};

/// The tolerance where none is asked for: a thousandth of the longest side of what there is.
const USUAL: f64 = 1e-3;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    faces: usize,
    vertices: usize,
    parts: u64,
    euler: i64,
    watertight: bool,
    manifold: bool,
    volume: f64,
    area: f64,
    tolerance: f64,
    deviation: f64,
    resolution: u32,
    cell: f64,
    faces_before: usize,
    bytes: usize,
}

/// Writes the mesh of a scene.
pub(crate) fn run(args: &MeshArgs, console: &Console) -> Result<(), Failure> {
    let name = args.output.to_string_lossy();
    let Some(target) = Target::of_name(&name) else {
        let ends: Vec<String> = Target::ALL
            .iter()
            .map(|(_, end)| format!(".{end}"))
            .collect();
        return Err(Failure::with_help(
            Exit::Usage,
            format!(
                "{} does not say what kind of mesh it is",
                args.output.display()
            ),
            format!("end the name in one of {}", ends.join(", ")),
        ));
    };
    make_folder(&args.output)?;
    probe(&args.output)?;
    let mut options = crate::scene::options(&args.scene, None)?;
    // the solid, not the floor that a picture of it would have
    options.bare = true;
    let limits = options.limits;
    let scene = crate::scene::loaded(&args.scene, &options, console)?.scene;
    let (solid, bounds) = solid(&scene, args)?;
    let _asking = Asking::begin();
    let shares = Shares(console.working_bar("meshing"));
    let made = contoured(args, &solid, bounds, &limits, &shares);
    shares.0.finish_and_clear();
    let (made, tolerance) = made.map_err(|error| failed(&error))?;
    let bytes = painted(&scene, &solid, &made, target)?;
    write_atomically(&args.output, |writer| writer.write_all(&bytes))?;
    report(args, &made, tolerance, bytes.len(), console)
}

/// The program of all that a scene shows, cut to the box that was asked for, and a box around it.
fn solid(scene: &Scene, args: &MeshArgs) -> Result<(Program, Aabb), Failure> {
    let invalid = |error: String| Failure::new(Exit::Scene, error);
    let field = scene.field().map_err(|e| invalid(e.to_string()))?;
    let mut field =
        field.ok_or_else(|| invalid("the scene shows nothing to make a mesh of".into()))?;
    if let Some(cut) = args.bounds {
        let sides: [f64; 3] = std::array::from_fn(|k| cut.max[k] - cut.min[k]);
        let shape = Shape::from(field) & box3(sides).translate(cut.centre());
        field = shape.field().map_err(|e| invalid(e.to_string()))?;
    }
    let bounds = field.facts().bounds;
    if !bounds.is_finite() {
        let endless: Vec<String> = (scene.objects().iter())
            .filter(|o| !o.field.facts().bounds.is_finite())
            .map(|o| match &o.place {
                Some((_, line, _)) => {
                    format!(
                        "object {} (line {line})",
                        display::name(&o.name, display::NAME)
                    )
                }
                None => format!("object {}", display::name(&o.name, display::NAME)),
            })
            .take(5)
            .collect();
        return Err(Failure::with_help(
            Exit::Scene,
            format!(
                "the scene has no ends: {} goes on for ever",
                endless.join(", ")
            ),
            "cut it with --bounds X0,Y0,Z0,X1,Y1,Z1 (it is closed where it is cut), or leave it out of the scene",
        ));
    }
    let program = Program::compile(&field, &zeroset_field::program::Limits::default())
        .map_err(|e| invalid(e.to_string()))?;
    Ok((program, bounds))
}

fn contoured(
    args: &MeshArgs,
    solid: &Program,
    bounds: Aabb,
    limits: &SceneLimits,
    watch: &dyn Watch,
) -> Result<(Contoured, f64), ContourError> {
    let bounds = tightened(solid, &bounds, watch)?;
    if bounds.is_empty() {
        return Err(ContourError::Empty { inside: false });
    }
    let longest = 2.0 * bounds.half().into_iter().fold(0.0, f64::max);
    let tolerance = args.tolerance.unwrap_or(USUAL * longest);
    let mut contour = Contour {
        simplify: !args.all_faces,
        limits: Limits {
            cells: limits.grid_samples,
            faces: limits.mesh_faces,
        },
        ..Contour::fitting(tolerance, &bounds)
    };
    if let Some(resolution) = args.resolution {
        (contour.resolution, contour.finest) = (resolution, resolution);
    }
    Ok((contour.of(solid, &bounds, watch)?, tolerance))
}

fn failed(error: &ContourError) -> Failure {
    let help = match error {
        ContourError::Stopped => return Failure::silent(Exit::Interrupted),
        ContourError::Setting { .. } => return Failure::new(Exit::Usage, error.to_string()),
        ContourError::Cells { .. } => "--limit grid_samples=NUMBER allows more",
        ContourError::Faces { .. } => "--limit mesh_faces=NUMBER allows more",
        ContourError::Empty { .. } => "`zeroset slice` shows where the field is negative",
        ContourError::Endless | ContourError::Leaves | ContourError::Fine { .. } => {
            "cut it with --bounds X0,Y0,Z0,X1,Y1,Z1"
        }
    };
    let exit = match error {
        ContourError::Cells { .. } | ContourError::Faces { .. } | ContourError::Fine { .. } => {
            Exit::Usage
        }
        _ => Exit::Scene,
    };
    Failure::with_help(exit, error.to_string(), help)
}

/// The bytes of the file, with as much of the scene's materials as its format has room for.
fn painted(
    scene: &Scene,
    solid: &Program,
    made: &Contoured,
    target: Target,
) -> Result<Vec<u8>, Failure> {
    let surface = &made.surface;
    let (program, _) = compiled(scene, &zeroset_field::program::Limits::default())?;
    let painter = Painter::new(scene, &program, made.step);
    let colours = match target {
        Target::Stl => Vec::new(),
        _ => painter.colours(&surface.points),
    };
    let normals = match target {
        Target::Glb | Target::Obj => surface.normals(solid),
        _ => Vec::new(),
    };
    let (mut surfacings, mut of_faces) = (Vec::new(), Vec::new());
    if target == Target::Glb {
        of_faces = painter.materials(&surface.points, &surface.faces);
        surfacings = (scene.materials().iter().enumerate())
            .map(|(i, m)| Surfacing {
                name: format!("material {}", i + 1),
                metallic: m.metallic,
                roughness: m.roughness,
                emission: m.emission.to_array(),
            })
            .collect();
    }
    let mesh = Painted {
        name: scene.name(),
        points: &surface.points,
        faces: &surface.faces,
        colours: &colours,
        normals: &normals,
        surfacings: &surfacings,
        surfacing_of: &of_faces,
    };
    write(&mesh, target).map_err(|e| Failure::new(Exit::Job, e.to_string()))
}

fn report(
    args: &MeshArgs,
    made: &Contoured,
    tolerance: f64,
    bytes: usize,
    console: &Console,
) -> Result<(), Failure> {
    let topology = made.surface.topology();
    let summary = Summary {
        faces: made.surface.faces.len(),
        vertices: made.surface.points.len(),
        parts: topology.parts,
        euler: topology.euler,
        watertight: topology.watertight,
        manifold: topology.manifold,
        volume: made.surface.volume(),
        area: made.surface.area(),
        tolerance,
        deviation: made.deviation,
        resolution: made.resolution,
        cell: made.step,
        faces_before: made.faces_before,
        bytes,
    };
    if args.json {
        console.emit(&json::line(&summary)?)?;
    }
    let name = args.output.to_string_lossy();
    console.note(format_args!(
        "{}: {} faces over {} vertices in {}, {}, {:.1} KiB",
        display::name(&name, display::NAME),
        grouped(summary.faces as u64),
        grouped(summary.vertices as u64),
        if summary.parts == 1 {
            "1 part".into()
        } else {
            format!("{} parts", summary.parts)
        },
        if summary.watertight {
            "watertight"
        } else {
            "not watertight"
        },
        bytes as f64 / 1024.0,
    ));
    console.note(format_args!(
        "  off the surface by {} at most where it was measured, the tolerance is {}; cells of {}, {} along the longest side",
        rounded(summary.deviation),
        rounded(tolerance),
        rounded(summary.cell),
        summary.resolution,
    ));
    if made.deviation > tolerance {
        console.note(
            "  This is more than the tolerance: what is finer than the cells is not followed. --resolution asks for smaller ones.",
        );
    }
    if !summary.manifold {
        return Err(Failure::new(
            Exit::Job,
            format!(
                "{}: the mesh is not closed; this is a defect of Zeroset",
                args.output.display()
            ),
        ));
    }
    Ok(())
}

/// Three digits of a length.
fn rounded(x: f64) -> String {
    shortest(format!("{x:.2e}").parse().unwrap_or(x))
}
