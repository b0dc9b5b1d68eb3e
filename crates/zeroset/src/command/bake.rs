//! `zeroset bake` and `zeroset edt`: fields as files of samples, and distance transforms of pictures.

use crate::args::{BakeArgs, EdtArgs, SceneArgs};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::{Shares, only_png, write_watched};
use crate::interrupt::Asking;
use crate::json;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use zeroset_eval::Evaluator;
use zeroset_field::program::{Limits as ProgramLimits, Program};
use zeroset_language::limits::Limits;
use zeroset_output::atomic::{probe, write_atomically};
use zeroset_output::display;
use zeroset_output::format::Metadata;
use zeroset_output::format::png::{Depth, write_watched as write_watched_png};
use zeroset_output::format::read::read as read_picture;
use zeroset_output::picture::Picture;
use zeroset_volume::bake::{Bake, BakeError, sample};
use zeroset_volume::check::{Check, MOST_CROSSINGS, crossings, mend};
use zeroset_volume::file::{VolumeFormat, write};
use zeroset_volume::mesh::{Mesh, MeshLimits};
use zeroset_volume::read::{MeshFormat, read};
use zeroset_volume::transform::signed;
use zeroset_volume::volume::Volume;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    nodes: [u32; 3],
    origin: [f64; 3],
    step: [f64; 3],
    bytes: usize,
    mesh: Option<MeshSummary>,
}

#[derive(Serialize)]
struct MeshSummary {
    vertices: usize,
    faces: usize,
    welded: usize,
    unused: usize,
    collapsed: usize,
    parts: usize,
    holes: usize,
    open_edges: usize,
    crowded_edges: usize,
    flipped: usize,
    flat: usize,
    duplicates: usize,
    crossings: usize,
    watertight: bool,
    area: f64,
    volume: f64,
}

/// Samples a mesh or a scene into a file.
pub(crate) fn run(args: &BakeArgs, console: &Console) -> Result<(), Failure> {
    let usage = |message: String| Failure::new(Exit::Usage, message);
    let format = VolumeFormat::of_name(&args.output.to_string_lossy())
        .map_err(|e| usage(format!("{}: {e}", args.output.display())))?;
    probe(&args.output)?;
    let mut limits = Limits::default();
    for (name, value) in &args.limit {
        limits.set(name, value).map_err(|e| usage(e.to_string()))?;
    }
    // a file of OpenVDB is sparse by what is left out beyond its band
    let band = match args.band {
        Some(cells) if cells > 0.0 => Some(cells),
        Some(_) => None,
        None => (format == VolumeFormat::Vdb).then_some(3.0),
    };
    let default = Bake::default();
    let bake = Bake {
        voxels: args.voxels,
        sign: args.sign,
        band,
        // all of the band has room around the surface
        margin: band.map_or(default.margin, |cells| cells.min(1000.0).ceil() as u32 + 1),
    };
    let end = args.input.extension().and_then(|e| e.to_str());
    let (volume, mesh) = match end {
        Some("star" | "json") => (of_scene(args, &bake, &limits, console)?, None),
        _ => of_mesh(&args.input, &bake, &limits, console).map(|(v, m)| (v, Some(m)))?,
    };
    let stem = args.input.file_stem().unwrap_or_default().to_string_lossy();
    let volume = volume.with_name(stem);
    let bytes = write(&volume, format);
    let written = {
        let _asking = Asking::begin();
        write_atomically(&args.output, |writer| writer.write_all(&bytes))
    };
    written?;
    let summary = Summary {
        nodes: volume.nodes(),
        origin: volume.origin(),
        step: volume.step(),
        bytes: bytes.len(),
        mesh,
    };
    if args.json {
        return console.emit(&json::line(&summary)?);
    }
    let [x, y, z] = summary.nodes;
    console.note(format_args!(
        "{}: {x}x{y}x{z} samples, {} apart, {:.1} MiB",
        args.output.display(),
        crate::reference::shortest(summary.step[0]),
        bytes.len() as f64 / f64::from(1 << 20),
    ));
    Ok(())
}

fn failed(error: &BakeError) -> Failure {
    match error {
        BakeError::Stopped => Failure {
            exit: Exit::Interrupted,
            report: None,
        },
        _ => Failure::new(Exit::Job, error.to_string()),
    }
}

