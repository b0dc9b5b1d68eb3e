//! The command line: what can be asked, and in what words.

use crate::backend::Backend;
use crate::console::Colour;
use crate::failure::{EXIT_CODES, Exit, Failure};
use crate::values::{Chosen, Frames, SectionPlane, Size, Window, assignment, help};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use zeroset_language::limits::Limits;
use zeroset_output::format::recipe::Recipe;
use zeroset_scene::film::Plane;
use zeroset_scene::methods::Choice;
use zeroset_scene::scene::{Scene, SceneParts};
use zeroset_scene::settings::{
    Antialias, Integrator, March, Normals, Occlusion, Shading, Shadow, Tone,
};

/// Renders signed distance fields: from a scene of a few lines to a picture.
#[derive(Debug, Parser)]
#[command(
    name = "zeroset",
    version,
    propagate_version = true,
    arg_required_else_help = true
)]
#[command(subcommand_required = true, after_long_help = EXIT_CODES)]
pub(crate) struct CommandLine {
    #[command(flatten)]
    pub global: Global,
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Args)]
pub(crate) struct Global {
    /// When to use colours
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        value_enum,
        default_value_t,
        help_heading = "Messages"
    )]
    pub color: Colour,
    /// Say only what went wrong
    #[arg(
        short,
        long,
        global = true,
        conflicts_with = "verbose",
        help_heading = "Messages"
    )]
    pub quiet: bool,
    /// Say what is being done; twice for more
    #[arg(short, long, global = true, action = clap::ArgAction::Count, help_heading = "Messages")]
    pub verbose: u8,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Open a window on a scene: fly through it, move its sliders, compare methods. `zeroset SCENE` does the same
    #[cfg(feature = "window")]
    View(ViewArgs),
    /// Render a scene to a picture
    Render(RenderArgs),
    /// Check a scene: its objects, their bounds, what is proven about their distances, what a picture will cost
    Check(CheckArgs),
    /// Prove a picture pixel by pixel: each ray hits where the picture says and nothing before, or meets nothing
    Certify(CertifyArgs),
    /// Say why a pixel shows what it shows: its ray step by step, what sets each step, what is proven, what to do
    Why(WhyArgs),
    /// Write values of sliders, choices, toggles and colours into a scene's file; all else in it stays as it is
    Set(SetArgs),
    /// Print a scene as JSON, which every command takes in place of a script
    Expand(ExpandArgs),
    /// Print a scene as one shader: WGSL, or GLSL that runs when it is pasted into Shadertoy
    #[cfg(feature = "shaders")]
    Export(ExportArgs),
    /// Make a scene of a model of others: GLSL as in Shadertoy, JSON of Lipschitz pruning, a register list (.vm)
    Import(ImportArgs),
    /// List what the scene language offers, or explain one name
    Fields(FieldsArgs),
    /// Draw a section through a scene's distance field, with lines of equal distance
    Slice(SliceArgs),
    /// Sample a mesh or a scene as signed distances on a grid, and write it as OpenVDB or NRRD
    Bake(BakeArgs),
    /// Make a mesh of a scene's solid: closed, with its sharp edges and its colours
    Mesh(MeshArgs),
    /// Draw the signed distance transform of a picture, as Evans 2006, figure 3
    Edt(EdtArgs),
    /// Say how different pictures are from another one: RMSE, PSNR, SSIM and FLIP
    Compare(CompareArgs),
    /// Say how near each occlusion method is to sampled occlusion in a scene, and with which numbers it is nearest
    FitAo(FitAoArgs),
    /// Measure how fast this machine is
    Bench(BenchArgs),
    /// List the GPUs of this machine, what they can do, and which one renders
    #[cfg(feature = "gpu")]
    Gpu(GpuArgs),
    /// Make a folder with a first scene to play with
    Init(InitArgs),
    /// Print completions for a shell
    Completions(CompletionsArgs),
    /// Print a manual page
    Man(ManArgs),
}

/// A scene and what changes it.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArgs {
    /// The scene: a script (.star) or JSON (.json)
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scene: PathBuf,
    /// Set a parameter of the scene (slider, choice, toggle or color); can be given many times
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment, help_heading = "Scene")]
    pub set: Vec<(String, String)>,
    /// What time() is in the scene, seconds. Default: 0
    #[arg(
        long,
        value_name = "SECONDS",
        allow_negative_numbers = true,
        value_parser = crate::values::seconds,
        help_heading = "Scene"
    )]
    pub time: Option<f64>,
    /// Change a limit on what a scene may cost; can be given many times. `zeroset fields limits` lists them
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment, help_heading = "Scene")]
    pub limit: Vec<(String, String)>,
}

