//! What a scene file declares while it runs, and the scene that it becomes.

use crate::files::Reading;
use crate::framing;
use crate::json::valid;
use crate::limits::Limits;
use crate::load::{Options, Parameter};
use crate::naming::shortened;
use crate::report::{Place, Report, Source, suggestion};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::environment::Environment;
use zeroset_scene::film::Plane;
use zeroset_scene::light::{self, Fog, Light, Sky};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Settings, Shading, Shadow};

/// A camera as far as the file states it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraDraft {
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
    /// Radius of the lens.
    pub(crate) aperture: f64,
    /// What is in focus; what is looked at where nothing is said.
    pub(crate) focus: Option<Focus>,
    /// How long the shutter is open, seconds.
    pub(crate) shutter: f64,
    /// Moments of that time.
    pub(crate) moments: u32,
}

/// What a camera is focused on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Focus {
    /// What is so far before it, along the way it looks.
    Distance(f64),
    /// What is as far as a point.
    Point(DVec3),
}

/// Moments of a shutter that states none.
pub(crate) const MOMENTS: u32 = 32;

/// Vertical field of view where a file states none, degrees.
pub(crate) const FOV: f64 = 40.0;

impl Default for CameraDraft {
    fn default() -> Self {
        let (near, far) = (0.0, None);
        CameraDraft {
            eye: None,
            target: None,
            up: DVec3::Y,
            direction: None,
            axes: None,
            fov: FOV.to_radians(),
            height: None,
            near,
            far,
            aperture: 0.0,
            focus: None,
            shutter: 0.0,
            moments: MOMENTS,
        }
    }
}

/// What a script has declared so far.
pub(crate) struct Draft {
    /// The scene's name, if it says one.
    pub(crate) name: Option<String>,
    /// Texts of all files, for messages.
    pub(crate) sources: Vec<Source>,
    pub(crate) objects: Vec<Object>,
    pub(crate) materials: Vec<Material>,
    /// Objects whose material the file leaves open.
    pub(crate) plain: Vec<usize>,
    numbers: HashMap<String, u16>,
    pub(crate) view: Option<CameraDraft>,
    /// Absent as long as nothing is said of lights.
    pub(crate) lights: Option<Vec<Light>>,
    pub(crate) sky: Option<Sky>,
    pub(crate) environment: Option<Environment>,
    pub(crate) fog: Option<Fog>,
    pub(crate) settings: Option<Settings>,
    /// Where that which may be stated once was stated.
    pub(crate) stated: BTreeMap<&'static str, Place>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) overrides: BTreeMap<String, String>,
    pub(crate) time: f64,
    pub(crate) animated: bool,
    pub(crate) files: Reading,
    pub(crate) log: Vec<String>,
    pub(crate) warnings: Vec<Report>,
    size: Option<[u32; 2]>,
}

/// Lines of the log that are kept.
const LOG: usize = 1000;
/// Characters of such a line that are kept.
const LOG_LINE: usize = 2000;

impl Draft {
    pub(crate) fn new(options: &Options, files: Reading, sources: Vec<Source>) -> Draft {
        Draft {
            sources,
            objects: Vec::new(),
            materials: Vec::new(),
            plain: Vec::new(),
            numbers: HashMap::new(),
            view: None,
            lights: None,
            stated: BTreeMap::new(),
            name: None,
            sky: None,
            environment: None,
            fog: None,
            settings: None,
            parameters: Vec::new(),
            overrides: options.set.clone(),
            time: options.time,
            animated: false,
            files,
            log: Vec::new(),
            warnings: Vec::new(),
            size: options.size,
        }
    }

    pub(crate) fn print(&mut self, line: &str) {
        if self.log.len() < LOG {
            self.log.push(shortened(line, LOG_LINE));
        }
    }

    /// File, line and column of a place, 1-based; found without reading the file again for each.
    pub(crate) fn position(&self, place: Place) -> Option<(String, u32, u32)> {
        let source = self.sources.get(place.file as usize)?;
        let (line, column) = source.position(place.start as usize);
        Some((source.name.clone(), line as u32, column as u32))
    }

