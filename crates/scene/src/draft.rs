//! What a scene file declares while it runs, and the scene that it becomes.

use crate::camera::{Camera, Lens};
use crate::files::Files;
use crate::framing;
use crate::light::{self, Light, Sky};
use crate::limits::Limits;
use crate::load::{Options, Parameter};
use crate::material::Material;
use crate::report::{Place, Source};
use crate::scene::{Object, Scene};
use crate::settings::{Settings, Shading, Shadow};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};
use zeroset_field::bounds::Aabb;

/// A camera as far as the file states it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) eye: Option<DVec3>,
    pub(crate) target: Option<DVec3>,
    pub(crate) up: DVec3,
    /// The way it looks; where it stands follows from what is to be seen.
    pub(crate) direction: Option<DVec3>,
    /// Columns right, up, backwards.
    pub(crate) axes: Option<glam::DMat3>,
    /// Vertical field of view, radians.
    pub(crate) fov: f64,
    /// Height of an orthographic view.
    pub(crate) height: Option<f64>,
    pub(crate) near: f64,
    pub(crate) far: Option<f64>,
}

/// Vertical field of view where a file states none, degrees.
pub(crate) const FOV: f64 = 40.0;

impl Default for View {
    fn default() -> Self {
        let (near, far) = (0.0, None);
        View {
            eye: None,
            target: None,
            up: DVec3::Y,
            direction: None,
            axes: None,
            fov: FOV.to_radians(),
            height: None,
            near,
            far,
        }
    }
}

/// What a script has declared so far.
pub(crate) struct Draft {
    /// Texts of all files, for messages.
    pub(crate) sources: Vec<Source>,
    pub(crate) objects: Vec<Object>,
    pub(crate) materials: Vec<Material>,
    numbers: HashMap<String, u16>,
    pub(crate) view: Option<(View, Place)>,
    pub(crate) lights: Vec<Light>,
    pub(crate) sky: Option<(Sky, Place)>,
    pub(crate) settings: Option<(Settings, Place)>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) overrides: BTreeMap<String, String>,
    pub(crate) time: f64,
    pub(crate) animated: bool,
    pub(crate) files: Files,
    pub(crate) log: Vec<String>,
    size: Option<[u32; 2]>,
}

/// Lines of the log that are kept.
const LOG: usize = 1000;

impl Draft {
    pub(crate) fn new(options: &Options, files: Files, sources: Vec<Source>) -> Draft {
        Draft {
            sources,
            objects: Vec::new(),
            materials: Vec::new(),
            numbers: HashMap::new(),
            view: None,
            lights: Vec::new(),
            sky: None,
            settings: None,
            parameters: Vec::new(),
            overrides: options.set.clone(),
            time: options.time,
            animated: false,
            files,
            log: Vec::new(),
            size: options.size,
        }
    }

    pub(crate) fn print(&mut self, line: String) {
        if self.log.len() < LOG {
            self.log.push(line);
        }
    }

    /// The number of a material; equal ones share it. `None` where there are too many.
    pub(crate) fn number(&mut self, material: &Material) -> Option<u16> {
        // equal text means equal numbers: floats are written so that they can be read back exactly
        let key = serde_json::to_string(material).unwrap_or_default();
        if let Some(number) = self.numbers.get(&key) {
            return Some(*number);
        }
        let number = u16::try_from(self.materials.len())
            .ok()
            .filter(|n| *n < u16::MAX)?;
        self.materials.push(material.clone());
        self.numbers.insert(key, number);
        Some(number)
    }

    /// The scene, with what the file left out.
    pub(crate) fn finish(self, name: String, limits: &Limits) -> Result<Scene, String> {
        let mut settings = self.settings.map_or_else(Settings::default, |s| s.0);
        if let Some(size) = self.size {
            settings.size = size;
        }
        check_size(settings.size, limits)?;
        let nodes = self
            .objects
            .iter()
            .fold(0, |n: u64, o| n.saturating_add(o.field.facts().nodes));
        if nodes > limits.nodes {
            return Err(format!(
                "the scene has {nodes} nodes (a shape used twice counts twice), at most {} are allowed: use \
                 .repeat(...) or .polar(...) for many copies, or raise the limit `nodes`",
                limits.nodes
            ));
        }
        let objects = self.objects;
        let mut lights = self.lights;
        if lights.is_empty() {
            lights.push(key_light(settings.shading));
        }
        let bounds = objects.iter().map(|o| o.field.facts().bounds);
        let camera = framing::camera(
            &self.view.map_or_else(View::default, |v| v.0),
            bounds,
            settings.size,
        )?;
        let sky = self.sky.map_or_else(Sky::default, |s| s.0);
        Ok(Scene {
            name,
            objects,
            materials: self.materials,
            lights,
            sky,
            camera,
            settings,
        })
    }
}

/// Whether a picture of this size is allowed.
pub(crate) fn check_size([width, height]: [u32; 2], limits: &Limits) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if width == 0 || height == 0 || pixels > limits.pixels {
        return Err(format!(
            "a picture of {width}x{height} pixels: width and height must be at least 1, and at most {} pixels are \
             allowed (limit `pixels`)",
            limits.pixels
        ));
    }
    Ok(())
}

/// The sun of a scene that states no light.
fn key_light(shading: Shading) -> Light {
    let warm = Vec3::new(1.0, 0.95, 0.86);
    // Lambert's law divides by pi where Phong's model does not
    let strength = if shading == Shading::Phong {
        0.9
    } else {
        0.9 * std::f32::consts::PI
    };
    Light {
        source: light::Source::Directional {
            direction: Vec3::new(0.62, -1.0, -0.55).normalize(),
        },
        radiance: warm * strength,
        shadow: Shadow::SoftClosest { sharpness: 12.0 },
    }
}

/// The box of all that has an end; what goes on for ever is left out. `None` where nothing is left.
pub(crate) fn finite_bounds(bounds: impl Iterator<Item = Aabb>) -> Option<Aabb> {
    bounds
        .filter(|b| !b.is_empty() && b.is_finite())
        .reduce(|a, b| a.hull(&b))
}

impl View {
    pub(crate) fn lens(&self) -> Lens {
        match self.height {
            Some(height) => Lens::Orthographic {
                height: height as f32,
            },
            None => Lens::Pinhole {
                fov: self.fov as f32,
            },
        }
    }
}

/// A camera with these axes.
pub(crate) fn camera_with(
    axes: glam::DMat3,
    eye: DVec3,
    lens: Lens,
    near: f64,
    far: f64,
) -> Camera {
    Camera {
        eye: eye.as_vec3(),
        axes: axes.as_mat3(),
        lens,
        near: near as f32,
        far: far as f32,
    }
}