fn held(nodes: [u32; 3], limits: &Limits) -> Result<(), Failure> {
    let count: u64 = nodes.iter().map(|n| u64::from(*n)).product();
    if count <= limits.grid_samples {
        return Ok(());
    }
    let [x, y, z] = nodes;
    Err(Failure::with_help(
        Exit::Usage,
        format!("{x}x{y}x{z} samples are more than {}", limits.grid_samples),
        "ask for fewer voxels, or raise the limit: --limit grid_samples=...",
    ))
}

fn of_mesh(
    path: &Path,
    bake: &Bake,
    limits: &Limits,
    console: &Console,
) -> Result<(Volume, MeshSummary), Failure> {
    let name = path.display();
    let bad =
        |reason: &dyn std::fmt::Display| Failure::new(Exit::File, format!("{name}: {reason}"));
    let format = MeshFormat::of_name(&path.to_string_lossy()).map_err(|e| {
        let help = "a scene ends in .star or .json";
        Failure::with_help(Exit::Usage, format!("{name}: {e}"), help)
    })?;
    let bytes = bytes_of(path, limits).map_err(|e| bad(&e))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    // buffers of a glTF lie beside it, as files of a scene do
    let mut beside = |other: &str| {
        let is_plain = Path::new(other)
            .components()
            .all(|c| matches!(c, std::path::Component::Normal(_)));
        if !is_plain {
            return Err("it is outside of the mesh's folder".to_owned());
        }
        bytes_of(&folder.join(other), limits)
    };
    let mesh_limits = MeshLimits {
        vertices: limits.mesh_faces,
        faces: limits.mesh_faces,
    };
    let mut mesh = read(&bytes, format, &mesh_limits, &mut beside).map_err(|e| bad(&e))?;
    held(bake.nodes(mesh.bounds()).map_err(|e| failed(&e))?, limits)?;
    let check = mend(&mut mesh);
    let crossings = crossings(&mesh);
    report(&mesh, &check, crossings, console);
    let _asking = Asking::begin();
    let shares = Shares(console.working_bar("sampling"));
    let volume = bake.bake(&mesh, &check, &shares).map_err(|e| failed(&e));
    shares.0.finish_and_clear();
    let w = check.welding;
    let summary = MeshSummary {
        vertices: check.vertices,
        faces: check.faces,
        welded: w.welded,
        unused: w.unused,
        collapsed: w.collapsed,
        parts: check.parts,
        holes: check.holes,
        open_edges: check.open_edges,
        crowded_edges: check.crowded_edges,
        flipped: check.flipped,
        flat: check.flat,
        duplicates: check.duplicates,
        crossings,
        watertight: check.watertight,
        area: check.area,
        volume: check.volume,
    };
    Ok((volume?, summary))
}

fn bytes_of(path: &Path, limits: &Limits) -> Result<Vec<u8>, String> {
    let about = std::fs::metadata(path).map_err(|e| e.to_string())?;
    if !about.is_file() {
        return Err("it is not an ordinary file".into());
    }
    if about.len() > limits.mesh_bytes {
        return Err(format!(
            "it has {} bytes, at most {} are allowed: raise the limit with --limit mesh_bytes=...",
            about.len(),
            limits.mesh_bytes
        ));
    }
    std::fs::read(path).map_err(|e| e.to_string())
}

/// What is right and wrong with a mesh, in a few lines.
fn report(mesh: &Mesh, check: &Check, crossings: usize, console: &Console) {
    let [low, high] = mesh.bounds();
    let side = |k: usize| crate::reference::shortest(f64::from(high[k] - low[k]));
    console.note(format_args!(
        "{} faces over {} vertices in {} parts, {} x {} x {}, {}",
        check.faces,
        check.vertices,
        check.parts,
        side(0),
        side(1),
        side(2),
        if check.watertight {
            "watertight"
        } else {
            "not watertight"
        },
    ));
    let crossed = if crossings >= MOST_CROSSINGS {
        "pairs of faces that cross, and more"
    } else {
        "pairs of faces that cross"
    };
    for (count, what) in [
        (
            check.welding.welded,
            "vertices at the place of another, welded",
        ),
        (check.welding.unused, "vertices that no face uses, left out"),
        (
            check.welding.collapsed,
            "faces with two corners at one place, left out",
        ),
        (check.holes, "holes, closed by the sign"),
        (check.crowded_edges, "edges of more than two faces"),
        (check.flipped, "faces that ran the wrong way, turned around"),
        (check.flat, "faces without an area"),
        (check.duplicates, "faces over the corners of another"),
        (crossings, crossed),
    ] {
        if count > 0 {
            console.note(format_args!("  {count} {what}"));
        }
    }
}