#[derive(Clone, Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The scene of a picture that is made again: a .png or .exr in place of SCENE says with which parameters, time, size, camera, methods
    /// and seed `render` made it, and what is given beside it counts instead. Default: the .star or .json beside the picture with its name
    #[arg(long = "scene", value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Scene")]
    pub scene_file: Option<PathBuf>,
    /// The picture: .png, or .exr with all planes as layers. Default: named as the scene's file, in this folder
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Size in pixels, for example 1920x1080. Default: what the scene says, or 512x512
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Show a plane of the film as a picture. Default: colour
    #[arg(long, value_name = "PLANE", value_parser = plane_parser())]
    pub view: Option<Plane>,
    /// Leave out the strip beside a view that explains its colours
    #[arg(long)]
    pub no_legend: bool,
    /// Leave the background out: a PNG gets an alpha channel, an EXR the channel A and premultiplied colours. A scene that says nothing but what
    /// is shown gets no floor either
    #[arg(long, conflicts_with_all = ["view", "denoise"])]
    pub transparent: bool,
    /// Add mattes of the objects to an .exr, as Cryptomatte: programs that compose pictures select objects by their names, with smooth edges
    #[arg(long, conflicts_with_all = ["view", "time_limit"])]
    pub cryptomatte: bool,
    /// Bits a channel of a PNG. Default: 8
    #[arg(long, value_name = "BITS", value_parser = PossibleValuesParser::new(["8", "16"]))]
    pub bits: Option<String>,
    #[command(flatten)]
    pub methods: Methods,
    /// What renders
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub backend: Backend,
    /// The GPU whose name holds this text; `zeroset gpu` lists them. One that fails is an error
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Threads of the CPU; the picture is the same with any number. Default: all cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Render many pictures, numbered from A to just before B (or A..=B with B), one for each frame of time. In the
    /// output's name, #### is the place of the number; without it the number goes before the ending
    #[arg(long, value_name = "A..B", conflicts_with = "watch")]
    pub frames: Option<Frames>,
    /// Frames a second, which says what time it is at a frame: --time plus frame / fps
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = crate::values::positive, requires = "frames")]
    pub fps: f64,
    /// Take the noise out of the picture that paths traced at random, guided by the colours, normals and distances of surfaces
    #[arg(long, conflicts_with = "view")]
    pub denoise: bool,
    /// Seconds that rendering a picture may take, after the scene is loaded. Then the file is written, whole, with what
    /// there is: the tiles that are finished, and a picture of fewer rays or of larger pixels in all other places. What
    /// share is finished is said on standard error, and the exit code is 5
    #[arg(long, value_name = "SECONDS", value_parser = crate::values::positive)]
    pub time_limit: Option<f64>,
    /// Render until 95 % intervals are so narrow: of every 100 pixels of each 64x32, 95 are then that near to what they converge to, as a
    /// share of white on a screen (0.01 is hardly seen). Rays go where the error is. --spp is the most a pixel has on average (65536)
    #[arg(long, value_name = "SHARE", value_parser = crate::values::positive, help_heading = "Convergence")]
    pub noise: Option<f64>,
    /// Keep all rays in this file, every minute, at the end and when Ctrl-C or --time-limit ends the picture
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["frames", "watch"], help_heading = "Convergence")]
    pub checkpoint: Option<PathBuf>,
    /// Go on from the file of --checkpoint: to the same picture, bit for bit, as if nothing had ended it. With more --spp or less --noise
    /// it goes on from a finished one
    #[arg(long, requires = "checkpoint", help_heading = "Convergence")]
    pub resume: bool,
    /// Seconds between two checkpoints
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = crate::values::positive, requires = "checkpoint", help_heading = "Convergence")]
    pub checkpoint_every: f64,
    /// Render again whenever a file that the scene loads is saved, until Ctrl-C
    #[arg(long)]
    pub watch: bool,
    /// Print what was rendered and what it took as JSON, one line a picture
    #[arg(long)]
    pub json: bool,
    /// What a picture says of how it was made, that is made again
    #[arg(skip)]
    pub recipe: Option<Box<Recipe>>,
}

impl RenderArgs {
    /// The plane that is shown.
    pub(crate) fn plane(&self) -> Plane {
        self.view.unwrap_or(Plane::Colour)
    }
}

