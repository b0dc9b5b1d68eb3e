//! Fields of samples: meshes, volumes and pictures of the scene's folder, made once however often they are asked for.

use crate::assets::Baked;
use crate::files::Reading;
use crate::images;
use crate::limits::Limits;
use std::sync::Arc;
use web_time::{Duration, Instant};
use zeroset_field::sampled::{Sampled, Source};
use zeroset_volume::bake::{Bake, Sign, Watch};
use zeroset_volume::check::mend;
use zeroset_volume::file::{self, VolumeFormat};
use zeroset_volume::mesh::MeshLimits;
use zeroset_volume::outline;
use zeroset_volume::read::{self, MeshFormat};
use zeroset_volume::volume::Volume;

/// The ways to find what is inside of a mesh, by name.
pub(crate) const SIGNS: [(&str, Sign); 3] = [
    ("auto", Sign::Auto),
    ("parity", Sign::Parity),
    ("winding", Sign::Winding),
];

/// Bytes that a face takes while it is sampled, and that a node does: upper bounds.
const FACE: u64 = 640;
const NODE: u64 = 16;
/// Bytes that a node keeps, with the ranges over it.
const KEPT: u64 = 6;

/// The samples that a scene file asks for, and how long making them took: what is not charged to the time that loading may take,
/// but to that of sampling.
///
/// # Errors
/// What is wrong with the file, and what is allowed.
pub(crate) fn load(
    files: &mut Reading,
    source: &Source,
    limits: &Limits,
) -> Result<(Arc<Sampled>, Duration), String> {
    let mut source = source.clone();
    let file = match &mut source {
        Source::Mesh { file, .. } | Source::Grid { file } | Source::Image { file, .. } => file,
    };
    // one name for one file
    *file = Reading::normal(file).map_err(|e| e.to_string())?;
    let (name, source) = (&file.clone(), &source);
    let mut taken = Duration::ZERO;
    let sampled = files.sampled(name, &format!("{source:?}"), |files| {
        let start = Instant::now();
        let clock = Clock {
            start,
            seconds: limits.sampling_seconds - files.budget.sampled().as_secs_f64(),
        };
        let made = match source {
            Source::Mesh {
                file, voxels, sign, ..
            } => mesh(files, file, *voxels, sign, limits, &clock),
            Source::Grid { file } => grid(files, file, limits),
            Source::Image { file, width, level } => {
                image(files, file, *width, *level, limits, &clock)
            }
        };
        taken = start.elapsed();
        files.budget.pause(taken);
        if clock.is_stopped() {
            return Err(format!(
                "sampling \"{name}\" takes longer than {} seconds (limit `sampling_seconds`): make it coarser, or bake it \
                 into a file",
                limits.sampling_seconds
            ));
        }
        Ok(Arc::new(made?.with_source(source.clone())))
    })?;
    let count = sampled.grid().values().len() as u64;
    files
        .hold_sampled(name, count * KEPT)
        .map_err(|e| e.to_string())?;
    Ok((sampled, taken))
}

/// Stops what takes too long.
struct Clock {
    start: Instant,
    seconds: f64,
}

impl Watch for Clock {
    fn is_stopped(&self) -> bool {
        self.start.elapsed().as_secs_f64() > self.seconds
    }
}

fn wrong(name: &str, what: &str, e: &dyn std::fmt::Display) -> String {
    format!("\"{name}\" is no {what} that can be read: {e}")
}