fn of_scene(
    args: &BakeArgs,
    bake: &Bake,
    limits: &Limits,
    console: &Console,
) -> Result<Volume, Failure> {
    let scene = SceneArgs {
        scene: args.input.clone(),
        set: args.set.clone(),
        time: Some(args.time),
        limit: args.limit.clone(),
    };
    let mut options = crate::scene::options(&scene, None)?;
    // the solid, not the floor that a picture of it would have
    options.bare = true;
    let loaded = crate::scene::loaded(&scene, &options, console)?.scene;
    let invalid = |error: String| Failure::new(Exit::Scene, error);
    let field = loaded.field().map_err(|e| invalid(e.to_string()))?;
    let field = field.ok_or_else(|| invalid("the scene shows nothing to sample".into()))?;
    let bounds = field.facts().bounds;
    if !bounds.is_finite() || bounds.is_empty() {
        return Err(Failure::with_help(
            Exit::Scene,
            "the scene has no ends: a grid needs a box around all of it",
            "leave the floor out, or cut it: ... & box(size)",
        ));
    }
    let corners = [bounds.min, bounds.max].map(|p| p.map(|x| x as f32));
    held(bake.nodes(corners).map_err(|e| failed(&e))?, limits)?;
    let program =
        Program::compile(&field, &ProgramLimits::default()).map_err(|e| invalid(e.to_string()))?;
    let _asking = Asking::begin();
    let shares = Shares(console.working_bar("sampling"));
    let volume = sample(bake, corners, &shares, || {
        let mut evaluator = Evaluator::new(program.values());
        move |points: &[[f32; 3]], values: &mut [f32]| {
            let points: Vec<glam::Vec3> = points.iter().map(|p| (*p).into()).collect();
            // one value for each point: the slices are as long
            let _ = evaluator.values(&points, values);
        }
    });
    shares.0.finish_and_clear();
    volume.map_err(|e| failed(&e))
}

/// Draws the signed distance transform of a picture.
pub(crate) fn edt(args: &EdtArgs, console: &Console) -> Result<(), Failure> {
    only_png(&args.output, "distance transforms")?;
    probe(&args.output)?;
    let picture = read_picture(&args.image)?;
    let size = [picture.width() as usize, picture.height() as usize, 1];
    let bright: Vec<bool> = (picture.pixels().iter())
        .map(|[r, g, b]| {
            // Rec. 709, of what a screen shows
            let shown = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            (shown >= args.level) != args.dark
        })
        .collect();
    let values = signed(size, &bright, args.metric, args.method)
        .map_err(|e| Failure::new(Exit::Job, format!("{}: {e}", args.image.display())))?;
    let most = (values.iter())
        .filter(|v| v.is_finite())
        .fold(0.0_f32, |m, v| m.max(v.abs()));
    if most == 0.0 {
        let message = format!(
            "{} has no boundary: all of it is of one side",
            args.image.display()
        );
        let help = "--level moves the brightness that parts what is inside from what is not";
        return Err(Failure::with_help(Exit::Job, message, help));
    }
    let width = picture.width();
    let drawn = Picture::from_fn(width, picture.height(), |x, y| {
        let value = values[(x + width * y) as usize];
        if value.abs() < 1.0 && !args.plain {
            return [1.0, 0.0, 0.0];
        }
        [0.5 + 0.5 * value / most; 3]
    });
    let notes =
        Metadata::new("distance transform").with("Largest distance", format!("{most} pixels"));
    write_watched(&args.output, console, &|| false, |writer, observer| {
        write_watched_png(writer, &drawn, Depth::Eight, &notes, observer)
    })?;
    let name = args.output.to_string_lossy();
    console.note(format_args!(
        "{}: black is {most} pixels within, white as many outside",
        display::name(&name, display::NAME)
    ));
    Ok(())
}