/// Methods in place of those that the scene states. `zeroset fields methods` explains them.
#[derive(Clone, Debug, Default, PartialEq, Args)]
pub(crate) struct Methods {
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<March>("How rays find the surface"))]
    pub march: Option<Chosen<March>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Normals>("How normals are found"))]
    pub normals: Option<Chosen<Normals>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Shadow>("The shadows of all lights"))]
    pub shadow: Option<Chosen<Shadow>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Occlusion>("Ambient occlusion, where an object has none of its own"))]
    pub ao: Option<Chosen<Occlusion>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Antialias>("How edges are smoothed"))]
    pub aa: Option<Chosen<Antialias>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Shading>("How light becomes colour"))]
    pub shading: Option<Chosen<Shading>>,
    /// Rays a pixel, whatever the scene states: as many as --aa supersample,samples=N
    #[arg(long, value_name = "N", help_heading = "Methods", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Chooses other random numbers than the scene's, 0 to 4294967295: those of where rays go in a pixel, and of light that is sampled
    #[arg(long, value_name = "N", help_heading = "Methods")]
    pub seed: Option<u32>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Tone>("How light beyond white is shown"))]
    pub tone: Option<Chosen<Tone>>,
    #[arg(long, value_name = "METHOD", help_heading = "Methods", help = help::<Integrator>("Which ways light takes to the eye"))]
    pub integrator: Option<Chosen<Integrator>>,
}

impl Methods {
    /// Puts what is chosen into a scene.
    ///
    /// # Errors
    /// A method takes more samples than are allowed.
    pub(crate) fn apply(&self, scene: &mut Scene, limits: &Limits) -> Result<(), Failure> {
        scene.edit_moments(|parts| self.put(parts, limits))
    }

    fn put(&self, parts: &mut SceneParts, limits: &Limits) -> Result<(), Failure> {
        let settings = &mut parts.settings;
        put("march", self.march, &mut settings.march, limits)?;
        put("normals", self.normals, &mut settings.normals, limits)?;
        put("ao", self.ao, &mut settings.occlusion, limits)?;
        put("aa", self.aa, &mut settings.antialias, limits)?;
        if let Some(samples) = self.spp {
            let filter = settings.antialias.filter().unwrap_or_default();
            let chosen = Chosen(Antialias::Supersample { samples, filter });
            put("spp", Some(chosen), &mut settings.antialias, limits)?;
        }
        if let Some(seed) = self.seed {
            settings.seed = seed;
        }
        put("tone", self.tone, &mut settings.tone, limits)?;
        put("shading", self.shading, &mut settings.shading, limits)?;
        put(
            "integrator",
            self.integrator,
            &mut settings.integrator,
            limits,
        )?;
        for light in &mut parts.lights {
            put("shadow", self.shadow, &mut light.shadow, limits)?;
        }
        Ok(())
    }
}

/// Every option that chooses a method, as `$each(name, field)`.
macro_rules! every {
    ($methods:expr, $each:ident) => {
        $each!("march", $methods.march);
        $each!("normals", $methods.normals);
        $each!("shadow", $methods.shadow);
        $each!("ao", $methods.ao);
        $each!("aa", $methods.aa);
        $each!("shading", $methods.shading);
        $each!("tone", $methods.tone);
        $each!("integrator", $methods.integrator);
    };
}

impl Methods {
    /// What is chosen, by option, in the words of the command line.
    pub(crate) fn written(&self) -> BTreeMap<String, String> {
        let mut out = BTreeMap::new();
        macro_rules! write {
            ($name:literal, $field:expr) => {
                if let Some(chosen) = $field {
                    out.insert($name.to_owned(), chosen.to_string());
                }
            };
        }
        every!(self, write);
        out
    }

    /// Chooses a method by its option, where none is chosen.
    ///
    /// # Errors
    /// There is no such option, or it does not take the text.
    pub(crate) fn choose(&mut self, option: &str, text: &str) -> Result<(), String> {
        macro_rules! read {
            ($name:literal, $field:expr) => {
                if option == $name {
                    let chosen = text.parse().map_err(|why| format!("--{option}: {why}"))?;
                    $field.get_or_insert(chosen);
                    return Ok(());
                }
            };
        }
        every!(self, read);
        Err(format!("--{option} chooses no method"))
    }
}

fn put<T: Choice>(
    flag: &str,
    chosen: Option<Chosen<T>>,
    place: &mut T,
    limits: &Limits,
) -> Result<(), Failure> {
    let Some(Chosen(method)) = chosen else {
        return Ok(());
    };
    (method.check(limits.samples)).map_err(|(param, refused)| {
        let message = format!("`{param}` of --{flag} {refused}");
        let help = "--limit samples=NUMBER allows more";
        Failure::with_help(Exit::Usage, message, help)
    })?;
    *place = method;
    Ok(())
}