fn mesh(
    files: &mut Reading,
    name: &str,
    voxels: u32,
    sign: &str,
    limits: &Limits,
    clock: &Clock,
) -> Result<Sampled, String> {
    let bad = |e: &dyn std::fmt::Display| wrong(name, "mesh", e);
    let format = MeshFormat::of_name(name).map_err(|e| bad(&e))?;
    let sign = SIGNS
        .iter()
        .find(|s| s.0 == sign)
        .map_or(Sign::Auto, |s| s.1);
    let real = files.find(name).map_err(|e| e.to_string())?;
    // what is only needed to make the samples is given back at the end
    let mut budget = files.budget;
    let bytes = files
        .read_at(&real, name, limits.mesh_bytes, "mesh_bytes", &mut budget)
        .map_err(|e| e.to_string())?;
    let bake = Bake {
        voxels,
        sign,
        ..Bake::default()
    };
    // a glTF may say the rest in other files: what they are called is in it, what they hold is not
    let whole = format != MeshFormat::Gltf;
    let assets = files.cache.assets.clone();
    let key = |bytes: &[u8]| Baked::key(&["mesh", name, &format!("{bake:?}")], bytes);
    if whole && let Some(sampled) = assets.baked(&key(&bytes), limits.grid_samples) {
        return Ok(sampled);
    }
    let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut beside = |other: &str| {
        let path = if folder.is_empty() {
            other.to_owned()
        } else {
            format!("{folder}/{other}")
        };
        let real = files.find(&path).map_err(|e| e.to_string())?;
        files
            .read_at(&real, &path, limits.mesh_bytes, "mesh_bytes", &mut budget)
            .map_err(|e| e.to_string())
    };
    let mesh_limits = MeshLimits {
        vertices: limits.mesh_faces,
        faces: limits.mesh_faces,
    };
    let mut mesh = read::read(&bytes, format, &mesh_limits, &mut beside).map_err(|e| bad(&e))?;
    let nodes = bake.nodes(mesh.bounds()).map_err(|e| bad(&e))?;
    let count: u64 = nodes.iter().map(|n| u64::from(*n)).product();
    if count > limits.grid_samples {
        return Err(format!(
            "\"{name}\" at {voxels} voxels would have {}x{}x{} samples, at most {} are allowed (limit `grid_samples`)",
            nodes[0], nodes[1], nodes[2], limits.grid_samples
        ));
    }
    let needed = FACE * mesh.faces().len() as u64 + NODE * count;
    budget
        .borrow(needed, || format!("sampling \"{name}\""))
        .map_err(|e| e.to_string())?;
    let check = mend(&mut mesh);
    let volume = bake.bake(&mesh, &check, clock).map_err(|e| bad(&e))?;
    if whole {
        assets.keep_baked(&key(&bytes), &volume);
    }
    volume.into_sampled().map_err(|e| bad(&e))
}

fn grid(files: &mut Reading, name: &str, limits: &Limits) -> Result<Sampled, String> {
    let bad = |e: &dyn std::fmt::Display| wrong(name, "volume", e);
    let format = VolumeFormat::of_name(name).map_err(|e| bad(&e))?;
    let real = files.find(name).map_err(|e| e.to_string())?;
    let mut budget = files.budget;
    let bytes = files
        .read_at(&real, name, limits.mesh_bytes, "mesh_bytes", &mut budget)
        .map_err(|e| e.to_string())?;
    // what is left of the memory bounds the samples as well
    let mut most = limits.grid_samples;
    while most > 0 && budget.borrow(NODE * most, String::new).is_err() {
        most /= 2;
    }
    let volume = file::read(&bytes, format, most).map_err(|e| bad(&e))?;
    volume.into_sampled().map_err(|e| bad(&e))
}

fn image(
    files: &mut Reading,
    name: &str,
    width: f64,
    level: f64,
    limits: &Limits,
    clock: &Clock,
) -> Result<Sampled, String> {
    let (size, ink) = images::brightness(files, name, limits)?;
    let pixels = ink.len() as u64;
    files
        .budget
        .borrow(4 * FACE * pixels / 8 + NODE * pixels, || {
            format!("the outline of \"{name}\"")
        })
        .map_err(|e| e.to_string())?;
    outline::shape(size, &ink, level as f32, width, clock)
        .map_err(|e| format!("\"{name}\" makes no shape: {e}"))
}

impl Baked {
    /// A volume as it is kept from one run to the next.
    pub(crate) fn pack(volume: &Volume) -> Vec<u8> {
        file::write(volume, VolumeFormat::Nrrd)
    }

    /// What was packed; nothing where it is damaged.
    pub(crate) fn unpack(bytes: &[u8], most: u64) -> Option<Sampled> {
        let volume = file::read(bytes, VolumeFormat::Nrrd, most).ok()?;
        volume.into_sampled().ok()
    }
}