    /// Keeps a warning about a place; one for each place, and no more than a person reads.
    pub(crate) fn warn(&mut self, report: Report, place: Place) {
        const MOST: usize = 20;
        let report = match self.sources.get(place.file as usize) {
            Some(source) => report.at(source, place),
            None => report,
        }
        .as_warning();
        let same =
            |w: &Report| w.message() == report.message() && w.position() == report.position();
        if self.warnings.len() < MOST && !self.warnings.iter().any(same) {
            self.warnings.push(report);
        }
    }

    /// The number of a material; equal ones share it. `None` where there are too many.
    pub(crate) fn number(&mut self, material: &Material) -> Option<u16> {
        // equal text means equal numbers: floats are written so that they can be read back exactly
        let mut key = serde_json::to_string(material).unwrap_or_default();
        // which says of formulas only where they are
        for (_, pattern) in material.patterns() {
            for part in pattern.parts() {
                if let Pattern::Formula { formula } = part {
                    let fields: Vec<usize> = (formula.fields().iter())
                        .map(|inner| inner.field().key())
                        .collect();
                    key += &format!("{:?}{:?}{fields:?}", formula.steps(), formula.results());
                }
            }
        }
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

    /// That something is set from outside which the scene does not have, and what to do.
    pub(crate) fn unknown_parameter(&self) -> Option<(String, String)> {
        let names = || self.parameters.iter().map(|p| p.name.as_str());
        let unknown = self
            .overrides
            .keys()
            .find(|name| !names().any(|n| n == *name))?;
        let help = suggestion(unknown, names()).unwrap_or_else(|| match self.parameters.len() {
            0 => "slider(...), choice(...), toggle(...) and color(...) make parameters".to_string(),
            _ => format!("there are {}", names().collect::<Vec<_>>().join(", ")),
        });
        Some((
            format!("the scene has no parameter \"{unknown}\" to set"),
            help,
        ))
    }

    /// The scene, with what the file left out.
    pub(crate) fn finish(self, name: &str, limits: &Limits) -> Result<Scene, String> {
        let mut settings = self.settings.unwrap_or_default();
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
        let lights = self
            .lights
            .unwrap_or_else(|| vec![key_light(settings.shading)]);
        let bounds = objects.iter().map(|o| framing::surface(&o.field));
        let camera = framing::camera(&self.view.unwrap_or_default(), bounds, settings.size)?;
        let sky = self.sky.unwrap_or_default();
        let sky = Sky {
            fog: self.fog.or(sky.fog),
            ..sky
        };
        let parts = SceneParts {
            name: self.name.unwrap_or_else(|| name.to_string()),
            objects,
            materials: self.materials,
            lights,
            sky,
            environment: self.environment,
            camera,
            settings,
        };
        // numbers of double precision may have become infinite in single precision
        valid::limits(&parts, limits).map_err(|p| p.message())?;
        parts.build().map_err(|e| e.to_string())
    }
}

/// A direction of length 1, even where the squares of its numbers underflow or overflow.
pub(crate) fn unit(direction: [f64; 3]) -> DVec3 {
    let v = DVec3::from(direction);
    if (1e-200..1e200).contains(&v.length_squared()) {
        v.normalize()
    } else {
        (v / v.abs().max_element()).normalize()
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
    // of the colour alone: what else is asked for is known to whoever renders
    limits
        .check_picture([width, height], &[Plane::Colour], 0)
        .map_err(|e| e.to_string())
}

/// The sun of a scene that states no light.
fn key_light(shading: Shading) -> Light {
    let warm = Vec3::new(1.0, 0.95, 0.86);
    // Lambert's law divides by pi where the other models do not
    let strength = match shading {
        Shading::Physical | Shading::Phong => 0.9,
        Shading::Lambert | Shading::LambertLegacy => 0.9 * std::f32::consts::PI,
    };
    Light {
        source: light::Source::Directional {
            direction: Vec3::new(0.62, -1.0, -0.55).normalize(),
        },
        radiance: warm * strength,
        shadow: Shadow::SoftClosest { sharpness: 12.0 },
    }
}

impl CameraDraft {
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
        aperture: 0.0,
        focus: 0.0,
    }
}