#[cfg(feature = "window")]
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// What renders
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub backend: Backend,
    /// The GPU whose name holds this text; `zeroset gpu` lists them
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Threads of the CPU. Default: all cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SetArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Parameters of the scene with their values, such as size=0.7
    #[arg(value_name = "NAME=VALUE", value_parser = assignment)]
    pub values: Vec<(String, String)>,
    /// Print the new text instead of writing it
    #[arg(long)]
    pub print: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExpandArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Write to a file instead of standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

#[cfg(feature = "shaders")]
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub language: ShaderLanguage,
    /// Size in pixels that WGSL draws. (Shadertoy has its own.) Default: what the scene says, or 512x512
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Write to a file instead of standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

#[cfg(feature = "shaders")]
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct ShaderLanguage {
    /// As a WGSL module with a vertex and a fragment entry point, for WebGPU and wgpu
    #[arg(long)]
    pub wgsl: bool,
    /// As GLSL that runs when it is pasted into Shadertoy; dragging with the mouse looks around
    #[arg(long)]
    pub glsl: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FieldsArgs {
    /// The name to explain. Default: list all names
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WhyArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Column of the pixel, from the left, beginning with 0
    #[arg(value_name = "X")]
    pub x: u32,
    /// Row of the pixel, from above, beginning with 0
    #[arg(value_name = "Y")]
    pub y: u32,
    /// Size of the picture in pixels. Default: what the scene says, or 512x512
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CertifyArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Size in pixels. Default: what the scene says, or 512x512
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// A map of the verdicts: .png; green is hit, blue missed, yellow unknown, red wrong
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Fail where less of the picture is proven
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = crate::values::percent)]
    pub at_least: f64,
    /// Threads. Default: as many as the machine has cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SliceArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The plane of the section, for example z=0 or y=-0.5
    #[arg(long, value_name = "AXIS=WHERE", default_value = "z=0")]
    pub plane: SectionPlane,
    /// The picture: .png. Default: named as the scene's file with -slice, in this folder
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Size in pixels
    #[arg(long, value_name = "WxH", default_value = "512x512")]
    pub size: Size,
    /// What is seen of the plane, scene units: left, bottom, right, top. Default: the scene's bounds and some air
    #[arg(long, value_name = "U0,V0,U1,V1", allow_hyphen_values = true)]
    pub window: Option<Window>,
    /// Leave out the strip that explains the colours
    #[arg(long)]
    pub no_legend: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BakeArgs {
    /// A mesh (.obj, .ply, .stl, .gltf or .glb) or a scene (.star or .json)
    #[arg(value_name = "MESH|SCENE", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// The file: .vdb (OpenVDB) or .nrrd
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// Cells along the longest side
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(8..=2047))]
    pub voxels: u32,
    /// Cells from the surface beyond which distances end; 0 keeps them all. Default: 3 in OpenVDB, all in NRRD
    #[arg(long, value_name = "CELLS", value_parser = crate::values::cells)]
    pub band: Option<f64>,
    /// What is inside of a mesh: parity (of rays), winding (number above 1/2), or auto
    #[arg(long, value_name = "HOW", default_value = "auto", value_parser = crate::values::sign)]
    pub sign: zeroset_volume::bake::Sign,
    /// Print what was found as JSON
    #[arg(long)]
    pub json: bool,
    /// Set a parameter of the scene (slider, choice, toggle or color); can be given many times
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment, help_heading = "Scene")]
    pub set: Vec<(String, String)>,
    /// What time() is in the scene, seconds
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_parser = crate::values::seconds,
        help_heading = "Scene"
    )]
    pub time: f64,
    /// Change a limit on what a scene or a mesh may cost; can be given many times. `zeroset fields limits` lists them
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment, help_heading = "Scene")]
    pub limit: Vec<(String, String)>,
}

#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The file: .glb, .stl, .obj, .ply or .3mf
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// How far the faces may be from the surface, scene units. Default: a thousandth of the longest side
    #[arg(long, value_name = "LENGTH", value_parser = crate::values::positive)]
    pub tolerance: Option<f64>,
    /// Cells along the longest side; what is thinner than a cell may be missed. Default: from 64 on as many as the tolerance needs
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(i64::from(zeroset_contour::LEAST)..=i64::from(zeroset_contour::MOST)))]
    pub resolution: Option<u32>,
    /// Keep all faces, also where the tolerance needs fewer
    #[arg(long)]
    pub all_faces: bool,
    /// Cut what goes beyond this box, and close it there: scenes with an endless floor need it
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", allow_hyphen_values = true, value_parser = crate::values::bounds)]
    pub bounds: Option<zeroset_catalogue::bounds::Aabb>,
    /// Print what was made as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct EdtArgs {
    /// The picture: PNG or OpenEXR
    #[arg(value_name = "IMAGE", value_hint = ValueHint::FilePath)]
    pub image: PathBuf,
    /// The picture of distances: .png
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// What is near: euclidean, city-block or chessboard
    #[arg(long, value_name = "METRIC", default_value = "euclidean", value_parser = crate::values::metric)]
    pub metric: zeroset_volume::transform::Metric,
    /// How it is found: exact, brute, chamfer or dead-reckoning
    #[arg(long, value_name = "METHOD", default_value = "exact", value_parser = crate::values::transform)]
    pub method: zeroset_volume::transform::Method,
    /// The brightness from which on a pixel is inside, 0 to 1
    #[arg(long, value_name = "LEVEL", default_value_t = 0.5)]
    pub level: f32,
    /// What is darker is inside
    #[arg(long)]
    pub dark: bool,
    /// Leave the red line at the boundary out
    #[arg(long)]
    pub plain: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The reference: PNG or OpenEXR
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub reference: PathBuf,
    /// What is compared with it; of several there is a table
    #[arg(value_name = "B", required = true, value_hint = ValueHint::FilePath)]
    pub tests: Vec<PathBuf>,
    /// Print as JSON, a line for each
    #[arg(long)]
    pub json: bool,
    /// Write the differences that are seen (FLIP) as a picture, of one B
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct FitAoArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    #[arg(long, value_name = "METHOD", help = help::<Occlusion>("The method to fit, and the numbers to begin with. Default: quilez, bent, evans and upward, as the scene states them"))]
    pub ao: Option<Chosen<Occlusion>>,
    /// Size of the pictures that are compared, pixels
    #[arg(long, value_name = "WxH", default_value = "160x120")]
    pub size: Size,
    /// Rays a pixel of the reference, which is rendered twice
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub rays: u32,
    /// Threads of the CPU. Default: all cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Write the reference and all methods beside each other as a PNG: as stated, fitted, and how far they are off
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    #[command(subcommand)]
    pub measure: Measure,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Measure {
    /// Evaluate a scene's field in SIMD batches, and one point at a time
    Eval(Measured),
    /// Count evaluations a ray by each marcher, and hits that a dense march finds and it does not
    March(Measured),
    /// Render pictures by the stream renderer and by the plain one, at equal threads
    Frame(MeasuredFrame),
    /// Render pictures with cells, which hold what is left of a field in a part of space, and without
    Cells(Measured),
    /// Compose a volume of twenty moving bodies by the bricks that they touch, and from scratch, and render it with skylight
    Volumes(MeasuredVolumes),
}

#[derive(Debug, Args)]
pub(crate) struct MeasuredVolumes {
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Measured {
    /// The scene. Default: three joined solids over a floor (eval), a city of boxes (march), a molecule (cells)
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scene: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MeasuredFrame {
    /// The scene. Default: a sphere and a box on the ground, soft shadows, 5-tap occlusion, 512x512
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scene: Option<PathBuf>,
    /// What is measured: the CPU, or a GPU against the CPU
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = Backend::Cpu)]
    pub backend: Backend,
    /// The GPU whose name holds this text; `zeroset gpu` lists them
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Threads of the CPU's renderers
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: u16,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
pub(crate) struct GpuArgs {
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The file: .glsl or .frag (in a build with --features shaders), .json, .vm
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The function of a shader that gives the distance at a point. Default: map, sdf, scene, de, DE, GetDist, sdScene or the like
    #[arg(long, value_name = "NAME")]
    pub function: Option<String>,
    /// Write to a scene file instead of standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// The folder; it is made if there is none. Nothing in it is replaced
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The command to explain. Default: zeroset itself
    #[arg(value_name = "COMMAND")]
    pub command: Option<String>,
}

fn plane_parser() -> impl TypedValueParser<Value = Plane> {
    PossibleValuesParser::new(Plane::ALL.map(Plane::name)).try_map(|name| {
        Plane::ALL
            .into_iter()
            .find(|p| p.name() == name)
            .ok_or("no such plane")
    })
}
